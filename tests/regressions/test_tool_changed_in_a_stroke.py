"""A tool that was changed while a stroke was held left the stroke open, and no other could begin."""

import numpy as np

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor.events import LEFT, Moved, Pressed, Released
from stippler.editor.tools.toolbox import Toolbox


def test_the_stroke_is_taken_back_and_another_begins(tmp_path):
    drawing = Drawing.blank(Page(100.0, 100.0))
    drawing.dots = Dots.round(np.array([[10.0, 10.0], [60.0, 60.0]]), 0.5)
    document = Document(drawing)
    box = Toolbox(tmp_path / "brushes.json", lambda text, grade: None)

    def take(event):
        return box.take(event, document, lambda x, y: (x, y), 1.0)

    box.choose("erase")
    assert take(Pressed(LEFT, 10.0, 10.0, 0.0))
    assert take(Moved(12.0, 10.0, 0.1)) is False
    assert document.in_stroke
    assert len(document.dots) == 1
    box.choose("select")
    assert not document.in_stroke
    assert len(document.dots) == 2
    box.choose("erase")
    take(Pressed(LEFT, 60.0, 60.0, 1.0))
    take(Released(LEFT, 60.0, 60.0, 1.1))
    assert document.history.n_done == 1
    np.testing.assert_array_equal(document.dots.position_mm, [[10.0, 10.0]])
