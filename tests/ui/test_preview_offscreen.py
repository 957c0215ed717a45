"""Changes of shape seen beforehand in the whole editor: what is shown is what is left."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from stippler.drawing.dots import Dots

NAMES = [f.name for f in fields(Dots)]
AT = (60.0, 45.0)  # mm, in the midst of the disc
ASIDE = (5.0, 5.0)
TOOLES = {
    "enlarge": ("size", {"how": "enlarge", "amount": 60.0}),
    "set": ("size", {"how": "set", "dot_mm": 1.9}),
    "stretch": ("shape", {"how": "stretch", "along": "angle", "angle": 90.0, "amount": 100.0}),
    "stretch at random": ("shape", {"how": "stretch", "along": "random", "amount": 100.0}),
    "stretch along the edge": ("shape", {"how": "stretch", "along": "edge", "amount": 100.0}),
    "stretch along the stroke": ("shape", {"how": "stretch", "along": "stroke", "amount": 100.0}),
    "roughen": ("shape", {"how": "roughen", "amount": 90.0}),
}


@pytest.fixture(autouse=True)
def settings_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "config"))


@pytest.fixture
def opened(desk, picture: Path):
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.host.settle()
    return desk


def same(a: Dots, b: Dots) -> bool:
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in NAMES)


def on_screen(desk, at_mm: tuple[float, float]) -> tuple[float, float]:
    editor = desk.app.editor
    x, y = editor.view.camera.page_to_screen(at_mm, editor.view.size_px)
    origin = editor.pointer.origin_px
    return float(x + origin[0]), float(y + origin[1])


def hover(desk, at_mm: tuple[float, float]) -> None:
    """Come from the left, and stay."""
    x, y = on_screen(desk, at_mm)
    desk.host.move(x - 30, y)
    desk.host.move(x, y)
    desk.host.settle()


def take_brush(desk, kind: str, values: dict, **changes) -> None:
    toolbox = desk.app.editor.painting.toolbox
    toolbox.choose(kind)
    toolbox.set_brush(replace(toolbox.brush, values=values, radius_mm=16.0, **changes))


def page_of(desk) -> np.ndarray:
    """Return the canvas, without the line that shows the tip."""
    shot = desk.host.screenshot().astype(int)
    x, y = on_screen(desk, AT)
    i, j = np.mgrid[: shot.shape[0], : shot.shape[1]]
    tip = 16.0 * desk.app.editor.view.camera.px_per_mm
    ring = np.abs(np.hypot(j + 0.5 - x, i + 0.5 - y) - tip) < 4
    left, top = (round(v) for v in desk.app.editor.pointer.origin_px)
    shot[ring] = 0
    w, h = desk.app.editor.view.size_px
    return shot[top : top + h, left : left + w]


@pytest.mark.parametrize("name", TOOLES)
def test_a_press_leaves_what_hovering_showed(opened, name: str) -> None:
    document = opened.app.session.document
    start = document.dots.copy()
    hover(opened, AT)
    plain = page_of(opened)
    n_drawn = opened.app.editor.canvas.n_drawn
    take_brush(opened, *TOOLES[name])
    hover(opened, AT)
    shown = page_of(opened)
    assert np.abs(shown - plain).max() > 150
    assert same(document.dots, start)
    assert opened.app.editor.canvas.n_drawn == n_drawn  # only what lies under the tip
    opened.host.press()
    opened.host.release()
    opened.app.editor.painting.toolbox.choose("")
    opened.host.settle()
    left = page_of(opened)
    assert not same(document.dots, start)
    assert np.abs(shown - left).max() <= 24
    assert np.abs(shown - left).mean() < 0.02


def test_the_page_may_be_turned_mirrored_and_zoomed(opened) -> None:
    view = opened.app.editor.view
    middle = (view.size_px[0] / 2, view.size_px[1] / 2)
    turned = replace(view.camera, rotation_rad=0.7).flipped(middle, view.size_px)
    view.camera = turned.zoomed(1.7, middle, view.size_px)
    test_a_press_leaves_what_hovering_showed(opened, "stretch")


def test_hovering_uploads_nothing_and_rests_with_the_pointer(opened, monkeypatch) -> None:
    take_brush(opened, *TOOLES["enlarge"])
    canvas = opened.app.editor.canvas
    scene = canvas._renderer().scene
    for name in ("set_dots", "update_dots", "set_positions"):
        monkeypatch.setattr(scene, name, lambda *_, **__: pytest.fail("dots were uploaded"))
    hover(opened, AT)
    n_drawn = canvas.patch.n_drawn
    assert n_drawn > 0
    opened.app.editor.show_panel("Tool")
    opened.host.settle()
    assert canvas.patch.n_drawn == n_drawn
    hover(opened, (62.0, 45.0))
    assert canvas.patch.n_drawn > n_drawn


def test_the_preview_goes_with_pointer_brush_and_stroke(opened) -> None:
    editor = opened.app.editor
    hover(opened, AT)
    plain = page_of(opened)
    take_brush(opened, *TOOLES["set"])
    hover(opened, AT)
    assert (page_of(opened) != plain).any()
    opened.host.move(*opened.host.place("No tool"))  # over the strip of tools
    opened.host.settle()
    assert (page_of(opened) == plain).all()
    hover(opened, AT)
    assert editor.canvas.patch.box is not None
    opened.host.leave()
    opened.host.settle()
    assert (page_of(opened) == plain).all()
    opened.host.enter()
    hover(opened, AT)
    opened.host.press()
    assert editor.canvas.patch.box is None
    opened.host.key("escape")
    opened.host.release()
    assert editor.canvas.patch.box is not None
    editor.painting.toolbox.choose("erase")
    opened.host.settle()
    assert editor.canvas.patch.box is None
