"""What was chosen before and after steps: it comes back with undo, and goes with the steps."""

import gc
import weakref

import numpy as np

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor import selection_memory
from stippler.editor.selection_memory import SelectionMemory
from stippler.editor.tools.selection import Selection


def drawn(n: int = 10) -> Document:
    drawing = Drawing.blank(Page(100.0, 100.0))
    drawing.dots = Dots.round(np.random.default_rng(1).random((n, 2)) * 90.0 + 5.0, 0.5)
    return Document(drawing)


def step(
    memory: SelectionMemory, document: Document, chosen: np.ndarray, select: Selection
) -> None:
    memory.note(document)
    document.begin("Move")
    document.move(np.array([0]), document.dots.position_mm[:1] + 0.1)
    document.commit()
    select.choose(chosen)
    memory.keep(document)


def test_undo_and_redo_bring_the_selection_back() -> None:
    document, selection = drawn(), Selection()
    memory = SelectionMemory(selection)
    step(memory, document, np.array([1, 2]), selection)
    made = document.history.undone
    assert made is not None
    memory.undone(made)
    assert selection.ids.tolist() == []
    memory.redone(made)
    assert selection.ids.tolist() == [1, 2]


def test_a_drawing_that_is_gone_leaves_no_step_behind() -> None:
    document, selection = drawn(), Selection()
    memory = SelectionMemory(selection)
    step(memory, document, np.array([1]), selection)
    made = weakref.ref(document.history.undone)
    assert made() is not None
    del document
    gc.collect()
    assert made() is None


def test_large_selections_are_kept_as_far_as_they_fit(monkeypatch) -> None:
    monkeypatch.setattr(selection_memory, "_MOST_BYTES", 1000)
    document, selection = drawn(40), Selection()
    memory = SelectionMemory(selection)
    for k in range(20):
        step(memory, document, np.arange(k, k + 20), selection)
    steps = [s for s in document.history.steps if s in memory._kept]
    assert 1 < len(steps) < 20
    assert steps[-1] is document.history.undone
