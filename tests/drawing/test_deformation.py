"""Deformations, lines and patterns against their definitions."""

import itertools

import numpy as np
import pytest
import shapely
from scipy.interpolate import RBFInterpolator

from stippler.drawing.deformation import (
    MOST_PINS,
    UNIT_MATRIX,
    Cage,
    Deformation,
    before_fold,
    between,
    onto,
)
from stippler.drawing.line import Line
from stippler.drawing.pattern import MOST_COPIES, Pattern, PolygonSet
from stippler.drawing.planar.path import Path
from stippler.errors import GeometryError, ParameterError

BOX = (0.0, 0.0, 20.0, 10.0)
SOME = np.array([(1.0, 1.0), (4.0, 9.0), (10.5, 5.5), (19.0, 2.0)])


def bent(by=1.5, which=5):
    cage = Cage.over(BOX, 5, 6)
    x, y = cage.rest_mm()[which]
    return Deformation(cage=cage.moved({which: (x + by, y - by / 2)}))


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda: Cage((0, 0, 0, 5), 4, 4, ((0, 0),) * 16), "no extent"),
        (lambda: Cage((0, 5, 5, 5), 4, 4, ((0, 0),) * 16), "no extent"),
        (lambda: Cage((0, 0, np.inf, 5), 4, 4, ((0, 0),) * 16), "no extent"),
        (lambda: Cage.over(BOX, 3, 4), "needs 4 to 64"),
        (lambda: Cage.over(BOX, 4, 65), "needs 4 to 64"),
        (lambda: Cage(BOX, 4, 4, ((0, 0),) * 15), "another number"),
        (lambda: Cage(BOX, 4, 4, ((0, np.nan),) * 16), "not finite"),
        (lambda: Deformation((0.0,) * 9), "cannot be inverted"),
        (lambda: Deformation((1.0,) * 8), "cannot be inverted"),
        (lambda: Deformation((np.nan,) * 9), "cannot be inverted"),
        (lambda: Deformation(pins_mm=(((0, 0), (0, np.inf)),)), "not finite"),
        (
            lambda: Deformation(pins_mm=tuple(((k, 0), (k, 1)) for k in range(MOST_PINS + 1))),
            "more than",
        ),
        (lambda: Deformation(pins_mm=(((1, 2), (3, 4)), ((1, 2), (5, 6)))), "start at one place"),
        (lambda: onto(BOX, [(0, 0), (1, 1), (2, 2), (3, 3)]), "lie in line"),
        (
            lambda: Deformation((1, 0, 0, 0, 1, 0, -0.1, 0, 1)).apply([(11.0, 0.0)]),
            "beyond its horizon",
        ),
    ],
)
def test_refused(make, why):
    with pytest.raises(GeometryError, match=why):
        make()


def test_a_cage_takes_what_lies_on_a_control_point_along():
    cage = Cage.over(BOX, 5, 6)
    rng = np.random.default_rng(1)
    places = cage.rest_mm() + rng.normal(0, 0.3, (30, 2))
    moved = cage.moved({k: tuple(p) for k, p in enumerate(places)})
    assert np.allclose(moved.places_mm(), places)
    assert np.allclose(Deformation(cage=moved).apply(cage.rest_mm()), places, atol=1e-9)


def test_a_finer_cage_moves_the_control_points_as_the_coarse_one_did():
    coarse = bent()
    fine = coarse.cage.refined(9, 12)
    assert (fine.rows, fine.columns, fine.box_mm) == (9, 12, BOX)
    rest = Cage.over(BOX, 9, 12).rest_mm()
    assert np.allclose(Deformation(cage=fine).apply(rest), coarse.apply(rest), atol=1e-9)


PINS = (
    ((2.0, 2.0), (3.0, 2.5)),
    ((15.0, 3.0), (14.0, 4.0)),
    ((8.0, 9.0), (8.5, 8.0)),
    ((12.0, 6.0), (12.0, 6.0)),
)


def test_one_pin_moves_all():
    moved = Deformation(pins_mm=PINS[:1]).apply(SOME)
    assert np.allclose(moved, np.add(SOME, (1.0, 0.5)))


def test_two_pins_turn_and_scale_all():
    """The one similarity through both: as complex numbers, z goes to a z + b."""
    (a0, b0), (a1, b1) = [[complex(*p) for p in pin] for pin in PINS[:2]]
    factor = (b1 - b0) / (a1 - a0)
    z = SOME[:, 0] + 1j * SOME[:, 1]
    expected = b0 + factor * (z - a0)
    moved = Deformation(pins_mm=PINS[:2]).apply(SOME)
    assert np.allclose(moved[:, 0] + 1j * moved[:, 1], expected)


@pytest.mark.parametrize("n", [3, 4])
def test_more_pins_are_a_thin_plate(n):
    start, end = np.array(PINS[:n]).transpose(1, 0, 2)
    expected = RBFInterpolator(start, end, kernel="thin_plate_spline", degree=1)(SOME)
    assert np.allclose(Deformation(pins_mm=PINS[:n]).apply(SOME), expected)


def test_pins_in_line_still_meet_their_places():
    pins = tuple(((float(k), 2.0 * k), (k + 0.5, 2.0 * k - 0.25)) for k in range(5))
    made = Deformation(pins_mm=pins)
    assert np.allclose(made.apply([a for a, _ in pins]), [b for _, b in pins], atol=1e-6)


def test_the_way_back():
    matrix = onto(BOX, [(1, 1), (18, 2), (21, 11), (-1, 9)])
    made = Deformation(matrix, bent().cage, PINS)
    assert np.allclose(made.inverse_of(made.apply(SOME)), SOME, atol=1e-6)
    plain = Deformation(matrix)
    assert np.allclose(plain.inverse_of(plain.apply(SOME)), SOME, atol=1e-9)
    assert made.inverse_of(np.empty((0, 2))).shape == (0, 2)


def test_where_nothing_leads_to_there_is_no_way_back():
    """All is drawn onto a line: what lies beside it was nowhere."""
    flat = Cage.over(BOX)
    flat = flat.moved({k: (x, 5.0) for k, (x, _) in enumerate(flat.rest_mm())})
    found = Deformation(cage=flat).inverse_of([(5.0, 2.0)])
    assert np.isnan(found).all()


def test_the_corners_of_a_box_go_where_they_are_put():
    corners = [(1, 1), (18, 2), (21, 11), (-1, 9)]
    x0, y0, x1, y1 = BOX
    moved = Deformation(onto(BOX, corners)).apply([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    assert np.allclose(moved, corners)


def test_one_deformation_for_two_in_turn():
    first, second = bent(0.5), bent(-0.4, 11)
    both = first.followed_by(second, BOX, points=24)
    grid = np.array(list(itertools.product(np.linspace(1, 19, 12), np.linspace(1, 9, 8))))
    assert np.abs(both.apply(grid) - second.apply(first.apply(grid))).max() < 0.02
    one_move = Deformation((1, 0, 3, 0, 1, 0, 0, 0, 1)).followed_by(second, BOX)
    assert (one_move.cage.rows, one_move.cage.box_mm) == (9, BOX)
    assert one_move.matrix == (1, 0, 3, 0, 1, 0, 0, 0, 1)


def test_it_bends_just_short_of_folding():
    start, end = Deformation(cage=Cage.over(BOX, 5, 6)), bent(14.0, 7)
    assert len(end.folds(BOX))
    assert not len(start.folds(BOX))
    x0, y0, x1, y1 = BOX
    folds = end.folds(BOX)
    assert (folds >= (x0, y0)).all()
    assert (folds <= (x1, y1)).all()
    held = before_fold(start, end, BOX)
    assert not len(held.folds(BOX))
    share = held.cage.moves_mm[7][0] / end.cage.moves_mm[7][0]
    assert 0.05 < share < 1.0
    assert len(between(start, end, share + 0.01).folds(BOX))
    little = bent(0.2)
    assert before_fold(start, little, BOX) is little


def test_half_way_between_two():
    start = Deformation((1, 0, 2, 0, 1, 0, 0, 0, 1), None, (((0, 0), (2, 0)),))
    end = Deformation(
        (1, 0, 4, 0, 1, 2, 0, 0, 1), bent(2.0).cage, (((0, 0), (4, 0)), ((9, 0), (9, 4)))
    )
    half = between(start, end, 0.5)
    assert half.matrix == (1, 0, 3, 0, 1, 1, 0, 0, 1)
    assert half.pins_mm == (((0, 0), (3, 0)), ((9, 0), (9, 2)))
    assert half.cage.moves_mm[5] == (1.0, -0.5)
    assert between(end, end, 0.3) == end
    assert between(start, Deformation(), 1.0) == Deformation(UNIT_MATRIX)


def test_they_come_back_from_plain_values():
    for made in (
        Deformation(),
        bent(),
        Deformation(onto(BOX, [(1, 1), (18, 2), (21, 11), (-1, 9)]), pins_mm=PINS),
    ):
        assert Deformation.from_json(made.to_json()) == made


# --- lines --------------------------------------------------------------------------------------


def line(points=((0, 0), (10, 0), (10, 10)), **options):
    return Line("one", Path.polyline(points), **options)


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda: line(((0, 0),)), "no length"),
        (lambda: line(((0, 0), (0, 0))), "no length"),
        (lambda: line(width_mm=(0.1, -0.1)), "0 to 100 mm"),
        (lambda: line(width_mm=(0.1, 100.1)), "0 to 100 mm"),
        (lambda: line(reach_mm=np.nan), "0 to 100 mm"),
        (lambda: line(distance_mm=-1.0), "0 to 100 mm"),
        (lambda: line(meeting="jump"), "'jump' is unknown"),
        (lambda: line(colour="red"), "is no colour"),
    ],
)
def test_lines_that_are_none(make, why):
    with pytest.raises((GeometryError, ParameterError), match=why):
        make()
    assert line(width_mm=(0.0, 100.0)).width_mm == (0.0, 100.0)


def test_a_line_with_too_many_points_is_refused(monkeypatch):
    monkeypatch.setattr("stippler.drawing.line.MOST_VERTICES", 3)
    assert line().length_mm == 20.0
    with pytest.raises(GeometryError, match="more than 3 points"):
        line(((0, 0), (1, 0), (2, 0), (3, 1)))


def test_places_along_a_line_against_shapely():
    one = line()
    s = np.array([-1.0, 0.0, 3.0, 10.0, 14.5, 20.0, 99.0])
    shape = shapely.linestrings(one.path.points_mm)
    along = shapely.get_coordinates(shapely.line_interpolate_point(shape, np.clip(s, 0, 20)))
    assert np.allclose(one.at(s), along)
    assert one.directions(s).tolist() == [[1, 0], [1, 0], [1, 0], [0, 1], [0, 1], [0, 1], [0, 1]]
    ring = line(((0, 0), (10, 0), (10, 10), (0, 0)))
    around = np.array([-1.0, ring.length_mm + 3.0])
    assert np.allclose(ring.at(around), ring.at(np.array([ring.length_mm - 1.0, 3.0])))
    assert np.allclose(ring.directions(around)[1], (1, 0))


def test_a_tapered_line_is_the_hull_of_its_discs():
    one = line(((0, 0), (10, 0)), width_mm=(4.0, 2.0))
    assert one.half_widths().tolist() == [2.0, 1.0]
    x, y = np.random.default_rng(0).uniform(-3, 13, (2, 4000))
    # a round cone: the least over t of |p - t| - w(t)
    t = np.linspace(0, 10, 2001)
    depth = (np.hypot(x[:, None] - t, y[:, None]) - (2.0 - 0.1 * t)).min(axis=1)
    inside = shapely.contains_xy(one.outline(), x, y)
    sure = np.abs(depth) > 0.02
    assert np.array_equal(inside[sure], depth[sure] < 0)


def test_the_edges_of_a_line_keep_half_its_width():
    assert line(width_mm=(0.0, 0.0)).edges() == (line(width_mm=(0.0, 0.0)),)
    sides = line(((0, 0), (10, 0)), width_mm=(4.0, 2.0)).edges()
    assert [s.path.points_mm.tolist() for s in sides] == [
        [[0, 2], [10, 1]], [[0, -2], [10, -1]],
    ]  # fmt: skip
    assert all(s.width_mm == (0.0, 0.0) for s in sides)
    square = ((0, 0), (20, 0), (20, 20), (0, 20), (0, 0))
    rings = line(square, width_mm=(2.0, 2.0)).edges()
    assert [r.is_closed for r in rings] == [True, True]
    boxes = sorted(shapely.linestrings(r.path.points_mm).bounds for r in rings)
    assert boxes == [
        pytest.approx((-1, -1, 21, 21), abs=1e-3), pytest.approx((1, 1, 19, 19), abs=1e-3)
    ]  # fmt: skip


def test_two_closed_lines_apart_have_rings_of_their_own():
    """A closed line that tapers to nothing falls into pieces where its ink is none."""
    one = line(((0, 0), (20, 0), (20, 20), (0, 0)), width_mm=(2.0, 2.0))
    assert len(one.edges()) == 2


def test_ink_is_what_is_printed_seen_and_wide():
    assert line().is_inked
    assert not line(printed=False).is_inked
    assert not line(hidden=True).is_inked
    assert not line(width_mm=(0.0, 0.0)).is_inked
    assert line(width_mm=(0.0, 0.1)).is_inked


# --- patterns -----------------------------------------------------------------------------------


def triangle():
    return PolygonSet.of("t", [np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])], finest=9.0)


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda: PolygonSet.of("none", []), "has 0 polygons"),
        (lambda: PolygonSet("p", np.zeros((2, 2)), np.array([0, 2])), "polygons that are none"),
        (lambda: PolygonSet("p", np.full((3, 2), np.nan), np.array([0, 3])), "that are none"),
        (lambda: PolygonSet.from_json({"name": "p", "corners": [], "start": []}), "damaged"),
        (
            lambda: PolygonSet.from_json({"name": "p", "corners": [0] * 6, "start": [1, 3]}),
            "damaged",
        ),
        (
            lambda: PolygonSet.from_json({"name": "p", "corners": [0] * 6, "start": [0, 4]}),
            "damaged",
        ),
        (
            lambda: PolygonSet.from_json({"name": "p", "corners": [0] * 8, "start": [0, 2, 4]}),
            "damaged",
        ),
        (lambda: Pattern(0, triangle(), columns=0), "copies are possible"),
        (lambda: Pattern(0, triangle(), rows=MOST_COPIES + 1), "copies are possible"),
        (lambda: Pattern(0, triangle(), between="lost"), "'lost' is unknown"),
        (lambda: Pattern.over(0, triangle(), BOX, 0.0), "is no size"),
        (lambda: Pattern.over(0, triangle(), BOX, np.inf), "is no size"),
    ],
)
def test_patterns_that_are_none(make, why):
    with pytest.raises((GeometryError, ParameterError), match=why):
        make()


def test_patterns_of_too_many_polygons_are_refused(monkeypatch):
    monkeypatch.setattr("stippler.drawing.pattern.MOST_POLYGONS", 6)
    assert Pattern(0, triangle(), 3, 2).rows == 2
    with pytest.raises(ParameterError, match="more than 6 polygons"):
        Pattern(0, triangle(), 7, 1)


def test_long_edges_get_vertices_unless_there_would_be_too_many():
    ring = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    fine = PolygonSet.of("t", [ring], finest=0.25)
    assert len(fine.corners) == 4 + 6 + 4
    expected = shapely.Polygon(ring).segmentize(0.25).exterior.coords[:-1]
    assert np.allclose(fine.corners, expected)
    assert len(PolygonSet.of("t", [ring], finest=1e-4).corners) == 3


def test_copies_lie_side_by_side():
    corners, start = triangle().repeated(2, 2)
    assert start.tolist() == [0, 3, 6, 9, 12]
    assert corners[::3].tolist() == [[0, 0], [1, 0], [0, 1], [1, 1]]
    made = Pattern.over(1, triangle(), BOX, 5.0)
    assert (made.columns, made.rows) == (6, 4)
    rings, _ = made.rings_mm()
    assert rings.min(axis=0).tolist() == [-5.0, -5.0]
    assert rings.max(axis=0).tolist() == [25.0, 15.0]


def test_sets_of_polygons_are_equal_by_what_they_hold():
    assert triangle() == triangle()
    assert hash(triangle()) == hash(triangle())
    assert triangle() != PolygonSet.of("u", triangle().rings(), finest=9.0)
    assert triangle() != 5
    with pytest.raises(ValueError, match="read-only"):
        triangle().corners[0] = 1.0
