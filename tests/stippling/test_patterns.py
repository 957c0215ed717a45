"""Patterns and what bends them: exactness, folds, clipping, bad sets."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from stippler.drawing.deformation import Cage, Deformation, before_fold, onto
from stippler.drawing.pattern import Pattern, PolygonSet
from stippler.errors import GeometryError, ParameterError
from stippler.kernels.machine.pool import set_threads
from stippler.stippling.patterns import builtin, builtin_names, cells_of, set_of_rings

BOX = (0.0, 0.0, 90.0, 60.0)


@given(st.integers(0, 10_000), st.integers(4, 7), st.integers(4, 9))
@settings(max_examples=10, deadline=None)
def test_a_cage_is_a_natural_spline_through_its_control_points(seed, rows, columns):
    rng = np.random.default_rng(seed)
    cage = Cage(BOX, rows, columns, tuple(map(tuple, rng.normal(0, 3, (rows * columns, 2)))))
    bent = Deformation(cage=cage)
    assert np.allclose(bent.apply(cage.rest_mm()), cage.places_mm(), atol=1e-9)
    moves = np.array(cage.moves_mm).reshape(rows, columns, 2)
    points = rng.random((50, 2)) * (90, 60)
    down = CubicSpline(np.linspace(0, 60, rows), moves, axis=0, bc_type="natural")
    for point, found in zip(points, bent.apply(points), strict=True):
        across = CubicSpline(np.linspace(0, 90, columns), down(point[1]), bc_type="natural")
        assert np.allclose(found - point, across(point[0]), atol=1e-9)


@given(st.integers(0, 10_000), st.integers(1, 12))
@settings(max_examples=10, deadline=None)
def test_pins_take_their_places_along(seed, n):
    rng = np.random.default_rng(seed)
    at, to = rng.random((n, 2)) * 80, rng.random((n, 2)) * 80
    pins = tuple((tuple(a), tuple(b)) for a, b in zip(at, to, strict=True))
    assert np.allclose(Deformation(pins_mm=pins).apply(at), to, atol=1e-6)


def test_a_homography_meets_its_corners():
    corners = [(10, 10), (80, 20), (70, 55), (5, 50)]
    bent = Deformation(onto(BOX, corners))
    assert np.allclose(bent.apply([(0, 0), (90, 0), (90, 60), (0, 60)]), corners)
    with pytest.raises(GeometryError, match="horizon"):
        Deformation((1, 0, 0, 0, 1, 0, 1, 0, -5)).apply([(1, 1)])


def test_folding_over_is_found_and_prevented():
    flat = Deformation(cage=Cage.over(BOX))
    gentle = Deformation(cage=Cage.over(BOX).moved({5: (36, 26)}))
    inside_out = Deformation(cage=Cage.over(BOX).moved({5: (85, 55)}))
    assert not len(flat.folds(BOX))
    assert not len(gentle.folds(BOX))
    assert len(inside_out.folds(BOX))
    held = before_fold(flat, inside_out, BOX)
    assert not len(held.folds(BOX))
    assert held.cage.places_mm()[5, 0] > 33
    mirrored = Deformation((-1, 0, 90, 0, 1, 0, 0, 0, 1))
    assert not len(mirrored.folds(BOX))


def test_a_finer_cage_moves_as_the_coarse_one_at_its_points():
    cage = Cage.over(BOX).moved({5: (36, 26), 10: (50, 44)})
    fine = cage.refined(7, 7)
    rest = fine.rest_mm()
    assert np.allclose(Deformation(cage=fine).apply(rest), Deformation(cage=cage).apply(rest))


@pytest.mark.parametrize("name", builtin_names())
def test_every_set_fills_an_area_without_overlap(name):
    outline = shapely.Point(40, 40).buffer(25).difference(shapely.Point(40, 40).buffer(8))
    cage = Cage.over((0, 0, 80, 80)).moved({5: (32, 30)})
    pattern = Pattern.over(1, builtin(name), (0, 0, 80, 80), 40, between="toned")
    pattern = replace(pattern, deformation=replace(pattern.deformation, cage=cage))
    found = cells_of(outline, pattern)
    assert cells_of(outline, Pattern.from_json(pattern.to_json())) is found
    cells = shapely.union_all(found.polygons)
    assert cells.area == pytest.approx(sum(p.area for p in found.polygons), rel=1e-6)
    assert cells.area > 0.4 * outline.area
    whole = shapely.union_all(found.compartments)
    assert whole.symmetric_difference(outline).area < 0.02 * outline.area
    assert all(p.is_valid and p.area > 0 for p in found.polygons)


def test_relaxation_keeps_dots_in_a_patterns_polygons():
    from stippler.stippling.initial_points import random_in
    from stippler.stippling.relax import Relaxation

    outline = shapely.box(0, 0, 60, 60)
    pattern = Pattern.over(1, builtin("cobbles"), outline.bounds, 40)
    cells = cells_of(outline, pattern).compartments
    dots = np.concatenate([random_in(p, max(2, round(p.area)), 3) for p in cells])
    owner = np.repeat(np.arange(len(cells)), [max(2, round(p.area)) for p in cells])
    engine = Relaxation(dots, cells, compartment_of_dot=owner)
    engine.run(6)
    polygons = np.array(cells, dtype=object)[owner]
    assert (shapely.distance(polygons, shapely.points(engine.points)) < 1e-9).all()


def test_bad_sets_are_refused_or_said():
    with pytest.raises(GeometryError):
        PolygonSet.of("none", [])
    with pytest.raises(GeometryError):
        set_of_rings("flat", [np.array([(0, 0), (1, 1), (2, 2)])])
    square = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    bow = square[[0, 2, 1, 3]] + np.array([[0, 0], [0, 0.4], [0, 0], [0, 0]])
    made, notes = set_of_rings("some", [square, square + 0.5, bow + 3, square[:2]])
    assert "1 paths" in notes[0]
    found = cells_of(shapely.box(0, 0, 50, 50), Pattern.over(1, made, (0, 0, 50, 50), 50))
    assert any("overlap" in note for note in found.notes)
    assert any("cross themselves" in note for note in found.notes)
    with pytest.raises(ParameterError, match="more than"):
        Pattern(1, builtin("hexagons"), 100, 100)
    with pytest.raises(GeometryError, match="does not meet"):
        cells_of(shapely.box(900, 900, 950, 950), Pattern.over(1, made, (0, 0, 50, 50), 50))


def test_many_polygons():
    pattern = Pattern.over(1, builtin("hexagons"), (0, 0, 100, 100), 3.2)
    assert len(pattern.polygons) * pattern.columns * pattern.rows > 90_000
    assert np.isfinite(pattern.rings_mm()[0]).all()


def test_any_number_of_threads_bends_alike():
    points = np.random.default_rng(0).random((60_000, 2)) * 60
    bent = Deformation(cage=Cage.over(BOX).moved({5: (36, 26)}))
    try:
        set_threads(1)
        one = bent.apply(points)
        set_threads(3)
        assert np.array_equal(one, bent.apply(points))
    finally:
        set_threads(0)
