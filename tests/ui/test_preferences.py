"""What is kept from one start to the next."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from stippler.drawing.style import Style
from stippler.ui.preferences import FILE, LAYOUT_FILE, N_RECENT, Preferences
from stippler.ui.theme import DARK, LIGHT
from stippler.ui.window.placement import Place

VALUES: dict[str, Any] = {
    "tone": "perceptual",
    "width_mm": 90.0,
    "n_dots": 5000,
    "size_range_mm": (0.1, 0.3),
    "iterations": 7,
    "first_dots": "random",
    "weighted": False,
}


def written(folder: Path) -> Preferences:
    kept = Preferences(folder)
    kept.look.theme, kept.look.scale, kept.look.opacity = DARK, 1.5, 0.6
    kept.look.reference_shown = True
    kept.values = dict(VALUES)
    kept.place = Place((900, 700), (10, 20), maximised=True)
    kept.closed = ["History"]
    kept.note_opened(Path("/pictures/shell.png"))
    kept.note_ran("view.fit")
    kept.layout, kept.layout_scale = "[Window][Drawing]\nPos=1,2\n", 1.5
    kept.keep()
    return kept


def test_all_of_it_comes_back(tmp_path: Path) -> None:
    before, after = written(tmp_path), Preferences.load(tmp_path)
    assert after.problem == ""
    assert after.look == before.look
    assert after.values == VALUES
    for name in ("place", "closed", "recent", "ran", "layout", "layout_scale"):
        assert getattr(after, name) == getattr(before, name), name


def test_nothing_is_kept_without_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Preferences().keep()
    assert list(tmp_path.iterdir()) == []


def test_it_is_written_only_when_it_has_changed(tmp_path: Path) -> None:
    kept = written(tmp_path)
    (tmp_path / FILE).unlink()
    kept.keep()
    assert not (tmp_path / FILE).exists()
    kept.note_ran("view.theme")
    kept.keep()
    assert (tmp_path / FILE).exists()


@pytest.mark.parametrize(
    ("part", "value"),
    [
        ("look", "dark"),
        ("look", {"opacity": "much"}),
        ("look", {"scale": float("nan")}),
        ("values", {"tone": "loud", "width_mm": 90.0}),
        ("values", {"tone": "linear", "width_mm": -1}),
        ("values", {"tone": "linear", "width_mm": 90, "n_dots": 1.5}),
        ("values", {"tone": "linear", "width_mm": 90, "size_range_mm": [0.3, 0.1]}),
        ("values", {"tone": "linear", "width_mm": 90, "first_dots": "sneeze"}),
        ("window", {"size": [0, 700], "at": None, "maximised": False}),
        ("window", {"size": "wide"}),
        ("recent_files", [3]),
        ("recent_files", 3),
        ("recent_commands", [None]),
        ("layout_scale", "big"),
    ],
)
def test_a_bad_part_is_one_line_and_the_others_are_used(
    tmp_path: Path, part: str, value: Any
) -> None:
    written(tmp_path)
    document = json.loads((tmp_path / FILE).read_text())
    document[part] = value
    document["of a later version"] = 1
    (tmp_path / FILE).write_text(json.dumps(document))
    kept = Preferences.load(tmp_path)
    assert FILE in kept.problem
    assert repr(part) in kept.problem
    assert "\n" not in kept.problem
    assert kept.closed == ["History"]
    if part != "look":
        assert kept.look.theme is DARK
    if part == "values":
        assert kept.begin(Style(), "linear", 148.0, ()) == (Style(), "linear", 148.0)


def test_unknown_parts_of_the_look_are_ignored(tmp_path: Path) -> None:
    (tmp_path / FILE).write_text('{"look": {"theme": "sepia", "scale": 77, "glow": 1}}')
    kept = Preferences.load(tmp_path)
    assert kept.problem == ""
    assert kept.look.theme is LIGHT
    assert kept.look.scale == 3.0


def test_a_layout_that_is_no_text_is_told(tmp_path: Path) -> None:
    (tmp_path / LAYOUT_FILE).write_bytes(b"\xff\xfe\xfa")
    kept = Preferences.load(tmp_path)
    assert LAYOUT_FILE in kept.problem
    assert kept.layout == ""


def test_what_the_command_line_asks_for_counts_more(tmp_path: Path) -> None:
    written(tmp_path)
    kept = Preferences.load(tmp_path)
    style, tone, width_mm = kept.begin(Style(), "linear", 148.0, ())
    assert (style.n_dots, style.iterations, tone, width_mm) == (5000, 7, "perceptual", 90.0)
    assert style.seed == 1
    asked = Style(iterations=3)
    style, tone, width_mm = kept.begin(asked, "linear", 148.0, {"iterations", "tone"})
    assert (style.n_dots, style.iterations, tone, width_mm) == (5000, 3, "linear", 90.0)
    # one of number and sizes follows from the other: both are then the command line's
    style, _, _ = kept.begin(Style(size_range_mm=(0.2, 0.4)), "linear", 1.0, {"size_range_mm"})
    assert (style.n_dots, style.size_range_mm) == (None, (0.2, 0.4))


def test_ten_recent_pictures_the_last_first() -> None:
    kept = Preferences()
    for k in range(N_RECENT + 5):
        kept.note_opened(Path(f"/p/{k}.png"))
    kept.note_opened(Path("/p/12.png"))
    assert len(kept.recent) == N_RECENT
    assert kept.recent[:2] == [Path("/p/12.png"), Path("/p/14.png")]
    assert len(set(kept.recent)) == N_RECENT
