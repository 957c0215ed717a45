"""A number too large for a float, or a pit of brackets, in a settings file ended the editor.

And a file of brushes that could not be read was written over, with all that was in it.
"""

import json

import pytest

from stippler.brushes.brush import Brush, first_brushes
from stippler.brushes.presets import load_brushes
from stippler.editor.tools.toolbox import Toolbox
from stippler.errors import StipplerError
from stippler.settings import read_document
from stippler.ui.preferences import FILE, Preferences

HUGE = 10**400


@pytest.mark.parametrize(
    "document",
    [
        {"layout_scale": HUGE},
        {"layout_scale": 1e-300},
        {"layout_scale": -1.0},
        {"look": {"opacity": HUGE}},
        {"values": {"width_mm": HUGE}},
    ],
)
def test_a_value_out_of_all_range_is_told(tmp_path, document):
    (tmp_path / FILE).write_text(json.dumps(document))
    kept = Preferences.load(tmp_path)
    assert "as at first" in kept.problem
    assert kept.layout_scale == 0.0


def test_brackets_without_end_are_told(tmp_path):
    (tmp_path / FILE).write_text("[" * 100_000)
    document, problem = read_document(tmp_path / FILE)
    assert not document
    assert "is kept as preferences.broken.json" in problem


@pytest.mark.parametrize("changes", [{"radius_mm": HUGE}, {"name": 5}, {"name": None}])
def test_a_brush_that_is_none_is_left_out_and_its_file_kept(tmp_path, changes):
    path, said = tmp_path / "brushes.json", []
    mine = Brush("Mine", "erase", 2.0)
    bad = {**first_brushes()[0].as_dict(), **changes}
    path.write_text(text := json.dumps({"brushes": [bad, mine.as_dict()]}))
    box = Toolbox(path, lambda line, grade: said.append(line))
    assert "brushes.broken.json" in said[0]
    box.save()
    assert (tmp_path / "brushes.broken.json").read_text() == text
    assert mine in load_brushes(path)[0]


def test_a_broken_file_of_brushes_is_not_written_over(tmp_path):
    path = tmp_path / "brushes.json"
    path.write_text('{"brushes": [')
    box = Toolbox(path, lambda line, grade: None)
    box.choose("add")
    box.resize(2.0)
    box.save()
    assert (tmp_path / "brushes.broken.json").read_text() == '{"brushes": ['


def test_what_could_not_be_kept_is_tried_again(tmp_path):
    folder = tmp_path / "settings"
    folder.write_text("in the way")
    kept = Preferences(folder)
    with pytest.raises(StipplerError):
        kept.keep()
    folder.unlink()
    kept.keep()
    assert (folder / FILE).exists()
