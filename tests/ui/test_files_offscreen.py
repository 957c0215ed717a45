"""Files in the window: disks that fail, earlier versions, recent files, history and view kept."""

import errno
import os
import shutil
from pathlib import Path

import numpy as np
import pytest

import stippler
from stippler import atomic_write
from stippler.app import App
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.style import Style
from stippler.files.native.drawing_file import save_drawing
from stippler.ui.popups.shelf import small_picture
from stippler.ui.window.scripted_host import Host


@pytest.fixture
def drawing():
    made = Drawing.blank(Page(120.0, 90.0))
    at = np.random.default_rng(4).random((400, 2)) * (120, 90)
    made.dots = Dots.round(at, 0.4)
    return made


@pytest.fixture
def kept(kernels, monkeypatch, tmp_path):
    """An editor that keeps earlier versions and edits; its hands."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    app = App(
        Style(n_dots=300, iterations=4), tone="linear", width_mm=120.0, size=(1000, 700),
        offscreen=True, recovery=tmp_path / "recovery", backups=tmp_path / "backups",
    )  # fmt: skip
    host = Host(app.window, app.editor, app.step)
    yield app, host
    app.session.keeping.close()
    app.close()


def opened(app, host, path):
    app.session.open_drawing(path)
    host.until(lambda: not app.session.busy, "the file")
    host.settle()


def erased(host, at=(600, 300)):
    host.key("e")
    host.drag(at, (at[0] + 20, at[1] + 30), "left")


def saved(app, host):
    host.key("s", ctrl=True)
    host.until(lambda: not app.session.exporting, "the file")
    host.settle()


def failing(error):
    def fail(*_, **__):
        raise OSError(error, os.strerror(error))

    return fail


DISKS = [
    pytest.param(errno.ENOSPC, "full", id="the disk is full"),
    pytest.param(errno.EROFS, "read-only", id="the folder is read-only"),
    pytest.param(errno.EACCES, "may not be written", id="the folder may not be written"),
    pytest.param(errno.EIO, "cannot be written", id="a network drive goes away"),
    pytest.param(errno.ESTALE, "cannot be written", id="a network drive was mounted anew"),
    pytest.param(errno.ENOENT, "folder does not exist", id="a stick was pulled out"),
]


@pytest.mark.parametrize(("error", "told"), DISKS)
def test_a_disk_that_fails_loses_nothing_and_another_place_is_offered(
    kept, drawing, tmp_path, monkeypatch, error, told
):
    app, host = kept
    path = tmp_path / "ear.stipple"
    save_drawing(drawing, path)
    before = path.read_bytes()
    opened(app, host, path)
    erased(host)
    n_dots, dots = app.session.n_dots, app.session.document.dots.copy()
    with monkeypatch.context() as broken:
        broken.setattr(atomic_write.os, "fsync", failing(error))
        saved(app, host)
    assert told in host.said()
    assert path.read_bytes() == before
    assert app.session.unsaved
    assert host.shown("Save elsewhere")
    host.click("Save elsewhere")
    host.fill("path", str(tmp_path / "elsewhere.stipple"))
    host.until(lambda: not app.session.exporting, "the file")
    host.settle()
    assert not app.session.unsaved
    again = stippler.open(tmp_path / "elsewhere.stipple").dots
    assert len(again) == n_dots
    assert np.array_equal(again.position_mm, dots.position_mm)
    assert app.session.document.undo()


def test_a_folder_that_is_gone_is_told_and_saving_again_works_when_it_is_back(
    kept, drawing, tmp_path
):
    app, host = kept
    drive = tmp_path / "drive"
    drive.mkdir()
    save_drawing(drawing, drive / "ear.stipple")
    opened(app, host, drive / "ear.stipple")
    erased(host)
    shutil.move(drive, tmp_path / "unplugged")
    saved(app, host)  # the file is gone: changed, as far as one can tell
    saved(app, host)
    assert "folder does not exist" in host.said()
    assert app.session.unsaved
    shutil.move(tmp_path / "unplugged", drive)
    host.click("Try again")
    host.until(lambda: not app.session.exporting, "the file")
    host.settle()
    assert not app.session.unsaved
    assert len(stippler.open(drive / "ear.stipple").dots) == app.session.n_dots


def test_later_leaves_everything_as_it_is(kept, drawing, tmp_path, monkeypatch):
    app, host = kept
    save_drawing(drawing, tmp_path / "ear.stipple")
    opened(app, host, tmp_path / "ear.stipple")
    erased(host)
    with monkeypatch.context() as broken:
        broken.setattr(atomic_write.os, "fsync", failing(errno.ENOSPC))
        saved(app, host)
    host.click("Later")
    host.settle()
    assert not host.shown("Later")
    assert app.session.unsaved
    erased(host, (700, 400))
    assert app.session.document.history.n_done == 2


def test_every_save_keeps_what_it_replaces_and_it_can_be_opened(kept, drawing, tmp_path):
    app, host = kept
    path = tmp_path / "ear.stipple"
    save_drawing(drawing, path)
    opened(app, host, path)
    for k in range(2):
        erased(host, (560 + 60 * k, 300))
        saved(app, host)
    versions = app.session.saving.earlier().listed()
    assert [backup.number for backup in versions] == [2, 1]
    now = path.read_bytes()
    app.editor.commands["file.earlier"].run()
    host.until(lambda: host.shown("shelf 1"), "the shelf")
    host.until(lambda: app.editor.popups.earlier.is_ready, "the pictures")
    host.settle()
    host.click("shelf 1")
    host.until(lambda: app.session.n_dots == 400, "the first version")
    assert app.session.exports.file == path
    assert app.session.unsaved
    assert path.read_bytes() == now
    saved(app, host)
    assert len(stippler.open(path).dots) == 400
    assert not app.session.unsaved


def test_a_backup_that_cannot_be_kept_does_not_hinder_saving(kept, drawing, tmp_path):
    app, host = kept
    path = tmp_path / "ear.stipple"
    save_drawing(drawing, path)
    opened(app, host, path)
    (tmp_path / "backups").write_text("no folder")
    erased(host)
    saved(app, host)
    assert "earlier version could not be kept" in host.said()
    assert len(stippler.open(path).dots) == app.session.n_dots


def test_autosaves_go_beside_and_never_over_the_file(kept, drawing, tmp_path):
    app, host = kept
    path = tmp_path / "ear.stipple"
    save_drawing(drawing, path)
    before = path.read_bytes()
    opened(app, host, path)
    clock = [0.0]
    saving = app.session.saving
    saving._clock = lambda: clock[0]
    app.session.poll()
    assert saving.earlier().listed() == []  # nothing was changed
    for k in range(3):
        erased(host, (560 + 60 * k, 300))
        for _ in range(3):
            app.session.poll()
            clock[0] += 400.0
        app.session.poll()
        saving.wait()
    listed = saving.earlier().listed()
    assert len(listed) == 3
    assert all(backup.is_auto for backup in listed)
    assert len(stippler.open(listed[0].path).dots) == app.session.n_dots
    assert path.read_bytes() == before
    assert app.session.unsaved
    clock[0] += 1000.0
    app.session.poll()
    saving.wait()
    assert len(saving.earlier().listed()) == 3  # the same state is not saved twice


def test_an_autosave_that_fails_is_told_once(kept, drawing, tmp_path):
    app, host = kept
    save_drawing(drawing, tmp_path / "ear.stipple")
    opened(app, host, tmp_path / "ear.stipple")
    (tmp_path / "backups").write_text("no folder")
    app.session.saving._clock = iter(range(0, 10**6, 1000)).__next__
    erased(host)
    for _ in range(3):
        app.session.poll()
        app.session.saving.wait()
    app.session.poll()
    assert "could not be saved by itself" in host.said()


def test_the_history_comes_back_where_a_person_wants_it_in_the_file(kept, drawing, tmp_path):
    app, host = kept
    path = tmp_path / "ear.stipple"
    save_drawing(drawing, path)
    opened(app, host, path)
    erased(host)
    app.session.saving.wishes.history = True
    saved(app, host)
    opened(app, host, path)
    assert app.session.document.history.n_done == 1
    assert not app.session.unsaved
    host.key("z", ctrl=True)
    assert app.session.n_dots == 400
    app.session.saving.wishes.history = False
    saved(app, host)
    opened(app, host, path)
    assert app.session.document.history.steps == []


def test_view_and_brushes_come_back_with_the_drawing(kept, drawing, tmp_path):
    app, host = kept
    path = tmp_path / "ear.stipple"
    save_drawing(drawing, path)
    opened(app, host, path)
    toolbox, view = app.editor.painting.toolbox, app.editor.view
    host.key("e")
    toolbox.resize(1.7)
    host.scroll(3, (600, 350))
    host.settle()
    view.turn(0.3)
    camera, brush = view.camera, toolbox.brush
    saved(app, host)
    toolbox.resize(0.3)
    toolbox.choose("")
    view.fit()
    app.session.new(Page(50.0, 50.0))
    host.until(lambda: not app.session.busy, "a page")
    host.settle()
    opened(app, host, path)
    assert view.camera == camera
    assert toolbox.brush == brush
    assert not view.following
    app.session.new(Page(60.0, 50.0))
    host.until(lambda: not app.session.busy, "a page")
    host.settle()
    assert brush not in toolbox.shelf.brushes  # it was lent with the drawing


def test_recent_files_are_shown_by_their_pictures(kept, drawing, picture: Path, tmp_path):
    app, host = kept
    path = tmp_path / "ear.stipple"
    save_drawing(drawing, path)
    opened(app, host, path)
    app.session.open(picture)
    host.until(lambda: app.session.phase == "done", "the drawing")
    host.settle()
    host.key("o", ctrl=True, shift=True)
    host.until(lambda: host.shown("shelf 1"), "the shelf")
    host.until(lambda: app.editor.popups.recent.is_ready, "the pictures")
    host.settle()
    kept_pictures = app.editor.popups.recent._pictures
    host.until(lambda: all(one.texture is not None for one in kept_pictures.values()), "all drawn")
    host.click("shelf 1")
    host.until(lambda: app.session.exports.file == path, "the drawing")
    assert app.session.n_dots == 400


def test_small_pictures_of_anything(picture, tmp_path):
    (tmp_path / "none.stipple").write_bytes(b"nothing")
    (tmp_path / "cut.png").write_bytes(picture.read_bytes()[:60])
    found = small_picture(picture, 64)
    assert max(found.shape) == 64
    assert found.min() < 120 < found.max()
    for name in ("none.stipple", "cut.png", "gone.png"):
        assert small_picture(tmp_path / name, 64) is None
