"""Memory that runs out and exceptions anywhere leave the drawing whole, saveable, recoverable."""

import itertools
import logging
import time
from pathlib import Path

import moderngl
import numpy as np
import pytest

import stippler
from stippler import export
from stippler.app import App
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.store import DotStore
from stippler.drawing.style import Style
from stippler.editor import processing
from stippler.editor.log_file import begin_log, end_log, log_path
from stippler.files.native import drawing_file, recovery
from stippler.files.native.drawing_file import members_of, save_drawing
from stippler.headless import open_context, render_image
from stippler.jobs import preflight, reading, stippling
from stippler.ui.canvas.canvas import Canvas
from stippler.ui.window.scripted_host import Host


@pytest.fixture
def kept(kernels, monkeypatch, tmp_path):
    """An editor on a drawing that is kept for recovery, with a log; its hands."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    monkeypatch.setenv("STIPPLER_STATE_DIR", str(tmp_path / "state"))
    app = App(
        Style(n_dots=300, iterations=4), tone="linear", width_mm=120.0, size=(1000, 700),
        offscreen=True, recovery=tmp_path / "recovery", backups=tmp_path / "backups",
    )  # fmt: skip
    log = begin_log(log_path())
    app.session.messages.log_path = log_path()
    host = Host(app.window, app.editor, app.step)
    drawing = Drawing.blank(Page(120.0, 90.0))
    at = np.random.default_rng(4).random((400, 2)) * (120, 90)
    drawing.dots = Dots.round(at, 0.4)
    app.session.show(drawing)
    host.settle()
    host.key("e")
    host.drag((600, 300), (620, 330), "left")
    yield app, host
    end_log(log)
    app.session.keeping.close()
    app.close()


def out_of_memory(*_, **__):
    raise MemoryError


def assert_whole(app, host, before, tmp_path):
    """The drawing is as it was; it can be saved, recovered, undone to the start, and done again."""
    document = app.session.document
    assert members_of(document.drawing) == before
    save_drawing(document.drawing, tmp_path / "after.stipple")
    assert len(stippler.open(tmp_path / "after.stipple").dots) == len(document.dots)
    keeping = app.session.keeping
    assert keeping._keeper.wait()
    (folder,) = keeping.root.iterdir()
    lost = recovery.Lost(folder, "one", None, 0.0)  # as another program would find it
    assert members_of(reading.recovered(lost).drawing) == before
    while document.undo():
        pass
    assert len(document.dots) == 400
    while document.redo():
        pass
    assert members_of(document.drawing) == before


def relax(app, host):
    app.session.relax(3, weighted=False)
    host.until(lambda: not app.session.busy, "the end")


def save(app, host):
    app.session.save(save.folder / "ear.stipple")
    host.until(lambda: not app.session.exporting, "the end")


def export_svg(app, host):
    app.session.export(save.folder / "ear.svg", 300.0)
    host.until(lambda: not app.session.exporting, "the end")


def open_other(app, host):
    app.session.open_drawing(save.folder / "other.stipple")
    host.until(lambda: not app.session.busy, "the end")


def undo(app, host):
    host.key("z", ctrl=True)
    host.settle()


def autosave(app, host):
    app.session.saving._clock = itertools.count(time.monotonic() + 10_000.0, 10_000.0).__next__
    for _ in range(3):
        app.session.poll()
    app.session.saving.wait()
    app.session.poll()


JOBS = [
    pytest.param(relax, stippling, "relax_drawing", id="worker"),
    pytest.param(save, drawing_file, "members_of", id="save"),
    pytest.param(autosave, drawing_file, "members_of", id="autosave"),
    pytest.param(export_svg, export, "_files", id="export"),
    pytest.param(open_other, drawing_file, "_read_dots", id="open"),
    pytest.param(undo, DotStore, "_grow", id="undo"),
]


@pytest.mark.parametrize(("job", "where", "what"), JOBS)
def test_memory_that_runs_out_leaves_drawing_and_journal_whole(
    kept, tmp_path, monkeypatch, job, where, what
):
    app, host = kept
    save.folder = tmp_path
    save_drawing(app.session.drawing, tmp_path / "other.stipple")
    before = members_of(app.session.document.drawing)
    n_said = len(app.session.messages.log)
    with monkeypatch.context() as broken:
        broken.setattr(where, what, out_of_memory)
        job(app, host)
    assert len(app.session.messages.log) > n_said
    assert "emory" in host.said() or "saved by itself" in host.said()
    assert not list(tmp_path.glob("*.part*"))
    assert not (tmp_path / "ear.stipple").exists()
    if host.shown("Later"):
        host.click("Later")
    assert_whole(app, host, before, tmp_path)


def test_a_journal_that_runs_out_of_memory_is_begun_anew(kept, tmp_path, monkeypatch):
    app, host = kept
    from stippler.files.native import edit_log

    with monkeypatch.context() as broken:
        broken.setattr(edit_log, "of_entry", out_of_memory)
        host.drag((700, 400), (720, 430), "left")
        app.session.keeping._keeper.wait()
        app.session.poll()
    assert "cannot be kept for recovery" in host.said()
    app.session.keeping._failed_s = -100.0
    app.session.poll()
    before = members_of(app.session.document.drawing)
    assert_whole(app, host, before, tmp_path)


def test_a_job_that_will_not_fit_is_told_before(kept, tmp_path, monkeypatch):
    app, host = kept
    monkeypatch.setattr(preflight, "available_bytes", lambda: 50 << 20)
    app.session.export(tmp_path / "ear.svg", 300.0)
    host.until(lambda: not app.session.exporting, "the file")
    assert any("52 MB are free" in line.text for line in app.session.messages.log)
    assert (tmp_path / "ear.svg").exists()  # it warns; the person decides


def test_filling_and_processing_that_will_not_fit_are_told_before(kept, monkeypatch):
    app, host = kept
    session = app.session
    monkeypatch.setattr(preflight, "available_bytes", lambda: 50 << 20)
    session.fill()
    host.until(lambda: not session.busy, "the dots")
    assert any("fill with fewer dots" in line.text for line in session.messages.log)
    assert session.n_dots > 400  # it warns; the person decides
    field = np.tile(np.linspace(0, 1, 40), (30, 1))
    document = session.document
    document.begin("Picture")
    document.set("reference", 0, Reference(field, 120.0))
    document.commit()
    assert processing.process(session, [0])
    host.until(lambda: not session.busy, "the page")
    assert any("process fewer areas" in line.text for line in session.messages.log)


def boom(*_, **__):
    raise RuntimeError("boom")


def break_panel(app, host, monkeypatch):
    monkeypatch.setattr("stippler.ui.editor_window.draw_status", boom)
    host.move(640, 360)
    host.settle()


def break_brush(app, host, monkeypatch):
    monkeypatch.setattr(type(app.session.document), "remove", boom)
    host.drag((700, 400), (720, 430), "left")


def break_worker(app, host, monkeypatch):
    monkeypatch.setattr(stippling, "relax_drawing", boom)
    relax(app, host)


def break_shader(app, host, monkeypatch):
    def no_program(*_, **__):
        raise moderngl.Error("0:12: syntax error in dots.frag")

    monkeypatch.setattr(app.editor.canvas, "draw", no_program)
    host.move(640, 360)
    host.settle()


@pytest.mark.parametrize("break_it", [break_panel, break_brush, break_worker, break_shader])
def test_an_exception_anywhere_is_told_logged_and_harmless(kept, tmp_path, monkeypatch, break_it):
    app, host = kept
    before = members_of(app.session.document.drawing)
    with monkeypatch.context() as broken:
        break_it(app, host, broken)
        said = host.said()
    assert "boom" in said or "syntax error" in said
    assert str(log_path()) in said
    for handler in logging.getLogger("stippler").handlers:
        handler.flush()
    log = log_path().read_text()
    assert "Traceback" in log
    assert "boom" in log or "syntax error" in log
    assert_whole(app, host, before, tmp_path)
    host.settle()
    host.drag((650, 350), (670, 380), "left")
    assert app.session.document.history.n_done == 2  # the editor goes on


def test_a_panel_that_fails_leaves_the_others_on_the_screen(kept, monkeypatch):
    _, host = kept
    monkeypatch.setattr("stippler.ui.editor_window.draw_status", boom)
    host.key("s", ctrl=True, shift=True)
    host.settle()
    assert "the status bar failed" in host.said()
    assert host.shown("path")  # of a dialog that is drawn after it


def test_events_after_one_that_fails_are_taken(kept, monkeypatch):
    """All in one frame: a drop that fails, and the end of a stroke that had begun before it."""
    app, host = kept
    monkeypatch.setattr(app.editor.popups.filing, "drop", boom)
    n_dots = app.session.n_dots
    host.move(700, 400)
    host.press()
    host.move(720, 430)
    with host.batch():
        host.drop(Path("any.png"))
        host.move(740, 440)
        host.release()
    host.settle()
    assert "the input failed" in host.said()
    assert not app.session.document.in_stroke
    assert app.session.document.history.n_done == 2
    assert app.session.n_dots < n_dots


def test_a_lost_gl_context_loses_no_drawing(kept):
    """The page is drawn anew from the drawing alone, to the same pixels."""
    app, host = kept
    host.move(500, 690)
    host.key("v")
    host.settle()
    before = host.screenshot()[100:600, 400:900]
    app.editor.canvas.close()
    app.editor.canvas = Canvas(app.window.ctx)
    host.move(501, 690)
    host.settle()
    assert np.array_equal(host.screenshot()[100:600, 400:900], before)


def test_two_contexts_draw_one_drawing_to_the_same_pixels():
    drawing = Drawing.blank(Page(60.0, 40.0))
    at = np.random.default_rng(4).random((300, 2)) * (60, 40)
    drawing.dots = Dots.round(at, 0.3)
    pictures = []
    for _ in range(2):
        context = open_context()
        try:
            pictures.append(np.asarray(render_image(drawing, px_per_mm=6.0, context=context)))
        finally:
            context.release()
    assert np.array_equal(*pictures)
    assert pictures[0].min() < pictures[0].max()
