"""Even spacing without rows: what the three rules keep to, whatever the dots."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree
from shapely import affinity
from shapely.geometry import Point, Polygon, box

from stippler.kernels.machine.pool import n_threads, set_threads
from stippler.stippling import cells
from stippler.stippling.density import DensityField
from stippler.stippling.relax import AT_REST, Relaxation, relax
from stippler.stippling.spacing import LLOYD
from tests.conftest import EXAMPLES
from tests.stippling.shapes import comb, star_polygon

RING = Point(0, 0).buffer(10, quad_segs=12).difference(Point(2, 1).buffer(4, quad_segs=8))
COMB = Polygon(
    [(0, 0), (20, 0), (20, 3), (3, 3), (3, 5), (20, 5), (20, 8), (3, 8), (3, 10), (20, 10),
     (20, 13), (0, 13)]
)  # fmt: skip


def dots_in(shape, n, seed, spread=1.0):
    """Return n dots, all over the shape or, for a small spread, in a part of it."""
    rng = np.random.default_rng(seed)
    x0, y0, x1, y1 = shape.bounds
    shapely.prepare(shape)
    found = np.empty((0, 2))
    while len(found) < n:
        xy = rng.random((20 * n, 2)) * [(x1 - x0) * spread, (y1 - y0) * spread] + [x0, y0]
        found = np.concatenate([found, xy[shapely.contains_xy(shape, xy[:, 0], xy[:, 1])]])
    return found[:n]


@settings(deadline=None, max_examples=25)
@given(
    shape=st.sampled_from([RING, COMB, box(0, 0, 7, 3)]),
    n=st.integers(2, 200),
    seed=st.integers(0, 2**16),
    spread=st.sampled_from([1.0, 0.5]),
)
def test_nothing_crosses_a_wall_and_fixed_dots_stay(shape, n, seed, spread):
    xy = dots_in(shape, n, seed, spread)
    fixed = np.random.default_rng(seed).random(n) < 0.2
    after = relax(xy, shape, 12, fixed, method="even")
    assert np.isfinite(after).all()
    assert (shapely.distance(shape, shapely.points(after)) < 1e-9).all()
    assert (after[fixed] == xy[fixed]).all()


def test_threads_change_nothing():
    xy = dots_in(RING, 9_000, 4)
    field = DensityField(np.random.default_rng(1).random((90, 90)) + 0.2, 20 / 90, (-10.0, -10.0))
    before = n_threads()
    results = []
    for n in (1, 3):
        set_threads(n)
        results.append(relax(xy, RING, 9, density=field, method="even").tobytes())
    set_threads(before)
    assert results[0] == results[1]


def test_a_kept_neighbour_gives_what_a_search_gives():
    xy = dots_in(RING, 3_000, 5)
    kept = Relaxation(xy, RING, method="even")
    fresh = Relaxation(xy, RING, method="even")
    kept.run(10)
    fresh.run(10)
    assert kept._cells.keeps_stars
    for _ in range(5):
        fresh._cells._keep = False
        kept.step()
        fresh.step()
        assert np.abs(kept.points - fresh.points).max() < 1e-9


@given(
    seed=st.integers(0, 10**6), n=st.integers(20, 250), is_weighted=st.booleans(),
    shape=st.sampled_from(["box", "round", "parts", "concave", "holed", "comb"]),
)  # fmt: skip
@settings(max_examples=40 * EXAMPLES, deadline=None)
def test_cells_at_borders_are_kept_as_they_would_be_found(seed, n, is_weighted, shape):
    """Boxes, convex and concave borders, cells cut apart: kept by rules, and true."""
    a = np.arange(17) * np.pi / 8.5
    ring = Polygon(0.5 + 0.4 * np.c_[np.cos(a), np.sin(a)])
    shapes = {
        "box": box(0, 0, 1, 1),
        "round": ring,
        "parts": [box(0, 0, 0.4, 1), Polygon([(0.4, 0), (1, 0), (1, 0.8), (0.7, 1), (0.4, 1)])],
        "concave": star_polygon(seed, 3 + seed % 40),
        "holed": box(0, 0, 1, 1).difference(Point(0.4, 0.5).buffer(0.2)),
        "comb": affinity.scale(comb(4), 0.25, 1.0, origin=(0, 0)),
    }
    parts, rng = shapes[shape], np.random.default_rng(seed)
    points = 3 * rng.random((4 * n, 2)) - 1 if shape == "concave" else rng.random((n, 2))
    points = points[shapely.contains_xy(shapely.unary_union(parts), *points.T)]
    fixed = rng.random(len(points)) < 0.1
    field = DensityField(rng.random((9, 9)) + 0.05, 1 / 9) if is_weighted else None
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cells, "MOST_TODO", 2.0)
        patch.setattr(cells, "KEEP_BELOW", 10.0)
        kept = Relaxation(points, parts, fixed, None, field, method="even")
        fresh = Relaxation(points, parts, fixed, None, field, method="even")
        for _ in range(8):
            fresh._cells._keep = False
            fresh.step()
            kept.step()
            gap = np.abs(kept.points - fresh.points).max(initial=0.0)
            assert gap <= 1e-8 * kept.spacing_mm


def test_cells_at_a_pages_edge_are_kept_by_the_rules_too():
    engine = Relaxation(np.random.default_rng(1).random((3000, 2)), box(0, 0, 1, 1), method="even")
    engine.run(60)
    assert engine.n_failed < 30  # some 200 lie at the edge


def test_dots_come_to_rest_and_say_so():
    xy = dots_in(box(0, 0, 10, 10), 2_000, 6)
    engine = Relaxation(xy, box(0, 0, 10, 10), method="even")
    report = engine.run(5_000)
    assert report.reason == "rest"
    spacing = np.sqrt(100 / 2_000)
    assert report.steps[-1].largest_mm <= AT_REST * spacing
    again = engine.run(50)
    assert again.reason == "rest"
    assert again.n_steps <= 5


def test_rest_is_even():
    xy = dots_in(box(0, 0, 10, 10), 2_000, 7)
    after = relax(xy, box(0, 0, 10, 10), 120, method="even")
    inside = ((after > 0.6) & (after < 9.4)).all(axis=1)
    nearest = KDTree(after).query(after[inside], k=2)[0][:, 1]
    hexagonal = np.sqrt(2 / np.sqrt(3) * 100 / 2_000)
    assert nearest.min() > 0.72 * hexagonal
    assert nearest.std() / nearest.mean() < 0.04


def test_dots_follow_the_density_itself():
    """Five eighths of a ramp's weight, and of its dots, lie in its denser half; Lloyd's do not."""
    values = np.broadcast_to(np.linspace(1.0, 3.0, 100), (100, 100))
    xy = dots_in(box(0, 0, 10, 10), 300, 8)
    field = DensityField(values, 0.1)
    share = {
        method: (relax(xy, box(0, 0, 10, 10), 400, density=field, method=method)[:, 0] > 5).mean()
        for method in ("even", "lloyd")
    }
    assert share["even"] == pytest.approx(0.625, abs=0.02)
    assert share["lloyd"] < 0.6


def test_a_dot_on_white_stays():
    values = np.zeros((10, 10))
    values[:, 5:] = 1.0
    xy = np.array([[0.5, 2.0], [0.5, 7.0], [1.6, 4.5], [7.0, 3.0], [8.0, 6.0]])
    after = relax(xy, box(0, 0, 10, 10), 3, density=DensityField(values, 1.0), method="even")
    assert (after[:2] == xy[:2]).all()


def test_lloyd_among_the_rules_is_lloyd():
    xy = dots_in(box(0, 0, 10, 10), 500, 9)
    engine = Relaxation(xy, box(0, 0, 10, 10), method="even")
    engine.set_rules(LLOYD)
    for _ in range(4):
        engine.step()
    assert np.abs(engine.points - relax(xy, box(0, 0, 10, 10), 4)).max() < 1e-9
