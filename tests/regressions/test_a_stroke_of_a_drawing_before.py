"""A stroke that ends after another drawing was opened went into that one's journal."""

import numpy as np

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor.keeping import Keeping
from stippler.editor.messages import Messages
from stippler.files.native.edit_log import EditLog


def document_of(n: int) -> Document:
    drawing = Drawing.blank(Page(50, 50))
    drawing.dots = Dots.round(np.random.default_rng(n).uniform(0, 50, (n, 2)), 0.5)
    return Document(drawing)


def test_only_the_open_drawing_is_kept(tmp_path, monkeypatch):
    keeping, taken = Keeping(tmp_path, Messages()), []
    before, now = document_of(5), document_of(7)
    keeping.open(before, "before")
    before.begin("Erase")
    before.remove(np.arange(2))
    keeping.open(now, "now")
    monkeypatch.setattr(EditLog, "take", lambda _, entry: taken.append(entry.edit.label))
    before.commit()
    now.begin("Thin")
    now.remove(np.arange(3))
    now.commit()
    keeping.close()
    assert taken == ["Thin"]
