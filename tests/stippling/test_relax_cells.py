"""Cells against shapely: the Voronoi polygon, cut by the compartment, the piece with the dot."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon, box

from stippler.kernels.machine import pool
from stippler.stippling.relax import DensityField, Relaxation
from tests.stippling.shapes import (
    cell_by_qhull,
    comb,
    cut_one_by_one,
    half_planes,
    points_in,
    spiked,
    star_polygon,
)

TOLERANCE = 1e-9  # of the mean spacing
SETTINGS = settings(
    max_examples=40, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck)
)


def expected(points: np.ndarray, polygon: Polygon, diagram=half_planes) -> np.ndarray:
    """Area and centroid of each dot's piece."""
    out = []
    for point, cell in zip(points, diagram(points, polygon), strict=True):
        piece = cell.intersection(polygon)
        if piece.geom_type != "Polygon":
            parts = [g for g in piece.geoms if g.geom_type == "Polygon"]
            piece = min(parts, key=lambda part: part.distance(Point(point)))
        out.append([piece.area, piece.centroid.x, piece.centroid.y])
    return np.array(out)


def assert_cells(
    points: np.ndarray, polygon: Polygon, tolerance: float = TOLERANCE, diagram=half_planes
) -> None:
    engine = Relaxation(points, polygon)
    want = expected(points, polygon, diagram)
    spacing = math.sqrt(polygon.area / len(points))
    np.testing.assert_allclose(
        engine.cell_areas() / spacing**2, want[:, 0] / spacing**2, rtol=0, atol=tolerance
    )
    # a centroid is the moment over the area: judge moments, slivers have ill-defined ones
    weight = np.minimum(want[:, :1] / spacing**2, 1.0)
    np.testing.assert_allclose(
        engine.centroids() * weight / spacing, want[:, 1:] * weight / spacing, rtol=0,
        atol=tolerance * max(1.0, np.abs(want[:, 1:]).max() / spacing * 1e-3),
    )  # fmt: skip


@SETTINGS
@given(seed=st.integers(0, 10**6), corners=st.integers(3, 60), n=st.integers(1, 200))
def test_cells_are_shapelys_pieces(seed, corners, n):
    polygon = star_polygon(seed, corners)
    assert_cells(points_in(polygon, n, seed + 1), polygon)


@SETTINGS
@given(n=st.integers(1, 120), seed=st.integers(0, 10**6), teeth=st.integers(2, 9))
def test_cells_cut_apart_keep_the_piece_with_the_dot(n, seed, teeth):
    polygon = comb(teeth)
    assert polygon.is_valid
    assert_cells(points_in(polygon, n, seed), polygon)


@pytest.mark.parametrize("n", [1, 2, 3, 10, 300])
def test_needles_and_a_hole_beside_the_border(n):
    polygon = spiked()
    assert polygon.is_valid
    assert_cells(points_in(polygon, n, n), polygon)


@SETTINGS
@given(
    seed=st.integers(0, 10**6), n=st.integers(30, 400), n_clusters=st.integers(1, 5),
    spread=st.sampled_from([0.1, 0.01, 1e-4]), corners=st.integers(3, 30),
)  # fmt: skip
def test_cells_of_tight_clusters(seed, n, n_clusters, spread, corners):
    """Grid cells that are crowded, and cells of dots at a crowd's edge, which reach far."""
    polygon = star_polygon(seed, corners)
    rng = np.random.default_rng(seed)
    centre = points_in(polygon, n_clusters, seed)[rng.integers(0, n_clusters, n)]
    points = centre + spread * rng.uniform(-1, 1, (n, 2))
    points = np.vstack([points[shapely.contains_xy(polygon, *points.T)], centre[:1]])
    assert_cells(points, polygon)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e6])
@pytest.mark.parametrize("shift", [0.0, 10.0])
def test_any_scale(scale, shift):
    polygon = star_polygon(7, 25)
    points = points_in(polygon, 150, 3)
    moved = shapely.transform(polygon, lambda xy: (xy + shift) * scale)
    inside = shapely.contains_xy(moved, *((points + shift) * scale).T)
    assert_cells((points[inside] + shift) * scale, moved)


@pytest.mark.parametrize(
    "points",
    [
        np.c_[np.linspace(0.05, 0.95, 30), np.full(30, 0.5)],
        np.c_[np.linspace(0.05, 0.95, 30), np.linspace(0.05, 0.95, 30)],
        np.stack(np.meshgrid(np.arange(12), np.arange(12)), -1).reshape(-1, 2) / 12 + 0.05,
        np.c_[0.5 + 0.4 * np.cos(np.arange(90) * np.pi / 45), 0.5 + 0.4 * np.sin(
            np.arange(90) * np.pi / 45)],
        np.vstack([[[0.5, 0.5]], np.c_[0.5 + 0.4 * np.cos(np.arange(90) * np.pi / 45),
                                       0.5 + 0.4 * np.sin(np.arange(90) * np.pi / 45)]]),
        0.5 + 1e-5 * np.random.default_rng(0).standard_normal((150, 2)),
        np.vstack([c + 1e-3 * np.random.default_rng(1).standard_normal((60, 2))
                   for c in ([0.2, 0.2], [0.8, 0.3], [0.4, 0.9])]),
        np.array([[0.3, 0.4]]),
        np.array([[0.3, 0.4], [0.3, 0.6]]),
        np.array([[0.3, 0.4], [0.3 + 1e-9, 0.4]]),
    ],
    ids=["line", "diagonal", "grid", "circle", "hub", "speck", "clusters", "one", "two", "close"],
)  # fmt: skip
@pytest.mark.parametrize("shape", ["square", "star"])
def test_special_positions(points, shape):
    polygon = box(0, 0, 1, 1)
    if shape == "star":
        a = np.arange(24) * np.pi / 12
        r = np.where(np.arange(24) % 2, 0.9, 0.7)
        polygon = Polygon(np.c_[0.5 + r * np.cos(a), 0.5 + r * np.sin(a)])
    assert_cells(points, polygon, diagram=cut_one_by_one)


def test_a_thin_strip():
    strip = box(0, 0, 1000, 1e-3)
    assert_cells(points_in(strip, 200, 5), strip)
    tilted = Polygon([(0, 0), (1000, 1), (1000, 1.001), (0, 0.001)])
    assert_cells(points_in(tilted, 200, 5), tilted)


def test_a_cell_of_a_thousand_corners():
    a = np.arange(1000) * 2 * np.pi / 1000
    r = 0.4 + 1e-3 * np.sin(37 * a)
    assert_cells(
        np.vstack([[[0.5, 0.5]], np.c_[0.5 + r * np.cos(a), 0.5 + r * np.sin(a)]]),
        box(0, 0, 1, 1),
    )


@SETTINGS
@given(
    seed=st.integers(0, 10**6), n=st.integers(70, 400), noise=st.sampled_from([0, 1e-9, 1e-4, 0.1]),
    radius=st.sampled_from([0.2, 0.6, 0.99, 1.5]), is_square=st.booleans(),
)  # fmt: skip
def test_cells_of_very_many_corners(seed, n, noise, radius, is_square):
    rng = np.random.default_rng(seed)
    a = rng.random() + np.arange(n) * 2 * np.pi / n
    shape = box(0, 0, 1, 1) if is_square else Point(0.5, 0.5).buffer(0.55, quad_segs=5)
    middle = np.array([0.5, 0.5]) if seed % 3 else rng.uniform(0.2, 0.8, 2)
    r = 0.5 * radius * (1 + noise * rng.standard_normal(n))
    ring = middle + np.c_[r * np.cos(a), r * np.sin(a)]
    behind = middle + 1.7 * (ring[::3] - middle)  # in the directions of others
    dots = np.vstack([[middle], ring, behind])
    dots = dots[shapely.contains_xy(shape, dots[:, 0], dots[:, 1])]
    engine = Relaxation(dots, shape)
    areas, spacing2 = engine.cell_areas(), shape.area / len(dots)
    assert areas.sum() == pytest.approx(shape.area, rel=1e-10)
    cell = cell_by_qhull(dots[0], dots[1:]).intersection(shape)
    assert areas[0] == pytest.approx(cell.area, abs=TOLERANCE * spacing2)
    off = np.abs(engine.centroids()[0] - [cell.centroid.x, cell.centroid.y])
    assert off.max() < TOLERANCE * math.sqrt(spacing2)


@SETTINGS
@given(seed=st.integers(0, 10**6), n_parts=st.integers(2, 9), n=st.integers(1, 25))
def test_dots_see_only_their_own_compartment(seed, n_parts, n):
    parts = [
        shapely.transform(star_polygon(seed + i, 12), lambda xy, i=i: xy + np.array([1.5 * i, 0]))
        for i in range(n_parts)
    ]  # they overlap: only the membership given tells the dots apart
    sets = [points_in(p, n, seed + i) for i, p in enumerate(parts)]
    owner = np.repeat(np.arange(n_parts), n)
    shuffled = np.random.default_rng(seed).permutation(len(owner))
    points = np.vstack(sets)[shuffled]
    areas = Relaxation(points, parts, compartment_of_dot=owner[shuffled]).cell_areas()
    for i, part in enumerate(parts):
        alone = Relaxation(sets[i], part).cell_areas()
        mine = areas[np.argsort(shuffled)][owner == i]
        np.testing.assert_allclose(mine, alone, rtol=0, atol=1e-12)


@SETTINGS
@given(seed=st.integers(0, 10**6), n=st.integers(1, 60), w=st.integers(1, 12), h=st.integers(1, 9))
def test_density_is_integrated_exactly(seed, n, w, h):
    rng = np.random.default_rng(seed)
    polygon = star_polygon(seed, 15)
    points = points_in(polygon, n, seed)
    values = rng.random((h, w)) * (rng.random((h, w)) < 0.7)
    x0, y0, x1, y1 = polygon.bounds
    side = ((x1 - x0) / w, (y1 - y0) / h)
    engine = Relaxation(points, polygon, density=DensityField(values, side, (x0, y0)))
    cells = half_planes(points, polygon)
    pixels = [
        (box(x0 + c * side[0], y0 + r * side[1], x0 + (c + 1) * side[0], y0 + (r + 1) * side[1]),
         np.float32(values[r, c]))
        for r in range(h) for c in range(w)
    ]  # fmt: skip
    masses, centroids = engine.cell_masses(), engine.centroids()
    for i, (point, cell) in enumerate(zip(points, cells, strict=True)):
        piece = cell.intersection(polygon)
        if piece.geom_type != "Polygon":
            parts = [g for g in piece.geoms if g.geom_type == "Polygon"]
            piece = min(parts, key=lambda part, p=point: part.distance(Point(p)))
        shares = [(pixel.intersection(piece), value) for pixel, value in pixels]
        mass = sum(share.area * float(value) for share, value in shares)
        assert masses[i] == pytest.approx(mass, abs=1e-11)
        if mass > 1e-9:
            for axis, name in enumerate("xy"):
                moment = sum(
                    share.area * float(value) * getattr(share.centroid, name)
                    for share, value in shares
                    if share.area > 0
                )
                assert centroids[i, axis] * mass == pytest.approx(moment, abs=1e-11)


def test_no_weight_no_move():
    values = np.zeros((50, 50))
    values[:, 25:] = 1.0
    points = points_in(box(0, 0, 1, 1), 400, 0)
    engine = Relaxation(points, box(0, 0, 1, 1), density=DensityField(values, 1 / 50))
    white = engine.cell_masses() == 0.0
    assert 20 < np.count_nonzero(white) < 200
    engine.step()
    np.testing.assert_array_equal(engine.points[white], points[white])


@pytest.mark.parametrize("spread", [1.0, 0.01], ids=["even", "crowded"])
def test_same_bits_for_any_number_of_threads(spread):
    polygon = star_polygon(11, 40)
    points = points_in(polygon, 20_000, 1)
    middle = polygon.representative_point().coords[0]
    points[::2] = middle + spread * (points[::2] - middle)
    points = points[shapely.contains_xy(polygon, *points.T)]
    results = []
    try:
        for threads in (1, 2, 5):
            pool.set_threads(threads)
            engine = Relaxation(points, polygon)
            reports = engine.run(12)
            results.append((engine.points.tobytes(), reports))
    finally:
        pool.set_threads(0)
    assert results[0] == results[1] == results[2]


def test_density_under_cells_that_end_on_pixel_borders():
    values = np.random.default_rng(0).random((4, 8))
    dots = np.array([[1.0, 2.0], [3.0, 2.0], [6.0, 2.0]])  # cells end at x = 0, 2, 4.5 and 8
    masses = Relaxation(dots, box(0, 0, 8, 4), density=DensityField(values, 1.0)).cell_masses()
    columns = values.astype(np.float32).sum(axis=0, dtype=float)
    want = [columns[:2].sum(), columns[2:4].sum() + columns[4] / 2, columns[5:].sum()]
    want[2] += columns[4] / 2
    np.testing.assert_allclose(masses, want, rtol=1e-12)
