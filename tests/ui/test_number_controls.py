"""Numbers in the window: typed over, stepped, slid, found by name; at every size and scale."""

from __future__ import annotations

from pathlib import Path

import pytest

from stippler.app import App
from stippler.drawing.drawing import Page
from stippler.drawing.style import Style
from stippler.editor.number_steps import Scale
from stippler.ui.panels.layout import DRAWING, TOOL, VIEW
from stippler.ui.window.scripted_host import Host


@pytest.fixture
def sprayer(desk):
    """An empty page, a spray at hand, its panel in front."""
    desk.app.session.new(Page(120.0, 90.0))
    desk.host.until(lambda: desk.app.session.document is not None, "the page")
    desk.host.click("Spray dots")
    return desk


def hardness(desk) -> float:
    return round(100 * desk.app.editor.painting.toolbox.brush.tip.hardness, 6)


def test_digits_over_a_slider_go_into_it_and_never_to_the_canvas(sprayer) -> None:
    host, view = sprayer.host, sprayer.app.editor.view
    before = view.camera
    host.move(*host.place("Hardness"))
    host.type("73")
    host.key("enter")
    assert hardness(sprayer) == 73.0
    host.move(*host.place("Hardness"))
    with host.batch():  # a pen or a quick hand: all in one frame
        host.type("1.5")
        host.key("enter")
    assert hardness(sprayer) == 1.5
    host.type("9")
    host.key("backspace")
    host.type("12 %")
    host.key("enter")
    assert hardness(sprayer) == 12.0
    assert view.camera == before
    assert sprayer.app.editor.look.theme.name == "light"


def test_a_press_that_does_not_move_changes_nothing_and_two_type(sprayer) -> None:
    host = sprayer.host
    x0, y0, x1, y1 = sprayer.app.editor.widgets.marks["Hardness"]
    at = (x0 + 0.9 * (x1 - x0), (y0 + y1) / 2)
    host.click(at)
    assert hardness(sprayer) == 50.0
    host.click(at)
    assert sprayer.app.editor.gui.wants_keys
    host.type("2*15")
    host.key("enter")
    assert hardness(sprayer) == 30.0
    host.click(at)
    host.click(at)
    host.type("90")
    host.key("escape")
    assert hardness(sprayer) == 30.0
    host.drag(((x0 + x1) / 2, at[1]), (x0 + 0.75 * (x1 - x0), at[1]), "left")
    assert hardness(sprayer) == pytest.approx(75.0, abs=3.0)
    assert hardness(sprayer) == round(hardness(sprayer))


def test_arrows_and_the_wheel_step(sprayer) -> None:
    host = sprayer.host
    host.click("Hardness")
    host.key("up")
    assert hardness(sprayer) == 51.0
    host.key("left", shift=True)
    assert hardness(sprayer) == 50.0  # the next multiple of ten
    host.key("left_shift")  # comes up
    host.scroll(-3, host.place("Hardness"))
    assert hardness(sprayer) == 47.0
    host.leave()
    host.key("up")  # no control has a hand on it: the arrow is the selection's
    assert hardness(sprayer) == 47.0


def test_what_is_out_of_bounds_is_held_and_said(sprayer) -> None:
    host = sprayer.host
    host.move(*host.place("Hardness"))
    host.type("190")
    host.key("enter")
    assert hardness(sprayer) == 100.0
    assert host.said() == "Hardness: at most 100 %"
    host.move(*host.place("Hardness"))
    host.type("1 furlong")
    host.key("enter")
    assert hardness(sprayer) == 100.0
    assert "furlong" in host.said()


def test_the_palette_knows_values_options_and_fields(desk, picture: Path) -> None:
    host, session = desk.host, desk.app.session
    host.drop(picture)
    host.until(lambda: session.phase == "done", "the drawing")
    for typed, took in (
        ("gamma 1.3", lambda: session.adjustment.gamma == 1.3),
        ("pen quill", lambda: session.style.pen == "quill"),
        ("turned 30", lambda: round(desk.app.editor.view.camera.rotation_rad, 4) == 0.5236),
    ):
        host.key("p", ctrl=True, shift=True)
        host.type(typed)
        host.key("enter")
        host.settle()
        assert took(), typed
    host.key("p", ctrl=True, shift=True)
    host.type("evening out")
    host.key("enter")
    host.type("7")
    host.key("enter", ctrl=True)  # counts the number, then starts
    drawing = session.drawing
    host.until(lambda: drawing.style_of(0).iterations == 7, "the new dots")


def test_the_zoom_is_typed(sprayer) -> None:
    host, window = sprayer.host, sprayer.app.window
    host.click("Zoom")
    host.type("150")
    host.key("enter")
    assert sprayer.app.editor.view.camera.px_per_mm == pytest.approx(1.5 * window.px_per_mm)


def test_values_without_effect_say_why(sprayer) -> None:
    sprayer.app.editor.show_panel(DRAWING)
    sprayer.host.settle()
    width = sprayer.app.session.width_mm
    sprayer.host.move(*sprayer.host.place("Width"))
    sprayer.host.type("99")
    sprayer.host.key("enter")
    assert sprayer.app.session.width_mm == width
    assert sprayer.app.editor.view.following  # and "9" reached no command


@pytest.mark.parametrize(
    ("value", "scale", "text"),
    [
        (100.0, Scale("%"), "100 %"),
        (1.5, Scale("%"), "1.5 %"),
        (0.2, Scale("mm"), "0.2 mm"),
        (0.0626, Scale("mm"), "0.063 mm"),
        (148.0, Scale("mm"), "148 mm"),
        (20000, Scale("", 0), "20,000"),
        (-5.0, Scale("°"), "−5°"),
        (-0.0, Scale("°"), "0°"),
        (1.0, Scale("", 2), "1"),
    ],
)
def test_decimals_mean_something(value: float, scale: Scale, text: str) -> None:
    assert scale.text(value) == text


@pytest.mark.parametrize(("size", "scale"), [((900, 600), "1"), ((900, 600), "1.5"),
                                             ((1280, 800), "2"), ((1280, 800), "3")])  # fmt: skip
def test_no_label_is_cut_and_the_canvas_has_room(
    kernels: None,
    size: tuple[int, int],
    scale: str,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    monkeypatch.setenv("STIPPLER_SCALE", scale)
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    app = App(Style(), tone="linear", width_mm=120.0, size=size, offscreen=True)
    try:
        host = Host(app.window, app.editor, app.step)
        app.session.new(Page(120.0, 90.0))
        host.until(lambda: app.session.document is not None, "the page")
        for name in app.editor.panels.names:
            app.editor.show_panel(name)
            host.settle()
            assert app.editor.widgets.cut == [], name
        for tool in app.editor.painting.toolbox.cards:
            app.editor.painting.toolbox.choose(tool.name)
            app.editor.show_panel(TOOL)
            host.settle()
            assert app.editor.widgets.cut == [], tool.name
        assert app.editor.view.size_px[0] >= 0.34 * size[0]
        app.editor.panels.turn_hidden()  # so that labels are the strip's alone
        host.leave()
        host.settle()
        for tool in app.editor.painting.toolbox.cards:
            label = app.editor.commands[f"tool.{tool.name}"].label
            x0, _, x1, y1 = app.editor.widgets.marks[label]
            assert y1 <= size[1] - 28 * float(scale)
            assert x1 - x0 >= 15 * float(scale)
    finally:
        app.close()


def test_floating_panels_stay_inside(sprayer) -> None:
    from imgui_bundle import imgui

    sprayer.app.editor.show_panel(VIEW)
    sprayer.host.settle()
    for place in ((900.0, 660.0), (-200.0, -50.0), (300.0, 690.0)):
        window = imgui.internal.find_window_by_name(VIEW)
        imgui.internal.dock_builder_dock_window(VIEW, 0)
        imgui.internal.set_window_pos(window, imgui.ImVec2(*place))
        sprayer.host.move(600, 300)
        sprayer.host.settle()
        window = imgui.internal.find_window_by_name(VIEW)
        assert window.pos.x >= 30
        assert window.pos.y >= 20
        assert window.pos.x + window.size.x <= 1001
        assert window.pos.y + window.size.y <= 673
