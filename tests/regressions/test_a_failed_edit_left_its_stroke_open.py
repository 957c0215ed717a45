"""An edit that was refused half way left its stroke open: every edit after it failed.

"ValueError: a stroke has begun already", found by random input.
"""

import numpy as np
import pytest

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.one_step import as_one_step
from stippler.errors import GeometryError


@pytest.fixture
def document() -> Document:
    drawing = Drawing.blank(Page(50, 50))
    drawing.dots = Dots.round(np.array([[10.0, 10.0], [30.0, 30.0]]), 0.5)
    return Document(drawing)


def test_what_a_refused_edit_has_done_is_taken_back(document):
    before = document.dots.copy()

    def act(document: Document) -> None:
        document.remove(np.array([0]))
        raise GeometryError("refused half way")

    with pytest.raises(GeometryError):
        as_one_step(document, "Odd", act)
    assert not document.in_stroke
    assert np.array_equal(document.dots.position_mm, before.position_mm)
    assert not document.history.steps
    edit = as_one_step(document, "Even", lambda d: d.remove(np.array([0])))
    assert not edit.is_empty
    assert [step.label for step in document.history.steps] == ["Even"]
