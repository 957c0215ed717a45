"""Cells that reach far over white paper are found row by row; they equal those found by rings."""

import numpy as np
from shapely.geometry import box

from stippler.stippling.density import DensityField
from stippler.stippling.relax import Relaxation


def test_a_far_cell_is_cut_once_by_each_neighbour():
    # Dots cut again by what had cut them already got slivers, and with them a neighbour twice:
    # the next step, which trusts the neighbours of the last, then moved the dot to a wrong place.
    rng = np.random.default_rng(4)
    ink = np.zeros((300, 300))
    y, x = np.mgrid[:300, :300]
    ink[np.hypot(x - 110, y - 150) < 60] = 1.0
    ink[140:160, 240:250] = 1.0
    points = rng.uniform(0, 300, (120_000, 2))
    rows, columns = points.T[::-1].astype(int)
    points = points[ink[rows, columns] > 0][:9000]
    page, density = box(0, 0, 300, 300), DensityField(ink, 1.0)
    kept = Relaxation(points, page, density=density)
    for _ in range(6):
        before = kept.points
        kept.step()
        fresh = Relaxation(before, page, density=density)
        fresh.step()
        np.testing.assert_allclose(kept.points, fresh.points, atol=1e-9)


def test_far_cells_cover_the_page():
    rng = np.random.default_rng(5)
    cluster = 500 + rng.normal(0, 4, (4000, 2))
    edge = 200 + rng.uniform(0, 30, (60, 2))
    engine = Relaxation(np.vstack([cluster, edge]), box(0, 0, 1000, 1000))
    areas = engine.cell_areas()
    assert areas.min() > 0
    np.testing.assert_allclose(areas.sum(), 1e6, rtol=1e-12)
