"""Dots along curves about a void: each cell reaches across it, and all dots lie beside its circles.

Where n dots lie on a circle all cells meet at its middle, and each looked at all n dots: 16,000
took four seconds a step, and eight thousand one. Later each asked every grid cell along the rim:
100,000 dots took 7 s on a circle and 34 s on an ellipse, 16,000 in a ring of walls 17 s.
"""

import numpy as np
import pytest
import shapely
from scipy.spatial import Voronoi
from shapely.geometry import Point, Polygon, box

from stippler.kernels.cells.grid import spot_of
from stippler.kernels.cells.tables import Dots, Grid
from stippler.kernels.cells.tree_search import cut_lanes_by_tree
from stippler.kernels.cells.voronoi import start_lanes
from stippler.kernels.machine.jit import kernel
from stippler.kernels.machine.pool import set_threads
from stippler.kernels.machine.simd import BUFFER, put, stack_doubles, stack_ints
from stippler.stippling.relax import Relaxation

SIDE = 1.25


def _ring(n, radius=1.0, noise=0.0):
    angle = 2 * np.pi * np.arange(n) / n
    radius = radius + noise * np.random.default_rng(0).standard_normal(n)
    return np.c_[radius * np.cos(angle), radius * np.sin(angle)]


def _spiral(n, turns):
    far = np.sqrt(np.linspace(0.01, 1.0, n))
    return np.c_[far * np.cos(2 * np.pi * turns * far), far * np.sin(2 * np.pi * turns * far)]


def _sine(n):
    x = np.linspace(-1.0, 1.0, n)
    return np.c_[x, 0.3 * np.sin(4 * np.pi * x)]


CURVES = {
    "noise": _ring(3000, noise=1e-6),
    "less noise": _ring(3000, noise=1e-9),
    "about one": np.vstack([[[0.0, 0.0]], _ring(3000)]),
    "half": _ring(6000, noise=1e-6)[:3000],
    "ellipse": _ring(4000) * [1.0, 0.6],
    "two": np.vstack([_ring(3000), _ring(2000, 0.7, 1e-6)]),
    "off the middle": _ring(3000, 0.5, 1e-6) + np.array([0.3, 0.211]),
    "line": np.c_[np.linspace(-1, 1, 3000), np.linspace(-0.3, 0.4, 3000)],
    "thin ellipse": _ring(4000) * [1.0, 0.1] + 1e-7 * np.random.default_rng(1).random((4000, 2)),
    "spiral": _spiral(4000, 1.3),
    "spiral of many turns": _spiral(6000, 7.3),
    "sine": _sine(4000),
    "cross": np.vstack([_sine(3000), _sine(3000)[:, ::-1] + 1e-3]),
    "two lines": np.vstack([_sine(2000) * [1, 0] + [0, y] for y in (0.0, 0.37)]),
    "few beside": np.vstack([_ring(4000), 2.4 * np.random.default_rng(2).random((300, 2)) - 1.2]),
}


def _areas_by_qhull(dots):
    """Return the areas of the cells in the square: of dots and their images beyond its sides."""
    images = [dots]
    for axis in (0, 1):
        for side in (-SIDE, SIDE):
            image = dots.copy()
            image[:, axis] = 2 * side - image[:, axis]
            images.append(image)
    found = Voronoi(np.vstack(images))
    regions = (found.regions[k] for k in found.point_region[: len(dots)])
    return np.array([Polygon(found.vertices[r]).convex_hull.area for r in regions])


@pytest.mark.parametrize("name", CURVES)
def test_cells_are_those_of_qhull(name):
    dots = CURVES[name]
    areas = Relaxation(dots, box(-SIDE, -SIDE, SIDE, SIDE)).cell_areas()
    np.testing.assert_allclose(areas.sum(), 4 * SIDE**2, rtol=1e-12)
    np.testing.assert_allclose(areas, _areas_by_qhull(dots), rtol=1e-8)


def _wavy(n, radius):
    angle = 2 * np.pi * np.arange(n) / n
    r = radius * (1 + 0.2 * np.sin(7 * angle))
    return Polygon(np.c_[r * np.cos(angle), r * np.sin(angle)])


WALLS = {
    "circle": Point(0, 0).buffer(1.2, 64),
    "close by": Point(0, 0).buffer(1.001, 500),
    "ring": Point(0, 0).buffer(1.1, 64).difference(Point(0, 0).buffer(0.5, 16)),
    "narrow ring": Point(0, 0).buffer(1.001, 200).difference(Point(0, 0).buffer(0.55, 64)),
    "triangle": Polygon([(-3, -1.2), (3, -1.3), (0.1, 3)]),
    "waves": _wavy(300, 1.3).difference(box(-0.4, 0.1, 0.4, 0.2)),
}
IN_WALLS = {
    "ring": _ring(2500), "ellipse": _ring(2500) * [1.0, 0.6], "noise": _ring(2500, noise=1e-6)
}  # fmt: skip


@pytest.mark.parametrize("wall", WALLS)
@pytest.mark.parametrize("curve", IN_WALLS)
def test_cells_between_walls_are_those_of_shapely(wall, curve):
    """Each is its dot's cell among all, cut off by the walls: the piece that holds the dot."""
    shape, dots = WALLS[wall], IN_WALLS[curve]
    dots = dots[shapely.contains_xy(shape, *dots.T)]
    areas = Relaxation(dots, shape).cell_areas()
    np.testing.assert_allclose(areas, _pieces_by_qhull(dots, shape), rtol=1e-7, atol=1e-12)


def _pieces_by_qhull(dots, shape):
    far = 40.0 * np.array([(1.0, 0.3), (-1.0, 0.1), (0.2, 1.0), (0.1, -1.0)])
    found = Voronoi(np.vstack([dots, far]))
    regions = (found.regions[k] for k in found.point_region[: len(dots)])
    cells = [Polygon(found.vertices[r]).convex_hull for r in regions]
    areas = []
    for dot, piece in zip(dots, shapely.intersection(cells, shape), strict=True):
        parts = np.array(shapely.get_parts(piece))
        parts = parts[shapely.area(parts) > 0]
        areas.append(parts[np.argmin(shapely.distance(parts, Point(dot)))].area)
    return np.array(areas)


@pytest.mark.parametrize("n", [3000, 20_000])
def test_all_cells_of_a_ring_are_alike(n):
    angle = 2 * np.pi * (np.arange(n) + 0.5) / n
    areas = Relaxation(_ring(n), box(-SIDE, -SIDE, SIDE, SIDE)).cell_areas()
    ends = np.c_[np.cos(angle), np.sin(angle)]
    ends *= SIDE / np.abs(ends).max(axis=1, keepdims=True)
    before = np.roll(ends, 1, axis=0)
    wedges = np.abs(ends[:, 0] * before[:, 1] - ends[:, 1] * before[:, 0]) / 2
    has_corner = np.isclose(np.abs(ends - before).min(axis=1), 0.0, atol=1e-15)
    # a dot rounded by 1e-16 turns the side between it and the next by 1e-16 of their distance
    np.testing.assert_allclose(areas[has_corner], wedges[has_corner], rtol=1e-8)
    np.testing.assert_allclose(areas.sum(), 4 * SIDE**2, rtol=1e-12)


def test_the_same_for_any_number_of_threads():
    steps = []
    for threads in (1, 2, 3):
        set_threads(threads)
        try:
            engine = Relaxation(_ring(20_000), box(-SIDE, -SIDE, SIDE, SIDE))
            engine.run(3)
        finally:
            set_threads(0)
        steps.append(engine.points)
    np.testing.assert_array_equal(steps[0], steps[1])
    np.testing.assert_array_equal(steps[0], steps[2])


@kernel
def _leaves_looked_into(dots: Dots, grid: Grid) -> int:
    U, V, N = stack_doubles(BUFFER), stack_doubles(BUFFER), stack_ints(BUFFER)
    for k in range(BUFFER):
        put(U, k, 0.0)
        put(V, k, 0.0)
        put(N, k, np.int32(0))
    count = 0
    for i in range(len(dots.compartment)):
        spot = spot_of(dots.x[i], dots.y[i], 0, grid)
        m = start_lanes(U, V, N, spot.x0, spot.y0, spot.x1, spot.y1)
        _, n_leaves = cut_lanes_by_tree(U, V, N, m, dots, grid, spot, np.int64(grid.root[0]))
        count += n_leaves
    return count


def test_few_leaves_are_looked_into_for_a_cell_however_many_there_are():
    """On a circle each cell once looked into all; later on an ellipse into most."""
    for squeeze in (1.0, 0.6, 0.1):
        for n in (4_000, 64_000):
            cells = Relaxation(_ring(n) * [1.0, squeeze], box(-SIDE, -SIDE, SIDE, SIDE))._cells
            cells._sort()
            assert _leaves_looked_into(cells._dots, cells._table) < 12 * n
