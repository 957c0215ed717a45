"""Where all steps were undone and one lay on disk and was lost, redoing counted below nothing."""

import numpy as np
import pytest

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.history import HistoryError


@pytest.mark.parametrize(
    ("n_undone", "told", "n_left", "n_done"),
    [(0, "Third. and 2 older", 0, 0), (1, "Second. and 1 older", 1, 0), (1, "Third", 2, 2),
     (2, "Second. and 1 later", 1, 1), (3, "First. and 2 later", 0, 0)],
)  # fmt: skip
def test_the_step_nearest_to_now_is_named_and_the_others_stay(n_undone, told, n_left, n_done):
    drawing = Drawing.blank(Page(10.0, 10.0))
    drawing.dots = Dots.round([(1, 1), (2, 2)], 0.2)
    document = Document(drawing, 0)
    for label in ("First", "Second", "Third"):
        document.begin(label)
        document.move(np.array([0]), document.dots.position_mm[[0]] + 0.5)
        document.commit()
    for _ in range(n_undone):
        document.undo()
    history, back = document.history, "older" in told
    step = history.undone if back else history.redone
    if step.path is None:
        history._write(step, step.edit)
    step.path.unlink()
    place = document.dots.position_mm.copy()
    with pytest.raises(HistoryError, match=told):
        document.undo() if back else document.redo()
    assert (len(history.steps), history.n_done) == (n_left, n_done)
    assert np.array_equal(document.dots.position_mm, place)
    document.begin("Fourth")
    document.move(np.array([1]), document.dots.position_mm[[1]] + 0.5)
    document.commit()
    assert history.undone.label == "Fourth"
    assert document.undo()
    assert np.array_equal(document.dots.position_mm, place)
