"""Input that comes in bursts, on dense screens, while minimised, and into faulty handlers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

from stippler.app import App
from stippler.drawing.drawing import Page
from stippler.drawing.style import Style
from stippler.ui.panels.layout import TOOL
from stippler.ui.window.scripted_host import Host

CANVAS = (650.0, 330.0)


def blank(desk) -> None:
    """Open an empty page, with the brush that adds dots in hand."""
    desk.app.session.new(Page(120.0, 90.0))
    desk.host.until(lambda: desk.app.session.document is not None, "the page")
    desk.host.key("a")
    desk.host.settle()


def tap(desk, at: str | tuple[float, float]) -> None:
    """Move there, press and release."""
    host = desk.host
    host.move(*(host.place(at) if isinstance(at, str) else at))
    host.press()
    host.release()


@pytest.mark.parametrize("order", ["panel first", "canvas first"])
def test_a_tap_on_a_panel_and_one_on_the_canvas_in_a_batch(desk, order: str) -> None:
    blank(desk)
    desk.app.editor.show_panel(TOOL)
    desk.host.settle()
    taps = ["Copy brush", CANVAS]
    n_brushes = len(desk.app.editor.painting.toolbox.shelf.brushes)
    with desk.host.batch():
        for at in taps if order == "panel first" else taps[::-1]:
            tap(desk, at)
    assert desk.app.session.n_dots == 1
    assert len(desk.app.editor.painting.toolbox.shelf.brushes) == n_brushes + 1


def test_many_taps_of_one_batch_all_count(desk) -> None:
    blank(desk)
    with desk.host.batch():
        for k in range(8):
            tap(desk, (CANVAS[0] + 15 * k, CANVAS[1]))
            tap(desk, "Drag a dot" if k % 2 else "Erase")
            tap(desk, "Add a dot")
    assert desk.app.session.n_dots == 8


def test_a_stroke_that_ends_over_a_panel_is_the_canvas_s(desk) -> None:
    blank(desk)
    desk.host.click("Spray dots")
    start = desk.host.place("Copy brush")
    with desk.host.batch():
        desk.host.move(*CANVAS)
        desk.host.press()
        desk.host.move(*start)
        desk.host.release()
    assert not desk.app.editor.painting.is_busy
    assert desk.app.session.phase == "done"
    assert desk.app.session.document.history.n_done == 1


def test_a_menu_and_its_entry_in_one_batch(desk) -> None:
    blank(desk)
    desk.host.click("menu View")
    at = desk.host.place("item Light or dark")
    desk.host.key("escape")
    assert not desk.host.shown("item Light or dark")
    assert desk.app.editor.painting.toolbox.brush is not None  # Esc was the menu's
    theme = desk.app.editor.look.theme
    with desk.host.batch():
        tap(desk, "menu View")
        tap(desk, at)
    assert desk.app.editor.look.theme is not theme


def test_chords_and_words_of_one_burst_reach_a_field(desk) -> None:
    desk.host.click("Number")
    desk.host.type("1234")
    with desk.host.batch():
        desk.host.key("a", ctrl=True)
        desk.host.type("77")
        desk.host.key("left")
        desk.host.type("5")
        desk.host.key("enter")
    assert desk.app.session.style.n_dots == 757


def test_the_palette_is_opened_and_filled_in_one_burst(desk) -> None:
    theme = desk.app.editor.look.theme
    with desk.host.batch():
        desk.host.key("p", ctrl=True, shift=True)
        desk.host.type("light or dark")
        desk.host.key("enter")
    assert desk.app.editor.look.theme is not theme


def test_a_handler_that_fails_loses_no_release(desk) -> None:
    blank(desk)
    desk.host.key("s")

    def fail() -> None:
        raise RuntimeError("the cat")

    command = desk.app.editor.commands["view.theme"]
    object.__setattr__(command, "run", fail)
    with desk.host.batch():
        desk.host.key("t")
        desk.host.move(*CANVAS)
        desk.host.press()
        desk.host.release()
    assert any("the cat" in line.text for line in desk.app.session.messages.log)
    assert not desk.app.editor.painting.is_busy
    assert desk.app.session.n_dots > 0


def test_a_result_that_cannot_be_taken_ends_the_run_and_not_the_editor(
    desk, picture: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    n = desk.app.session.n_dots
    desk.app.session.relax(100_000, weighted=True)

    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("the dog")

    monkeypatch.setattr(type(desk.app.session.document), "merge", fail)
    said = desk.app.session.messages.log
    desk.host.until(lambda: any("the dog" in line.text for line in said), "the report")
    assert not desk.app.session.busy
    assert desk.app.session.n_dots == n
    desk.host.settle()


# --- minimised -------------------------------------------------------------------------------


@pytest.fixture
def minimised(desk, monkeypatch: pytest.MonkeyPatch):
    """Make the window as small as a minimised one, or as it was."""
    real = type(desk.app.window).size_px

    def set_to(value: bool) -> None:
        size = property(lambda _: (0, 0)) if value else real
        monkeypatch.setattr(type(desk.app.window), "size_px", size)

    return set_to


def test_what_happens_while_minimised_is_not_lost(desk, minimised) -> None:
    blank(desk)
    desk.host.key("s")
    desk.host.move(*CANVAS)
    desk.host.press()
    assert desk.app.editor.painting.is_busy
    minimised(True)
    desk.host.release()
    assert not desk.app.editor.painting.is_busy
    minimised(False)
    desk.host.key("z", ctrl=True)
    minimised(True)
    desk.app.window.input.close()
    desk.app.step(0.0)
    assert desk.app.window.wants_to_close


def test_closing_while_minimised_asks_where_work_would_be_lost(desk, minimised) -> None:
    blank(desk)
    desk.host.click(CANVAS)
    minimised(True)
    desk.app.window.input.close()
    desk.app.step(0.0)
    minimised(False)
    desk.host.move(*CANVAS)
    desk.host.settle()
    assert not desk.app.window.wants_to_close
    assert desk.host.shown("Discard")


# --- dense screens ---------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
def test_controls_have_one_size_in_units_on_every_screen(
    kernels: None, ratio: float, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    monkeypatch.delenv("STIPPLER_SCALE", raising=False)
    style = Style(n_dots=300, iterations=4)
    app = App(style, tone="linear", width_mm=120.0, size=(1000, 700), offscreen=True, ratio=ratio)
    try:
        host = Host(app.window, app.editor, app.step)
        assert app.window.size_px == (1000 * ratio, 700 * ratio)
        assert app.window.scale == 1.0
        x0, y0, x1, y1 = app.editor.widgets.marks["Start"]
        assert (x1 - x0, y1 - y0) == pytest.approx((288, 25), abs=4)
        app.session.new(Page(120.0, 90.0))
        host.until(lambda: app.session.document is not None, "the page")
        host.key("a")
        host.click((650.0, 330.0))
        (x, y) = app.session.document.dots.position_mm[0]
        view = app.editor.view
        at = view.camera.page_to_screen((x, y), view.size_px)
        origin = app.editor.pointer.origin_px
        assert np.allclose((at + origin) / ratio, (650.0, 330.0), atol=0.6)
        host.key("q")
        host.settle()
        glass = app.editor.canvas._lens.size[0]
        assert glass == pytest.approx(240 * ratio, abs=2)
        data = imgui.get_draw_data()
        assert tuple(data.framebuffer_scale) == (ratio, ratio)
    finally:
        app.close()
