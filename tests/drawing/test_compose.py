"""Edits joined by `then` against the edits done one after the other, over few dots."""

from dataclasses import fields

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.document import Document
from stippler.drawing.dot_edit import FIELDS
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.edit import Edit
from stippler.drawing.style import Style
from tests.conftest import EXAMPLES

NAMES = [f.name for f in fields(Dots)]
ROW = st.integers(0, 7)
ACTS = st.one_of(
    st.tuples(st.just("insert"), st.integers(1, 3), st.integers(0, 9)),
    st.tuples(st.just("remove"), st.lists(ROW, min_size=1, max_size=4), st.just(0)),
    st.tuples(st.just("move"), st.lists(ROW, min_size=1, max_size=4), st.integers(0, 9)),
    st.tuples(st.just("size"), st.lists(ROW, min_size=1, max_size=4), st.integers(1, 3)),
    st.tuples(st.just("style"), st.integers(0, 2), st.integers(0, 3)),
    st.tuples(st.just("undo"), st.just(0), st.just(0)),
)
STROKES = st.lists(st.lists(ACTS, min_size=1, max_size=4), min_size=2, max_size=5)


def act(document, what, which, value):
    n = len(document.dots)
    if what == "insert":
        document.insert(Dots.round(np.full((which, 2), value + 0.5), 0.2))
    elif what == "style":
        document.set("style", which, Style(n_dots=value) if value else None)
    elif what != "undo":
        rows = np.unique([row for row in which if row < n]).astype(np.int64)
        if what == "remove":
            document.remove(rows)
        elif what == "move":
            document.change("position_mm", rows, np.full((len(rows), 2), float(value)))
        else:
            document.change("radius_mm", rows, np.full(len(rows), value, np.float32))


def drawn():
    drawing = Drawing.blank(Page(10, 10))
    drawing.dots = Dots.round([(k, k) for k in range(5)], 0.2)
    return drawing


def state(document):
    dots = document.dots
    return [getattr(dots, name).tolist() for name in NAMES], dict(document.drawing.styles)


def check(edit, start, end):
    """An edit leads from one state to another and back, to the row."""
    start._apply(edit)
    assert state(start) == state(end)
    assert np.array_equal(start.rows(end.dots.id), np.arange(len(end.dots)))
    start._apply(edit.inverse())


@settings(max_examples=300 * EXAMPLES)
@given(STROKES, st.data())
def test_edits_joined_do_what_they_do_in_turn(strokes, data):
    document, edits, states = Document(drawn()), [], []
    for acts in strokes:
        states.append(document.drawing.snapshot())
        if acts[0][0] == "undo" and edits:
            edits.append(edits[-1].inverse())
            document._apply(edits[-1])
            continue
        document.begin("stroke")
        for one in acts:
            act(document, *one)
        edits.append(document.commit())
    first = data.draw(st.integers(0, len(edits) - 2))
    cut = data.draw(st.integers(first + 1, len(edits) - 1))
    begin = states[first]
    left, right = Edit(""), Edit("")
    for edit in edits[first:cut]:
        left = left.then(edit)
    for edit in edits[cut:]:
        right = right.then(edit)
    both = left.then(right)
    start = Document(begin)
    before = state(start)
    check(both, start, document)
    assert state(start) == before
    check(Edit.from_arrays(dict(both.arrays())), start, document)
    assert both.is_empty == (before == state(document))
    for name, change in both.dots.changes.items():
        assert name in FIELDS
        assert len(np.unique(change.ids)) == len(change.ids)
        there = np.isin(change.ids, document.dots.id) & np.isin(change.ids, start.dots.id)
        assert there.all()
