"""Lines: distances kept, one-dimensional spacing, rows; bad lines."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.deformation import Deformation
from stippler.drawing.line import ADHERE, DISTANCE, Line
from stippler.drawing.line_index import LineIndex, keeping_distance
from stippler.drawing.planar.moves import smooth_path
from stippler.drawing.planar.path import Path
from stippler.errors import GeometryError, ParameterError
from stippler.stippling.lines import (
    border_lines,
    crossings,
    hatch_lines,
    row,
    spread,
    spread_all,
)


def curves(n, seed, **options):
    rng = np.random.default_rng(seed)
    out = []
    for k in range(n):
        at = rng.random(2) * 90 + np.cumsum(rng.normal(0, 3, (6, 2)), axis=0)
        path = smooth_path(Path.polyline(at, closed=k % 3 == 0))
        out.append(Line(f"curve {k}", path, (0.3, 0.3 * (k % 2)), **options))
    return out


def circle(r, **options):
    t = np.linspace(0, 2 * np.pi, 500)[:-1]
    ring = np.column_stack([50 + r * np.cos(t), 50 + r * np.sin(t)])
    return Line("circle", Path.polyline(ring, closed=True), **options)


STRAIGHT = Line("straight", Path.polyline([(10, 10), (90, 10)]), (0.0, 0.0))


@given(st.integers(0, 9999))
@settings(max_examples=15, deadline=None)
def test_the_nearest_line_is_shapelys(seed):
    lines = [Line(k.name, k.path, (0.0, 0.0)) for k in curves(6, seed)]
    points = np.random.default_rng(seed).random((300, 2)) * 100
    which, along, away = LineIndex(lines, 4.0).nearest(points)
    shapes = np.array([shapely.linestrings(k.path.points_mm) for k in lines])
    true = shapely.distance(shapes[:, None], shapely.points(points)[None])
    best = true.min(axis=0)
    near = best < 4.0
    assert np.allclose(away[near], best[near], atol=1e-9)
    assert (which[near] >= 0).all()
    for k in np.flatnonzero(near):
        foot = lines[which[k]].at(along[k : k + 1])[0]
        assert math.hypot(*(foot - points[k])) == pytest.approx(best[k], abs=1e-6)


@given(st.integers(0, 9999))
@settings(max_examples=15, deadline=None)
def test_distances_are_kept_to_a_millionth_of_a_mm(seed):
    lines = [Line(k.name, k.path, (0.4, 0.4), meeting=DISTANCE, distance_mm=0.5)
             for k in curves(5, seed)]  # fmt: skip
    points = np.random.default_rng(seed).random((400, 2)) * 100
    moved, held = keeping_distance(lines).keep_distance(points)
    shapes = [shapely.linestrings(k.path.points_mm) for k in lines]
    away = np.min([shapely.distance(s, shapely.points(moved)) for s in shapes], axis=0)
    assert (away[held] >= 0.7 - 1e-6).all()
    assert held.mean() > 0.95
    first = np.min([shapely.distance(s, shapely.points(points)) for s in shapes], axis=0)
    assert np.array_equal(moved[first > 0.7 + 1e-9], points[first > 0.7 + 1e-9])


class TestSpacing:
    @pytest.mark.parametrize("line", [STRAIGHT, circle(20), curves(2, 5)[1], curves(1, 5)[0]])
    def test_it_is_even_to_a_percent(self, line):
        n = 60
        along = np.sort(np.random.default_rng(1).random(n)) * line.length_mm
        found = np.sort(spread(line, along))
        gaps = np.diff(found)
        assert np.ptp(gaps) < 0.01 * gaps.mean()
        assert gaps.mean() == pytest.approx(line.length_mm / n, rel=1e-9)

    def test_tone_makes_it_denser(self):
        found = np.sort(spread(STRAIGHT, np.linspace(0, 80, 100), lambda p: p[:, 0] - 9.0))
        share = ((found + 1.0) ** 2 - 1) / (81.0**2 - 1)  # of the tone's integral
        assert np.allclose(share, (np.arange(100) + 0.5) / 100, atol=0.002)

    @given(st.integers(0, 9999), st.booleans())
    @settings(max_examples=40, deadline=None)
    def test_energy_never_rises(self, seed, closed):
        rng = np.random.default_rng(seed)
        line = circle(5) if closed else STRAIGHT
        length = line.length_mm
        at = np.sort(rng.random(int(rng.integers(2, 30)))) * length

        def energy(s):
            s = np.sort(s % length if closed else s)
            if closed:
                return (np.diff(np.r_[s, s[0] + length]) ** 3).sum() / 12
            inner = (np.diff(s) ** 3).sum() / 12
            return inner + (s[0] ** 3 + (length - s[-1]) ** 3) / 3

        before = energy(at)
        for share in (0.1, 0.3, 0.7, 1.0):
            at = spread(line, at, share=share)
            assert energy(at) <= before * (1 + 1e-9)
            before = energy(at)

    def test_fixed_dots_stay_and_part_the_line(self):
        along = np.array([3.0, 5.0, 20.0, 24.0, 60.0])
        found = spread(STRAIGHT, along, fixed=np.array([0, 0, 1, 0, 0], bool))
        assert found[2] == 20.0
        assert np.allclose(np.diff(found[:3]), np.diff(found[:3])[0])
        assert (found > 0).all()
        assert (np.diff(found) > 0).all()

    def test_one_dot_lies_in_a_crossing(self):
        other = Line("other", Path.polyline([(50, 0), (50, 40)]), (0.0, 0.0))
        assert len(crossings([STRAIGHT, other])) == 1
        line_of = np.repeat([0, 1], [40, 20])
        along = np.r_[np.linspace(0, 80, 40), np.linspace(0, 40, 20)]
        found, points = spread_all([STRAIGHT, other], line_of, along)
        far = np.hypot(*(points - (50, 10)).T)
        assert (far < 1e-9).sum() == 1
        assert np.sort(far)[1] > 1.0
        assert np.isfinite(found).all()


class TestAdhering:
    def test_moving_a_line_moves_what_adheres(self):
        line = circle(10, meeting=ADHERE)
        along = spread(line, np.linspace(0, line.length_mm, 20, endpoint=False))
        moved = line.deformed(Deformation((1, 0, 5, 0, 1, -3, 0, 0, 1)))
        assert np.allclose(moved.at(along), line.at(along) + np.array([5, -3]), atol=1e-3)


class TestRows:
    def test_along_a_line_by_number_or_distance(self):
        assert len(row(STRAIGHT, 16)) == 16
        dots = row(STRAIGHT, distance_mm=2.0)
        assert np.allclose(dots[:, 0], 10 + np.arange(40) * 2 + 1)
        with pytest.raises(ParameterError):
            row(STRAIGHT)
        with pytest.raises(ParameterError):
            row(STRAIGHT, distance_mm=math.nan)

    def test_along_both_edges(self):
        sides = Line("wide", STRAIGHT.path, (2.0, 0.0)).edges()
        y = np.sort([side.at(np.array([0.0]))[0, 1] for side in sides])
        assert np.allclose(y, [9, 11], atol=1e-3)
        assert len(circle(10, width_mm=(2.0, 2.0)).edges()) == 2

    def test_along_a_border(self):
        area = shapely.box(0, 0, 40, 30).difference(shapely.box(10, 10, 20, 20))
        for side, sign in (("inside", -1), ("outside", 1), ("on", 0)):
            for line in border_lines(area, side, 1.0):
                dots = shapely.points(row(line, distance_mm=1.0))
                away = shapely.distance(area.boundary, dots)
                assert np.allclose(away, abs(sign), atol=0.05)
                if sign:
                    assert (shapely.contains(area, dots) == (sign < 0)).all()
        with pytest.raises(GeometryError, match="too narrow"):
            border_lines(area, "inside", 30.0)

    def test_hatching_stays_inside(self):
        area = shapely.Point(50, 50).buffer(20).difference(shapely.Point(50, 50).buffer(5))
        for line in hatch_lines(area, 1.5, 0.7):
            dots = row(line, distance_mm=0.8)
            assert shapely.distance(area, shapely.points(dots)).max() < 1e-3


class TestInk:
    def test_the_outline_is_what_a_round_pen_draws(self):
        line = Line("tapered", Path.polyline([(10, 10), (30, 10), (30, 30)]), (4.0, 1.0))
        ink = line.outline()
        assert ink.is_valid
        assert ink.bounds[0] == pytest.approx(8.0, abs=0.01)
        assert ink.bounds[3] == pytest.approx(30.5, abs=0.01)
        even = Line("even", line.path, (2.0, 2.0)).outline()
        assert even.area == pytest.approx(40 * 2 + np.pi, abs=0.3)


@pytest.mark.parametrize("points", [[(1, 1)], [(1, 1), (1, 1)], [(0, 0), (1e-9, 0)]])
def test_lines_without_length_are_refused(points):
    with pytest.raises(GeometryError, match="no length"):
        Line("none", Path.polyline(points))


def test_a_line_of_a_hundred_thousand_points():
    x = np.linspace(0, 200, 100_000)
    line = Line("long", Path.polyline(np.column_stack([x, 20 + np.sin(x)])), (0.1, 0.1))
    assert len(row(line, 5000)) == 5000
    which, _, away = LineIndex([line], 1.0).nearest(np.array([(100.0, 20.0), (100.0, 90.0)]))
    assert which.tolist() == [0, -1]
    assert away[1] == math.inf


def test_values_survive_json():
    for line in curves(4, 9):
        assert Line.from_json(line.to_json()) == line


def test_no_lines_are_no_trouble():
    empty = LineIndex([], 1.0)
    assert empty.nearest(np.ones((3, 2)))[0].tolist() == [-1, -1, -1]
    assert empty.keep_distance(np.ones((3, 2)))[1].all()
