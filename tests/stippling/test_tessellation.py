"""The tessellation against shapely: outlines, what lies beyond each side, measures."""

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon, box

from stippler.stippling.density import DensityField
from stippler.stippling.relax import Relaxation
from stippler.stippling.tessellation import Tessellation
from tests.stippling.shapes import (
    comb,
    gear,
    half_planes,
    points_in,
    spiked,
    spiral,
    star,
    star_polygon,
)

SETTINGS = settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=list(HealthCheck),
    phases=[p for p in Phase if p is not Phase.shrink],
)


def pieces(points, polygon):
    """Each dot's cell within the polygon, by shapely."""
    out = []
    for point, cell in zip(points, half_planes(points, polygon), strict=True):
        piece = cell.intersection(polygon)
        if piece.geom_type != "Polygon":
            parts = [g for g in piece.geoms if g.geom_type == "Polygon"]
            piece = min(parts, key=lambda part, p=point: part.distance(Point(p)))
        out.append(piece)
    return out


def assert_is_right(cells: Tessellation, polygon: Polygon) -> None:
    points = cells.position
    spacing2 = polygon.area / len(points)
    for i, piece in enumerate(pieces(points, polygon)):
        mine = cells.polygon(i)
        assert abs(mine.area - cells.area[i]) < 1e-11 * spacing2
        assert mine.buffer(0).symmetric_difference(piece).area < 1e-10 * spacing2
    dot = cells.dot_of_side
    for end in (cells.corner, cells.end):
        place = points[dot] + end
        on_border = cells.beyond < 0
        edge = cells.compartments.edges[-1 - cells.beyond[on_border]]
        lines = shapely.linestrings(edge.reshape(-1, 2, 2))
        assert (shapely.distance(lines, shapely.points(place[on_border])) < 1e-9).all()
        own, other = points[dot[~on_border]], points[cells.beyond[~on_border]]
        gap = np.hypot(*(place[~on_border] - own).T) - np.hypot(*(place[~on_border] - other).T)
        assert np.abs(gap).max(initial=0.0) < 1e-9


@SETTINGS
@given(seed=st.integers(0, 10**6), corners=st.integers(3, 60), n=st.integers(1, 150))
def test_outlines_are_shapelys(seed, corners, n):
    polygon = star_polygon(seed, corners)
    assert_is_right(Tessellation.of(points_in(polygon, n, seed), polygon), polygon)


def sliver(seed: int) -> Polygon:
    width = 10.0 ** -(1 + seed % 6)
    return Polygon([(0, 0), (3, 0.5), (3, 0.5 + width), (1, 1 / 6 + width)])


def on_an_edge(shape: Polygon, seed: int) -> np.ndarray:
    """A dot just on an edge, if rounding lets one be there; else none."""
    ring = shapely.get_coordinates(shape.exterior)
    middle = 0.5 * (ring[:-1] + ring[1:])
    middle = middle[shapely.distance(shape.boundary, shapely.points(middle)) == 0.0]
    middle = middle[shapely.intersects_xy(shape, middle[:, 0], middle[:, 1])]
    return middle[[seed % len(middle)]] if len(middle) else middle


MAKERS = [
    lambda seed: star_polygon(seed, 3 + seed % 40), lambda seed: comb(2 + seed % 5),
    lambda seed: gear(5 + seed % 12), lambda seed: spiral(1.5, 0.2 + 0.1 * (seed % 6)),
    lambda seed: star(4 + seed % 20), lambda seed: box(0, 0, 1 + seed % 3, 2), sliver,
]  # fmt: skip


@settings(SETTINGS, max_examples=60)
@given(data=st.data())
def test_subdivisions_to_1e_10(data):
    """Areas, masses and centroids of many compartments at once, dots on walls and in corners."""
    shapes, dots, owner = [], [], []
    for k in range(data.draw(st.integers(1, 5))):
        seed = data.draw(st.integers(0, 1000))
        shape = data.draw(st.sampled_from(MAKERS))(seed)
        shapes.append(shapely.transform(shape, lambda xy, k=k: np.add(xy, (8.0 * k, 0.0))))
        xy = points_in(shapes[-1], data.draw(st.sampled_from([0, 1, 2, 12, 60])), seed)
        if len(xy) and data.draw(st.booleans()):
            corners = shapely.get_coordinates(shapes[-1])[:-1]
            xy = np.vstack([xy, corners[seed % len(corners)]])
        if data.draw(st.booleans()):
            xy = np.vstack([xy, on_an_edge(shapes[-1], seed)])
        dots.append(xy)
        owner += [k] * len(xy)
    values = np.random.default_rng(len(owner)).random((5, 9))
    field = DensityField(values, (5.0, 2.0), (-4.0, -4.0))
    points = np.concatenate(dots)
    cells = Tessellation.of(points, shapes, np.array(owner, np.int32), field)
    pixels = [
        (box(5 * c - 4, 2 * r - 4, 5 * c + 1, 2 * r - 2), float(np.float32(values[r, c])))
        for r in range(5) for c in range(9)
    ]  # fmt: skip
    first = 0
    for k, shape in enumerate(shapes):
        spacing2 = shape.area / max(len(dots[k]), 1) + 1e-5  # coordinates of 40 round to 7e-15
        for i, piece in enumerate(pieces(dots[k], shape), start=first):
            assert cells.area[i] == pytest.approx(piece.area, abs=1e-10 * spacing2)
            parts = [(piece.intersection(pixel), value) for pixel, value in pixels]
            mass = sum(part.area * value for part, value in parts)
            assert cells.mass[i] == pytest.approx(mass, abs=1e-10 * spacing2)
            for axis, name in enumerate("xy"):
                moment = sum(p.area * v * getattr(p.centroid, name) for p, v in parts if p.area)
                here = cells.centroid[i, axis] * cells.mass[i]
                assert here == pytest.approx(moment, abs=1e-9 * spacing2)
        first += len(dots[k])


@pytest.mark.parametrize("polygon", [comb(6), spiked(), box(0, 0, 1, 2)], ids=str)
@pytest.mark.parametrize("n", [1, 7, 120])
def test_outlines_in_odd_shapes(polygon, n):
    assert_is_right(Tessellation.of(points_in(polygon, n, n), polygon), polygon)


def test_every_border_is_covered_once_where_no_cell_is_cut_apart():
    shape = box(0, 0, 4, 4).difference(box(1, 1, 2.5, 2))
    engine = Relaxation(points_in(shape, 300, 1), shape)
    engine.run(10)
    cells = engine.tessellation()
    assert cells.area.sum() == pytest.approx(shape.area)
    on_border = cells.beyond < 0
    length = np.bincount(-1 - cells.beyond[on_border], cells.length[on_border])
    edges = cells.compartments.edges
    np.testing.assert_allclose(length, np.hypot(*(edges[:, 2:] - edges[:, :2]).T), rtol=1e-10)
    sides = set(zip(cells.dot_of_side.tolist(), cells.beyond.tolist(), strict=True))
    assert all((j, i) in sides for i, j in sides if j >= 0)


def test_a_cell_around_a_hole_has_two_rings():
    shape = box(0, 0, 4, 4).difference(box(2.4, 2.4, 2.6, 2.6))
    cells = Tessellation.of([[2.1, 2.1]], shape)
    assert [len(ring) for ring in cells.rings(0)] == [4, 4]
    assert cells.polygon(0).equals(shape)


def test_order_and_masses_are_of_the_dots_given():
    points = np.random.default_rng(0).random((500, 2))
    values = np.random.default_rng(1).random((20, 20))
    field = DensityField(values, 1 / 20)
    cells = Tessellation.of(points, box(0, 0, 1, 1), density=field)
    order = np.random.default_rng(2).permutation(500)
    shuffled = Tessellation.of(points[order], box(0, 0, 1, 1), density=field)
    np.testing.assert_allclose(shuffled.mass, cells.mass[order], rtol=1e-12)
    np.testing.assert_allclose(shuffled.centroid, cells.centroid[order], rtol=1e-12)
    assert cells.mass.sum() == pytest.approx(values.astype(np.float32).mean(), rel=1e-6)
    assert cells.area.sum() == pytest.approx(1.0)
    with pytest.raises(ValueError, match="read-only"):
        cells.corner[0] = 0.0


def test_no_dots_have_no_sides():
    cells = Tessellation.of(np.empty((0, 2)), box(0, 0, 1, 1))
    assert len(cells) == 0
    assert len(cells.corner) == 0
