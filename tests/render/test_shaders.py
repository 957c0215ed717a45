"""The shader loader: includes, line numbers, and errors that name the real file."""

import pytest

from stippler import resources
from stippler.render.shaders import Program, ShaderError, Source

VERTEX = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }\n"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "lib").mkdir()
    (tmp_path / "a.vert").write_text(VERTEX)
    (tmp_path / "lib" / "half.glsl").write_text(
        "// half\nfloat half_of(float x) { return x / 2.0; }\n"
    )
    return tmp_path


def fragment(folder, *lines):
    text = "\n".join(["#version 330 core", *lines, ""])
    (folder / "a.frag").write_text(text)


def test_an_include_is_put_in_place_once(folder):
    fragment(folder, '#include "lib/half.glsl"', '#include "lib/half.glsl"', "// end")
    source = Source(folder / "a.frag", folder)
    assert source.text.count("float half_of") == 1
    assert source.text.startswith("#version 330 core\n")
    assert source.files == ["a.frag", "lib/half.glsl"]


def test_an_error_names_its_own_file_and_line(ctx, folder):
    fragment(folder, '#include "lib/half.glsl"', "out vec4 o;", "void main() { o = wrong; }")
    with pytest.raises(ShaderError, match=r"a\.frag:4\b.*wrong"):
        Program(ctx, "a.vert", "a.frag", folder=folder)
    good_after(ctx, folder)


def test_an_error_in_an_include_names_the_include(ctx, folder):
    (folder / "lib" / "half.glsl").write_text(
        "// one\n// two\nfloat half_of(float x) { return y; }\n"
    )
    fragment(folder, "// a line before", '#include "lib/half.glsl"', "void main() {}")
    with pytest.raises(ShaderError, match=r"lib/half\.glsl:3\b.*y"):
        Program(ctx, "a.vert", "a.frag", folder=folder)
    good_after(ctx, folder)


def test_defines_do_not_shift_lines(ctx, folder):
    fragment(folder, "#ifdef RED", "out vec4 o;", "void main() { o = wrong; }", "#endif")
    with pytest.raises(ShaderError, match=r"a\.frag:4\b"):
        Program(ctx, "a.vert", "a.frag", ["RED"], folder)
    good_after(ctx, folder)


def good_after(ctx, folder):
    """Make and release a program that works: errors leave nothing behind."""
    fragment(folder, "out vec4 o;", "void main() { o = vec4(1.0); }")
    Program(ctx, "a.vert", "a.frag", folder=folder).release()


def test_what_is_missing_is_an_error(folder):
    fragment(folder, "", '#include "lib/none.glsl"')
    with pytest.raises(ShaderError, match=r"a\.frag:3: there is no lib/none\.glsl"):
        Source(folder / "a.frag", folder)
    with pytest.raises(ShaderError, match=r"b\.frag"):
        Source(folder / "b.frag", folder)


def test_a_shader_without_version_is_an_error(folder):
    (folder / "a.frag").write_text("void main() {}\n")
    with pytest.raises(ShaderError, match="#version"):
        Source(folder / "a.frag", folder)


def test_an_unknown_define_is_an_error(ctx, folder):
    fragment(folder, "out vec4 o;", "void main() { o = vec4(1.0); }")
    with pytest.raises(ShaderError, match="GREEN"):
        Program(ctx, "a.vert", "a.frag", ["GREEN"], folder)
    good_after(ctx, folder)


def test_an_unknown_uniform_is_an_error(ctx, folder):
    fragment(folder, "uniform float u_a;", "out vec4 o;", "void main() { o = vec4(u_a); }")
    program = Program(ctx, "a.vert", "a.frag", folder=folder)
    program.set({"u_a": 0.5})
    with pytest.raises(ShaderError, match="u_b"):
        program.set({"u_b": 0.5})
    program.release()


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        ("0:7(3): error: x", "a.frag:7: error: x"),
        ("0(7) : error C1: x", "a.frag:7 : error C1: x"),
        ("ERROR: 0:7: x", "ERROR: a.frag:7: x"),
    ],
)
def test_messages_of_all_drivers_are_understood(folder, message, expected):
    fragment(folder, "")
    assert Source(folder / "a.frag", folder).explain(message) == expected


def test_every_shader_file_says_what_it_is_for():
    for path in sorted(resources.shaders().rglob("*.*")):
        assert path.read_text(encoding="utf-8").startswith("// "), path
