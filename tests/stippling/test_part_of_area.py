"""Where dots may lie: polygons of patterns, what lines keep free; relaxation stays there."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.deformation import Cage, Deformation, onto
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.pattern import Pattern
from stippler.drawing.planar.moves import smooth_path
from stippler.drawing.planar.path import Path
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import GeometryError
from stippler.stippling.part_of_area import part_for_dots, zone_of
from stippler.stippling.patterns import builtin, cells_of
from stippler.stippling.patterns_of_picture import following
from stippler.stippling.pipeline import run
from stippler.stippling.tasks import relaxing, stippling

PAGE = Page(40.0, 30.0)


def drawing_with(pattern=None, *lines):
    drawing = Drawing.blank(PAGE, Style(n_dots=400, iterations=6))
    if pattern is not None:
        drawing.patterns = {3: pattern}
    drawing.lines = dict(enumerate(lines))
    return drawing


def ramp():
    return Reference(np.tile(np.linspace(0.2, 0.9, 80, dtype=np.float32), (60, 1)), 40.0)


def test_nothing_is_cut_where_nothing_cuts():
    drawing = drawing_with()
    whole = drawing.outlines()[0]
    assert part_for_dots(drawing, 0, whole) is whole
    far = Line("far", Path.polyline([(90, 90), (95, 95)]), meeting="distance")
    assert part_for_dots(drawing_with(None, far), 0, whole) is whole


@given(st.integers(0, 9999), st.floats(0.0, 1.5), st.floats(0.0, 1.5), st.floats(0.05, 2.0))
@settings(max_examples=25, deadline=None)
def test_no_place_of_a_zone_is_left_out_and_hardly_more_is_in(seed, start, end, distance):
    rng = np.random.default_rng(seed)
    path = smooth_path(Path.polyline(rng.random((5, 2)) * (40, 30)))
    line = Line("curve", path, (start, end), meeting="distance", distance_mm=distance)
    zone = zone_of(line)
    points = rng.random((600, 2)) * (40, 30)
    at, half = path.points_mm, line.half_widths()
    d = np.diff(at, axis=0)
    t = (((points[:, None] - at[:-1]) * d).sum(-1) / (d * d).sum(-1)).clip(0, 1)
    axis = np.hypot(*np.moveaxis(at[:-1] + t[..., None] * d - points[:, None], -1, 0))
    away = (axis - half[:-1] - t * np.diff(half)).min(axis=1)
    inside = shapely.contains_xy(zone, *points.T)
    assert inside[away < distance - 1e-6].all()
    assert not inside[away > distance + 0.02 * (distance + max(start, end)) + 0.01].any()


@pytest.mark.parametrize("between", ["free", "toned"])
def test_stippled_dots_lie_in_the_polygons_of_a_pattern(between):
    pattern = Pattern.over(0, builtin("hexagons"), (0, 0, 40, 30), 24.0, between=between)
    keep = Line("keep", Path.polyline([(5, 25), (35, 5)]), (1.0, 1.0), meeting="distance")
    drawing = drawing_with(pattern, keep)
    drawing.reference = ramp()
    *_, made = run(stippling(drawing, 0).task)
    assert len(made.position_mm) == 400
    cells = np.array(cells_of(drawing.outlines()[0], pattern).compartments, dtype=object)
    at = shapely.points(made.position_mm)
    tree = shapely.STRtree(cells)
    assert len(np.unique(tree.query(at, predicate="intersects")[0])) == 400
    axis = shapely.linestrings(keep.path.points_mm)
    assert shapely.distance(axis, at).min() >= 0.5 + keep.distance_mm - 1e-6
    again = list(run(stippling(drawing, 0).task))[-1]
    assert np.array_equal(again.position_mm, made.position_mm)


def test_relaxed_dots_stay_in_their_polygons():
    pattern = Pattern.over(0, builtin("cobbles"), (0, 0, 40, 30), 30.0)
    drawing = drawing_with(pattern)
    drawing.dots = Dots.round(np.random.default_rng(2).random((900, 2)) * (40, 30), 0.1)
    task, rows, _ = relaxing(drawing, Style(), 5)
    cells = cells_of(drawing.outlines()[0], pattern).polygons
    tree, before = shapely.STRtree(cells), drawing.dots.position_mm[rows]
    assert 300 < len(rows) < 900  # those between stay
    *_, made = run(task)
    was = dict(zip(*tree.query(shapely.points(before), predicate="intersects"), strict=True))
    now = dict(zip(*tree.query(shapely.points(made.position_mm), predicate="intersects"),
                   strict=True))  # fmt: skip
    assert was == now


@given(st.integers(0, 9999), st.integers(0, 3))
@settings(max_examples=20, deadline=None)
def test_an_inverse_leads_back(seed, n_pins):
    rng = np.random.default_rng(seed)
    cage = Cage.over((0, 0, 40, 30)).moved(
        {5: tuple(rng.normal((13.3, 10), 1.0)), 10: tuple(rng.normal((26.7, 20), 1.0))}
    )
    corners = np.array([(0, 0), (40, 0), (40, 30), (0, 30)]) + rng.normal(0, 2, (4, 2))
    pins = tuple(
        ((10.0 * k + 5, 9.0 * k + 4), (10.0 * k + 5.7, 9.0 * k + 4.4)) for k in range(n_pins)
    )
    bent = Deformation(onto((0, 0, 2, 2), corners), cage, pins)
    points = rng.random((200, 2)) * 2
    assert np.allclose(bent.inverse_of(bent.apply(points)), points, atol=1e-6)


@pytest.mark.parametrize("way", ["along", "across"])
def test_bands_follow_the_picture(way):
    part = shapely.box(2, 2, 38, 28)
    pattern = following(0, part, ramp(), 2.0, way)
    cells = cells_of(part, pattern)
    assert not cells.notes
    assert 0.4 * part.area < sum(p.area for p in cells.polygons) < 0.8 * part.area
    longest = max(cells.polygons, key=lambda p: p.area)
    x0, y0, x1, y1 = longest.bounds
    runs_down = y1 - y0 > 5 * (x1 - x0)  # tone grows to the right
    assert runs_down == (way == "along")
    flat = Reference(np.full((60, 80), 0.5, np.float32), 40.0)
    with pytest.raises(GeometryError, match="no slope"):
        following(0, part, flat, 2.0, way)


def test_bands_about_a_spot_are_rings_with_room_within():
    y, x = np.mgrid[0:60, 0:80]
    spot = np.exp(-((x - 40) ** 2 + (y - 30) ** 2) / 300.0)
    part = shapely.box(0, 0, 40, 30)
    pattern = following(0, part, Reference(spot.astype(np.float32), 40.0), 2.0, "along")
    cells = cells_of(part, pattern)
    assert not cells.notes
    assert max(p.area for p in cells.polygons) < 0.2 * part.area


@pytest.mark.parametrize(
    "corners",
    [[(5, 5), (35, 25), (35, 5), (5, 25)], [(0, 15), (40, 15)], [(-9, -9), (60, 50)]],
    ids=["a loop", "through a hole", "beyond the page"],
)
def test_odd_lines_cut_an_area_with_a_hole(corners):
    line = Line("odd", Path.polyline(corners), (0.5, 2.0), meeting="distance", distance_mm=0.4)
    drawing = drawing_with(None, line)
    area = shapely.box(0, 0, 40, 30).difference(shapely.Point(20, 15).buffer(5))
    part = part_for_dots(drawing, 0, area)
    assert part.is_valid
    assert part.within(area.buffer(1e-9))
    assert shapely.distance(part, shapely.linestrings(corners)) >= 0.25 + 0.4 - 1e-9
    assert part.area > 0.6 * area.area


def test_lines_that_leave_an_area_no_room_are_named():
    drawing = Drawing.blank(Page(20.0, 10.0))
    path = Path.polyline([(-5, 5), (25, 5)])
    drawing.lines = {0: Line("wide", path, (0.2, 0.2), meeting="distance", distance_mm=8.0)}
    with pytest.raises(GeometryError, match="leave it no room"):
        part_for_dots(drawing, 0, shapely.box(0, 0, 20, 10))
