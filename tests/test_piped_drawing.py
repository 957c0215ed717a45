"""Drawings through pipes, and never over the file that is read."""

import subprocess
import sys

import pytest

import stippler
from stippler.files.native.drawing_file import save_drawing
from tests.corpus.contents import CONTENTS


@pytest.fixture
def drawing(tmp_path):
    save_drawing(CONTENTS["areas"](), tmp_path / "a.stipple")
    return tmp_path / "a.stipple"


def run(line, folder):
    command = line.replace("stippler", f"{sys.executable} -m stippler")
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=folder)
    return done.returncode, done.stdout, done.stderr


def test_a_drawing_is_piped_in_and_out(drawing):
    code, _, said = run("cat a.stipple | stippler render - -o out.svg", drawing.parent)
    assert (code, said) == (0, "")
    assert (drawing.parent / "out.svg").read_text().startswith("<svg")
    line = "stippler render - -o - --format stipple < a.stipple | stippler render - -o b.stipple"
    assert run(line, drawing.parent) == (0, "", "")
    assert len(stippler.open(drawing.parent / "b.stipple").dots) == 24


def test_a_drawing_is_not_written_over_while_it_is_read(drawing):
    before = drawing.read_bytes()
    code, _, said = run("stippler render - -o a.stipple < a.stipple", drawing.parent)
    assert code == 1
    assert "is the very file that is read" in said
    assert drawing.read_bytes() == before
    code, _, said = run("cat a.stipple | stippler render - -o a.stipple", drawing.parent)
    assert (code, said) == (0, "")  # whoever reads for us has read it all by then
    assert len(stippler.open(drawing).dots) == 24


def test_what_is_said_of_a_pipe_names_no_file_of_ours(drawing):
    code, _, said = run("head -c 700 a.stipple | stippler render - -o x.svg", drawing.parent)
    assert code == 1
    assert said.startswith("stippler: standard input: is broken")
    line = "cat a.stipple | stippler render - -o x.svg --dots 5"
    code, _, said = run(line, drawing.parent)
    assert code == 2
    assert "standard input is a drawing already" in said
    assert not (drawing.parent / "x.svg").exists()
