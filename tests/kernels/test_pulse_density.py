import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Point, Polygon

from stippler.kernels.halftone.grow_regions import USED, diffuse, fill_cells, grow
from stippler.kernels.halftone.scan_order import (
    FRONT_STEP,
    along_front,
    chamfer,
    order_by_distance,
    outside_polygon,
)
from stippler.stippling.halftone import growth_orders


def field(seed, h, w, white):
    rng = np.random.default_rng(seed)
    charge = rng.random((h, w)).astype(np.float32) * 0.2
    charge[rng.random((h, w)) < white] = 0.0
    return charge


def grown(charge, order=None, stops=(), chance=1, reach=40):
    work = charge.copy()
    order = np.arange(charge.size, dtype=np.int32) if order is None else order
    n_max = int(charge.sum()) + 16
    points, areas, cursor = np.empty((n_max, 2)), np.empty(n_max, np.float32), np.zeros(2)
    dy, dx = growth_orders("circular", reach)
    for seeds in np.split(order, stops):
        n = grow(work, seeds, cursor, dy, dx, chance, points, areas, n_max)
    return points[:n], areas[:n], work, cursor[1]


@settings(max_examples=40)
@given(
    st.integers(0, 10**6), st.integers(1, 60), st.integers(1, 60), st.sampled_from([0, 0.3, 0.9])
)
def test_every_bit_of_charge_is_in_one_region(seed, h, w, white):
    charge = field(seed, h, w, white)
    points, areas, rest, left = grown(charge)
    total = charge.sum(dtype=np.float64)
    assert np.isclose(len(points) + left + rest[rest > 0].sum(), total, atol=2e-5 * total + 1e-6)
    assert len(points) >= int(total - 1e-3) - 1
    assert (rest[charge == 0] == 0).all()
    assert np.isin(rest[charge > 0], USED).all() or (rest[charge > 0] <= charge[charge > 0]).all()
    assert areas.sum() <= np.count_nonzero(charge) + 1e-3 * len(areas)


@settings(max_examples=40)
@given(st.integers(0, 10**6), st.sampled_from([0.2, 0.8, 0.97]))
def test_no_dot_stands_on_white(seed, white):
    charge = field(seed, 50, 50, white) * 5
    points, *_ = grown(charge)
    assert (charge[points[:, 1].astype(int), points[:, 0].astype(int)] > 0).all()


@given(st.integers(0, 10**6), st.lists(st.integers(0, 1600), max_size=5))
def test_growing_piecewise_changes_nothing(seed, stops):
    charge = field(seed, 40, 40, 0.1)
    once, areas, rest, _ = grown(charge)
    again, areas2, rest2, _ = grown(charge, stops=tuple(sorted(stops)))
    assert np.array_equal(once, again)
    assert np.array_equal(areas, areas2)
    assert np.array_equal(rest, rest2)


def test_chance_changes_the_dots_but_not_their_number():
    charge = np.full((80, 80), 0.07, np.float32)
    a, b = grown(charge, chance=1)[0], grown(charge, chance=2)[0]
    assert len(a) == len(b)
    assert not np.array_equal(a, b)


def test_cells_share_a_pixel_evenly():
    density = np.array([[1.0, 0.0], [4.0, 9.0]], np.float32)
    cells = np.empty((6, 6), np.float32)
    fill_cells(0, len(density), density, 3, 1.0, cells)
    assert np.allclose(cells, np.kron(density, np.ones((3, 3))) / 9)
    assert (cells[:3, 3:] == 0).all()


@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.5]))
def test_error_diffusion_keeps_the_sum(seed, white):
    charge = field(seed, 40, 60, white).astype(np.float64) * 3
    total = charge.sum()
    points = np.empty((charge.size, 2))
    n = diffuse(charge, points)
    assert abs(n - total) <= 0.02 * total + 45  # what is left on the last row and at the sides


POLYGONS = st.one_of(
    st.builds(
        lambda x, y, r, hole: Point(x, y).buffer(r).difference(Point(x + 2, y).buffer(r * hole)),
        st.floats(-5, 45), st.floats(-5, 45), st.floats(1, 40), st.floats(0.0, 0.9),
    ),
    st.builds(
        lambda a, b, width: LineString([a, b]).buffer(width),
        st.tuples(st.floats(0, 40), st.floats(0, 40)),
        st.tuples(st.floats(41, 80), st.floats(0, 40)),
        st.floats(0.3, 8),
    ),
)  # fmt: skip


@given(POLYGONS)
def test_only_cells_inside_a_polygon_count(polygon):
    if polygon.is_empty or not isinstance(polygon, Polygon):
        return
    rings = [polygon.exterior, *polygon.interiors]
    corners = [np.asarray(ring.coords) for ring in rings]
    edges = np.concatenate([np.hstack((c[:-1], c[1:])) for c in corners])
    charge = np.ones((41, 47), np.float32)
    outside_polygon(edges, charge)
    y, x = np.mgrid[0:41, 0:47] + 0.5
    inside = shapely.contains_xy(polygon, x, y)
    near = shapely.distance(polygon.boundary, shapely.points(x, y)) < 1e-9
    assert ((charge > 0) == inside)[~near].all()


@settings(max_examples=20)
@given(st.integers(0, 10**6), st.sampled_from([0.02, 0.2]))
def test_seeds_run_from_the_border_inwards(seed, white):
    charge = field(seed, 30, 45, white)
    distance = np.empty(charge.shape, np.uint16)
    chamfer(charge, distance)
    outside = np.pad(charge, 1) == 0
    oy, ox = np.nonzero(outside)
    y, x = np.nonzero(charge)
    true = np.hypot(y[:, None] + 1 - oy, x[:, None] + 1 - ox).min(axis=1)
    assert (distance[charge == 0] == 0).all()
    assert (np.abs(distance[y, x] / 3 - true) <= 0.09 * true).all()
    order = np.empty(len(y), np.int32)
    order_by_distance(distance, order)
    assert np.array_equal(np.sort(order), np.flatnonzero(charge))
    assert (np.diff(distance.ravel()[order].astype(int)) >= 0).all()


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.integers(1, 40), st.integers(1, 40), st.integers(1, 50))
def test_an_undulating_front_reaches_every_cell_once_and_in_order(seed, h, w, piece):
    charge = field(seed, h, w, 0.3)
    rng = np.random.default_rng(seed)
    lag = rng.uniform(-8, 8, (h // FRONT_STEP + 2, w)).astype(np.float32)
    rows = np.arange(h)
    ahead = np.stack([np.interp(rows, np.arange(len(lag)) * FRONT_STEP, c) for c in lag.T], axis=1)
    level_of_cell = np.maximum.accumulate(np.ceil(rows[:, None] + ahead), axis=0)
    last = h + 20
    next_row, due = np.zeros(w, np.int32), lag[0].copy()
    at = np.array((-20, 0), np.int64)
    listed, order = [], np.empty(piece, np.int32)
    while at[0] < last:
        stop = min(int(at[0]) + 7, last)
        n = along_front(charge, lag, next_row, due, at, stop, order)
        listed.extend(order[:n].tolist())
    assert sorted(listed) == np.flatnonzero(charge).tolist()
    assert (next_row == h).all()
    assert (np.diff(level_of_cell.ravel()[listed]) >= -1).all()  # but for rounding in float32
