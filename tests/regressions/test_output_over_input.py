"""`render photo.png -o photo.png` put the drawing in the photograph's place, through links, too."""

import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import stippler
from stippler.errors import OutputError
from stippler.start import main


@pytest.fixture
def photo(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Image.fromarray(np.arange(64, dtype=np.uint8).reshape(8, 8)).save("photo.png")
    Path("soft.png").symlink_to("photo.png")
    Path("hard.png").hardlink_to("photo.png")
    return Path("photo.png")


@pytest.mark.parametrize("output", ["photo.png", "./photo.png", "soft.png", "hard.png"])
@pytest.mark.parametrize("source", ["photo.png", "soft.png"])
def test_render_refuses_before_any_work(photo, monkeypatch, capsys, source, output):
    before = photo.read_bytes()
    monkeypatch.setattr(sys, "argv", ["stippler", "render", source, "-o", output])
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 1
    line = capsys.readouterr().err
    assert line.count("\n") == 1
    assert "the very file that is read" in line
    assert photo.read_bytes() == before


def test_a_drawing_knows_what_it_was_made_from(photo):
    before = photo.read_bytes()
    drawing = stippler.stipple("photo.png", dots=10, iterations=0)
    for name in ("photo.png", "soft.png", "hard.png"):
        with pytest.raises(OutputError, match="the very file that is read"):
            drawing.save(name)
    assert photo.read_bytes() == before
