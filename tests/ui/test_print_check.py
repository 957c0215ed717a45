"""Faults are shown one after the other, and repaired as one step that can be undone."""

from types import SimpleNamespace

import numpy as np
import pytest

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor.messages import Messages
from stippler.editor.print_check import PrintCheck


class Painting:
    """What the check needs of the editor's."""

    def __init__(self, document: Document) -> None:
        self.document, self.chosen = document, None
        self.toolbox = SimpleNamespace(selection=SimpleNamespace(choose=self._choose))

    def _choose(self, ids, mods) -> None:
        self.chosen = ids.tolist()

    def act(self, label, act) -> None:
        self.document.begin(label)
        act(self.document)
        self.document.commit()


@pytest.fixture
def parts():
    one = Drawing.blank(Page(40, 30))
    one.dots = Dots.round(
        [(5, 5), (6.02, 5), (20, 20), (12, 12), (-9, 3)], [0.5, 0.5, 0.5, 0.02, 0.5]
    )
    document = Document(one)
    shown = []
    view = SimpleNamespace(show_box=lambda low, high: shown.append((low, high)))
    session = SimpleNamespace(document=document, messages=Messages())
    painting = Painting(document)
    return PrintCheck(session, painting, view), painting, document, session, shown


def test_faults_are_shown_in_turn(parts):
    check, painting, _, session, shown = parts
    chosen = []
    for _ in range(4):
        check.show_next()
        chosen.append(painting.chosen)
    assert chosen == [[3], [4], [0, 1], [3]]
    assert session.messages.log[-1].text.startswith("1 of 3")
    (left, top), (right, bottom) = shown[2]
    assert left < 5 < 6.02 < right
    assert top < 5 < bottom


def test_a_repair_is_one_step_and_can_be_undone(parts):
    check, _, document, session, _ = parts
    before = document.dots.copy()
    check.repair()
    assert session.messages.log[-1].text.startswith("3 faults for print, 0 after")
    assert len(document.dots) == 3
    assert document.history.n_done == 1
    assert document.undo()
    np.testing.assert_array_equal(document.dots.position_mm, before.position_mm)
    np.testing.assert_array_equal(document.dots.radius_mm, before.radius_mm)
    np.testing.assert_array_equal(document.dots.id, before.id)
    check.show_next()
    assert session.messages.log[-1].text.startswith("1 of 3")


def test_pairs_that_grow_together_are_shown_too(parts):
    from stippler.files.checks import Process

    check, painting, *_ = parts
    check.process = Process(least_dot_mm=0.0, least_gap_mm=0.0, gain_mm=0.02)
    chosen = []
    for _ in range(2):
        check.show_next()
        chosen.append(painting.chosen)
    assert chosen == [[4], [0, 1]]
