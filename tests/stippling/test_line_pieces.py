"""Pieces of lines within polygons, and dots spread along them, against shapely and Lloyd."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.line import Line
from stippler.drawing.line_index import LineIndex
from stippler.drawing.planar.moves import smooth_path
from stippler.drawing.planar.path import Path
from stippler.stippling.line_pieces import Measure, Pieces, evened

seeds = st.integers(0, 9999)


def curves(rng, n):
    found = []
    for k in range(n):
        at = rng.random(2) * 40 + np.cumsum(rng.normal(0, 6, (6, 2)), axis=0)
        found.append(Line(f"curve {k}", smooth_path(Path.polyline(at, closed=k % 2 == 1))))
    return found


def holed(rng):
    whole = shapely.box(2, 2, 38, 30)
    return whole.difference(shapely.Point(*rng.uniform(8, 30, 2)).buffer(rng.uniform(1, 6)))


@given(seeds)
@settings(max_examples=25, deadline=None)
def test_pieces_are_what_shapely_cuts(seed):
    rng = np.random.default_rng(seed)
    lines, part = curves(rng, 4), holed(rng)
    pieces = Pieces.within(lines, [part])
    for k, line in enumerate(lines):
        inside = shapely.intersection(shapely.linestrings(line.path.points_mm), part)
        mine = pieces.line == k
        assert pieces.length[mine].sum() == pytest.approx(inside.length, abs=0.01)
    if len(pieces):
        piece = np.repeat(np.arange(len(pieces)), 20)
        u = np.tile((np.arange(20) + 0.5) / 20, len(pieces)) * pieces.length[piece]
        along = pieces.along(piece, u)
        at = LineIndex(lines, 0.0).at(pieces.line[piece], along)
        assert shapely.distance(part, shapely.points(at)).max() < 1e-6
        again, place = pieces.find(pieces.line[piece], along)
        assert np.array_equal(again, piece)
        assert np.allclose(place, u, atol=1e-6)


def test_a_ring_that_leaves_the_page_is_one_piece_across_its_start():
    t = np.linspace(0, 2 * np.pi, 200)[:-1]
    ring = np.column_stack([20 + 10 * np.cos(t), 15 + 10 * np.sin(t)])
    line = Line("ring", Path.polyline(ring, closed=True))
    whole = Pieces.within([line], [shapely.box(0, 0, 40, 30)])
    assert whole.is_ring.tolist() == [True]
    cut = Pieces.within([line], [shapely.box(12, 0, 40, 30)])  # its start, at the right, is inside
    assert len(cut) == 1
    assert not cut.is_ring[0]
    assert cut.begin[0] + cut.length[0] > line.length_mm


def test_polygons_that_all_but_touch_do_not_cut_a_line():
    parts = [shapely.box(0, 0, 10, 9), shapely.box(10.00002, 0, 20, 9), shapely.box(21, 0, 30, 9)]
    line = Line("across", Path.polyline([(1, 5), (29, 5)]))
    assert np.allclose(Pieces.within([line], parts).length, [19, 8], atol=1e-4)


def lloyd(m, still, whole, ring, steps=4000):
    """Move each dot to the middle of its cell, again and again: what `evened` finds at once."""
    m = np.sort(m)
    for _ in range(steps):
        if ring:
            low, high = np.r_[m[-1] - whole, m[:-1]], np.r_[m[1:], m[0] + whole]
            goal = (low + high) / 4 + m / 2
        else:
            edges = np.r_[0.0, (m[1:] + m[:-1]) / 2, whole]
            goal = (edges[1:] + edges[:-1]) / 2
        m = np.where(still, m, goal)
    return m


@given(seeds, st.booleans(), st.integers(2, 9))
@settings(max_examples=30, deadline=None)
def test_dots_come_to_lie_where_lloyds_steps_end(seed, ring, n):
    rng = np.random.default_rng(seed)
    m, still = np.sort(rng.random(n)) * 10.0, rng.random(n) < 0.3
    if ring and not still.any():
        still[0] = True
    piece = np.zeros(n, np.int64)
    found = evened(piece, m, still, np.array([10.0]), np.array([ring]))
    true = lloyd(m, still, 10.0, ring)
    off = np.abs((found - true + 5.0) % 10.0 - 5.0)
    assert off.max() < 1e-4
    assert np.array_equal(found[still], m[still])


@given(seeds)
@settings(max_examples=20, deadline=None)
def test_pieces_do_not_disturb_one_another(seed):
    rng = np.random.default_rng(seed)
    whole, ring = rng.uniform(1, 30, 5), rng.random(5) < 0.5
    piece = rng.integers(0, 5, 40)
    m, still = rng.random(40) * whole[piece], rng.random(40) < 0.2
    found = evened(piece, m, still, whole, ring)
    for k in range(5):
        mine = piece == k
        alone = evened(np.zeros(mine.sum(), np.int64), m[mine], still[mine], whole[k : k + 1],
                       ring[k : k + 1])  # fmt: skip
        assert np.allclose(found[mine], alone, atol=1e-9)


def test_the_measure_is_the_tones_integral():
    lines = [
        Line("a", Path.polyline([(0, 0), (10, 0)])),
        Line("b", Path.polyline([(0, 5), (4, 5)])),
    ]
    pieces = Pieces.within(lines, [shapely.box(-1, -1, 20, 20)])
    measure = Measure(pieces, LineIndex(lines, 0.0).at, np.array([500, 500]), lambda p: p[:, 0])
    piece, u = np.array([0, 0, 1]), np.array([10.0, 5.0, 4.0])
    assert np.allclose(measure.mass(piece, u), [50, 12.5, 8], rtol=1e-3)
    assert np.allclose(measure.place(piece, measure.mass(piece, u)), u)
