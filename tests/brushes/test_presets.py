"""Brushes as data: checked, kept in a file, found again."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.brushes.brush import Brush, first_brushes
from stippler.brushes.effects import EFFECTS
from stippler.brushes.kinds import KINDS
from stippler.brushes.presets import load_brushes, presets_path, save_brushes
from stippler.brushes.tip import Tip
from stippler.errors import ParameterError, StipplerError


def test_every_kind_has_an_effect_or_a_tool_and_its_own_key():
    assert {kind.name for kind in KINDS} - set(EFFECTS) == {"drag"}
    assert len({kind.key for kind in KINDS}) == len(KINDS)


@given(st.floats(0.05, 500), st.floats(0, 1), st.floats(-3, 3), st.text(max_size=20))
def test_a_brush_survives_json(radius, hardness, angle, name):
    tip = Tip("polygon", hardness, 0.5, angle, ((0.0, 0.5), (1.0, 0.0), (-0.25, -1.0)))
    brush = Brush(name, "jitter", radius, tip, values={"amount": 33.0, "measure": "cell"})
    assert Brush.from_dict(json.loads(json.dumps(brush.as_dict()))) == brush


def test_brushes_survive_a_restart(tmp_path):
    path = tmp_path / "deep" / "brushes.json"
    mine = [*first_brushes(), Brush("Fine erase", "erase", 0.5)]
    save_brushes(path, mine)
    loaded, problem = load_brushes(path)
    assert not problem
    assert sorted(map(str, loaded)) == sorted(map(str, mine))
    assert [p.name for p in path.parent.iterdir()] == ["brushes.json"]


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"brushes": 3}', '{"brushes": [{"kind": "nonsense"}]}', "\x00"]
)
def test_a_damaged_file_is_told_and_every_type_is_there(tmp_path, text):
    path = tmp_path / "brushes.json"
    path.write_text(text)
    brushes, problem = load_brushes(path)
    assert problem
    assert {brush.kind for brush in brushes} == {kind.name for kind in KINDS}


def test_a_missing_file_is_nothing_to_tell(tmp_path):
    assert load_brushes(tmp_path / "none.json") == (first_brushes(), "")


def test_a_folder_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StipplerError):
        save_brushes(tmp_path / "file" / "brushes.json", [])


def test_the_settings_folder_can_be_moved(tmp_path, monkeypatch):
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    assert presets_path() == tmp_path / "brushes.json"


@pytest.mark.parametrize(
    "wrong",
    [
        {"kind": "nonsense"},
        {"kind": "erase", "radius_mm": 0.0},
        {"kind": "erase", "radius_mm": float("nan")},
        {"kind": "erase", "spacing": 0.0},
        {"kind": "erase", "smoothing": "glue"},
        {"kind": "erase", "pressure": "hope"},
        {"kind": "size", "values": {"amount": 1e9}},
        {"kind": "size", "values": {"amount": "much"}},
        {"kind": "size", "values": {"how": "somehow"}},
        {"kind": "relax", "values": {"by_tone": 1.0}},
    ],
)
def test_what_is_no_brush_is_refused(wrong):
    with pytest.raises(ParameterError):
        Brush("wrong", **wrong)
