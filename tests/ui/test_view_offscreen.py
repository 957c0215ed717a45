"""Turning, flipping, lens and picture in the whole editor, by scripted keys, mouse and panels."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from stippler.drawing.adjustment import NEUTRAL
from stippler.ui.panels.layout import DRAWING, VIEW
from stippler.ui.theme import PANEL_WIDTH, STRIP_WIDTH

PLACE = (650.0, 330.0)
LEFT = round(STRIP_WIDTH + PANEL_WIDTH) + 60  # the strip may have two columns


@pytest.fixture(autouse=True)
def settings_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))


@pytest.fixture
def opened(desk, picture: Path):
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.app.editor.show_panel(VIEW)
    desk.host.settle()
    desk.app.session.messages.dismiss()
    desk.host.settle()
    return desk


def on_screen(desk, x_mm: float, y_mm: float) -> tuple[float, float]:
    editor = desk.app.editor
    x, y = editor.view.camera.page_to_screen((x_mm, y_mm), editor.view.size_px)
    origin = editor.pointer.origin_px
    return float(x + origin[0]), float(y + origin[1])


def dark(shot: np.ndarray, at: tuple[float, float], reach: int) -> float:
    x, y = (round(v) for v in at)
    return float((shot[y - reach : y + reach, x - reach : x + reach].mean(axis=2) < 100).mean())


def test_keys_turn_flip_and_set_upright(opened) -> None:
    host, view = opened.host, opened.app.editor.view
    start = view.camera
    for key in ("period", "period", "period", "comma"):
        host.key(key)
    assert math.degrees(view.camera.rotation_rad) == pytest.approx(30)
    host.key("y")
    assert view.camera.flip
    assert math.degrees(view.camera.rotation_rad) == pytest.approx(-30)
    host.key("0")
    assert view.camera == start


def test_the_panel_turns_flips_and_sets_upright(opened) -> None:
    host, view = opened.host, opened.app.editor.view
    host.fill("Turned", "37.5")
    assert math.degrees(view.camera.rotation_rad) == pytest.approx(37.5)
    host.click("Turn left")
    assert math.degrees(view.camera.rotation_rad) == pytest.approx(22.5)
    host.click("Flipped")
    assert view.camera.flip
    host.click("Upright")
    assert (view.camera.rotation_rad, view.camera.flip) == (0.0, False)


def test_shift_and_the_middle_button_turn_freely(opened) -> None:
    host, editor = opened.host, opened.app.editor
    middle = np.array(editor.pointer.origin_px) + np.array(editor.view.size_px) / 2
    x, y = (float(v) for v in middle)
    host.drag((x + 200, y), (x, y + 200), "middle", shift=True)
    assert math.degrees(editor.view.camera.rotation_rad) == pytest.approx(90)


def test_painting_on_a_turned_and_flipped_page_lands_under_the_brush(opened) -> None:
    host, document = opened.host, opened.app.session.document
    host.key("y")
    host.fill("Turned", "50")
    host.key("e")
    place = on_screen(opened, 50.0, 45.0)
    x, y = (round(v) for v in place)
    before = dark(host.screenshot(), place, 3 * 5)
    radius = opened.app.editor.painting.toolbox.brush.radius_mm
    host.move(*place)
    host.press()
    host.release()
    away = np.hypot(*(document.dots.position_mm - (50.0, 45.0)).T)
    assert before > 0
    assert away.min() > 0.8 * radius
    assert 0 < 300 - len(document.dots) < 60
    host.move(x + 150.0, y)
    host.settle()
    reach = round(0.5 * radius * opened.app.editor.view.camera.px_per_mm)
    assert dark(host.screenshot(), place, reach) == 0.0


def test_a_rectangle_selects_what_it_shows_on_a_turned_page(opened) -> None:
    host, editor = opened.host, opened.app.editor
    host.fill("Turned", "45")
    host.key("m")
    a, b = on_screen(opened, 60.0, 45.0), (0.0, 0.0)
    b = (a[0] + 60.0, a[1] + 90.0)
    host.drag(a, b, "left")
    chosen = editor.painting.toolbox.selection.ids
    document = opened.app.session.document
    at = editor.view.camera.page_to_screen(document.dots.position_mm, editor.view.size_px)
    at += editor.pointer.origin_px
    inside = ((at > a) & (at < b)).all(axis=1)
    assert 0 < inside.sum() < len(at) / 2
    assert set(chosen) == set(document.dots.id[inside])
    host.key("f", shift=True)
    place = editor.view.camera.page_to_screen(
        document.dots.position_mm[inside], editor.view.size_px
    )
    assert place.min() > 0
    assert (place < editor.view.size_px).all()
    assert editor.view.camera.px_per_mm > 6.0


def test_zooming_to_nothing_says_so(opened) -> None:
    camera = opened.app.editor.view.camera
    opened.host.key("f", shift=True)
    assert "no dots are selected" in opened.host.said()
    assert opened.app.editor.view.camera == camera


def test_the_lens_shows_while_its_key_is_held_and_draws_only_what_changes(opened) -> None:
    host, editor = opened.host, opened.app.editor
    canvas = editor.canvas
    host.move(*PLACE)
    host.settle()
    before, pages = host.screenshot(), canvas.n_drawn
    host.key_down("z")
    host.settle()
    under = host.screenshot()
    y, x = np.mgrid[:700, :1000] + 0.5
    changed = (under != before).any(axis=2)
    away = np.hypot(x - PLACE[0], y - PLACE[1])
    canvas_part = (x > LEFT) & (y < 665)
    assert changed[canvas_part & (away < 118)].mean() > 0.3
    assert not changed[canvas_part & (away > 142)].any()
    lenses = canvas.n_lens_drawn
    for _ in range(3):
        host.move(*PLACE)
    assert canvas.n_lens_drawn == lenses  # nothing has changed
    host.move(PLACE[0] + 9, PLACE[1])
    assert canvas.n_lens_drawn == lenses + 1
    assert canvas.n_drawn == pages  # the page is not drawn for the lens
    host.scroll(1, PLACE)  # the wheel takes the next strength
    assert editor.look.reduction == 8
    assert not editor.view.moving
    host.until(lambda: opened.app.window.now_s - editor.lens_key._since_s > 0.31, "a while")
    host.key_up("z")
    host.settle()
    assert editor.look.lens == "none"
    assert np.array_equal(host.screenshot()[:660, LEFT:], before[:660, LEFT:])


def test_the_lens_follows_a_brush_beside_it_while_it_paints(opened) -> None:
    host, editor = opened.host, opened.app.editor
    host.click("Reduce")
    host.key("e")
    host.move(*on_screen(opened, 45, 45))
    host.settle()
    drawn = editor.canvas.n_lens_drawn
    host.press()
    host.move(*on_screen(opened, 60, 45))
    assert editor.canvas.n_lens_drawn > drawn
    host.release()
    assert len(opened.app.session.document.dots) < 300
    editor.show_panel(VIEW)  # the brush's is in front
    host.settle()
    host.click("Magnify")
    assert editor.look.lens == "magnify"
    host.click("8 ×")
    assert editor.look.magnification == 8
    host.click("Off")
    assert editor.look.lens == "none"


def test_the_picture_is_adjusted_before_ones_eyes_and_then_for_the_dots(opened) -> None:
    host, session, look = opened.host, opened.app.session, opened.app.editor.look
    place = on_screen(opened, 60, 45)
    document, ink = session.document, float((session.document.dots.radius_mm**2).sum())
    assert not look.reference_shown
    opened.app.editor.show_panel(DRAWING)
    host.settle()
    host.click("More tones")
    host.click("Invert")
    assert session.adjustment.invert
    assert look.reference_shown  # what changes is seen
    host.key("d")
    x, y = (round(v) for v in place)
    inverted = host.screenshot()[y, x].mean()
    host.click("Invert")
    assert session.adjustment == NEUTRAL
    assert inverted > host.screenshot()[y, x].mean() + 10
    host.key("d")
    x0, y0, x1, y1 = opened.app.editor.widgets.marks["Brightness"]
    host.drag(((x0 + x1) / 2, (y0 + y1) / 2), (x0 + 0.75 * (x1 - x0), (y0 + y1) / 2), "left")
    assert session.adjustment.brightness == pytest.approx(0.45, abs=0.05)
    assert session.reference.adjustment == NEUTRAL
    host.click("Use for the dots")
    host.until(lambda: session.phase == "done", "new dots")
    host.settle()
    assert session.reference.adjustment == session.adjustment
    assert session.document is document
    assert float((document.dots.radius_mm**2).sum()) < 0.75 * ink
    assert not host.shown("Use for the dots")
    host.click("Reset")
    assert session.adjustment == NEUTRAL
    host.key("z", ctrl=True)
    assert float((document.dots.radius_mm**2).sum()) == pytest.approx(ink)
