"""Integrals of a field over polygons, sides in lanes, against shapely and against side by side."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.kernels.cells.border import sum_field, sum_field_in_lanes
from stippler.kernels.cells.field import integrate_edge
from stippler.kernels.cells.tables import Field
from stippler.kernels.machine.jit import kernel
from stippler.kernels.machine.simd import BUFFER, LANES, put, sides_before, stack_doubles
from tests.conftest import EXAMPLES


@kernel
def by_lanes(outline, n, x, y, field, found):
    found[0], found[1], found[2] = sum_field(outline, n, x, y, 0, field)


@kernel
def from_lanes(outline, n, x, y, field, found):
    """Sum a cell whose corners lie in lanes, and tell the sides that (x, y) + (2, 1) is beyond."""
    U, V = stack_doubles(BUFFER), stack_doubles(BUFFER)
    for k in range(LANES):
        put(U, k, outline[k if k < n else k - n, 0])
        put(V, k, outline[k if k < n else k - n, 1])
    scratch = np.empty((LANES, 6))
    found[0], found[1], found[2] = sum_field_in_lanes(U, V, n, x, y, 0, field, scratch)
    return sides_before(U, V, n, 2.0, 1.0)


@kernel
def side_by_side(outline, n, x, y, field, found):
    first, h, w = field.window[0, 0], field.window[0, 1], field.window[0, 2]
    for s in range(n):
        u, v, u1, v1 = outline[s, 0], outline[s, 1], outline[s, 2], outline[s, 3]
        m, mx, my = integrate_edge(field.sums, first, h, w, x, y, u, v, u1, v1)
        found[0] += m
        found[1] += mx
        found[2] += my


def field_of(values):
    h, w = values.shape
    sums = np.zeros((h, w + 1, 2))
    sums[:, 1:, 0] = np.cumsum(values, axis=1)
    sums[:, 1:, 1] = np.cumsum(values * (np.arange(w) + 0.5), axis=1)
    window = np.array([[5, h, w, 0, 0, 0]])  # others' sums lie before it
    return Field(
        np.concatenate([np.full(10, 7.0), sums.ravel()]), np.array([[0.0, 0.0, 1.0, 1.0]]), window
    )


def outline_of(corners, x, y):
    out = np.zeros((16 * (len(corners) // 16 + 2), 6))
    at = corners - (x, y)
    out[: len(at), :2], out[: len(at), 2:4] = at, np.roll(at, -1, axis=0)
    return out


def exact(corners, values, x, y):
    polygon = shapely.Polygon(corners)
    rows, columns = np.indices(values.shape).reshape(2, -1)
    parts = shapely.intersection(polygon, shapely.box(columns, rows, columns + 1, rows + 1))
    mass = shapely.area(parts) * values.ravel()
    at = np.nan_to_num(shapely.get_coordinates(shapely.centroid(parts), include_z=False))
    kept = ~shapely.is_empty(parts)
    return np.array([
        mass.sum(), (mass[kept] * (at[:, 0] - x)).sum(), (mass[kept] * (at[:, 1] - y)).sum()
    ])  # fmt: skip


def convex(rng, n, middle, reach):
    angle = np.sort(rng.uniform(0, 2 * np.pi, n))
    return middle + reach * np.column_stack([np.cos(angle), np.sin(angle)])


@given(
    n=st.integers(3, 20), seed=st.integers(0, 9999), reach=st.sampled_from([0.3, 2.0, 9.0, 300.0]),
    whole=st.booleans(),
)  # fmt: skip
@settings(max_examples=60 * EXAMPLES, deadline=None)
def test_masses_and_moments_are_those_of_the_pixels(n, seed, reach, whole):
    rng = np.random.default_rng(seed)
    values = rng.random((17, 23)) * (rng.random((17, 23)) < 0.7)
    x, y = rng.uniform(-2, 25), rng.uniform(-2, 19)
    corners = convex(rng, n, (x, y), reach)
    if whole:  # corners and sides on the borders of pixels
        corners = np.round(corners)
        if shapely.Polygon(corners).area == 0.0 or not shapely.is_valid(shapely.Polygon(corners)):
            return
    found, single = np.zeros(3), np.zeros(3)
    outline = outline_of(corners, x, y)
    by_lanes(outline, n, x, y, field_of(values), found)
    side_by_side(outline, n, x, y, field_of(values), single)
    size = max(reach, 25.0) * np.array([1.0, 25.0, 25.0])
    np.testing.assert_allclose(found / size, single / size, atol=1e-12)
    np.testing.assert_allclose(found / size, exact(corners, values, x, y) / size, atol=1e-11)
    if n <= 13:
        beyond = from_lanes(outline, n, x, y, field_of(values), single)
        np.testing.assert_allclose(found / size, single / size, atol=1e-12)
        u, v, u1, v1 = outline[:n, :4].T
        left = (v1 - v) * (u - 2.0) - (u1 - u) * (v - 1.0)
        clear = np.abs(left) > 1e-9 * reach * reach
        bits = (beyond >> np.arange(n)) & 1 == 1
        assert (bits == (left < 0.0))[clear].all()


@given(n=st.integers(3, 12), seed=st.integers(0, 9999))
@settings(max_examples=30 * EXAMPLES, deadline=None)
def test_white_between_ink_is_nothing_at_all(n, seed):
    rng = np.random.default_rng(seed)
    values = rng.random((40, 40))
    values[8:32, 8:32] = 0.0
    x, y = rng.uniform(19, 21, 2)
    found = np.ones(3)
    outline = outline_of(convex(rng, n, (x, y), 10.5), x, y)
    by_lanes(outline, n, x, y, field_of(values), found)
    assert not found.any()


def test_a_window_without_rows_has_no_mass():
    found = np.ones(3)
    outline = outline_of(np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]), 0.2, 0.2)
    by_lanes(outline, 3, 0.2, 0.2, field_of(np.ones((1, 1)))._replace(
        sums=np.zeros(0), window=np.zeros((1, 6), np.int64)), found)  # fmt: skip
    assert not found.any()
