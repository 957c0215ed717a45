"""Rows by id against a dictionary, whatever the ids."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.ids import MAX_ID, IdTable
from tests.conftest import EXAMPLES

BASE = st.integers(0, 50)
ID = st.one_of(st.integers(0, 300), st.integers(0, MAX_ID), BASE.map(lambda k: k << 40))
BATCH = st.lists(st.tuples(ID, st.integers(-1, 1000)), min_size=1, max_size=80)


@settings(max_examples=100 * EXAMPLES)
@given(st.lists(BATCH, min_size=1, max_size=6), st.lists(ID, min_size=1))
def test_rows_are_those_that_were_put_last(batches, others):
    table, known = IdTable(), {}
    for batch in batches:
        ids, rows = (np.array(column, np.int64) for column in zip(*batch, strict=True))
        table.put(ids, rows)
        known.update(batch)
    asked = np.array([*known, *others, -5], np.int64)
    assert table.find(asked).tolist() == [known.get(i, -1) for i in asked.tolist()]


def test_memory_follows_the_number_of_dots_and_not_their_ids():
    drawing = Drawing.blank(Page(10, 10))
    drawing.dots = Dots.round([[1, 1]], 0.2, first_id=300_000_000)
    document = Document(drawing)
    assert document.n_bytes < 300_000
    assert document.rows(np.array([300_000_000, 0, 299_999_999])).tolist() == [0, -1, -1]


def test_an_id_is_never_given_twice_though_the_drawing_was_put_away():
    drawing = Drawing.blank(Page(10, 10))
    drawing.dots = Dots.round([(1, 1), (2, 2)], 0.2)
    document = Document(drawing)
    document.begin("remove")
    document.remove(np.array([1]))
    document.commit()
    again = Document(drawing.snapshot())
    again.begin("insert")
    rows = again.insert(Dots.round([(5, 5)], 0.2))
    assert again.dots.id[rows].tolist() == [2]
