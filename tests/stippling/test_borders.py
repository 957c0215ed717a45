"""Automatic, wall, through and bleed: what borders are to the dots of an area."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import KDTree
from shapely.geometry import LineString, Point, Polygon, box

import stippler
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import ParameterError
from stippler.jobs.processing import process_now, tasks_of
from stippler.kernels.machine import pool
from stippler.stippling.borders import Borders
from stippler.stippling.pipeline import run
from stippler.stippling.task import Task
from tests.conftest import EXAMPLES

W, H = 60.0, 40.0
LEFT, RIGHT = box(0, 0, 25, H), box(25, 0, W, H)
RING = Point(30, 20).buffer(14).difference(Point(33, 20).buffer(6))


def picture() -> Reference:
    x = np.linspace(0.25, 0.5, 480, dtype=np.float32)
    return Reference(np.tile(x, (320, 1)), W)


def drawn(part: Polygon | None, border: str, n_dots: int = 1500, **style):
    parts = () if part is None else (part,)
    task = Task(Style(n_dots=n_dots, border=border, **style), picture(), parts_mm=parts)
    *_, made = run(task, snapshots=False)
    return made.position_mm, made.radius_mm.astype(np.float64)


def inked(at, radius, within) -> float:
    """Return the exact share of a place that discs cover."""
    near = shapely.dwithin(shapely.points(at), within, radius)
    discs = shapely.buffer(shapely.points(at[near]), radius[near] * 1.0004, quad_segs=32)
    return shapely.disjoint_subset_union_all(discs).intersection(within).area / within.area


def asked(within) -> float:
    """Return the darkness that `picture` has in a place, by its middle: it grows evenly."""
    return 0.25 + 0.25 * (within.centroid.x / W)


def split(border: str, n_dots: int = 3000) -> Document:
    """A page of which an area takes the right part; both have one style."""
    nothing = np.empty((0, 2)), np.empty(0, np.float32)
    style = Style(n_dots=n_dots, border=border, iterations=12)
    drawing = Drawing.from_reference(picture(), *nothing, style)
    drawing.areas[1] = Area("right", RIGHT, 0)
    return Document(drawing)


def test_only_the_edge_of_the_page_bleeds_by_itself():
    borders = Borders.of(box(0, 0, 12, 10), "automatic", (40.0, 30.0))
    assert borders.grown(3.0).equals(box(-3, -3, 12, 10))
    right = Borders.of(Polygon([(30, 5), (40, 5), (40, 25), (35, 25)]), "automatic", (40.0, 30.0))
    assert right.grown(2.0).symmetric_difference(
        right.outline.union(box(40, 5, 42, 25))
    ).area < 1e-9  # fmt: skip
    assert Borders.of(box(5, 5, 12, 10), "automatic", (40.0, 30.0)).bleeding == ()
    assert Borders.of(box(0, 0, 12, 10), "wall", (40.0, 30.0)).bleeding == ()
    all_of_it = Borders.of(box(5, 5, 12, 10), "bleed", (40.0, 30.0))
    assert all_of_it.grown(2.0).equals(box(3, 3, 14, 12))


@pytest.mark.parametrize("border", ["automatic", "wall", "bleed"])
@pytest.mark.parametrize("part", [LEFT, RING, Polygon([(0, 0), (40, 0), (12, 40), (0, 40)])])
def test_ink_of_an_area_is_what_it_asks_for(part, border):
    at, radius = drawn(part, border)
    assert len(at) == 1500
    assert shapely.intersects_xy(part, *at.T).all()
    assert inked(at, radius, part) == pytest.approx(asked(part), rel=0.005)


@pytest.mark.parametrize("border", ["automatic", "wall", "through", "bleed"])
def test_thirty_dots_meet_the_tone(border):
    part = Polygon([(0, 5), (20, 0), (22, 19), (3, 24)])
    at, radius = drawn(part, border, 30)
    assert inked(at, radius, part) == pytest.approx(asked(part), rel=0.005)


def unevenness(line, at, radius) -> float:
    """Return how far the ink along a line is off the tone, seen from two spacings."""
    step, spacing = 0.02, np.sqrt(W * H / 3000)
    n = int(line.length / step)
    xy = shapely.get_coordinates(shapely.line_interpolate_point(line, np.arange(n) * step))
    far, which = KDTree(at).query(xy, 6)
    off = (far < radius[which]).any(axis=1) - (0.25 + 0.25 * xy[:, 0] / W)
    seen = gaussian_filter1d(off, 2 * spacing / step, mode="nearest")
    return float(np.sqrt(np.mean(np.square(seen))))


def test_the_rim_of_an_area_is_that_of_the_page():
    depth = 0.05
    left, top = LineString([(depth, 0), (depth, H)]), LineString([(0, depth), (W, depth)])
    page = drawn(None, "automatic", 3000)
    whole = drawn(box(0, 0, W, H), "automatic", 3000)
    wall = drawn(box(0, 0, W, H), "wall", 3000)
    for line in (left, top):
        off = [unevenness(line, *dots) for dots in (page, whole, wall)]
        assert max(off[:2]) < 0.1
        assert off[2] > 0.2


@pytest.mark.parametrize("part", [RING, Polygon([(5, 5), (50, 10), (30, 38)])])
def test_the_rim_is_as_dark_as_the_tone_along_any_line_that_bleeds(part):
    line = part.buffer(-0.05).exterior
    off = [unevenness(line, *drawn(part, b, 2000)) for b in ("bleed", "wall")]
    assert off[0] < 0.1
    assert off[1] > 0.2


def test_ink_within_two_spacings_of_a_wall_is_right():
    spacing = np.sqrt(LEFT.area / 1500)
    for border in ("wall", "automatic"):
        strip = box(25 - 2 * spacing, 0, 25, H)
        assert inked(*drawn(LEFT, border), strip) == pytest.approx(asked(strip), rel=0.02)


def test_neighbours_that_see_through_are_drawn_as_one_page():
    document = split("through")
    (task,) = tasks_of(document, [0, 1])[0]
    assert task.areas == (0, 1)
    assert not process_now(document, [0, 1])
    dots = document.dots
    np.testing.assert_array_equal(document.partition.area_at(dots.position_mm), dots.area)
    *_, page = run(Task(document.drawing.styles[0], picture()), snapshots=False)
    order, expected = (np.lexsort(at.T) for at in (dots.position_mm, page.position_mm))
    np.testing.assert_array_equal(dots.position_mm[order], page.position_mm[expected])
    np.testing.assert_array_equal(dots.radius_mm[order], page.radius_mm[expected])


def test_no_seam_where_areas_see_through():
    """Dots line up along a wall: just beside it there are hardly any. Through it there are."""
    beside = {}
    for border in ("wall", "automatic", "through"):
        document = split(border)
        process_now(document, [0, 1])
        at = document.dots.position_mm
        spacing = np.sqrt(W * H / len(at))
        near = np.abs(at[:, 0] - 25.0) < 0.25 * spacing
        beside[border] = np.count_nonzero(near) / (0.5 * spacing * H) * spacing**2
    assert beside["wall"] < 0.2
    assert beside["automatic"] < 0.2
    assert beside["through"] == pytest.approx(1.0, abs=0.35)


def test_only_like_areas_that_touch_see_through():
    document = split("through")
    drawing = document.drawing
    drawing.styles[1] = Style(n_dots=700, border="through")
    drawing.areas[2] = Area("other style", box(50, 0, 60, 10), 1)
    drawing.areas[3] = Area("apart", box(52, 4, 58, 8), 0)
    drawing.areas[4] = Area("corner", box(48, 10, 50, 12), 1)
    groups = [task.areas for task in tasks_of(Document(drawing), [3, 1, 2, 4, 0])[0]]
    assert groups == [(3,), (1, 0), (2,), (4,)]


def test_the_border_of_an_area_counts_before_its_styles():
    drawing = split("automatic").drawing
    drawing.areas[1] = Area("right", RIGHT, 0, border="wall")
    assert [drawing.border_of(k) for k in (0, 1)] == ["automatic", "wall"]
    tasks = tasks_of(Document(drawing), [0, 1])[0]
    assert [task.task.style.border for task in tasks] == ["automatic", "wall"]
    for k in (0, 1):
        drawing.areas[k] = replace(drawing.areas[k], border="through")
    assert [task.areas for task in tasks_of(Document(drawing), [0, 1])[0]] == [(0, 1)]
    with pytest.raises(ParameterError, match="of automatic, wall, through, bleed"):
        Area("right", RIGHT, border="open")


def test_a_border_given_to_process_is_the_areas_own():
    drawing = stippler.process(split("automatic", 1500).drawing, [0, 1])
    one = stippler.process(drawing, "right", border="bleed", iterations=3)
    assert (one.areas[1].border, one.areas[0].border) == ("bleed", "")
    assert one.style_of(1).iterations == 3
    two = stippler.process(drawing, "right", border="wall")
    assert (two.areas[1].style, two.border_of(1)) == (0, "wall")
    edge = [np.count_nonzero(d.dots.position_mm[:, 0] > W - 0.2) for d in (drawing, one, two)]
    assert edge[2] == 0 < min(edge[:2])


@pytest.mark.parametrize("border", ["automatic", "bleed"])
def test_any_number_of_threads_gives_the_same_dots(border):
    found, before = [], pool.n_threads()
    try:
        for n in (1, 3):
            pool.set_threads(n)
            found.append(drawn(LEFT, border, iterations=5))
    finally:
        pool.set_threads(before)
    np.testing.assert_array_equal(found[0][0], found[1][0])
    np.testing.assert_array_equal(found[0][1], found[1][1])


@settings(max_examples=20 * EXAMPLES, deadline=None)
@given(st.integers(0, 10_000), st.integers(0, 250))
def test_trimmed_dots_are_the_areas_own(seed, n_wanted):
    rng = np.random.default_rng(seed)
    turn = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    reach = rng.uniform(4, 9, 12)
    area = Polygon(np.column_stack([np.cos(turn), np.sin(turn)]) * reach[:, None])
    borders = Borders.of(area, "bleed", (100.0, 100.0))
    dots = rng.uniform(-10, 10, (300, 2))
    kept, places = borders.trimmed(dots, np.full(300, 1.0), n_wanted)
    places = places[kept]
    assert shapely.intersects_xy(area, *places.T).all()
    inside = shapely.intersects_xy(area, *dots.T)
    moved = np.hypot(*(places - dots[kept]).T)
    assert (moved[inside[kept]] == 0.0).all()
    assert (moved <= 2.0 + 1e-9).all()
    n_near = np.count_nonzero(shapely.distance(area, shapely.points(dots[~inside])) <= 2.0)
    assert len(kept) == min(n_wanted, np.count_nonzero(inside) + n_near)


R = np.sqrt(0.4 * 0.81 / np.pi)
"""Of dots 0.9 mm apart that lay down a darkness of 0.4."""


def test_ink_along_any_line_meets_the_tone():
    area = Point(30, 14).buffer(11, 64)
    within = area.buffer(-0.15 * R).exterior
    borders = Borders.of(area, "bleed", (100.0, 100.0))
    rng = np.random.default_rng(1)
    grid = np.stack(np.meshgrid(np.arange(-2, 60, 0.9), np.arange(-12, 60, 0.9)), -1).reshape(-1, 2)
    dots = grid + rng.normal(0, 0.15, grid.shape)
    kept, places = borders.trimmed(dots, np.full(len(dots), R))
    places, radius = places[kept], np.full(len(kept), R)
    line = LineString(area.exterior)

    def error(at):
        """Return how far the ink is off 0.4 just inside the line, seen from two spacings."""
        xy = shapely.get_coordinates(shapely.line_interpolate_point(within, np.arange(0, 50, 0.05)))
        far = KDTree(at).query(xy)[0]
        return np.sqrt(np.mean(np.square(gaussian_filter1d((far < R) - 0.4, 36, mode="wrap"))))

    before = error(places)
    for give in (0.6, 0.3, 0.2):
        after = borders.rim_evened(places, radius, lambda p: np.full(len(p), 0.4), give)
        moved = np.hypot(*(after - places).T)
        assert moved.max() <= give * R + 1e-6
        assert shapely.intersects_xy(area, *after.T).all()
        assert (moved[shapely.distance(line, shapely.points(places)) > 2.0] == 0.0).all()
        places = after
    assert error(places) < 0.6 * before
