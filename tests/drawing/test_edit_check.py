"""Edits that do not fit are refused before anything changes; those that were made here all fit."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.document import Document
from stippler.drawing.dot_edit import Change, DotEdit, DotRows, Shift
from stippler.drawing.dots import Dots
from stippler.drawing.edit import Edit
from stippler.drawing.edit_check import check_edit
from stippler.drawing.style import Style
from stippler.errors import StipplerError
from tests.corpus.contents import CONTENTS


def document():
    return Document(CONTENTS["lines"]())


def random_edit(doc, rng):
    doc.begin("Random")
    for _ in range(rng.integers(1, 4)):
        n = len(doc.dots)
        rows = np.sort(rng.choice(n, min(n, 4), replace=False))
        match rng.integers(5):
            case 0:
                doc.move(rows, doc.dots.position_mm[rows] + 0.1)
            case 1:
                doc.remove(rows[:2])
            case 2:
                doc.insert(Dots.round(1 + rng.random((3, 2)) * 20, 0.2))
            case 3:
                doc.change("radius_mm", rows, doc.dots.radius_mm[rows] * np.float32(1.5))
            case 4:
                doc.set("style", 0, Style(n_dots=int(rng.integers(1, 99))))
    return doc.commit()


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_what_is_made_here_fits_forth_and_back(seed):
    rng, doc = np.random.default_rng(seed), document()
    other = Document(doc.drawing.snapshot())
    edits = []
    for _ in range(6):
        edits.append(random_edit(doc, rng))
        check_edit(edits[-1], other)
        other._apply(edits[-1])
    for edit in reversed(edits):
        check_edit(edit.inverse(), other)
        other._apply(edit.inverse())
    assert np.array_equal(other.dots.position_mm, document().dots.position_mm)


def placed(doc, rows, **changes):
    dots = doc.dots.take(np.array(rows))
    for name, value in changes.items():
        getattr(dots, name)[:] = value
    return DotRows(dots, np.array(rows, np.int64))


def new(doc, rows, **changes):
    made = placed(doc, [0] * len(rows), **{"id": 500 + np.arange(len(rows)), **changes})
    return DotRows(made.dots, np.array(rows, np.int64))


def moved(doc, rows, after, name="position_mm", ids=None):
    values = getattr(doc.dots, name)[rows]
    fresh = np.array(np.broadcast_to(np.asarray(after, values.dtype), values.shape))
    return {name: Change(doc.dots.id[rows] if ids is None else ids, values, fresh)}


def edit_of(changes=None, removed=None, inserted=None, shifted=None, values=None, next_id=None):
    dots = DotEdit(
        changes or {},
        removed or DotRows.none(),
        inserted or DotRows.none(),
        shifted or Shift.none(),
    )
    return Edit("Bad", dots, values or {}, next_id or {})


def shift(doc, before, after, ids=None):
    before = np.array(before, np.int64)
    ids = doc.dots.id[before] if ids is None else ids
    return Shift(ids, before, np.array(after, np.int64))


N = 24
FITTING = {
    "move": lambda d: edit_of(moved(d, [0, 1], 3.0)),
    "insert at the end": lambda d: edit_of(inserted=new(d, [N, N + 1])),
    "remove the last": lambda d: edit_of(removed=placed(d, [N - 1])),
    "remove, and the last moves up": lambda d: edit_of(
        removed=placed(d, [2]), shifted=shift(d, [N - 1], [2])
    ),
    "replace": lambda d: edit_of(removed=placed(d, [2]), inserted=new(d, [2])),
    "no curve": lambda d: edit_of(moved(d, [5], -1, "curve")),
    "next id": lambda d: edit_of(next_id={"dot": 999, "area": 3}),
    "line goes with its dots": lambda d: edit_of(
        {**moved(d, [0, 1, 2], -1, "curve"), **moved(d, [0, 1, 2], 0, "constraint")},
        values={"line": {2: (d.drawing.lines[2], None)}},
    ),
}
WRONG = {
    "not a number": lambda d: edit_of(moved(d, [0], np.nan)),
    "far away": lambda d: edit_of(moved(d, [0], 1e9)),
    "no size": lambda d: edit_of(moved(d, [0], 0.0, "radius_mm")),
    "too long": lambda d: edit_of(moved(d, [0], 9.0, "elongation")),
    "too rough": lambda d: edit_of(moved(d, [0], -0.1, "roughness")),
    "no angle": lambda d: edit_of(moved(d, [0], np.inf, "angle_rad")),
    "no constraint": lambda d: edit_of(moved(d, [0], 3, "constraint")),
    "no place along": lambda d: edit_of(moved(d, [0], np.nan, "parameter")),
    "bad before": lambda d: edit_of(
        {"radius_mm": Change(d.dots.id[:1], np.zeros(1, np.float32), np.ones(1, np.float32))}
    ),
    "kind of numbers": lambda d: edit_of(
        {"radius_mm": Change(d.dots.id[:1], np.ones(1), np.ones(1))}
    ),
    "shape": lambda d: edit_of({"position_mm": Change(d.dots.id[:1], np.ones(1), np.ones((1, 2)))}),
    "lengths": lambda d: edit_of(
        {"radius_mm": Change(d.dots.id[:2], *[np.ones(1, np.float32)] * 2)}
    ),
    "ids change": lambda d: edit_of(moved(d, [0], 700, "id")),
    "unknown field": lambda d: edit_of({"scent": Change(d.dots.id[:1], *[np.ones(1)] * 2)}),
    "changes what comes": lambda d: edit_of(
        moved(d, [0], 2.0, ids=np.array([500])), inserted=new(d, [N])
    ),
    "who is not there": lambda d: edit_of(moved(d, [0], 2.0, ids=np.array([9999]))),
    "twice": lambda d: edit_of(moved(d, [0, 0], 2.0)),
    "negative id": lambda d: edit_of(moved(d, [0], 2.0, ids=np.array([-1]))),
    "changes what goes": lambda d: edit_of(moved(d, [N - 1], 2.0), removed=placed(d, [N - 1])),
    "removed from elsewhere": lambda d: edit_of(
        removed=DotRows(placed(d, [2]).dots, np.array([N - 1]))
    ),
    "removed, who is not there": lambda d: edit_of(removed=placed(d, [N - 1], id=9999)),
    "removed twice": lambda d: edit_of(
        removed=DotRows(d.dots.take(np.array([N - 1, N - 1])), np.array([N - 1, N - 1]))
    ),
    "a gap is left": lambda d: edit_of(removed=placed(d, [2])),
    "rows of floats": lambda d: edit_of(
        removed=DotRows(placed(d, [N - 1]).dots, np.array([N - 1.0]))
    ),
    "more rows than dots": lambda d: edit_of(
        removed=DotRows(placed(d, [N - 1]).dots, np.array([N - 2, N - 1]))
    ),
    "inserted into a taken row": lambda d: edit_of(inserted=new(d, [2])),
    "inserted beyond the end": lambda d: edit_of(inserted=new(d, [N + 1])),
    "inserted before the beginning": lambda d: edit_of(inserted=new(d, [-1])),
    "inserted twice": lambda d: edit_of(inserted=new(d, [N, N + 1], id=500)),
    "inserted, who is there": lambda d: edit_of(inserted=new(d, [N], id=d.dots.id[3])),
    "inserted without size": lambda d: edit_of(inserted=new(d, [N], radius_mm=-1)),
    "inserted into no area": lambda d: edit_of(inserted=new(d, [N], area=7)),
    "inserted on no line": lambda d: edit_of(inserted=new(d, [N], curve=7)),
    "into no area": lambda d: edit_of(moved(d, [0], 7, "area")),
    "onto no line": lambda d: edit_of(moved(d, [0], 7, "curve")),
    "shift of nobody": lambda d: edit_of(
        removed=placed(d, [2]), shifted=shift(d, [N - 1], [2], np.array([9999]))
    ),
    "shift from elsewhere": lambda d: edit_of(
        removed=placed(d, [2]), shifted=shift(d, [N - 2], [2], d.dots.id[N - 1 :])
    ),
    "shift onto another": lambda d: edit_of(removed=placed(d, [2]), shifted=shift(d, [N - 1], [3])),
    "shift beyond": lambda d: edit_of(removed=placed(d, [2]), shifted=shift(d, [N - 1], [N + 9])),
    "shift of other length": lambda d: edit_of(
        removed=placed(d, [2]), shifted=replace(shift(d, [N - 1], [2]), after=np.array([2, 3]))
    ),
    "no page": lambda d: edit_of(values={"page": {0: (d.drawing.page, None)}}),
    "two pages": lambda d: edit_of(values={"page": {1: (None, d.drawing.page)}}),
    "unknown kind": lambda d: edit_of(values={"scent": {1: (None, Style())}}),
    "id of a value": lambda d: edit_of(values={"style": {-1: (None, Style())}}),
    "large id of a value": lambda d: edit_of(values={"style": {10**9: (None, Style())}}),
    "value that was not there": lambda d: edit_of(values={"style": {5: (Style(), None)}}),
    "value that was there": lambda d: edit_of(values={"style": {0: (None, Style())}}),
    "page's area": lambda d: edit_of(values={"area": {0: (d.drawing.areas[0], None)}}),
    "area without style": lambda d: edit_of(
        values={"area": {3: (None, replace(d.drawing.areas[0], style=4))}}
    ),
    "style in use": lambda d: edit_of(values={"style": {0: (Style(), None)}}),
    "line in use": lambda d: edit_of(values={"line": {2: (d.drawing.lines[2], None)}}),
    "next id below 0": lambda d: edit_of(next_id={"dot": -1}),
    "next id too large": lambda d: edit_of(next_id={"area": 2**53}),
    "next id of nothing": lambda d: edit_of(next_id={"scent": 1}),
}


@pytest.mark.parametrize("name", FITTING)
def test_what_fits_is_let_through(name):
    doc = document()
    edit = FITTING[name](doc)
    check_edit(edit, doc)
    doc._apply(edit)
    check_edit(edit.inverse(), doc)
    assert np.array_equal(doc.rows(doc.dots.id), np.arange(len(doc.dots)))


@pytest.mark.parametrize("name", WRONG)
def test_what_does_not_fit_is_refused(name):
    doc = document()
    with pytest.raises(ValueError, match=r"."):
        check_edit(WRONG[name](doc), doc)


ODD = (-1, 0, 1, 2, 7, 2**31, 2**53, np.nan, np.inf)


def damaged(arrays, rng):
    """Change a value, a length, an order or a type of one array."""
    names = sorted(name for name in arrays if name != "values" and len(arrays[name]))
    name = names[rng.integers(len(names))]
    values = arrays[name].copy()
    match rng.integers(4):
        case 0:
            with np.errstate(all="ignore"):
                values.reshape(-1)[rng.integers(values.size)] = np.array(
                    ODD[rng.integers(len(ODD))]
                ).astype(values.dtype)
        case 1:
            values = values[: rng.integers(len(values))]
        case 2:
            values = values[rng.permutation(len(values))]
        case 3:
            values = values.astype(np.float32 if values.dtype != np.float32 else np.int16)
    return {**arrays, name: values}


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1))
@pytest.mark.filterwarnings("ignore:invalid value encountered in cast")
def test_a_damaged_edit_is_refused_or_leaves_a_whole_drawing(seed):
    rng, doc = np.random.default_rng(seed), document()
    other = Document(doc.drawing.snapshot())
    edit = random_edit(doc, rng)
    before = other.dots.copy()
    arrays = dict(edit.arrays())
    if not any(name != "values" and len(values) for name, values in arrays.items()):
        return
    try:
        bad = Edit.from_arrays(damaged(arrays, rng), {})
        check_edit(bad, other)
    except (ValueError, KeyError, TypeError, IndexError, StipplerError):
        assert np.array_equal(other.dots.id, before.id)
        assert other.dots.position_mm.tobytes() == before.position_mm.tobytes()
        return
    for one in (bad, bad.inverse()):
        check_edit(one, other)
        other._apply(one)
        dots = other.dots
        assert len(np.unique(dots.id)) == len(dots)
        assert np.array_equal(other.rows(dots.id), np.arange(len(dots)))
        assert np.isin(dots.area, list(other.drawing.areas)).all()
        assert np.isfinite(dots.position_mm).all()
        assert (dots.radius_mm > 0).all()
