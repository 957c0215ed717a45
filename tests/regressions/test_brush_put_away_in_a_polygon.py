"""Putting the brush away with a polygon half drawn left the keyboard dead.

And the press on the button that did it had become one more corner, under the panel.
"""

import numpy as np

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor.events import LEFT, KeyDown, Pressed
from stippler.editor.tools.toolbox import Toolbox


def test_nothing_is_held_any_more(tmp_path):
    drawing = Drawing.blank(Page(100.0, 100.0))
    drawing.dots = Dots.round(np.array([[10.0, 10.0]]), 0.5)
    document = Document(drawing)
    box = Toolbox(tmp_path / "brushes.json", lambda text, grade: None)
    box.choose("select")
    box.tool.set("how", "polygon")
    for x in (10.0, 50.0):
        box.take(Pressed(LEFT, x, 10.0, x), document, lambda x, y: (x, y), 1.0)
    assert len(box.state.overlay.paths[0].points_mm) == 3
    box.choose("")
    assert not box.is_busy
    escape = KeyDown("escape")
    assert not box.take(escape, document, lambda x, y: (x, y), 1.0)
