"""The shape panel in the whole editor: held controls are seen, let go they are made."""

from __future__ import annotations

import itertools
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from stippler.drawing.dots import Dots
from stippler.editor.events import NO_MODS
from stippler.ui.panels.layout import SHAPE

NAMES = [f.name for f in fields(Dots)]


@pytest.fixture(autouse=True)
def settings_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "config"))


@pytest.fixture
def shaping(desk, picture: Path):
    """An editor with a drawing and the panel in front."""
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.app.editor.show_panel(SHAPE)
    desk.host.settle()
    return desk


def same(a: Dots, b: Dots) -> bool:
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in NAMES)


def page_of(desk) -> np.ndarray:
    desk.host.settle()
    left, top = (round(v) for v in desk.app.editor.pointer.origin_px)
    w, h = desk.app.editor.view.size_px
    return desk.host.screenshot().astype(int)[top : top + h, left : left + w]


_STARTS = itertools.cycle((0.3, 0.5, 0.7))


def hold(desk, label: str, share: float) -> None:
    """Press on a slider, and drag it to a share of its width."""
    x0, y0, x1, y1 = desk.app.editor.widgets.marks[label]
    start = x0 + next(_STARTS) * (x1 - x0)  # two presses at one place would be a double click
    desk.host.move(start, 0.5 * (y0 + y1))
    desk.host.press()
    desk.host.move(start + 8.0, 0.5 * (y0 + y1))  # a press alone changes nothing
    desk.host.move(x0 + share * (x1 - x0), 0.5 * (y0 + y1))
    desk.host.settle()


def let_go(desk) -> None:
    """Let go, and leave the panel, or its tooltip would cover the page."""
    desk.host.release()
    desk.host.move(500, 600)
    desk.host.settle()


def labels(desk) -> list[str]:
    return [step.label for step in desk.app.session.document.history.steps]


@pytest.mark.parametrize(
    ("label", "share", "step"),
    [("Size", 0.7, "Resize"), ("Elongation", 0.9, "Elongate"), ("Roughness", 0.9, "Roughen")],
)
def test_what_a_held_slider_shows_is_made_when_it_is_let_go(shaping, label, share, step) -> None:
    document = shaping.app.session.document
    start, plain = document.dots.copy(), page_of(shaping)
    hold(shaping, label, share)
    shown = page_of(shaping)
    assert np.abs(shown - plain).max() > 150
    assert same(document.dots, start)
    assert not labels(shaping)
    let_go(shaping)
    left = page_of(shaping)
    assert labels(shaping) == [f"{step} all dots"]
    assert np.abs(shown - left).max() <= 24
    assert np.abs(shown - left).mean() < 0.02
    shaping.host.key("z", ctrl=True)
    assert same(document.dots, start)
    assert (page_of(shaping) == plain).all()


def test_nothing_is_uploaded_while_a_slider_is_held(shaping, monkeypatch) -> None:
    renderer = shaping.app.editor.canvas._renderer().scene
    for name in ("set_dots", "update_dots", "set_positions"):
        monkeypatch.setattr(renderer, name, lambda *_, **__: pytest.fail("dots were uploaded"))
    n_drawn = shaping.app.editor.canvas.n_drawn
    hold(shaping, "Elongation", 0.9)
    assert shaping.app.editor.canvas.n_drawn > n_drawn


def test_escape_puts_back_what_is_held(shaping) -> None:
    document = shaping.app.session.document
    start, plain = document.dots.copy(), page_of(shaping)
    hold(shaping, "Elongation", 0.9)
    shaping.host.key("escape")
    shaping.host.move(400, 600)
    assert (page_of(shaping) == plain).all()
    let_go(shaping)
    assert same(document.dots, start)
    assert not labels(shaping)


def test_only_the_selection_is_shaped(shaping) -> None:
    document, painting = shaping.app.session.document, shaping.app.editor.painting
    shaping.host.click("Selection")
    plain = page_of(shaping)
    hold(shaping, "Elongation", 0.9)  # nothing is selected
    let_go(shaping)
    assert not labels(shaping)
    ids = document.dots.id[document.dots.position_mm[:, 0] < 60]
    painting.toolbox.selection.choose(ids.copy(), NO_MODS)
    shaping.host.move(600, 500)
    assert (page_of(shaping) != plain).any()  # they are marked
    hold(shaping, "Elongation", 0.9)
    shown = page_of(shaping)
    let_go(shaping)
    left = page_of(shaping)
    assert labels(shaping) == ["Elongate selected dots"]
    is_long = document.dots.elongation > 1
    assert np.array_equal(is_long, np.isin(document.dots.id, ids))
    assert np.abs(shown - left).max() <= 24


def test_pens_show_under_the_pointer_and_are_taken_by_a_click(shaping) -> None:
    document = shaping.app.session.document
    start, plain = document.dots.copy(), page_of(shaping)
    shaping.host.move(*shaping.host.place("Stick"))
    shown = page_of(shaping)
    assert np.abs(shown - plain).max() > 150
    shaping.host.move(500, 600)
    assert (page_of(shaping) == plain).all()
    assert same(document.dots, start)
    shaping.host.click("Stick")
    shaping.host.move(500, 600)
    assert np.abs(page_of(shaping) - shown).max() <= 24
    assert labels(shaping) == ["Stick: all dots"]
    shaping.host.click("Technical pen")
    shaping.host.move(500, 600)
    assert np.abs(page_of(shaping) - plain).max() <= 24


def test_dots_turn_along_the_picture(shaping) -> None:
    document = shaping.app.session.document
    hold(shaping, "Elongation", 0.9)
    let_go(shaping)
    panel = shaping.app.editor.shaping
    panel.direction = "edges"
    panel.scatter_rad = 0.0
    shaping.host.move(600, 500)  # a frame with the new controls
    hold(shaping, "Scatter", 0.5)
    shown = page_of(shaping)
    let_go(shaping)
    assert np.abs(page_of(shaping) - shown).max() <= 24
    assert labels(shaping)[-1] == "Turn all dots"
    hold(shaping, "Scatter", 0.0)
    let_go(shaping)
    from_middle = document.dots.position_mm - (60.0, 45.0)
    away = np.hypot(*from_middle.T)
    at_rim = away > 27.0
    assert at_rim.sum() > 8
    along = np.arctan2(*from_middle[at_rim].T[::-1]) + np.pi / 2
    off = np.sin(document.dots.angle_rad[at_rim] - along)
    assert np.abs(off).mean() < 0.15


def test_a_drawing_is_made_with_a_pen_and_seen_so_meanwhile(shaping) -> None:
    session, editor = shaping.app.session, shaping.app.editor
    first = session.document.dots.copy()
    n_steps = session.style.iterations
    assert session.edit_style(pen="stick", iterations=100_000)  # however quick, it is under way
    session.start()
    shaping.host.until(lambda: session.document.in_draft and session.n_dots > 0, "dots")
    assert session.document.dots.roughness.min() > 0.5
    shaping.host.settle()
    assert editor.canvas._made.scene.dots.is_rough
    session.edit_style(iterations=n_steps)
    session.start()
    shaping.host.until(lambda: not session.busy, "the drawing")
    dots = session.document.dots
    assert dots.roughness.min() > 0.5
    assert np.array_equal(dots.position_mm, first.position_mm)
    assert 0.95 < np.median(dots.radius_mm / first.radius_mm) < 1.15  # sizes meet the tone anew
