"""The export dialog in the window: by mouse, by keyboard alone, and what goes wrong."""

import re
from threading import Event

import numpy as np
import pytest
from PIL import Image

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor import exports


@pytest.fixture
def dialog(desk):
    """The dialog, open on a drawing of 300 dots, everything found."""
    rng = np.random.default_rng(4)
    drawing = Drawing.blank(Page(120, 90))
    drawing.dots = Dots.round(rng.uniform((25, 10), (95, 80), (300, 2)), rng.uniform(0.3, 1.2, 300))
    desk.app.session.show(drawing)
    desk.host.settle()
    desk.host.key("e", ctrl=True)
    found(desk)
    return desk.app.editor.popups.exporting


def found(desk):
    """Wait until everything of what is chosen is known."""
    dialog = desk.app.editor.popups.exporting

    def known():
        going, look = dialog._going, dialog.look
        if going is None or look.file_key != going.asked.file_key:
            return False
        if look.proof_key != going.asked.proof_key or look.faults_key != going.asked.faults_key:
            return False
        if going.asked.wants_course and look.course_key != going.asked.file_key:
            return False
        return not going.asked.wants_moments or look.moments is not None

    desk.host.settle()
    desk.host.until(known, "the look")
    desk.host.settle()


def written(desk):
    desk.host.until(lambda: not desk.app.session.exporting, "the export")
    desk.host.settle()


def test_keyboard_alone(desk, dialog, tmp_path):
    """A name, Enter: written. Again, Esc: nothing. Tab goes on to the next control."""
    desk.host.type("a.svg")
    desk.host.key("enter")
    written(desk)
    assert not dialog.is_open
    assert (tmp_path / "a.svg").read_text().count("<circle") == desk.app.session.n_dots
    desk.host.key("e", ctrl=True)
    desk.host.type("b.svg")
    desk.host.key("escape")  # leaves the field
    desk.host.key("escape")
    assert not dialog.is_open
    assert not (tmp_path / "b.svg").exists()
    desk.host.key("e", ctrl=True)
    desk.host.type("c.pdf")
    for _ in range(4):  # Browse, Format, Publisher, Width
        desk.host.key("tab")
    desk.host.type("60")
    desk.host.key("enter")  # the number counts, and nothing is written
    assert dialog.choices.given["print_width"] == 60
    assert not (tmp_path / "c.pdf").exists()
    desk.host.click("path")
    desk.host.key("enter")
    written(desk)
    box = re.search(rb"MediaBox \[0 0 ([\d.]+)", (tmp_path / "c.pdf").read_bytes())
    assert float(box[1]) == pytest.approx(60 * 72 / 25.4, abs=0.01)


def test_the_preview_shows_the_drawing(desk, dialog):
    x0, y0, x1, y1 = (round(v) for v in desk.app.editor.widgets.marks["proof"])
    shot = desk.host.screenshot()[y0:y1, x0:x1].mean(axis=2)
    look = dialog.look
    height, width = look.picture.shape
    top, left = (y1 - y0 - height) // 2, (x1 - x0 - width) // 2
    seen = shot[top + 2 : top + height - 2, left + 2 : left + width - 2]
    truth = look.picture[2:-2, 2:-2].astype(float)
    assert np.abs(seen - truth).mean() < 8  # by a pixel's rounding
    assert seen.mean() == pytest.approx(truth.mean(), abs=1.5)
    at = (x0 + x1) / 2, (y0 + y1) / 2
    desk.host.scroll(6, at)
    found(desk)
    assert dialog.look.window.width_mm < 40
    near = dialog.look.window
    desk.host.drag(at, (at[0] - 60, at[1] - 30), "left")
    found(desk)
    assert dialog.look.window.left > near.left
    assert dialog.look.window.top > near.top
    desk.host.click("1:1")
    found(desk)
    window = dialog.look.window
    assert window.columns / window.width_mm == pytest.approx(desk.app.window.px_per_mm, rel=0.01)
    desk.host.click("Fit sheet")
    found(desk)
    assert dialog.look.window.width_mm == pytest.approx(120, rel=0.01)


def test_format_by_ending_and_options_by_format(desk, dialog, tmp_path):
    desk.host.type("a.tif")
    found(desk)
    assert desk.host.shown("Resolution")
    assert not desk.host.shown("Round dots Taps")
    desk.host.click("Bits 8")
    desk.host.fill("Resolution", "150")
    assert dialog.choices.given == {"bits": "8", "dpi": 150}
    desk.host.click("Export")
    written(desk)
    with Image.open(tmp_path / "a.tif") as image:
        assert (image.mode, image.width) == ("L", round(120 * 150 / 25.4))
    desk.host.key("e", ctrl=True, shift=True)  # again: the same options, no question
    written(desk)
    with Image.open(tmp_path / "a.tif") as image:
        assert (image.mode, image.width) == ("L", round(120 * 150 / 25.4))


@pytest.mark.parametrize(
    ("typed", "told"), [("-4", "give 1 to 10000"), ("wide", "wide"), ("99999 m", "10000")]
)
def test_a_bad_value_gets_one_line_and_changes_nothing(desk, dialog, typed, told):
    desk.host.click("Width")
    desk.host.type(typed)
    desk.host.key("enter")
    assert told in dialog.problem
    assert "\n" not in dialog.problem
    assert "print_width" not in dialog.choices.given
    assert dialog.is_open
    desk.host.click("Width")
    desk.host.type("5 cm")
    desk.host.key("enter")
    assert dialog.problem == ""
    assert dialog.choices.given["print_width"] == 50


def test_cancel_of_replace_goes_back_with_the_path(desk, dialog, tmp_path):
    out = tmp_path / "kept.svg"
    out.write_text("precious")
    desk.host.type(out.name)
    desk.host.key("enter")
    assert desk.host.shown("Replace")
    desk.host.click("Cancel")
    assert dialog.is_open
    assert dialog.choices.path == out.name
    assert out.read_text() == "precious"
    desk.host.type("nowhere/x.svg")
    desk.host.key("enter")
    assert "no folder" in dialog.problem
    assert dialog.choices.path == "nowhere/x.svg"
    (tmp_path / "figs").mkdir()
    desk.host.type("figs")
    desk.host.key("enter")
    assert dialog.choices.path == "figs/"
    desk.host.type(out.name)
    desk.host.key("enter")
    desk.host.click("Replace")
    written(desk)
    assert out.read_text().startswith("<svg")
    assert not dialog.is_open


def test_browsing_keeps_the_name(desk, dialog, tmp_path):
    folder = tmp_path / "figures"
    folder.mkdir()
    desk.host.type("moth.eps")
    desk.host.click("Browse")
    desk.host.click("figures/")
    desk.host.click("Choose")
    assert dialog.is_open
    assert dialog.choices.path == "figures/moth.eps"
    desk.host.click("Browse")
    desk.host.key("escape")
    desk.host.key("escape")
    assert dialog.choices.path == "figures/moth.eps"


def test_a_plotters_time_is_told_and_its_pen_plays(desk, dialog, tmp_path):
    desk.host.type("a.gcode")
    found(desk)
    assert "plotted in about" in dialog._forecast()
    desk.host.click("Pens")
    found(desk)
    total = dialog.look.course.total_s
    x0, y0, x1, y1 = (round(v) for v in desk.app.editor.widgets.marks["proof"])

    def ink():
        return int((desk.host.screenshot()[y0:y1, x0:x1].mean(axis=2) < 60).sum())

    before = ink()
    low, _, high, at = desk.app.editor.widgets.marks["moment"]
    desk.host.click((low + 0.5 * (high - low), at - 5))
    assert dialog.preview.playing.at_s == pytest.approx(total / 2, rel=0.1)
    half = ink()
    assert half > before
    desk.host.click("play")
    desk.host.until(lambda: dialog.preview.playing.at_s > 0.6 * total, "the play")
    assert ink() > half
    desk.host.click("play")
    assert not dialog.moves
    desk.host.click("Export")
    written(desk)
    told = re.search(r"(\d+\.\d) min", (tmp_path / "a.gcode").read_text())
    assert float(told[1]) * 60 == pytest.approx(total, abs=4)


def test_faults_are_counted_shown_and_repaired(desk, dialog):
    desk.host.click("Smallest dot")
    desk.host.type("0.8")
    desk.host.key("enter")
    found(desk)
    n = len(dialog.look.findings.too_small)
    assert n > 0
    undone = desk.app.session.document.dots.copy()
    desk.host.click("Show faults")
    assert not dialog.is_open
    assert "1 of" in desk.host.said()
    assert desk.app.editor.painting.n_selected >= 1
    desk.host.key("e", ctrl=True)
    desk.host.click("Repair")
    found(desk)
    assert len(dialog.look.findings.too_small) == 0
    dots = desk.app.session.document.dots
    assert len(dots) < len(undone)
    desk.host.key("escape")
    if dialog.is_open:
        desk.host.key("escape")
    desk.host.key("z", ctrl=True)
    np.testing.assert_array_equal(desk.app.session.document.dots.radius_mm, undone.radius_mm)


def test_a_press_that_is_calibrated_here_is_solved_for(desk, dialog, tmp_path):
    desk.host.type("a.svg")
    desk.host.key("enter")
    written(desk)
    desk.host.key("e", ctrl=True)
    desk.host.click("Calibrate")
    desk.host.click("Name")
    desk.host.type("riso")
    desk.host.click("Measured")
    desk.host.type("11.8 23.2 34.3 45.2 56 66.8")
    desk.host.click("Keep press")
    assert "7 shares" in dialog.problem
    desk.host.click("Measured")
    desk.host.type("11.8 23.2 34.3 45.2 56 66.8 77.3")
    desk.host.click("Keep press")
    assert dialog.choices.given["press"] == "riso"
    desk.host.click("path")
    desk.host.type("b.svg")
    desk.host.key("enter")
    written(desk)
    radii = [
        np.array([float(r) for r in re.findall(r' r="([\d.]+)"', (tmp_path / name).read_text())])
        for name in ("a.svg", "b.svg")
    ]
    from stippler.files.presses import press_named

    np.testing.assert_allclose(radii[0] - radii[1], press_named("riso").gain_mm, atol=3e-4)


def test_a_long_export_is_shown_and_can_be_given_up(desk, dialog, tmp_path, monkeypatch):
    """The file that was there survives."""
    gate, asked = Event(), []
    save = exports.export_drawing

    def slow(drawing, path, options, inputs, writing):
        asked.append(writing)

        def stepwise():
            import stippler.export

            real = stippler.export.save

            def held(*args, show, **more):
                def shows(n):
                    gate.wait(30)
                    show(n)

                return real(*args, show=shows, **more)

            stippler.export.save = held
            try:
                yield from save(drawing, path, options, inputs, writing)
            finally:
                stippler.export.save = real

        return stepwise()

    monkeypatch.setattr(exports, "export_drawing", slow)
    out = tmp_path / "large.svg"
    out.write_text("precious")
    desk.host.type(out.name)
    desk.host.key("enter")
    desk.host.click("Replace")
    desk.host.until(lambda: desk.host.shown("give up writing"), "the notice")
    desk.host.click("give up writing")
    gate.set()
    written(desk)
    assert "given up" in desk.host.said()
    assert out.read_text() == "precious"
    assert sorted(path.name for path in tmp_path.glob("*large*")) == ["large.svg"]
    desk.host.settle()
    assert not desk.host.shown("give up writing")


def test_a_small_window_has_room_for_all(desk, dialog):
    for label in ("path", "Browse", "Format", "proof", "Cancel", "Export"):
        x0, y0, x1, y1 = desk.app.editor.widgets.marks[label]
        assert 0 <= x0 < x1 <= 1000, label
        assert 0 <= y0 < y1 <= 700, label


def test_the_worker_and_the_texture_are_let_go(desk, dialog):
    worker = dialog._worker
    assert worker is not None
    dialog.close()
    assert not worker._thread.is_alive()
    assert dialog.preview._texture is None
