"""Grids of dots and border edges."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Polygon, box

from stippler.kernels.cells.grid import sort_by_grid_cell
from stippler.kernels.machine import pool
from stippler.stippling.compartments import Compartments
from stippler.stippling.dotgrid import DotGrid


@given(st.lists(st.integers(0, 30), max_size=200))
def test_sorting_is_stable_and_starts_fit(cells):
    cells = np.array(cells, np.int32)
    start, order = np.empty(32, np.int32), np.empty(len(cells), np.int32)
    sort_by_grid_cell(cells, start, order)
    np.testing.assert_array_equal(order, np.argsort(cells, kind="stable"))
    np.testing.assert_array_equal(start, np.searchsorted(np.sort(cells), np.arange(32)))


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6), n_dots=st.integers(1, 150))
def test_every_edge_is_listed_wherever_it_touches(seed, n_dots):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(9)) * 2 * np.pi + np.arange(9) * 1e-3
    radius = rng.uniform(0.2, 3.0, 9)
    shape = Polygon(np.c_[radius * np.cos(angle), radius * np.sin(angle)])
    if not shape.is_valid:
        shape = Polygon([(0, 0), (3, 1), (0.5, 2)])
    parts = Compartments.of(shape)
    grid = DotGrid.over(parts, np.array([n_dots]))
    border = grid.border
    x0, y0, h = grid.real[0, :3]
    nx, ny = grid.whole[0, :2]
    touched = np.zeros((ny, nx), bool)
    for e, (ax, ay, bx, by) in enumerate(parts.edges):
        line = LineString([(ax, ay), (bx, by)])
        for k in range(nx * ny):
            j, i = divmod(k, nx)
            cell = box(x0 + i * h, y0 + j * h, x0 + (i + 1) * h, y0 + (j + 1) * h)
            listed = e in border.edge_of_slot[border.cell_start[k] : border.cell_start[k + 1]]
            touched[j, i] |= listed
            if line.intersects(cell):
                assert listed
    for j, i in np.ndindex(ny, nx):
        rings = np.array([max(abs(j - b), abs(i - a)) for b, a in np.argwhere(touched)])
        assert border.clear[j * nx + i] == rings.min()


def test_a_rectangle_is_its_box():
    parts = Compartments.of([box(0, 0, 2, 1), Polygon([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0.5)])])
    assert parts.kind.tolist() == [0, 0]
    sides = [(0, 0, 1, 0), (1, 0, 1, 1), (1, 1, 0, 1), (0, 1, 0, 0)]
    np.testing.assert_array_equal(parts.edges[4:], sides)
    np.testing.assert_array_equal(parts.next_edge, [1, 2, 3, 0, 5, 6, 7, 4])
    assert len(DotGrid.over(parts, np.array([9, 9])).border.edge_of_slot) == 0
    cut = Polygon([(0, 0), (2, 0), (2, 1), (1, 1), (0, 0.5)])
    assert Compartments.of(cut).kind.tolist() == [1]


def test_borders_run_with_the_inside_on_their_left():
    shape = box(0, 0, 4, 4).difference(box(1, 1, 2, 2))
    for given_ in (shape, shapely.reverse(shape)):
        edges = Compartments.of(given_).edges
        a, b = edges[:, :2], edges[:, 2:]
        left = (a + b) / 2 + 1e-3 * (b - a)[:, ::-1] * [-1, 1]
        assert shapely.contains_xy(shape, *left.T).all()


def test_a_cancelled_range_run_says_so():
    done = []
    assert pool.parallel_for(lambda a, b: done.append((a, b)), 1000, grain=10, cancel=lambda: False)
    assert sorted(done) == [(k, k + 10) for k in range(0, 1000, 10)]
    done.clear()
    assert not pool.parallel_for(
        lambda a, b: done.append(a), 1000, grain=10, cancel=lambda: len(done) >= 7
    )
    assert 7 <= len(done) <= 7 + pool.n_threads()
