"""Plain arguments of `render` mean what the parser makes of them, and nothing else is plain."""

import gc
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from stippler import cli, cli_ends, cli_plain, cli_render, start
from stippler.cli_plain import STYLED, plain
from stippler.drawing.parameter import Kind
from stippler.files.write.formats import every_option
from tests.conftest import EXAMPLES

FLAGS = [one.option for one in STYLED if one.kind is Kind.FLAG] + [
    flag
    for option, _ in every_option().values()
    if option.type is bool
    for flag in (option.flag, f"--no-{option.flag[2:]}")
]
TAKING = [one.option for one in STYLED if one.kind is not Kind.FLAG] + [
    option.flag for option, _ in every_option().values() if option.type is not bool
]
TAKING += ["-o", "--output", "--format", "--style"]
VALUES = ["5", "2.5", "1e3", "1_000", " 7 ", "inf", "-3", "even", "wood", "0.1:0.3", "svg", "", "é"]

words = st.one_of(
    st.tuples(st.sampled_from(TAKING), st.sampled_from(VALUES)),
    st.sampled_from([(flag,) for flag in FLAGS]),
    st.sampled_from(
        [("a.png",), ("b.png",), ("-",), ("--",), ("--help",), ("--dots=5",), ("--dot",)]
    ),
)


class Seen:
    """What a command would have been carried out with, or what was said of it."""

    def __init__(self, patch):
        self.found = []
        for module in (cli, cli_render):
            patch.setattr(module, "render_file", lambda *asked: self.found.append(asked))
        for module in (cli, cli_ends):
            patch.setattr(module, "fail", self._fail)

    def _fail(self, text, status=0, do=""):
        self.found.append((text, do))
        return status

    def of(self, command):
        self.found.clear()
        return command(), list(self.found)


def both(args):
    """Return what plain arguments mean, and what the parser makes of them."""
    with pytest.MonkeyPatch.context() as patch:
        seen = Seen(patch)
        asked = plain(args)
        return None if asked is None else seen.of(asked.run), seen.of(lambda: cli.run(args))


@given(st.lists(words, max_size=5))
@settings(max_examples=60 * EXAMPLES, deadline=None)
def test_what_is_plain_means_what_the_parser_makes_of_it(more):
    args = ["render", "picture.png", "-o", "out.svg", *(word for one in more for word in one)]
    ours, parsed = both(args)
    assert ours is None or ours == parsed


@pytest.mark.parametrize("option", [*TAKING, *FLAGS])
def test_every_option_is_plain(option):
    for value in VALUES:
        given = [option] if option in FLAGS else [option, value]
        own = [] if option in ("-o", "--output") else ["-o", "out.svg"]
        ours, parsed = both(["render", "picture.png", *own, *given])
        if ours is not None:
            assert ours == parsed
            return
    pytest.fail("no value of it is plain")


@pytest.mark.parametrize(
    "args",
    [
        [], ["a.png"], ["render"], ["render", "a.png"], ["render", "-o", "b.svg"],
        ["render", "a.png", "b.png", "-o", "b.svg"], ["render", "-", "-o", "b.svg"],
        ["render", "a.png", "-o", "-"], ["render", "a.png", "-o"], ["render", "", "-o", "b.svg"],
        ["render", "a.png", "-o", "b.svg", "--help"], ["render", "a.png", "-o", "b.svg", "--", "c"],
        ["render", "a.png", "-o", "b.svg", "--dots", "many"], ["render", "a.png", "-ob.svg"],
        ["render", "a.png", "-o", "b.svg", "--dots=5"], ["render", "a.png", "-o", "b.svg", "--nib"],
        ["render", "a.png", "-o", "b.svg", "--seed", "1", "--seed", "2"],
        ["stats", "a.png"], ["edit", "a.png"],
    ],
)  # fmt: skip
def test_all_else_is_the_parsers(args):
    assert plain(args) is None


def test_what_a_shell_would_complete_is_the_parsers(monkeypatch):
    args = ["render", "a.png", "-o", "b.svg"]
    assert plain(args) == cli_plain.Plain(Path("a.png"), Path("b.svg"), "", {}, {})
    monkeypatch.setenv("_STIPPLER_COMPLETE", "bash_complete")
    assert plain(args) is None


def test_a_plain_render_imports_only_what_it_needs(tmp_path):
    picture, out = tmp_path / "grey.png", tmp_path / "out.svg"
    Image.fromarray(np.full((80, 80), 90, np.uint8)).save(picture)
    ended = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "stippler", "render", picture, "-o", out,
         "--dots", "200"],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    lines = [line for line in ended.stderr.splitlines() if line.startswith("import time:")]
    there = {line.rpartition("|")[2].strip() for line in lines}
    assert "stippler.cli_plain" in there
    needless = {
        "typer", "rich", "scipy", "numpy.ma", "subprocess", "zipfile", "PIL.JpegImagePlugin",
        "stippler.cli", "stippler.drawing.document", "stippler.drawing.planar.planar_map",
        "stippler.files.native.drawing_file", "stippler.stippling.beyond",
        "stippler.stippling.area_bleed", "stippler.stippling.new_on_lines",
    }  # fmt: skip
    assert not there & needless


def test_other_commands_collect_garbage_as_they_are_run():
    assert start._command(["--help"]).__name__ == "<lambda>"
    assert gc.isenabled()
