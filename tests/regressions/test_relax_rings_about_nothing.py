"""Dots along curves about a void: each cell reaches across it, and all dots lie beside its circles.

Where n dots lie on a circle all cells meet at its middle, and each looked at all n dots: 16,000
took four seconds a step, and eight thousand one.
"""

import time

import numpy as np
import pytest
from scipy.spatial import Voronoi
from shapely.geometry import Polygon, box

from stippler.kernels.machine.pool import set_threads
from stippler.stippling.relax import Relaxation

SIDE = 1.25


def _ring(n, radius=1.0, noise=0.0):
    angle = 2 * np.pi * np.arange(n) / n
    radius = radius + noise * np.random.default_rng(0).standard_normal(n)
    return np.c_[radius * np.cos(angle), radius * np.sin(angle)]


CURVES = {
    "noise": _ring(3000, noise=1e-6),
    "less noise": _ring(3000, noise=1e-9),
    "about one": np.vstack([[[0.0, 0.0]], _ring(3000)]),
    "half": _ring(6000, noise=1e-6)[:3000],
    "ellipse": _ring(4000) * [1.0, 0.6],
    "two": np.vstack([_ring(3000), _ring(2000, 0.7, 1e-6)]),
    "off the middle": _ring(3000, 0.5, 1e-6) + np.array([0.3, 0.211]),
    "line": np.c_[np.linspace(-1, 1, 3000), np.linspace(-0.3, 0.4, 3000)],
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


def test_four_times_the_dots_take_less_than_ten_times_the_work():
    """Eighteen times as long it took when each dot was looked at for each cell."""

    def seconds(n):
        took = []
        for _ in range(3):
            engine = Relaxation(_ring(n), box(-SIDE, -SIDE, SIDE, SIDE))
            start = time.process_time()
            engine.step()
            took.append(time.process_time() - start)
        return min(took)

    assert seconds(16_000) < 10 * seconds(4_000)
