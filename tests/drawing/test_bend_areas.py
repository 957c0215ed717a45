"""Borders that are bent, against outlines cut fine and moved point by point."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.area_edits import current_map, edit_areas
from stippler.drawing.bend_areas import MovingBorders, ShownBorders, bend_borders
from stippler.drawing.deformation import Cage, Deformation
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import UNIT_MM, Path
from tests.conftest import EXAMPLES

BOX = (8.0, 6.0, 52.0, 34.0)


def drawn(*rings, page=(60.0, 40.0)):
    document = Document(Drawing.blank(Page(*page)))
    for ring in rings:
        edit_areas(document, "area", lambda areas, ring=ring: edits.add(areas, ring, edits.IS_CUT))
    return document


def round_ring(x, y, r):
    """Return a circle of four curves."""
    c = 0.5523 * r
    nodes = []
    for k in range(4):
        u = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)][k], float)
        v = np.array([-u[1], u[0]])
        at = np.array([x, y]) + r * u
        nodes.append((tuple(at - c * v), tuple(at), tuple(at + c * v)))
    return Path.bezier(nodes, closed=True)


def square(x0, y0, x1, y1):
    return Path.polyline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], closed=True)


def reference_of(outline, bent):
    """Return an outline cut into short pieces and moved."""
    fine = shapely.segmentize(outline, 0.02)
    return shapely.transform(fine, lambda at: np.asarray(bent.apply(at)))


moves = st.lists(
    st.tuples(st.integers(0, 15), st.floats(-2.5, 2.5), st.floats(-2.5, 2.5)), max_size=4
)


@settings(max_examples=12 * EXAMPLES, deadline=None)
@given(moves)
def test_borders_go_where_their_points_go(moved):
    document = drawn(square(14, 10, 30, 28), round_ring(40, 20, 7.0))
    cage = Cage.over(BOX)
    rest = cage.rest_mm()
    bent = Deformation(cage=cage.moved({k: tuple(rest[k] + (dx, dy)) for k, dx, dy in moved}))
    wanted = {k: reference_of(document.partition.part_of(k), bent) for k in (1, 2)}
    shown = ShownBorders.of(current_map(document), (1, 2), 0.3).bent(bent)
    document.begin("bend")
    bend_borders(document, (1, 2), bent)
    document.commit()
    for k in (1, 2):
        outline = document.drawing.areas[k].outline_mm
        assert outline.is_valid
        assert shapely.hausdorff_distance(outline.exterior, wanted[k].exterior, 0.05) < 0.04
        live = min(
            shapely.hausdorff_distance(shapely.LinearRing(points), outline.exterior, 0.05)
            for points in shown
        )
        assert live < 0.06  # what was shown is what there is


@pytest.mark.parametrize("matrix", [
    (0.8, 0.0, 4.0, 0.0, 0.8, 3.0, 0.0, 0.0, 1.0), (0.7, 0.3, 3.0, -0.2, 0.9, 9.0, 0.0, 0.0, 1.0),
])  # fmt: skip
def test_what_only_scales_and_shears_keeps_nodes_and_handles(matrix):
    document = drawn(square(14, 10, 30, 28), round_ring(40, 20, 7.0))
    before = current_map(document)
    paths = MovingBorders.of(before, (1, 2)).bent(Deformation(matrix))
    (a, b, c), (d, e, f), _ = np.array(matrix).reshape(3, 3)
    for k, path in paths.items():
        old = before.arcs[k].path
        assert len(path.nodes()) == len(old.nodes())
        assert len(path.curves) == len(old.curves)
        x, y = old.points_mm[old.nodes()].T
        there = np.column_stack([a * x + b * y + c, d * x + e * y + f])
        assert np.abs(path.points_mm[path.nodes()] - there).max() <= UNIT_MM
        for mine, its in zip(path.curves, old.curves, strict=True):
            x, y = np.array(its.handles_mm).T
            there = np.column_stack([a * x + b * y + c, d * x + e * y + f])
            assert np.abs(np.array(mine.handles_mm) - there).max() < 1e-6


def test_nodes_at_the_pages_edge_stay_and_neighbours_follow():
    document = drawn(square(20, -5, 40, 25), square(40, 10, 50, 20))
    bent = Deformation(cage=Cage.over((15, 0, 45, 30)).moved({9: (28, 24), 10: (38, 23)}))
    shown = ShownBorders.of(current_map(document), (1,), 0.2).bent(bent)
    document.begin("bend")
    bend_borders(document, (1,), bent)
    document.commit()
    one, two = (document.drawing.areas[k].outline_mm for k in (1, 2))
    corners = set(map(tuple, shapely.get_coordinates(one).tolist()))
    assert {(20.0, 0.0), (40.0, 0.0)} <= corners
    assert one.intersection(two).area < 1e-9
    assert one.touches(two)
    whole = shapely.union_all([shapely.LineString(p) for p in shown])
    borders = shapely.union_all([one.boundary, two.boundary])
    inner = borders.difference(shapely.box(0, 0, 60, 40).boundary.buffer(1e-6))
    assert shapely.hausdorff_distance(whole, inner, 0.02) < 0.06
    document.undo()
    assert document.drawing.areas[1].outline_mm.equals(shapely.box(20, 0, 40, 25))


def test_what_is_bent_out_of_the_page_ends_at_its_edge():
    document = drawn(square(20, 10, 40, 25))
    document.begin("bend")
    bend_borders(document, (1,), Deformation((1, 0, 25, 0, 1, 0, 0, 0, 1)))
    document.commit()
    assert document.drawing.areas[1].outline_mm.equals(shapely.box(45, 10, 60, 25))
