"""Undo, as a relaxation began and had moved nothing yet, took back the stroke before it.

And a relaxation after a picture that could not be read went by that picture's name, and a start
meanwhile tried to read it again.
"""

from pathlib import Path

import numpy as np
import pytest

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.editor.session import Session
from stippler.errors import PictureError
from stippler.jobs.work import Work
from stippler.jobs.worker import Update
from stippler.stippling.stipple import Progress

POINTS = np.array([[10.0, 10.0], [20.0, 20.0], [30.0, 30.0]])


class Worker:
    """Numbers what it is asked; a test puts its updates in."""

    def __init__(self):
        self.n, self.update = 0, None

    def start(self, run):
        self.n, self.update = self.n + 1, None
        return self.n

    def stop(self):
        pass

    def poll(self):
        update, self.update = self.update, None
        return update


@pytest.fixture
def worker():
    return Worker()


@pytest.fixture
def session(worker):
    """A session with a drawn picture, one dot of which a person has removed."""
    made = Session(
        worker,
        Worker(),
        Style(n_dots=3),
        tone="linear",
        width_mm=40.0,
        stipple=lambda *asked: made.asked.append(asked) or iter(()),
    )
    made.asked = []
    made.open(Path("good.png"))
    reference = Reference(np.full((30, 40), 0.5, np.float32), 40.0)
    progress = Progress("done", 1, 1, POINTS, np.full(3, 0.5, np.float32))
    worker.update = Update(
        1, Work("done", 1, 1, progress=progress, reference=reference), "finished", None, 1
    )
    made.poll()
    made.document.begin("Erase")
    made.document.remove(np.array([0]))
    made.document.commit()
    return made


def test_a_session_takes_back_only_the_run(session):
    session.relax(10, weighted=True)
    session.undo()
    assert not session.busy
    assert session.n_dots == 2
    session.undo()
    assert session.n_dots == 3


def test_a_drawing_takes_back_only_the_run():
    drawing = Drawing.blank(Page(40.0, 40.0))
    drawing.dots = Dots.round(POINTS, 0.5)
    document = Document(drawing)
    document.begin("Erase")
    document.remove(np.array([0]))
    document.commit()
    document.begin_run("Relax all")
    assert document.undo()
    assert not document.in_run
    assert len(document.dots) == 2


def test_a_relaxation_goes_by_the_picture_that_is_open(session, worker):
    session.open(Path("bad.png"))
    failure = PictureError("is no picture", "bad.png")
    worker.update = Update(worker.n, None, "failed", failure, 0)
    session.poll()
    session.relax(10, weighted=True)
    assert session.name == "good.png"
    session.start()
    assert session.name == "good.png"
