"""Painting in the whole editor, without a display: scripted mouse and keys."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from stippler.brushes import effects
from stippler.drawing.dots import Dots
from stippler.editor.messages import ERROR
from stippler.ui.panels.layout import HISTORY, TOOL

NAMES = [f.name for f in fields(Dots)]


@pytest.fixture(autouse=True)
def settings_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    return tmp_path / "settings"


def same(a: Dots, b: Dots) -> bool:
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in NAMES)


def opened(desk, picture: Path):
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.host.settle()
    return desk.app.session.document


def on_screen(desk, x_mm: float, y_mm: float) -> tuple[float, float]:
    editor = desk.app.editor
    x, y = editor.view.camera.page_to_screen((x_mm, y_mm), editor.view.size_px)
    origin = editor.pointer.origin_px
    return float(x + origin[0]), float(y + origin[1])


def paint(desk, start: tuple[float, float], end: tuple[float, float]) -> None:
    desk.host.drag(on_screen(desk, *start), on_screen(desk, *end), "left")


def test_a_tool_is_clicked_a_stroke_painted_undone_and_done_again(desk, picture: Path) -> None:
    document = opened(desk, picture)
    start = document.dots.copy()
    shot = desk.host.screenshot()
    desk.host.click("Erase")
    assert desk.app.editor.painting.toolbox.brush.kind == "erase"
    paint(desk, (45, 45), (75, 45))
    assert len(document.dots) < len(start)
    erased = document.dots.copy()
    desk.host.move(*on_screen(desk, 110, 80))
    desk.host.settle()
    painted = desk.host.screenshot()
    x, y = (round(v) for v in on_screen(desk, 60, 45))
    assert painted[y - 3 : y + 3, x - 20 : x + 20].mean() > 250 > shot[y - 3 : y + 3].mean()
    desk.host.key("z", ctrl=True)
    assert same(document.dots, start)
    desk.host.key("y", ctrl=True)
    assert same(document.dots, erased)
    desk.app.editor.show_panel(HISTORY)
    desk.host.settle()
    desk.host.click("step 0")
    assert same(document.dots, start)
    desk.host.click("Redo")
    assert same(document.dots, erased)


def test_escape_within_a_stroke_takes_it_back(desk, picture: Path) -> None:
    document = opened(desk, picture)
    start = document.dots.copy()
    desk.host.key("k")
    desk.host.move(*on_screen(desk, 60, 45))
    desk.host.press("left")
    desk.host.move(*on_screen(desk, 70, 45))
    assert not same(document.dots, start)
    desk.host.key("escape")
    desk.host.release("left")
    assert same(document.dots, start)
    assert not document.history.steps


def test_only_what_changed_is_uploaded(desk, picture: Path, monkeypatch) -> None:
    document = opened(desk, picture)
    desk.host.key("b")
    desk.host.settle()
    renderer = desk.app.editor.canvas._renderer().scene
    uploads: list[int] = []
    update = renderer.update_dots
    monkeypatch.setattr(
        renderer, "update_dots", lambda d, rows, s: (uploads.append(len(rows)), update(d, rows, s))
    )
    monkeypatch.setattr(renderer, "set_dots", lambda *_: pytest.fail("all was uploaded"))
    paint(desk, (60, 45), (63, 45))
    assert uploads
    assert 0 < max(uploads) < len(document.dots) / 4


def test_painting_goes_on_while_all_dots_relax(desk, picture: Path) -> None:
    document = opened(desk, picture)
    session = desk.app.session
    session.edit_style(spacing="lloyd")  # which never rests
    start = document.dots.copy()
    desk.host.fill("Evening out", "100000")
    desk.host.click("Relax all")
    desk.host.until(lambda: session.done > 2, "some steps")
    desk.host.key("k")
    paint(desk, (60, 45), (66, 45))
    assert session.relaxing
    edit = document.history.steps[-1].edit
    assert edit is not None
    change = edit.dots.changes["position_mm"]
    at = session.done
    desk.host.until(lambda: session.done > at + 3, "more steps")
    assert np.array_equal(document.dots.position_mm[document.rows(change.ids)], change.after)
    desk.host.key("z", ctrl=True)  # the stroke
    assert session.relaxing
    desk.host.key("z", ctrl=True)  # the run, which ends
    assert not session.busy
    assert same(document.dots, start)


def test_a_new_page_is_painted_on(desk) -> None:
    desk.host.key("s")
    desk.host.drag((640, 100), (660, 100), "left")
    assert "no page" in desk.host.said()
    desk.host.key("n", ctrl=True)
    desk.host.fill("Page width", "80")
    desk.host.fill("Page height", "60")
    desk.host.click("Begin")
    desk.host.until(lambda: desk.app.session.paintable, "the page")
    desk.host.settle()
    page = desk.app.session.drawing.page
    assert (page.width_mm, page.height_mm) == (80, 60)
    assert desk.app.session.reference is None
    desk.host.key("a")
    desk.host.click(on_screen(desk, 20, 30))
    desk.host.click(on_screen(desk, 40, 30))
    dots = desk.app.session.document.dots
    assert np.allclose(dots.position_mm, [(20, 30), (40, 30)], atol=0.1)
    desk.host.move(*on_screen(desk, 70, 50))
    desk.host.settle()
    x, y = (round(v) for v in on_screen(desk, 20, 30))
    assert desk.host.screenshot()[y - 1 : y + 2, x - 1 : x + 2].mean(axis=2).min() < 128


def test_a_failing_brush_is_told_and_the_editor_lives_on(desk, picture: Path, monkeypatch) -> None:
    document = opened(desk, picture)
    start = document.dots.copy()

    def broken(touch: object) -> None:
        raise RuntimeError("on purpose")

    monkeypatch.setitem(effects.EFFECTS, "jitter", broken)
    desk.host.key("j")
    paint(desk, (60, 45), (66, 45))
    assert same(document.dots, start)
    assert desk.app.session.messages.log[-1].level == ERROR
    assert "on purpose" in desk.host.said()
    desk.host.key("x")
    desk.host.click(on_screen(desk, 60, 45))
    assert len(document.dots) == len(start) - 1


def test_a_selection_is_made_and_worked_on(desk, picture: Path) -> None:
    document = opened(desk, picture)
    n = len(document.dots)
    desk.host.key("m")
    paint(desk, (40, 30), (80, 60))
    painting = desk.app.editor.painting
    chosen = painting.n_selected
    assert chosen > 0
    desk.app.editor.show_panel(TOOL)
    desk.host.settle()
    for label in ("Fix dots", "Free dots", "Relax dots", "Jitter dots", "Larger", "Smaller"):
        desk.host.click(label)
    desk.host.click("Duplicate")
    assert len(document.dots) == n + chosen
    desk.host.key("delete")
    assert len(document.dots) == n
    assert len(document.history.steps) == 8
    for _ in range(8):
        desk.host.key("z", ctrl=True)
    assert len(document.dots) == n
    desk.host.key("a", ctrl=True)
    assert painting.n_selected == n
    desk.host.key("escape")
    assert painting.n_selected == 0


def test_the_brush_panel_changes_the_brush_and_brushes_are_kept(
    desk, settings_folder: Path
) -> None:
    toolbox = desk.app.editor.painting.toolbox
    for card in toolbox.cards:
        desk.host.click(card.label)
        assert toolbox.tool is toolbox.made(card.name)
        assert desk.host.shown("Name") == (toolbox.brush is not None)
    desk.host.click("Jitter")
    desk.host.click("Copy brush")
    desk.host.click("On a rope")
    desk.host.key("right_bracket")
    assert (toolbox.brush.name, toolbox.brush.smoothing) == ("Jitter 2", "rope")
    assert toolbox.brush.radius_mm > 4
    toolbox.save()
    assert "Jitter 2" in (settings_folder / "brushes.json").read_text()


def test_stippling_again_is_a_step_that_can_be_taken_back(desk, picture: Path) -> None:
    document = opened(desk, picture)
    first = document.dots.copy()
    desk.host.fill("Number", "150")
    desk.host.click("Start")
    desk.host.until(lambda: not desk.app.session.busy, "the drawing")
    desk.host.settle()
    assert desk.app.session.document is document
    assert len(document.dots) < len(first)
    desk.host.key("z", ctrl=True)
    assert same(document.dots, first)


def test_dots_that_are_still_being_stippled_are_painted_on(desk, picture: Path) -> None:
    session = desk.app.session
    session.edit_style(n_dots=2000, iterations=100_000)
    desk.host.drop(picture)
    desk.host.until(lambda: session.stage == "relax" and session.done > 1, "the relaxation")
    assert not session.paintable
    desk.host.key("e")
    paint(desk, (50, 45), (70, 45))
    document = session.document
    assert session.relaxing
    assert session.done > 1
    (run, stroke) = document.history.steps
    assert run.is_open
    erased = stroke.edit.dots.removed.dots.id
    assert len(erased)
    desk.host.key("b")
    paint(desk, (50, 35), (60, 35))
    resized = document.history.steps[-1].edit.dots.changes["radius_mm"]
    at = session.done
    desk.host.until(lambda: session.done > at + 3, "more steps")
    session.stop()
    assert not session.busy
    assert (document.rows(erased) < 0).all()
    kept = document.rows(resized.ids)
    assert np.array_equal(document.dots.radius_mm[kept], resized.after)
    for _ in range(3):
        desk.host.key("z", ctrl=True)
    assert document.history.n_done == 0
    assert (document.rows(erased) >= 0).all()


def test_a_stippling_painted_on_ends_with_radii_for_the_dots_nobody_touched(
    desk, picture: Path
) -> None:
    session = desk.app.session
    session.edit_style(n_dots=2000, iterations=60)
    desk.host.drop(picture)
    desk.host.until(lambda: session.stage == "relax" and session.done > 1, "the relaxation")
    session.pause()
    desk.host.key("b")
    paint(desk, (50, 45), (70, 45))
    assert session.phase == "paused"
    before = session.document.dots.copy()
    touched = session.document.history.steps[-1].edit.dots.changes["radius_mm"].ids
    session.resume()
    desk.host.until(lambda: not session.busy, "the end")
    assert session.phase == "done"
    dots = session.document.dots
    assert np.array_equal(dots.id, before.id)
    by_hand = np.isin(dots.id, touched)
    same_size = dots.radius_mm == before.radius_mm
    assert same_size[by_hand].all()
    assert same_size[~by_hand].mean() < 0.1
    session.undo()
    session.undo()
    assert not session.document.history.n_done


def test_a_press_on_a_panel_is_no_corner_of_a_polygon(desk, picture):
    opened(desk, picture)
    toolbox = desk.app.editor.painting.toolbox
    toolbox.choose("select")
    toolbox.tool.set("how", "polygon")
    desk.host.settle()
    desk.host.click((600, 300))
    desk.host.click((700, 300))
    n = len(toolbox.state.overlay.paths[0].points_mm)
    desk.host.click((150, 690))  # beneath the controls of the panel at the left
    assert len(toolbox.state.overlay.paths[0].points_mm) == n
    desk.host.click("No tool")
    assert not desk.app.editor.painting.is_busy
    desk.host.key("r")  # the keyboard has not been left with the polygon
    assert desk.app.editor.look.reference_shown
