"""Selections: dragged by their hull, scaled, turned, nudged, copied; undo brings them back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.brushes.motion import Held, Motion
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.drawing import Drawing, Page

CANVAS = (650.0, 330.0)


def document_of(n: int = 60, seed: int = 1) -> Document:
    drawing = Drawing.blank(Page(100, 80))
    places = np.random.default_rng(seed).uniform((20, 20), (60, 60), (n, 2))
    drawing.dots = Dots.round(places, 0.4)
    return Document(drawing)


@given(
    shift=st.tuples(st.floats(-300, 300), st.floats(-300, 300)),
    scale=st.floats(0.05, 20),
    turn=st.floats(-7, 7),
)
@settings(max_examples=60, deadline=None)
def test_what_is_moved_together_stays_rigid_and_on_the_page(shift, scale, turn) -> None:
    document = document_of()
    before = document.dots.position_mm.copy()
    document.begin("move")
    done = Held(document, document.dots.id).put(Motion(shift, scale, turn, (40.0, 40.0)))
    after = document.dots.position_mm
    assert (after >= 0).all()
    assert (after <= (100, 80)).all()
    away_before = np.hypot(*(before[:, None] - before[None]).T)
    away_after = np.hypot(*(after[:, None] - after[None]).T)
    assert np.allclose(away_after, done.scale * away_before, atol=1e-6)
    document.cancel()
    assert np.array_equal(document.dots.position_mm, before)


def test_a_shift_slides_along_the_edge() -> None:
    document = document_of()
    document.begin("move")
    done = Held(document, document.dots.id).put(Motion((500.0, 7.0)))
    assert done.shift_mm[1] == 7.0
    assert document.dots.position_mm[:, 0].max() == pytest.approx(100.0)
    document.commit()


def test_fixed_dots_stay_and_sizes_and_directions_follow() -> None:
    document = document_of()
    document.begin("fix")
    document.change("constraint", np.array([3]), np.array([FIXED], np.int8))
    place = document.dots.position_mm[3].copy()
    motion = Motion(scale=0.5, turn_rad=0.25, about_mm=(40.0, 40.0))
    Held(document, document.dots.id).put(motion)
    dots = document.dots
    assert np.array_equal(dots.position_mm[3], place)
    free = np.arange(len(dots)) != 3
    assert np.allclose(dots.radius_mm[free], 0.2)
    assert np.allclose(dots.angle_rad[free], 0.25)
    document.commit()


# --- in the window ---------------------------------------------------------------------------


@pytest.fixture
def page(desk):
    """An empty page with a block of dots in its middle, all of them selected."""
    session = desk.app.session
    session.new(Page(120.0, 90.0))
    desk.host.until(lambda: session.document is not None, "the page")
    document = session.document
    x, y = np.meshgrid(np.arange(50.0, 70.0, 2.0), np.arange(35.0, 55.0, 2.0))
    document.begin("dots")
    document.insert(Dots.round(np.stack([x.ravel(), y.ravel()], axis=1), 0.4))
    document.commit()
    desk.host.settle()
    desk.host.key("m")
    desk.host.key("a", ctrl=True)
    return desk


def on_screen(desk, x_mm: float, y_mm: float) -> tuple[float, float]:
    view, origin = desk.app.editor.view, desk.app.editor.pointer.origin_px
    x, y = view.camera.page_to_screen((x_mm, y_mm), view.size_px)
    return float(x + origin[0]), float(y + origin[1])


def box(desk) -> np.ndarray:
    places = desk.app.session.document.dots.position_mm
    return np.concatenate([places.min(axis=0), places.max(axis=0)])


def test_a_press_between_its_dots_drags_the_selection_and_undo_brings_all_back(page) -> None:
    painting, before = page.app.editor.painting, box(page)
    chosen = painting.toolbox.selection.ids
    page.host.drag(on_screen(page, 61, 46), on_screen(page, 71, 41), "left")  # no dot is there
    assert np.allclose(box(page) - before, (10, -5, 10, -5), atol=0.2)
    page.host.click(on_screen(page, 10, 10))
    assert painting.n_selected == 0
    page.host.key("z", ctrl=True)
    assert np.allclose(box(page), before)
    assert np.array_equal(painting.toolbox.selection.ids, chosen)
    page.host.key("d", ctrl=True, shift=True)
    assert painting.n_selected == 100


def test_dragged_past_the_edge_it_stays_as_it_is(page) -> None:
    before = box(page)
    page.host.drag(on_screen(page, 61, 46), on_screen(page, 180, 46), "left")
    assert np.allclose(box(page)[[2, 1]], (120.0, before[1]))
    assert np.allclose(np.diff(box(page)[[0, 2]]), np.diff(before[[0, 2]]))


def test_handles_scale_and_turn(page) -> None:
    editor, before = page.app.editor, box(page)
    mm = 10.0 / editor.view.camera.px_per_mm
    corner = on_screen(page, before[2] + mm, before[3] + mm)
    page.host.drag(corner, on_screen(page, 2 * before[2] - 48, 2 * before[3] - 33), "left")
    assert box(page)[2] > before[2] + 10
    assert np.allclose(box(page)[:2], before[:2], atol=0.01)  # about the other corner
    assert page.app.session.document.history.steps[-1].label == "Scale selection"
    page.host.key("z", ctrl=True)
    mm = 30.0 / editor.view.camera.px_per_mm
    middle = (before[0] + before[2]) / 2
    page.host.drag(on_screen(page, middle, before[1] - mm), on_screen(page, 90, 44), "left")
    angle = page.app.session.document.dots.angle_rad
    assert np.allclose(angle, np.pi / 2, atol=0.05)


def test_arrows_nudge_and_clicks_beside_let_go(page) -> None:
    before = box(page)
    page.host.key("right")
    page.host.key("down", shift=True)
    assert np.allclose(box(page) - before, (0.1, 1.0, 0.1, 1.0))
    page.host.click(on_screen(page, 61, 46))
    assert page.app.editor.painting.n_selected == 0


def test_copy_cut_paste_invert_and_grow(page) -> None:
    painting, session = page.app.editor.painting, page.app.session
    page.host.key("c", ctrl=True)
    page.host.move(*on_screen(page, 20, 20))
    page.host.key("v", ctrl=True)
    assert session.n_dots == 200
    assert painting.n_selected == 100
    low, high = painting.selected_box()
    assert np.allclose((np.array(low) + high) / 2, (20, 20), atol=0.2)
    page.host.key("i", ctrl=True, shift=True)
    low, _ = painting.selected_box()
    assert low[0] > 49
    page.host.key("x", ctrl=True)
    assert session.n_dots == 100
    page.host.key("z", ctrl=True)
    assert session.n_dots == 200
    corner = session.document.dots.id[:1]
    painting.toolbox.selection.choose(corner)
    page.host.key("g", ctrl=True)
    assert 3 <= painting.n_selected <= 4


# --- keys and the small palette ---------------------------------------------------------------


def test_the_right_button_opens_a_palette_and_esc_closes_only_that(page) -> None:
    host, toolbox = page.host, page.app.editor.painting.toolbox
    host.move(*on_screen(page, 20, 20))
    host.press("right")
    host.release("right")
    host.settle()
    assert host.shown("context Erase")
    host.key("escape")
    assert not host.shown("context Erase")
    assert toolbox.name == "select"
    assert len(toolbox.selection.ids)
    host.press("right")
    host.release("right")
    host.settle()
    host.click("context Erase")
    assert toolbox.name == "erase"


def test_menus_open_by_keys_and_close_topmost_first(page) -> None:
    host = page.host
    host.key("f10")
    assert host.shown("item New page")
    host.key("down")
    host.key("escape")
    assert not host.shown("item New page")
    assert page.app.editor.painting.toolbox.name == "select"


def test_pointing_opens_the_next_menu_and_a_click_there_keeps_it(page) -> None:
    host = page.host
    host.click("menu File")
    host.move(*host.place("menu Edit"))
    host.settle()
    assert host.shown("item Undo")
    host.click("menu Edit")
    assert host.shown("item Undo")
    host.click("menu Edit")
    assert not host.shown("item Undo")


def test_marks_panels_zoom_and_stop_have_keys(page) -> None:
    host, editor = page.host, page.app.editor
    shot = host.screenshot()
    host.key("h", ctrl=True)
    marked = np.abs(host.screenshot().astype(int) - shot).sum(axis=2) > 60
    assert marked[:, 400:].sum() > 100
    host.key("h", ctrl=True)
    width = editor.view.size_px[0]
    host.key("tab")
    assert editor.view.size_px[0] > width + 200
    host.key("tab")
    assert editor.view.size_px[0] == width
    scale = editor.view.camera.px_per_mm
    host.key("equal")
    host.until(lambda: not editor.view.moving, "the larger page")
    assert editor.view.camera.px_per_mm == pytest.approx(1.25 * scale)
    page.app.session.relax(100_000, weighted=False)
    host.key("p", shift=True)
    assert not page.app.session.busy


def test_f6_gives_the_panels_the_keyboard_and_space_presses(page) -> None:
    host = page.host
    host.key("f6")
    wants = page.app.editor.gui.wants
    from stippler.editor.events import KeyDown

    assert wants(KeyDown("space"))
    assert not wants(KeyDown("e"))
    host.key("f6")
    assert not wants(KeyDown("space"))
