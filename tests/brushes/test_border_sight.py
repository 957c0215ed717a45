"""Brushes and *Relax* see through borders as the work on whole areas does."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import KDTree, Voronoi
from shapely.geometry import MultiPoint, box

from stippler.brushes.evening_out import evened_out
from stippler.brushes.local_cells import areas_of, centroids_of
from stippler.brushes.local_sight import seen_around
from stippler.jobs.processing import process_now
from stippler.jobs.stippling import relax_drawing
from stippler.stippling.border_policies import policies_of
from tests.stippling.test_border_pieces import SPACING, beside, parted
from tests.stippling.test_borders import H, W, asked, inked


def made(low="through", high="through", shaken=0.0, fresh=("through", "through")):
    """A page of two areas drawn as one, the dots of the right one shaken, and other policies."""
    document = parted(*fresh)
    process_now(document, [0, 1])
    rows = np.flatnonzero(document.dots.area == 1)
    by = np.random.default_rng(1).normal(0.0, shaken * SPACING, (len(rows), 2))
    inner = (np.abs(document.dots.position_mm[rows] - (W / 2, H / 2)) < (W / 2 - 1, H / 2 - 1)).all(
        1
    )
    document.begin("Shake")
    document.move(rows[inner], (document.dots.position_mm[rows] + by)[inner])
    document.commit()
    if (low, high) != fresh:
        other = parted(low, high).drawing.borders
        document.drawing.borders.update(other)
    return document


def near_line(document, y0=2.0, y1=38.0, within=0.8):
    x, y = document.dots.position_mm.T
    beside_line = (np.abs(x - 25.0) < within * SPACING) & (y > y0) & (y < y1)
    return np.flatnonzero(beside_line).astype(np.int64)


def test_cells_go_on_beyond_a_border_that_is_seen_through():
    document = made()
    rows = near_line(document)
    voronoi = Voronoi(document.dots.position_mm)
    corners = [voronoi.vertices[voronoi.regions[voronoi.point_region[row]]] for row in rows]
    expected = [MultiPoint(one).convex_hull.area for one in corners]
    np.testing.assert_allclose(areas_of(document, rows), expected, rtol=1e-9)
    walled = areas_of(made("wall", "wall"), rows)
    assert np.abs(walled / expected - 1).max() > 0.2


@pytest.mark.parametrize("by_tone", [True, False])
def test_a_brush_leaves_a_joint_alone_and_a_wall_pushes(by_tone):
    moves = {}
    for policy in ("through", "wall"):
        document = made(policy, policy)
        rows = near_line(document)
        moved = evened_out(document, rows, by_tone).moved_mm
        if not by_tone:
            moved = centroids_of(document, rows)
        moves[policy] = np.hypot(*(moved - document.dots.position_mm[rows]).T).mean() / SPACING
    assert moves["through"] < 0.06
    assert moves["wall"] > 2.0 * moves["through"]


def test_each_dot_is_asked_in_its_own_area_alone():
    document = made("through", "wall")
    rows = near_line(document)
    alone = [
        evened_out(document, rows[document.dots.area[rows] == k], True).moved_mm for k in (0, 1)
    ]
    both = evened_out(document, rows, True).moved_mm
    for k in (0, 1):
        mine = document.dots.area[rows] == k
        middle = np.abs(document.dots.position_mm[rows][mine][:, 1] - 20) < 8
        np.testing.assert_allclose(both[mine][middle], alone[k][middle], atol=0.02 * SPACING)


def test_what_is_seen_in_a_box():
    document = made("through", "wall")
    assert seen_around(document, 1, (20, 2, 30, 18)).areas == (0,)
    assert seen_around(document, 1, (20, 24, 30, 38)) is None
    assert seen_around(document, 0, (26, 2, 30, 18)) is None
    assert policies_of(document) is policies_of(document)
    walls = made("wall", "wall")
    assert seen_around(walls, 1, (20, 2, 30, 18)) is None


def relaxed(document, areas):
    drawing = document.drawing
    before = drawing.dots.position_mm.copy()
    *_, work = relax_drawing(drawing, drawing.styles[0], 20, areas)
    assert (document.partition.area_at(work.moved_mm) == drawing.dots.area).all()
    document.begin("Relax")
    rows = np.arange(len(before))
    document.move(rows, work.moved_mm)
    document.change("radius_mm", rows, work.radius_mm)
    document.commit()
    np.testing.assert_array_equal(document.dots.position_mm, work.moved_mm)
    return before


@pytest.mark.parametrize("areas", [None, [1]])
def test_relax_goes_on_through_a_border(areas):
    document = made(shaken=0.3)
    before = relaxed(document, areas)
    at, radius = document.dots.position_mm, document.dots.radius_mm.astype(float)
    if areas is not None:
        rest = document.dots.area == 0
        np.testing.assert_array_equal(at[rest], before[rest])
    rows = near_line(document)
    apart = KDTree(at).query(at[rows], 2)[0][:, 1] / SPACING
    assert apart.min() > 0.55
    assert apart.mean() > 0.9
    assert beside(at, 2, 38) == pytest.approx(1.0, abs=0.35)
    strip = box(25 - 2 * SPACING, 0, 25 + 2 * SPACING, H)
    assert inked(at, radius, strip) == pytest.approx(asked(strip), rel=0.015)


def test_relax_lines_up_along_the_walls():
    document = made("through", "wall", shaken=0.3)
    relaxed(document, None)
    at = document.dots.position_mm
    assert beside(at, 2, 19) > 0.6
    assert beside(at, 21, 38) < 0.3
