"""Pieces of borders that are walls, bleed, or are seen through, beside others that are not."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import affinity
from shapely.geometry import LineString, MultiLineString, Polygon, box

from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Partition
from stippler.drawing.planar import edits
from stippler.drawing.planar.edits import Outcome
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.policies import with_policy
from stippler.drawing.style import Style
from stippler.jobs.processing import process_now, tasks_of
from stippler.kernels.machine import pool
from stippler.stippling.border_policies import BorderPolicies, pieces_of, with_slits
from stippler.stippling.borders import Borders, strips_beyond
from stippler.stippling.pipeline import run
from stippler.stippling.scale import Scaling, scaled_drawing
from stippler.stippling.task import Task
from tests.conftest import EXAMPLES
from tests.stippling.test_borders import H, W, asked, inked, picture, unevenness

SPACING = np.sqrt(W * H / 3000)


def parted(low: str, high: str, border: str = "automatic") -> Document:
    """A page parted at x = 25; the border says one thing down to y = 20, and another below."""
    nothing = np.empty((0, 2)), np.empty(0, np.float32)
    style = Style(n_dots=3000, border=border, iterations=12)
    document = Document(Drawing.from_reference(picture(), *nothing, style))
    right = Path.polyline([(25, 0), (W, 0), (W, H), (25, H), (25, 20)], closed=True)
    edit_areas(document, "Draw", lambda m: edits.add(m, right), names={1: "right"})
    ((k, arc),) = (
        (k, a) for k, a in document.drawing.borders.items() if {a.left, a.right} == {0, 1}
    )
    assert len(arc.path) == 3
    said = (low, high) if arc.start[1] == 0 else (high, low)
    runs = [(i, i + 1, policy) for i, policy in enumerate(said)]
    edit_areas(document, "Border", lambda m: Outcome(with_policy(m, {k: runs})))
    return document


def beside(at, y0, y1) -> float:
    """Return how many dots lie next to the line x = 25, of those that an even page has there."""
    mine = at[(at[:, 1] > y0) & (at[:, 1] < y1)]
    n = np.count_nonzero(np.abs(mine[:, 0] - 25.0) < 0.25 * SPACING)
    return n / (0.5 * SPACING * (y1 - y0)) * SPACING**2


def test_one_arc_through_and_the_rest_walls():
    document = parted("through", "")
    (task,) = tasks_of(document, [0, 1])[0]
    assert task.areas == (0, 1)
    process_now(document, [0, 1])
    dots = document.dots
    at, radius = dots.position_mm, dots.radius_mm.astype(float)
    np.testing.assert_array_equal(document.partition.area_at(at), dots.area)
    assert beside(at, 0, 19) == pytest.approx(1.0, abs=0.45)
    assert beside(at, 21, 40) < 0.25
    for part in (box(0, 20, 25, H), box(25, 20, W, H), box(0, 0, W, 20)):
        assert inked(at, radius, part) == pytest.approx(asked(part), rel=0.02)
    assert inked(at, radius, box(0, 0, W, H)) == pytest.approx(0.375, rel=0.005)


def test_a_wall_in_what_sees_through_else():
    document = parted("wall", "", "through")
    (task,) = tasks_of(document, [1, 0])[0]
    process_now(document, [1, 0])
    at = document.dots.position_mm
    assert beside(at, 0, 19) < 0.25
    assert beside(at, 21, 40) == pytest.approx(1.0, abs=0.45)
    whole = task.task.parts_mm[0]
    assert whole.area == pytest.approx(W * H, rel=1e-5)
    assert shapely.intersects_xy(whole, *at.T).all()


def test_an_automatic_piece_of_a_wall_runs_off_the_page():
    document = parted("", "", "wall")
    ((k, arc),) = ((k, a) for k, a in document.drawing.borders.items() if a.start != a.end
                   and {a.left, a.right} == {1, -1})  # fmt: skip
    at = arc.path.points_mm
    i = next(i for i in range(len(at) - 1) if at[i, 0] == at[i + 1, 0] == W)
    edit_areas(
        document, "Border", lambda m: Outcome(with_policy(m, {k: [(i, i + 1, "automatic")]}))
    )
    process_now(document, [1])
    dots = document.dots
    at, radius = dots.position_mm, dots.radius_mm.astype(float)
    edge, top = LineString([(W - 0.05, 1), (W - 0.05, H - 1)]), LineString([(26, 0.05), (59, 0.05)])
    assert unevenness(edge, at, radius) < 0.1 < 0.2 < unevenness(top, at, radius)
    assert inked(at, radius, box(25, 0, W, H)) == pytest.approx(asked(box(25, 0, W, H)), rel=0.005)


def test_pieces_are_scaled_with_the_drawing():
    document = parted("through", "bleed")
    process_now(document, [0, 1])
    before = dict(pieces_of(document.drawing))
    scaled = scaled_drawing(document.drawing, Scaling(0.731))
    after = dict(pieces_of(scaled))
    assert before.keys() == after.keys() == {"through", "bleed"}
    for policy, line in before.items():
        there = affinity.scale(line, 0.731, 0.731, origin=(0, 0))
        assert there.hausdorff_distance(after[policy]) < 3e-4
    partition = Partition(scaled.outlines())
    assert BorderPolicies(scaled, partition).linked([0, 1]) == [(0, 1)]
    np.testing.assert_array_equal(partition.area_at(scaled.dots.position_mm), scaled.dots.area)


TRIANGLE = Polygon([(5, 5), (50, 10), (30, 38)])
SLANT = MultiLineString([[(50, 10), (30, 38)]])


def drawn(part, border, pieces, n_dots=2000, **style):
    task = Task(
        Style(n_dots=n_dots, border=border, **style), picture(), parts_mm=(part,), pieces_mm=pieces
    )
    *_, made = run(task, snapshots=False)
    return made.position_mm, made.radius_mm.astype(float)


@pytest.mark.parametrize("border", ["automatic", "bleed"])
def test_one_side_of_a_triangle_bleeds_or_does_not(border):
    own = "bleed" if border == "automatic" else "wall"
    at, radius = drawn(TRIANGLE, border, ((own, SLANT),))
    assert len(at) == 2000
    assert shapely.intersects_xy(TRIANGLE, *at.T).all()
    assert inked(at, radius, TRIANGLE) == pytest.approx(asked(TRIANGLE), rel=0.005)
    inner = TRIANGLE.buffer(-0.05).exterior
    sides = [LineString(p) for p in zip(inner.coords[:-1], inner.coords[1:], strict=True)]
    slant = max(sides, key=lambda side: -shapely.distance(side.centroid, SLANT))
    others = [side for side in sides if side is not slant]
    off, rest = unevenness(slant, at, radius), [unevenness(s, at, radius) for s in others]
    if border == "automatic":
        assert off < 0.1
        assert min(rest) > 0.2
    else:
        assert off > 0.2
        assert max(rest) < 0.1


def test_thirty_dots_with_pieces_meet_the_tone():
    part = Polygon([(0, 5), (20, 0), (22, 19), (3, 24)])
    at, radius = drawn(part, "wall", (("bleed", MultiLineString([[(20, 0), (22, 19)]])),), 30)
    assert inked(at, radius, part) == pytest.approx(asked(part), rel=0.005)


def test_any_number_of_threads_gives_the_same_dots():
    found, before = [], pool.n_threads()
    try:
        for n in (1, 3):
            pool.set_threads(n)
            document = parted("through", "bleed")
            process_now(document, [0, 1])
            found.append(document.dots.position_mm.copy())
    finally:
        pool.set_threads(before)
    np.testing.assert_array_equal(*found)


def test_who_is_drawn_as_one():
    document = parted("through", "wall")
    drawing = document.drawing

    def groups():
        return BorderPolicies(drawing, document.partition).joined([0, 1])

    assert groups() == [(0, 1)]
    drawing.styles[1] = Style(n_dots=500)
    drawing.areas[1] = replace(drawing.areas[1], style=1)
    assert groups() == [(0,), (1,)]
    drawing.areas[1] = replace(drawing.areas[1], style=0)
    assert groups() == [(0, 1)]
    again = parted("wall", "wall", "through")
    assert BorderPolicies(again.drawing, again.partition).joined([0, 1]) == [(0,), (1,)]


def along(document):
    """Return how uneven ink is along the line's lower half, and how many dots lie beside it."""
    at, radius = document.dots.position_mm, document.dots.radius_mm.astype(float)
    lines = [LineString([(x, 21), (x, 39)]) for x in (24.95, 25.05)]
    return max(unevenness(line, at, radius) for line in lines), beside(at, 21, 39)


def test_a_piece_that_bleeds_does_so_between_areas_that_see_through_beside_it():
    """As where each area is drawn by itself: dots of both run off the line, none line up."""
    for high in ("", "wall", "bleed"):
        document = parted("through", high)
        process_now(document, [0, 1])
        dots = document.dots
        at, radius = dots.position_mm, dots.radius_mm.astype(float)
        np.testing.assert_array_equal(document.partition.area_at(at), dots.area)
        assert beside(at, 1, 19) == pytest.approx(1.0, abs=0.3)
        for part in (box(0, 0, 25, H), box(25, 0, W, H)):
            assert inked(at, radius, part) == pytest.approx(asked(part), rel=0.005)
        assert len(at) == pytest.approx(3000, rel=0.005)
        off, near = along(document)
        if high == "bleed":
            assert off < 0.2
            assert near > 0.6
            for one in (1, 0):
                process_now(document, [one])
                assert along(document)[0] < 0.2
        else:
            assert off > 0.2
            assert near < 0.25


def test_areas_between_which_a_border_bleeds_are_not_drawn_as_one():
    def groups(*said, drawn=True):
        document = parted(*said)
        return BorderPolicies(document.drawing, document.partition).joined([0, 1], drawn=drawn)

    assert groups("through", "") == groups("through", "wall") == [(0, 1)]
    assert groups("through", "bleed") == groups("through", "", "bleed") == [(0,), (1,)]
    assert groups("through", "bleed", drawn=False) == [(0, 1)]
    assert groups("bleed", "", "through") == [(0,), (1,)]


@settings(max_examples=40 * EXAMPLES, deadline=None)
@given(st.integers(0, 10_000))
def test_strips_lie_beyond_pieces_and_nowhere_else(seed):
    rng = np.random.default_rng(seed)
    turn = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    reach = rng.uniform(4, 9, 12)
    corners = np.column_stack([np.cos(turn), np.sin(turn)]) * reach[:, None] + 50
    area = Polygon(corners)
    i, n = int(rng.integers(12)), int(rng.integers(1, 6))
    line = LineString(np.roll(corners, -i, axis=0)[: n + 1])
    borders = Borders.of(area, "wall", (100.0, 100.0), (("bleed", MultiLineString([line])),))
    (mine,) = borders.bleeding
    assert mine.equals(line)
    grown = borders.grown(1.0)
    assert grown.is_valid
    beyond = grown.difference(area)
    assert beyond.area == pytest.approx(
        sum(p.area for p in strips_beyond(line, area, 1.0)), rel=1e-6
    )
    for at in (0.3, 0.5, 0.8):
        foot = line.interpolate(at, normalized=True)
        assert beyond.distance(foot) < 1e-9
    spots = shapely.points(rng.uniform(38, 62, (200, 2)))
    inside = shapely.contains(beyond, spots)
    assert (shapely.distance(spots[inside], line) < 1.0 * 3.0).all()
    slits = with_slits(area, [MultiLineString([[(50, 50), tuple(corners[0])]])])
    assert area.area - slits.area < 1e-3
    assert not slits.covers(LineString([(50, 50), tuple(corners[0])]))
