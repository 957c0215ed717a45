"""Steps from before a journal that are undone and redone with it are followed in their order.

A redone step from before was taken for the journal's own and refused; a count of steps that did not
fit was believed, and undoing everything ended in `IndexError` then.
"""

from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.files.native.drawing_file import drawing_of, members_of
from stippler.files.native.edit_log import EditLog, replay
from stippler.files.read.picture import picture_of_bytes
from tests.fuzz import readers

CASE = Path(__file__).parents[1] / "fuzz" / "corpus" / "replay" / "counted-wrongly"
ACTS = st.lists(st.sampled_from(["add", "move", "undo", "undo", "redo"]), max_size=14)


def test_a_count_that_does_not_fit_is_not_believed() -> None:
    readers.read("replay", CASE.read_bytes())


def _act(document: Document, act: str, k: int) -> None:
    if act == "undo":
        document.undo()
    elif act == "redo":
        document.redo()
    else:
        document.begin(f"{act} {k}")
        if act == "add" or not len(document.dots):
            document.insert(Dots.round(np.array([[k % 20 + 1.0, 3.0]]), 0.2))
        else:
            document.move(np.array([0]), document.dots.position_mm[:1] + 0.3)
        document.commit()


def _same(one: Document, other: Document) -> bool:
    return one.dots.id.tolist() == other.dots.id.tolist() and np.array_equal(
        one.dots.position_mm, other.dots.position_mm
    )


@settings(deadline=None, max_examples=60)
@given(ACTS, ACTS)
def test_any_doing_and_undoing_over_the_beginning_is_followed(before, after) -> None:
    document, made = Document(Drawing.blank(Page(40.0, 30.0))), []
    for k, act in enumerate(before):
        _act(document, act, k)
    members = members_of(document.drawing)
    document.follow(EditLog(made.append, document).take)
    for k, act in enumerate(after):
        _act(document, act, 20 + k)
        again = Document(drawing_of(members, picture_of_bytes, "here")[0])
        assert replay(again, [make() for make in made], picture_of_bytes) == (len(made), "")
        assert _same(again, document)
    if not after:
        return
    labels = [step.label for step in document.history.steps]
    assert [step.label for step in again.history.steps] == labels[-len(again.history.steps) :] or (
        not again.history.steps
    )
    while again.undo():
        assert document.undo()
        assert _same(again, document)
    while again.redo():
        assert document.redo()
        assert _same(again, document)
