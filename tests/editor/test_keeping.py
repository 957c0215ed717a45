"""The open drawing is kept for recovery: windows, disks that fail, runs, what a crash left."""

import errno
import os

import numpy as np
import pytest

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor.keeping import PART_S, RETRY_S, Keeping
from stippler.editor.messages import Messages
from stippler.files.native import journal, recovery
from stippler.files.native.drawing_file import members_of
from stippler.files.native.recovery import Lost, lost_drawings
from stippler.jobs.reading import recovered


class Desk:
    """A document of 50 dots that is kept, and a clock that goes on when it is told to."""

    def __init__(self, root, path=None, lost=None):
        drawing = Drawing.blank(Page(40.0, 30.0))
        drawing.dots = Dots.round(np.random.default_rng(1).random((50, 2)) * (40, 30), 0.2)
        self.document, self.now_s = Document(drawing), 0.0
        self.messages = Messages()
        self.keeping = Keeping(root, self.messages, lambda: self.now_s)
        self.keeping.open(self.document, "ear", path, lost)

    @property
    def said(self):
        return [line.text for line in self.messages.log]

    def wait(self):
        return self.keeping._keeper.wait()

    def sprayed(self):
        self.document.begin("Spray")
        self.document.insert(Dots.round(np.array([[5.0, 6.0]]), 0.3))
        self.document.commit()

    def found(self):
        """Return what another program would recover now, with its history."""
        self.keeping._keeper.wait()
        return recovered(Lost(self.folder, "ear", None, 0.0))

    @property
    def folder(self):
        return self.keeping._keeper._folder


@pytest.fixture
def desk(tmp_path):
    desk = Desk(tmp_path / "recovery")
    yield desk
    desk.keeping.close()


def test_a_second_window_on_one_file_is_told_and_the_first_and_others_are_not(tmp_path):
    path = tmp_path / "ear.stipple"
    first = Desk(tmp_path / "recovery", path)
    assert first.wait()
    second = Desk(tmp_path / "recovery", path)
    other = Desk(tmp_path / "recovery", tmp_path / "eye.stipple")
    assert first.said == other.said == []
    (told,) = second.said
    assert "ear.stipple is open in another window" in told
    for one in (second, other, first):
        assert one.wait()
        one.keeping.close()
    assert Desk(tmp_path / "recovery", path).said == []  # nobody has it open any more


def test_what_a_run_has_changed_is_written_down_every_two_seconds_and_not_before(desk):
    dots = desk.document.begin_run("Relax")
    desk.document.merge(dots.position_mm + 0.25)
    desk.now_s = PART_S - 0.01
    desk.keeping.poll()
    assert np.array_equal(desk.found().dots.position_mm, dots.position_mm)
    desk.now_s = PART_S
    desk.keeping.poll()
    moved = desk.found()
    assert np.array_equal(moved.dots.position_mm, dots.position_mm + 0.25)
    desk.document.merge(dots.position_mm + 0.5)
    desk.now_s = 2 * PART_S - 0.01
    desk.keeping.poll()
    assert np.array_equal(desk.found().dots.position_mm, dots.position_mm + 0.25)
    desk.now_s = 2 * PART_S
    desk.keeping.poll()
    assert np.array_equal(desk.found().dots.position_mm, dots.position_mm + 0.5)
    assert PART_S == 2.0


@pytest.mark.parametrize("call", ["write", "fsync"])
def test_a_disk_that_fails_is_told_and_another_journal_is_begun_in_new_files(
    desk, monkeypatch, call
):
    def fail(*_):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    assert desk.wait()
    before = {file.name: file.stat().st_ino for file in desk.folder.iterdir()}
    with monkeypatch.context() as broken:
        broken.setattr(journal.os, call, fail)
        desk.sprayed()
        assert not desk.wait()
        for _ in range(3):
            desk.keeping.poll()
    assert [text for text in desk.said if "cannot be kept for recovery" in text] == desk.said
    assert len(desk.said) == 1
    desk.sprayed()
    desk.now_s += RETRY_S - 0.01
    desk.keeping.poll()
    assert len(desk.found().dots) < len(desk.document.dots)
    desk.now_s += 0.02
    desk.keeping.poll()
    assert desk.wait()
    desk.keeping.poll()
    assert desk.said[1:] == ["edits are kept for recovery again"]
    desk.sprayed()
    assert members_of(desk.found().drawing) == members_of(desk.document.drawing)
    new = {file.name for file in desk.folder.iterdir() if file.suffix in (".journal", ".stipple")}
    assert not new & set(before)


def test_a_disk_that_goes_on_failing_is_tried_now_and_then_and_told_once(desk, monkeypatch):
    assert desk.wait()
    tried = []

    def fail(*_):
        tried.append(desk.now_s)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(journal.os, "fsync", fail)
    desk.sprayed()
    assert not desk.wait()
    for _ in range(100):
        desk.keeping.poll()
        desk.now_s += 1.0
        desk.wait()
    assert sorted(set(tried)) == [0.0, RETRY_S, 2 * RETRY_S, 3 * RETRY_S]
    assert not any("again" in text for text in desk.said)


def test_what_a_crash_left_stays_until_the_drawing_is_kept_anew(tmp_path, monkeypatch):
    root = tmp_path / "recovery"
    (root / "left").mkdir(parents=True)
    lost = Lost(root / "left", "ear", None, 0.0)

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as broken:
        broken.setattr(recovery, "_write_base", full)
        desk = Desk(root, lost=lost)
        assert not desk.wait()
        desk.keeping.poll()
    assert (root / "left").exists()
    desk.now_s += RETRY_S
    desk.keeping.poll()
    assert desk.wait()
    desk.keeping.poll()
    assert not (root / "left").exists()
    assert members_of(desk.found().drawing) == members_of(desk.document.drawing)
    desk.keeping.close()
    assert list(root.iterdir()) == []


def test_a_save_begins_the_journal_anew_under_the_name_of_the_file(desk, tmp_path):
    desk.sprayed()
    desk.keeping.saved(tmp_path / "nose.stipple")
    desk.sprayed()
    assert members_of(desk.found().drawing) == members_of(desk.document.drawing)
    about = recovery._about(desk.folder)
    assert (about["name"], about["path"]) == ("nose.stipple", str(tmp_path / "nose.stipple"))
    assert lost_drawings(desk.keeping.root) == []  # it is open


def test_nothing_is_kept_where_nothing_is_wanted(tmp_path):
    desk = Desk(None)
    desk.sprayed()
    desk.keeping.saved(tmp_path / "nose.stipple")
    desk.keeping.poll()
    desk.keeping.close()
    assert desk.keeping._keeper is None
    assert list(tmp_path.iterdir()) == []
