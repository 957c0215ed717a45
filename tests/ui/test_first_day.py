"""What a first day met, sentence by sentence, where no other file has it."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Page
from stippler.ui.panels.layout import TOOL


@pytest.fixture
def page(desk):
    """An empty page with a block of dots in its middle."""
    session = desk.app.session
    session.new(Page(120.0, 90.0))
    desk.host.until(lambda: session.document is not None, "the page")
    x, y = np.meshgrid(np.arange(50.0, 70.0, 2.0), np.arange(35.0, 55.0, 2.0))
    session.document.begin("dots")
    session.document.insert(Dots.round(np.stack([x.ravel(), y.ravel()], axis=1), 0.4))
    session.document.commit()
    desk.host.settle()
    return desk


def on_screen(desk, x_mm: float, y_mm: float) -> tuple[float, float]:
    view, origin = desk.app.editor.view, desk.app.editor.pointer.origin_px
    x, y = view.camera.page_to_screen((x_mm, y_mm), view.size_px)
    return float(x + origin[0]), float(y + origin[1])


def press_alt(host, name: str) -> None:
    import glfw

    code = getattr(glfw, f"KEY_{name.upper()}")
    for action in (glfw.PRESS, glfw.RELEASE):
        host._window.input.key(code, 0, action, glfw.MOD_ALT)
        host._frame()
    host.settle()


def n_popups() -> int:
    from imgui_bundle import imgui

    return imgui.get_current_context().open_popup_stack.size()


# --- 1: Esc closes the topmost thing only ---------------------------------------------------


def test_esc_closes_an_open_list_and_leaves_the_brush(page) -> None:
    host, toolbox = page.host, page.app.editor.painting.toolbox
    host.click("Spray dots")
    host.click("Pressure")
    assert n_popups() == 1
    host.key("escape")
    assert n_popups() == 0
    assert toolbox.name == "spray"
    host.key("escape")
    assert toolbox.name == ""


# --- 2: selections --------------------------------------------------------------------------


def test_copies_are_told_from_their_originals_and_move_alone(page) -> None:
    host, painting = page.host, page.app.editor.painting
    document = page.app.session.document
    before = document.dots.position_mm.copy()
    host.key("m")
    host.key("a", ctrl=True)
    host.key("d", ctrl=True)
    dots = document.dots
    copies = painting.toolbox.selection.mask(document)
    assert copies.sum() == 100
    apart = np.hypot(*(dots.position_mm[copies] - before).T)
    assert (apart > 0.4).all()  # more than a radius: both are seen
    host.drag(on_screen(page, 61, 46), on_screen(page, 81, 61), "left")
    assert np.array_equal(document.dots.position_mm[~copies], before)
    host.key("z", ctrl=True)
    host.key("z", ctrl=True)
    assert painting.n_selected == 100  # the originals again
    assert np.array_equal(document.dots.position_mm, before)
    host.key("z", ctrl=True, shift=True)
    assert np.array_equal(painting.toolbox.selection.mask(document), copies)  # and the copies


# --- 3, 6: numbers, sizes in pixels of the screen -------------------------------------------


@pytest.mark.parametrize("name", ["Brush radius", "context radius"])
def test_the_radius_of_a_brush_is_a_number_like_all_and_knows_pixels(page, name: str) -> None:
    host, editor = page.host, page.app.editor
    host.click("Spray dots")
    view = editor.view.camera

    def ask() -> None:
        if name == "context radius":
            host.move(*on_screen(page, 20, 20))
            host.press("right")
            host.release("right")
            host.settle()
        host.move(*host.place(name))

    ask()
    host.type("2*3,5")
    host.key("enter")
    assert editor.painting.toolbox.brush.radius_mm == pytest.approx(7.0)
    if name == "context radius":
        host.key("escape")
    editor.view.zoom_to(0.02 * editor.view.camera.px_per_mm)
    editor.view.follow = False
    host.settle()
    ask()
    host.type("20 px")
    host.key("enter")
    wanted = 20 / editor.view.camera.px_per_mm
    assert editor.painting.toolbox.brush.radius_mm == pytest.approx(wanted, rel=0.01)
    assert editor.view.camera.rotation_rad == view.rotation_rad


# --- 4: keyboard only -----------------------------------------------------------------------


def test_in_a_dialog_tab_and_space_reach_all_and_enter_presses_what_is_marked(page) -> None:
    host, session = page.host, page.app.session
    host.key("n", ctrl=True)
    for _ in range(3):  # Begin, which Enter alone would press; A4, A5
        host.key("tab")
    shot = host.screenshot()
    host.key("tab")  # A6
    moved = np.abs(host.screenshot().astype(int) - shot).sum(axis=2) > 40
    for name in ("A5", "A6"):  # the mark is seen to go from one to the other
        x0, y0, x1, y1 = (round(v) for v in page.app.editor.widgets.marks[name])
        assert moved[y0 - 3 : y1 + 3, x0 - 3 : x1 + 3].any(), name
    host.key("enter")
    assert host.shown("Begin")  # the size was chosen, the dialog stays
    for _ in range(5):  # Turn page, width, height, Cancel, Begin
        host.key("tab")
    host.key("enter")
    assert host.shown("Discard")  # the dots of this drawing are in no file
    host.key("tab")  # from Save
    host.key("space")
    host.until(lambda: session.document.drawing.page.width_mm == 105.0, "the page")


def test_alt_and_a_letter_open_a_menu(page) -> None:
    press_alt(page.host, "f")
    assert page.host.shown("item New page")
    page.host.key("escape")
    assert not page.host.shown("item New page")


# --- 5: tooltips ----------------------------------------------------------------------------


def tip_of(desk, name: str) -> tuple[float, float, float, float] | None:
    """Rest the pointer on a control; return where its tooltip is."""
    from imgui_bundle import imgui

    desk.host.bring(name)
    desk.host.move(*desk.host.place(name))
    deadline = time.monotonic() + 3.0
    while time.monotonic() < deadline:  # no input: it has to come by itself
        desk.app.step(0.05)
        for k in range(3):
            window = imgui.internal.find_window_by_name(f"##Tooltip_{k:02d}")
            if window is not None and window.active and window.size.x > 40:
                low, size = window.pos, window.size
                return low.x, low.y, low.x + size.x, low.y + size.y
    return None


def test_tooltips_come_at_rest_and_cover_no_neighbour(page) -> None:
    host, editor = page.host, page.app.editor
    host.click("Spray dots")
    editor.show_panel(TOOL)
    host.settle()
    strip = {editor.commands[f"tool.{tool.name}"].label for tool in editor.painting.toolbox.cards}
    panel = {"Name", "Copy brush", "Reset brush", "Brush radius", "Hardness", "Pressure", "Tip"}
    for name, neighbours in (
        ("Brush radius", panel),
        ("Copy brush", panel),
        ("Pressure", panel),
        ("Spray dots", strip),
        ("Zoom", {"Zoom"}),  # in the status bar: above it
    ):
        rect = tip_of(page, name)
        assert rect is not None, f"{name} tells nothing"
        for other in neighbours:
            x0, y0, x1, y1 = editor.widgets.marks[other]
            apart = rect[0] >= x1 or rect[2] <= x0 or rect[1] >= y1 or rect[3] <= y0
            assert apart, (name, other, rect)
        assert rect[0] >= 0
        assert rect[3] <= 700
        host.leave()
        host.enter()


def test_a_tool_tells_its_name_as_soon_as_the_pointer_is_on_it(page) -> None:
    from imgui_bundle import imgui

    imgui.get_style().hover_delay_normal = 60.0  # however long a frame takes
    page.host.move(*page.host.place("Spray dots"))
    for _ in range(3):
        page.app.step(0.0)
    window = imgui.internal.find_window_by_name("##Tooltip_00")
    assert window is not None
    assert window.active
    assert window.size.y < 40  # one line; what it does comes when the pointer rests


# --- 10: the path stays ---------------------------------------------------------------------


def test_a_wrong_ending_or_folder_leaves_the_path_marked_to_be_typed_over(page, tmp_path) -> None:
    host = page.host
    host.key("s", ctrl=True)
    for wrong in ("moth.doc", "nowhere/moth.stipple"):
        host.type(wrong)
        host.key("enter")
        assert host.shown("path")
        assert page.app.session.exports.file is None
    host.type("moth.stipple")  # in place of what stood there
    host.key("enter")
    host.until((tmp_path / "moth.stipple").exists, "the file")


# --- 11: on disk within seconds -------------------------------------------------------------


def test_brushes_and_preferences_are_on_disk_within_seconds(page, tmp_path: Path) -> None:
    host, settings = page.host, tmp_path / "settings"
    page.app.editor._kept.folder = settings
    host.click("Spray dots")
    host.move(*host.place("Brush radius"))
    host.type("7.25")
    host.key("enter")
    host.key("t")
    host.leave()
    began = time.monotonic()

    def kept() -> bool:
        page.app.step(0.2)
        brushes, looks = settings / "brushes.json", settings / "preferences.json"
        if not (brushes.exists() and looks.exists()):
            return False
        return "7.25" in brushes.read_text() and '"dark"' in looks.read_text()

    host.until(kept, "what was changed, on disk")
    assert time.monotonic() - began < 9.0


def test_a_brush_is_reset_deleted_and_brought_back(page) -> None:
    host, shelf = page.host, page.app.editor.painting.toolbox.shelf
    host.click("Spray dots")
    first = shelf.used("spray")
    host.move(*host.place("Brush radius"))
    host.type("9")
    host.key("enter")
    host.click("Copy brush")
    copy = shelf.used("spray")
    host.click("Delete brush")
    assert len(shelf.of("spray")) == 1
    host.key("p", ctrl=True, shift=True)
    host.type("restore deleted")
    host.key("enter")
    assert shelf.used("spray") == copy
    host.click("Reset brush")
    assert shelf.used("spray").radius_mm == first.radius_mm
