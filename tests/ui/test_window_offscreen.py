"""The whole editor without a display: scripted mouse and keys in, pixels out."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.jobs.work import Source, Work
from stippler.ui.panels import contents
from stippler.ui.panels.layout import VIEW
from stippler.ui.theme import DARK, LIGHT

MIDDLE_OF_CANVAS = (650.0, 330.0)


def open_and_finish(desk, picture: Path) -> None:
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.host.settle()


def ink(shot: np.ndarray, x0: int, y0: int, x1: int, y1: int) -> float:
    """Return the share of dark pixels."""
    return float((shot[y0:y1, x0:x1].mean(axis=2) < 100).mean())


def near(shot: np.ndarray, x: int, y: int, colour: tuple[float, float, float]) -> bool:
    return bool(np.abs(shot[y, x] / 255.0 - np.array(colour)).max() < 0.02)


def test_an_empty_desk_invites(desk) -> None:
    shot = desk.host.screenshot()
    assert shot.shape == (700, 1000, 3)
    assert near(shot, 990, 40, LIGHT.desk)
    assert near(shot, 5, 300, LIGHT.panel)
    text = np.abs(shot[300:360, 560:740] / 255.0 - np.array(LIGHT.desk)).max(axis=2)
    assert (text > 0.2).sum() > 100  # the invitation is written
    assert desk.app.session.phase == "empty"
    desk.host.click("Start")  # disabled: nothing to start
    assert not desk.app.session.busy


def test_a_dropped_picture_becomes_dots_that_are_seen(desk, picture: Path) -> None:
    open_and_finish(desk, picture)
    session, view = desk.app.session, desk.app.editor.view
    assert abs(session.n_dots - 300) <= 15
    shot = desk.host.screenshot()
    x, y = (
        round(v)
        for v in view.camera.page_to_screen((60.0, 45.0), view.size_px)
        + np.array(desk.app.editor.pointer.origin_px)
    )
    reach = round(20 * view.camera.px_per_mm)
    assert ink(shot, x - reach, y - reach, x + reach, y + reach) > 0.1
    corner = round(8 * view.camera.px_per_mm)
    left, top = x - round(59 * view.camera.px_per_mm), y - round(44 * view.camera.px_per_mm)
    assert ink(shot, left, top, left + corner, top + corner) == 0.0  # white stays white


def test_start_and_stop_by_their_labels(desk, picture: Path) -> None:
    open_and_finish(desk, picture)
    desk.host.fill("Number", "150")
    assert desk.app.session.style.n_dots == 150
    desk.host.fill("Evening out", "100000")
    desk.host.click("Start")
    desk.host.until(lambda: desk.app.session.stage == "relax", "relaxation")
    desk.host.until(lambda: desk.host.shown("Stop"), "the button")
    desk.host.click("Pause")
    assert desk.app.session.phase == "paused"
    desk.host.settle()
    desk.host.click("Resume")
    assert desk.app.session.phase == "running"
    desk.host.click("Stop")
    assert desk.app.session.phase == "stopped"
    assert desk.app.session.drawing is not None
    assert abs(len(desk.app.session.drawing.dots) - 150) <= 10


def test_bad_numbers_are_refused_in_the_window(desk) -> None:
    desk.host.fill("Number", "0")
    assert desk.app.session.style.n_dots == 300
    assert "dots: 0 is out of range" in desk.host.said()
    assert desk.host.shown("notice")
    desk.host.click("notice")
    assert not desk.host.shown("notice")
    desk.host.fill("Evening out", "-3")
    assert desk.app.session.style.iterations == 4
    desk.host.fill("Width", "0")
    assert desk.app.session.width_mm == 120.0


def test_sizes_seed_method_and_tone_change_the_plan(desk) -> None:
    session = desk.app.session
    desk.host.click("In mm")
    assert session.style.size_range_mm == (0.12, 0.24)
    desk.host.click("As many dots as it takes")
    assert session.style.n_dots is None
    desk.host.click("Automatic")
    assert (session.style.size_range_mm, session.style.n_dots) == (None, None)
    seed = session.style.seed
    desk.host.click("More dots")
    desk.host.click("Another seed")
    assert session.style.seed != seed
    desk.host.click("As in file")
    assert session.tone == "perceptual"
    desk.host.click("First dots")
    desk.host.key("down")
    assert session.style.first_dots == "pulse-density"


def test_pan_zoom_and_fit(desk, picture: Path) -> None:
    open_and_finish(desk, picture)
    host, view = desk.host, desk.app.editor.view
    fitted = view.camera
    x, y = MIDDLE_OF_CANVAS
    origin = desk.app.editor.pointer.origin_px
    place = view.at(x - origin[0], y - origin[1])
    host.scroll(5, MIDDLE_OF_CANVAS)
    host.until(lambda: not view.moving, "the zoom")
    assert view.camera.px_per_mm == pytest.approx(fitted.px_per_mm * 1.2**5)
    assert view.at(x - origin[0], y - origin[1]) == pytest.approx(place, abs=1e-6)
    zoomed = view.camera
    host.drag(MIDDLE_OF_CANVAS, (x + 40, y - 20), "middle")
    moved = 40 / zoomed.px_per_mm
    assert view.camera.center_mm[0] == pytest.approx(zoomed.center_mm[0] - moved)
    host.key_down("space")
    host.drag(MIDDLE_OF_CANVAS, (x - 40, y + 20), "left")
    host.key_up("space")
    assert view.camera.center_mm == pytest.approx(zoomed.center_mm)
    host.key("f")
    assert view.camera == fitted
    host.scroll(3, host.place("Number"))  # over the panel the page stays
    assert view.camera == fitted
    host.move(*MIDDLE_OF_CANVAS)
    host.key("1")
    assert view.camera.px_per_mm == pytest.approx(desk.app.window.px_per_mm)
    desk.app.editor.show_panel(VIEW)
    host.settle()
    host.click("Fit")
    assert view.camera == fitted


def test_a_letter_typed_into_a_field_is_no_command(desk) -> None:
    desk.host.click("More dots")
    desk.host.click("Seed")
    desk.host.key("t")
    assert desk.app.editor.look.theme is LIGHT
    desk.host.key("enter")
    desk.host.key("t")
    assert desk.app.editor.look.theme is DARK
    assert near(desk.host.screenshot(), 990, 40, DARK.desk)


def test_the_page_is_drawn_only_when_it_changes(desk, picture: Path) -> None:
    open_and_finish(desk, picture)
    canvas, editor = desk.app.editor.canvas, desk.app.editor
    drawn, frames = canvas.n_drawn, editor.n_frames
    for x in range(400, 900, 20):
        desk.host.move(x, 300)
    assert editor.n_frames > frames
    assert canvas.n_drawn == drawn
    desk.app.editor.show_panel(VIEW)
    desk.host.settle()
    desk.host.click("Show picture")
    assert canvas.n_drawn > drawn


def test_something_else_dropped_is_one_line_and_no_crash(
    desk, picture: Path, tmp_path: Path
) -> None:
    open_and_finish(desk, picture)
    notes = tmp_path / "notes.png"
    notes.write_text("no picture at all")
    for path in (notes, tmp_path, tmp_path / "missing.png"):
        desk.host.drop(path)
        desk.host.until(lambda: not desk.app.session.busy, "an answer")
        desk.host.settle()
        assert str(path) in desk.host.said()
        assert desk.host.shown("notice")
        assert desk.app.session.name == "disc.png"
    assert desk.app.session.n_dots > 0


def test_a_picture_is_opened_by_our_own_dialog(desk, picture: Path) -> None:
    desk.host.key("o", ctrl=True)
    assert desk.app.editor.popups.dialogs.is_open
    desk.host.until(lambda: desk.host.shown("path"), "the dialog")
    desk.host.settle()
    desk.host.fill("path", str(picture))
    assert not desk.app.editor.popups.dialogs.is_open
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    assert desk.app.session.name == "disc.png"


def test_the_dialog_lists_pictures_and_escape_closes_it(desk, picture: Path) -> None:
    desk.host.key("o", ctrl=True)
    desk.host.fill("path", f"{picture.parent}/")
    assert desk.app.editor.popups.dialogs.is_open
    desk.host.until(lambda: desk.host.shown("disc.png"), "the list")
    desk.host.key("escape")
    assert not desk.app.editor.popups.dialogs.is_open
    assert not desk.app.session.busy


def test_export_asks_before_it_replaces_a_file(desk, picture: Path, tmp_path: Path) -> None:
    open_and_finish(desk, picture)
    out = tmp_path / "out.csv"
    out.write_text("precious")
    desk.host.key("e", ctrl=True)
    for verb, kept in (("Cancel", True), ("Replace", False)):  # Cancel goes back to the path
        desk.host.fill("path", str(out))
        assert desk.host.shown("Replace")
        assert out.read_text() == "precious"
        desk.host.click(verb)
        desk.host.until(lambda: not desk.app.session.exporting, "the export")
        assert (out.read_text() == "precious") is kept
    assert len(out.read_text().splitlines()) == 1 + desk.app.session.n_dots
    assert str(out) in desk.host.said()


def test_a_png_is_exported_while_the_window_draws(desk, picture: Path, tmp_path: Path) -> None:
    open_and_finish(desk, picture)
    desk.host.key("e", ctrl=True)
    desk.host.fill("path", str(tmp_path / "out.png"))
    desk.host.until(lambda: not desk.app.session.exporting, "the export")
    assert str(tmp_path / "out.png") in desk.host.said()
    with Image.open(tmp_path / "out.png") as out:
        assert out.width == round(120 / 25.4 * 300)
        assert out.convert("L").resize((60, 45)).getextrema()[0] < 200
    page = np.s_[:660, 300:]
    before, drawn = desk.host.screenshot()[page], desk.app.editor.canvas.n_drawn
    desk.host.key("t")
    desk.host.key("t")
    assert desk.app.editor.canvas.n_drawn > drawn
    assert np.array_equal(desk.host.screenshot()[page], before)  # the window's GL is as it was


def test_an_unknown_ending_is_one_line(desk, picture: Path, tmp_path: Path) -> None:
    open_and_finish(desk, picture)
    desk.host.key("e", ctrl=True)
    desk.host.fill("path", str(tmp_path / "out.doc"))
    dialog = desk.app.editor.popups.exporting
    assert ".doc is no ending" in dialog.problem
    assert dialog.choices.path == str(tmp_path / "out.doc")  # to be mended
    assert not (tmp_path / "out.doc").exists()
    desk.host.key("escape")
    assert not dialog.is_open


def test_a_faulty_panel_is_told_and_the_editor_lives_on(
    desk, picture: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    from imgui_bundle import imgui

    def faulty(*_: object) -> None:
        imgui.begin_child("left open")
        imgui.push_style_color(imgui.Col_.text, (1.0, 0.0, 0.0, 1.0))
        raise ZeroDivisionError("a test's own")

    with monkeypatch.context() as patch:
        patch.setattr(contents, "draw_dots", faulty)
        for _ in range(3):
            desk.host.move(*MIDDLE_OF_CANVAS)
        desk.host.settle()
        assert "the panel Drawing failed (ZeroDivisionError: a test's own)" in desk.host.said()
        assert desk.host.shown("notice")
        assert desk.host.shown("Open")  # what was drawn before it
    assert sum("the panel Drawing failed" in record.message for record in caplog.records) == 1
    desk.host.move(500, 300)
    desk.host.settle()
    assert desk.host.shown("Start")
    open_and_finish(desk, picture)


def test_a_job_that_dies_is_told(desk, picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def dying(source: Source, style: Style, reference: Reference | None) -> Iterator[Work]:
        yield Work("read")
        raise ZeroDivisionError("a test's own")

    monkeypatch.setattr(desk.app.session, "_stipple", dying)
    desk.host.drop(picture)
    desk.host.until(lambda: not desk.app.session.busy, "an end")
    desk.host.settle()
    assert "ZeroDivisionError" in desk.host.said()
    assert desk.host.shown("notice")


def test_a_second_picture_supersedes_the_first(desk, picture: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.png"
    Image.new("L", (60, 60), 128).save(other)
    desk.app.session.edit_style(iterations=100_000)
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.stage == "relax", "relaxation")
    desk.app.session.edit_style(iterations=2)
    desk.host.drop(other)
    desk.host.until(lambda: desk.app.session.phase == "done", "the second drawing")
    assert desk.app.session.name == "other.png"
    drawing = desk.app.session.drawing
    assert drawing is not None
    assert (drawing.page.width_mm, drawing.page.height_mm) == (120.0, 120.0)


def test_it_sleeps_when_nothing_changes(desk, picture: Path) -> None:
    open_and_finish(desk, picture)
    desk.app.session.messages.dismiss()
    # the tooltip's last look, and the one at the end of the line that is dismissed
    desk.host.until(lambda: desk.app.editor.sleep_s() > 5.0, "sleep")
    frames = desk.app.editor.n_frames
    assert desk.app.editor.sleep_s() > 5.0
    desk.app.step(0.0)
    assert desk.app.editor.n_frames == frames


def test_closing_while_work_runs_ends_at_once(kernels: None, picture: Path) -> None:
    from stippler.app import App

    app = App(Style(n_dots=300, iterations=100_000), tone="linear", width_mm=50.0, offscreen=True)
    app.session.open(picture)
    while app.session.stage != "relax":
        app.step(0.05)
    app.close()
    assert not app.worker._thread.is_alive()
    assert not app.exporter._thread.is_alive()
