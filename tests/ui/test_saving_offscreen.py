"""Drawings saved, opened and recovered in the window."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import stippler
from stippler.app import App
from stippler.drawing.style import Style
from stippler.ui.window.scripted_host import Host


def finished(desk, picture):
    desk.app.session.open(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")


def saved_as(desk, path):
    desk.host.key("s", ctrl=True, shift=True)
    desk.host.fill("path", str(path))
    desk.host.until(lambda: not desk.app.session.exporting, "the file")
    desk.host.settle()


def erased(desk):
    desk.host.key("e")
    desk.host.drag((600, 300), (620, 330), "left")


def reopened(desk, path):
    desk.app.session.open_drawing(path)
    desk.host.until(lambda: not desk.app.session.busy, "the file")
    desk.host.settle()


def test_a_drawing_is_saved_and_opened_as_it_was(desk, picture: Path, tmp_path: Path) -> None:
    finished(desk, picture)
    erased(desk)
    assert desk.app.session.unsaved
    path = tmp_path / "ear.stipple"
    saved_as(desk, path)
    assert desk.app.session.name == "ear.stipple"
    assert not desk.app.session.unsaved
    dots = desk.app.session.document.dots.copy()
    shot = desk.host.screenshot()[100:600, 400:900]
    desk.app.session.new(desk.app.session.drawing.page)
    desk.host.until(lambda: desk.app.session.n_dots == 0, "the page")
    reopened(desk, path)
    assert np.array_equal(desk.app.session.document.dots.position_mm, dots.position_mm)
    assert np.array_equal(desk.app.session.document.dots.id, dots.id)
    assert not desk.app.session.unsaved
    desk.host.move(500, 690)
    desk.host.key("v")
    desk.host.settle()
    after = desk.host.screenshot()[100:600, 400:900]
    assert np.abs(after.astype(int) - shot).mean() < 1.0


def test_what_goes_on_after_opening_is_a_drawing_like_any(desk, picture, tmp_path) -> None:
    finished(desk, picture)
    path = tmp_path / "ear.stipple"
    saved_as(desk, path)
    reopened(desk, path)
    before = desk.app.session.n_dots
    erased(desk)
    assert desk.app.session.n_dots < before
    desk.host.key("z", ctrl=True)
    assert desk.app.session.n_dots == before
    desk.app.session.relax(2, weighted=True)
    desk.host.until(lambda: not desk.app.session.busy, "relaxation")
    desk.app.session.start()
    desk.host.until(lambda: not desk.app.session.busy, "another drawing")
    assert "open a picture first" not in desk.host.said()


def test_a_copy_leaves_the_drawing_its_file(desk, picture, tmp_path) -> None:
    finished(desk, picture)
    saved_as(desk, tmp_path / "ear.stipple")
    desk.host.key("p", ctrl=True, shift=True)
    desk.host.type("save a copy")
    desk.host.key("enter")
    desk.host.fill("path", str(tmp_path / "copy.stipple"))
    desk.host.until(lambda: not desk.app.session.exporting, "the copy")
    desk.host.settle()
    assert desk.app.session.name == "ear.stipple"
    assert (tmp_path / "copy.stipple").exists()


def test_reverting_asks_and_brings_the_file_back(desk, picture, tmp_path) -> None:
    finished(desk, picture)
    saved_as(desk, tmp_path / "ear.stipple")
    n_dots = desk.app.session.n_dots
    erased(desk)
    desk.app.editor.commands["file.revert"].run()
    desk.host.move(600, 400)
    desk.host.click("Discard")
    desk.host.until(lambda: not desk.app.session.busy, "the file")
    assert desk.app.session.n_dots == n_dots


def test_a_file_changed_by_another_program_is_not_replaced_at_once(desk, picture, tmp_path):
    finished(desk, picture)
    path = tmp_path / "ear.stipple"
    saved_as(desk, path)
    path.write_bytes(b"another's work")
    erased(desk)
    desk.host.key("s", ctrl=True)
    desk.host.until(lambda: not desk.app.session.exporting, "nothing")
    assert path.read_bytes() == b"another's work"
    assert "another program" in desk.host.said()
    desk.host.key("s", ctrl=True)
    desk.host.until(lambda: not desk.app.session.exporting, "the file")
    assert len(stippler.open(path).dots) == desk.app.session.n_dots


def test_a_file_that_is_gone_is_told_as_such_and_written_anew_if_asked_again(
    desk, picture, tmp_path
):
    finished(desk, picture)
    path = tmp_path / "ear.stipple"
    saved_as(desk, path)
    path.unlink()
    erased(desk)
    desk.host.key("s", ctrl=True)
    desk.host.until(lambda: not desk.app.session.exporting, "nothing")
    assert "no longer there" in desk.host.said()
    assert "another program" not in desk.host.said()
    assert not path.exists()
    desk.host.key("s", ctrl=True)
    desk.host.until(lambda: not desk.app.session.exporting, "the file")
    assert len(stippler.open(path).dots) == desk.app.session.n_dots


def test_a_broken_drawing_leaves_what_was_open(desk, picture, tmp_path) -> None:
    finished(desk, picture)
    (tmp_path / "bad.stipple").write_bytes(b"PK\3\4 no")
    n_dots = desk.app.session.n_dots
    desk.host.drop(tmp_path / "bad.stipple")
    desk.host.until(lambda: not desk.app.session.busy, "the failure")
    assert "bad.stipple" in desk.host.said()
    assert desk.app.session.n_dots == n_dots


def test_saving_before_quitting_asks_for_a_file_and_goes_on(desk, picture, tmp_path) -> None:
    finished(desk, picture)
    erased(desk)
    desk.host.key("q", ctrl=True)
    desk.host.click("Save")
    desk.host.fill("path", str(tmp_path / "ear.stipple"))
    desk.host.until(lambda: desk.app.window.wants_to_close, "the end")
    assert len(stippler.open(tmp_path / "ear.stipple").dots) == desk.app.session.n_dots


PAINTER = """
import sys
from pathlib import Path
from stippler.app import App
from stippler.drawing.style import Style
from stippler.ui.window.scripted_host import Host
picture, root = map(Path, sys.argv[1:])
app = App(Style(n_dots=300, iterations=4), tone="linear", width_mm=120.0, size=(1000, 700),
          offscreen=True, recovery=root)
host = Host(app.window, app.editor, app.step)
app.session.open(picture)
host.until(lambda: app.session.phase == "done", "the drawing")
host.key("e")
for k in range(400):
    host.drag((600 + 4 * k, 300), (605 + 4 * k, 330), "left")
    assert app.session.keeping._keeper.wait()
    print(app.session.n_dots, flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="needs SIGKILL")
def test_a_killed_window_is_offered_back_and_is_as_it_was(
    kernels: None, picture: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    root = tmp_path / "recovery"
    process = subprocess.Popen(
        [sys.executable, "-c", PAINTER, str(picture), str(root)], stdout=subprocess.PIPE, text=True
    )
    said = [process.stdout.readline() for _ in range(3)]
    time.sleep(0.05)
    process.send_signal(signal.SIGKILL)
    said += process.stdout.readlines()
    process.wait()
    counts = [int(line) for line in said if line.endswith("\n")]
    assert counts == sorted(counts, reverse=True)
    assert len(set(counts)) > 1, "nothing was erased"
    app = App(
        Style(n_dots=300, iterations=4), tone="linear", width_mm=120.0, size=(1000, 700),
        offscreen=True, recovery=root,
    )  # fmt: skip
    host = Host(app.window, app.editor, app.step)
    try:
        app.open(None)
        host.until(lambda: host.shown("recover 0"), "the question")
        host.until(lambda: "dots" in app.editor.popups.recovery._entries[0].text, "the preview")
        host.settle()
        host.click("recover 0")
        host.until(lambda: not app.session.busy and app.session.n_dots, "the drawing")
        assert app.session.n_dots <= counts[-1]
        assert app.session.unsaved
        n_steps = app.session.document.history.n_done
        assert n_steps >= len(set(counts))
        while app.session.document.undo():
            pass
        assert app.session.n_dots >= max(counts)
        assert app.session.keeping._keeper.wait()
        host.settle()
        assert len(list(root.iterdir())) == 1  # what the crash left is gone, the new one is kept
    finally:
        app.session.keeping.close()
        app.close()
    assert list(root.iterdir()) == []
