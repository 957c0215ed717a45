"""When a drawing is saved by itself, where that goes, and what it never touches."""

import numpy as np
import pytest

import stippler
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor.exports import Exports
from stippler.editor.messages import Messages
from stippler.editor.saving import Saving
from stippler.files.native.drawing_file import save_drawing
from stippler.jobs.worker import Worker

MIN_S = 60.0


class Desk:
    """A document, its file, and a clock that goes on when it is told to."""

    def __init__(self, folder, name="", path=None):
        drawing = Drawing.blank(Page(40.0, 30.0))
        drawing.dots = Dots.round(np.random.default_rng(1).random((50, 2)) * (40, 30), 0.2)
        self.document, self.now_s, self.worker = Document(drawing), 0.0, Worker(lambda: None)
        exports = Exports(self.worker, Messages())
        if path is not None:
            save_drawing(drawing, path)
        exports.begin_drawing(path, self.document if path else None)
        self.saving = Saving(exports, Messages(), folder / "backups", lambda: self.now_s)
        self.saving.begin_drawing(name)

    def sprayed(self):
        self.document.begin("Spray")
        self.document.insert(Dots.round(np.array([[5.0, 6.0]]), 0.3))
        self.document.commit()

    def after(self, seconds):
        """Let time go on; return how many earlier versions there are then."""
        self.now_s += seconds
        self.saving.poll(self.document)
        self.saving.wait()
        return len(self.saving.earlier().listed())


@pytest.fixture
def desks():
    made = []

    def make(*args, **kwargs):
        made.append(Desk(*args, **kwargs))
        return made[-1]

    yield make
    for desk in made:
        desk.worker.close()


def test_it_waits_as_long_as_a_person_has_chosen(desks, tmp_path):
    desk = desks(tmp_path)
    desk.saving.wishes.autosave_min = 3
    desk.sprayed()
    assert desk.after(0.0) == 0
    assert desk.after(3 * MIN_S - 0.01) == 0
    assert desk.after(0.01) == 1
    assert desk.after(100 * MIN_S) == 1  # the same state is not saved twice
    desk.sprayed()
    assert desk.after(0.0) == 1
    assert desk.after(3 * MIN_S) == 2


@pytest.mark.parametrize("wish", ["autosave_min", "n_backups"])
def test_none_are_made_where_a_person_wants_none(desks, tmp_path, wish):
    desk = desks(tmp_path)
    setattr(desk.saving.wishes, wish, 0)
    desk.sprayed()
    assert desk.after(0.0) == desk.after(1000 * MIN_S) == 0
    assert not (tmp_path / "backups").exists()


def test_none_is_made_within_a_stroke_and_one_right_after_it(desks, tmp_path):
    desk = desks(tmp_path)
    desk.sprayed()
    desk.after(0.0)
    desk.document.begin("Spray")
    desk.document.insert(Dots.round(np.array([[7.0, 8.0]]), 0.3))
    assert desk.after(1000 * MIN_S) == 0
    desk.document.commit()
    assert desk.after(0.0) == 1
    made = desk.saving.earlier().listed()[0]
    assert len(stippler.open(made.path).dots) == 52


def test_drawings_without_a_file_do_not_share_their_versions(desks, tmp_path):
    one, other = desks(tmp_path, "Untitled a"), desks(tmp_path, "Untitled b")
    for desk in (one, other):
        desk.sprayed()
        desk.after(0.0)
    assert (one.after(10 * MIN_S), other.after(0.0)) == (1, 0)


def test_as_many_are_kept_as_a_person_has_chosen_and_the_file_stays_as_it_is(desks, tmp_path):
    path = tmp_path / "ear.stipple"
    desk = desks(tmp_path, path=path)
    before = path.read_bytes()
    desk.saving.wishes.n_backups = 2
    for _ in range(4):
        desk.sprayed()
        desk.after(0.0)
        desk.after(10 * MIN_S)
    versions = desk.saving.earlier().listed()
    assert [backup.number for backup in versions] == [4, 3]
    assert [len(stippler.open(backup.path).dots) for backup in versions] == [54, 53]
    assert path.read_bytes() == before
    assert sorted(file.name for file in tmp_path.iterdir()) == ["backups", "ear.stipple"]
