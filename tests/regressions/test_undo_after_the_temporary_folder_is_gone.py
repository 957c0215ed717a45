"""A cleaned temporary folder took the history with a traceback at each undo."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import HistoryError


def test_what_is_lost_is_said_once_and_the_rest_goes_on():
    drawing = Drawing.blank(Page(100, 100))
    drawing.dots = Dots.round(np.random.default_rng(1).random((500, 2)) * 100, 0.2)
    document = Document(drawing, budget_bytes=1000)

    def step():
        document.begin("move")
        document.move(np.arange(500), document.dots.position_mm * 0.99)
        document.commit()

    for _ in range(4):
        step()
    shutil.rmtree(Path(document.history.steps[0].path).parent)
    assert document.undo()  # this one was in memory
    place = document.dots.position_mm.copy()
    with pytest.raises(HistoryError, match="“move” and 2 older lay in a temporary folder"):
        document.undo()
    assert np.array_equal(document.dots.position_mm, place)
    assert not document.undo()
    assert document.redo()
    for _ in range(3):
        step()  # and lies on disk again
    assert any(one.path for one in document.history.steps)
    while document.undo():
        pass
    assert np.array_equal(document.dots.position_mm, place)
