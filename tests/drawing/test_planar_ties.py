"""Borders at their ties: tangents, boxes that touch, segments on each other, curves run back."""

import numpy as np
import pytest
import shapely

from stippler.drawing.planar import edits, moves, nodes, overlay
from stippler.drawing.planar.assemble import _runs, _same
from stippler.drawing.planar.borders import Snap, trace
from stippler.drawing.planar.moves import _doubled
from stippler.drawing.planar.overlay import meets
from stippler.drawing.planar.path import (
    UNIT_MM,
    Curve,
    Path,
    on_cubic,
    path_of_cubics,
    pieces_of,
    with_handles,
)
from stippler.drawing.planar.planar_map import PAGE, Arc, PlanarMap
from stippler.drawing.planar.policies import pieces_of as policies_of
from stippler.drawing.planar.policies import said, with_policy
from stippler.errors import GeometryError
from tests.drawing.test_planar_map import box, node_at, size

CURVE = np.array([(0.0, 0.0), (4.0, 9.0), (12.0, 9.0), (20.0, 3.0)])
NEXT = np.array([(20.0, 3.0), (30.0, -5.0), (33.0, 8.0), (40.0, 10.0)])


@pytest.fixture
def page():
    return PlanarMap.of_page(100, 80)


@pytest.fixture
def two(page):
    return edits.add(edits.add(page, box(10, 10, 50, 50)).map, box(50, 10, 90, 50)).map


def shared(areas):
    (k,) = (k for k, arc in areas.arcs.items() if {arc.left, arc.right} == {1, 2})
    return k


# --- paths --------------------------------------------------------------------------------------


def test_a_path_of_curves_run_back_and_back_again_is_itself():
    path = path_of_cubics([CURVE, NEXT])
    back = path.reversed()
    assert np.array_equal(back.vertices, path.vertices[::-1])
    for piece, wanted in zip(pieces_of(back), (NEXT[::-1], CURVE[::-1]), strict=True):
        assert piece == pytest.approx(wanted, abs=1e-9)
    again = back.reversed()
    assert again == path
    for curve in back.curves:
        assert list(curve.at) == sorted(curve.at)
        if curve.at:
            assert (curve.at[0], curve.at[-1]) == (0.0, 1.0)


def test_handles_are_changed_each_in_its_place():
    path = path_of_cubics([CURVE, NEXT])
    new = ((25.0, 1.0), (36.0, 12.0))
    changed = pieces_of(with_handles(path, 1, new))
    assert changed[0] == pytest.approx(CURVE, abs=1e-9)
    assert changed[1] == pytest.approx(np.array([NEXT[0], *new, NEXT[3]]), abs=1e-9)


@pytest.mark.parametrize("turn", [0.0, 0.004, 0.4, np.pi])
def test_a_node_is_smooth_where_its_handles_lie_in_line_and_apart(turn):
    c, s = np.cos(turn), np.sin(turn)
    away = np.array([8.0, -6.0]) @ np.array([[c, s], [-s, c]]) * 1.7
    after = np.array([CURVE[3], CURVE[3] + away, (33.0, 8.0), (40.0, 10.0)])
    path = path_of_cubics([CURVE, after])
    node = path.nodes()[1]
    assert nodes.is_smooth(path, node) is (turn < 0.001)


def test_pieces_beside_removed_nodes_become_one_with_tangents_of_the_whole_length():
    parts = [CURVE + 5, NEXT + 5]
    path = path_of_cubics(parts)
    one = pieces_of(nodes.remove_nodes(path, [path.nodes()[1]]))
    (piece,) = one
    whole = sum(float(np.hypot(*(p[3] - p[0]))) for p in parts)
    for k, (a, b) in enumerate(((parts[0][1], parts[0][0]), (parts[1][2], parts[1][3]))):
        chord = float(np.hypot(*(parts[k][3] - parts[k][0])))
        wanted = (a - b) * whole / chord
        assert piece[1 + k] - piece[3 * k] == pytest.approx(wanted, abs=2e-3)


# --- borders ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("segments", "doubled"),
    [
        ([(0, 0, 5, 5), (0, 0, 5, 5)], True), ([(0, 0, 5, 5), (5, 5, 0, 0)], True),
        ([(3, 0, 3, 5), (3, 5, 3, 0)], True), ([(3, 0, 3, 5), (3, 0, 3, 6)], False),
        ([(0, 0, 5, 5), (1, 1, 2, 2), (9, 9, 8, 8), (5, 5, 0, 0)], True),
        ([(0, 5, 5, 0), (0, 0, 5, 5)], False), ([(1, 2, 3, 4), (3, 4, 1, 3)], False),
        ([(7, 7, 8, 8)], False),
    ],
)  # fmt: skip
def test_segments_that_lie_on_each_other_are_found_whichever_way_they_run(segments, doubled):
    assert _doubled(np.array(segments, np.int64)) is doubled


@pytest.mark.parametrize(
    ("other", "wanted"),
    [((10, 10, 20, 20), True), ((11, 0, 20, 5), False), ((0, 10, 5, 12), True),
     ((-5, 2, 0, 4), True), ((-5, 2, -1, 4), False), ((2, -5, 4, 0), True),
     ((2, 11, 4, 12), False)],
)  # fmt: skip
def test_boxes_that_touch_meet(other, wanted):
    assert meets((0, 0, 10, 10), other) is wanted
    assert meets(other, (0, 0, 10, 10)) is wanted


def test_an_arc_is_the_same_run_either_way_and_a_ring_from_wherever_it_begins():
    way = Path.polyline([(0, 0), (5, 1), (9, 9)])
    arc = Arc(way, 1, 2)
    assert _same(arc, Arc(way, 1, 2))
    assert _same(arc, Arc(way.reversed(), 2, 1))
    assert not _same(arc, Arc(way.reversed(), 1, 2))
    assert not _same(arc, Arc(way, 2, 1))
    assert not _same(arc, Arc(way, 1, 3))
    ring = Path.polyline([(0, 0), (5, 0), (5, 5)], closed=True)
    other = Path.polyline([(5, 0), (5, 5), (0, 0)], closed=True)
    assert _same(Arc(ring, 1, 2), Arc(other, 1, 2))
    assert not _same(Arc(ring, 1, 2), Arc(other.reversed(), 1, 2))
    assert not _same(arc, Arc(Path.polyline([(0, 0), (5, 2), (9, 9)]), 1, 2))
    assert not _same(arc, Arc(Path.polyline([(0, 0), (9, 9)]), 1, 2))


@pytest.mark.parametrize("even", [True, False])
def test_a_run_of_edges_along_a_curve_remembers_uneven_times(even):
    at = np.linspace(0, 1, 5) if even else np.array([0.0, 0.1, 0.3, 0.9, 1.0])
    (curve,) = _runs([CURVE], np.zeros(4, np.int64), at[:-1], at[1:])
    assert (curve.first, curve.last) == (0, 4)
    assert curve.handles_mm == (tuple(CURVE[1]), tuple(CURVE[2]))
    assert curve.at == (() if even else pytest.approx(tuple(at)))


def test_the_way_along_borders_is_the_shortest_and_begins_and_ends_where_it_is_asked(two):
    k = shared(two)
    middle = next(i for i, arc in two.arcs.items() if {arc.left, arc.right} == {PAGE, 1})
    length = len(two.arcs[middle].path) - 1
    for along in (0.25, 0.6, length - 0.3):
        at = two.arcs[middle].path.points_mm
        place = at[int(along)] + (along % 1) * (at[int(along) + 1] - at[int(along)])
        goal = two.arcs[k].path.points_mm.mean(axis=0)
        way = trace(
            two, Snap(tuple(place), middle, None, along), Snap(tuple(goal), k, None, 0.5),
        )  # fmt: skip
        assert way[0] == pytest.approx(place)
        assert way[-1] == pytest.approx(goal)
        run = float(np.hypot(*np.diff(way, axis=0).T).sum())
        ring = shapely.box(10, 10, 50, 50).exterior
        a, b = ring.project(shapely.Point(place)), ring.project(shapely.Point(goal))
        assert run == pytest.approx(min(abs(a - b), ring.length - abs(a - b)), abs=1e-6)
        assert (np.diff(way, axis=0) != 0).any(axis=1).all()


# --- moves --------------------------------------------------------------------------------------


def test_a_border_that_is_not_there_keeps_none_of_the_others_from_being_simplified(page):
    turn = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.column_stack([50 + 20 * np.cos(turn), 40 + 20 * np.sin(turn)])
    round_one = edits.add(page, Path.polyline(ring, closed=True)).map
    (k,) = (k for k, arc in round_one.arcs.items() if {arc.left, arc.right} == {PAGE, 1})
    after = moves.simplify(round_one, [999, k], 2.0).map
    assert len(after.arcs[k].path) < len(round_one.arcs[k].path) / 2
    assert size(after, 1) == pytest.approx(size(round_one, 1), rel=0.2)


def test_handles_go_with_the_node_that_they_belong_to(page):
    curves = path_of_cubics(
        [np.array([(20.0, 20.0), (30.0, 10.0), (50.0, 10.0), (60.0, 20.0)]),
         np.array([(60.0, 20.0), (70.0, 40.0), (60.0, 60.0), (40.0, 60.0)]),
         np.array([(40.0, 60.0), (20.0, 60.0), (10.0, 40.0), (20.0, 20.0)])], closed=True,
    )  # fmt: skip
    areas = edits.add(page, curves).map
    corner = node_at(areas, 60, 20)
    after = moves.move_nodes(areas, {corner: (63.0, 16.0)}).map
    (k,) = (k for k, arc in after.arcs.items() if {arc.left, arc.right} == {PAGE, 1})
    pieces = [p for p in pieces_of(after.arcs[k].path) if len(p) == 4]
    points = {tuple(np.round(point, 3).tolist()) for piece in pieces for point in piece}
    for wanted in ((53.0, 6.0), (73.0, 36.0), (63.0, 16.0), (30.0, 10.0), (60.0, 60.0)):
        assert min(np.hypot(x - wanted[0], y - wanted[1]) for x, y in points) < 4e-3


def test_areas_beside_a_border_that_was_moved_keep_their_parts(two):
    k = shared(two)
    arc = two.arcs[k]
    bent = Path.polyline([arc.path.points_mm[0], (55.0, 30.0), arc.path.points_mm[-1]])
    after = overlay.renode(two, {k: Arc(bent, arc.left, arc.right)})
    assert sorted(after.areas) == sorted(two.areas)
    assert size(after, 1) + size(after, 2) == pytest.approx(3200)
    assert max(size(after, 1), size(after, 2)) == pytest.approx(1700)
    after.check()


@pytest.mark.parametrize("end", [(30.0, 70.0), (33.0, 45.0), (30.0, 79.9)])
def test_a_line_parts_an_area_only_where_it_goes_across(page, end):
    area = edits.add(page, box(10, 10, 50, 50)).map
    tail = Path.polyline([(30.0, 5.0), (30.0, 60.0), (45.0, 60.0), end])
    found = edits.split(area, tail, 1).map
    assert len(found.areas) == 3
    assert sorted(size(found, k) for k in found.areas if k) == pytest.approx([800, 800])
    assert all(arc.left != arc.right for arc in found.arcs.values())  # nothing of the line is left
    inside = Path.polyline([(30.0, 5.0), (30.0, 45.0)])
    with pytest.raises(Exception, match="does not part"):
        edits.split(area, inside, 1)
    found.check()


def test_one_unit_of_the_grid_is_told_from_none(page):
    area = edits.add(page, box(10, 10, 50, 50)).map
    corner = node_at(area, 50, 50)
    after = moves.move_nodes(area, {corner: (50.0 + UNIT_MM, 50.0)}).map
    assert size(after, 1) != size(area, 1)
    assert moves.move_nodes(area, {corner: (50.0, 50.0)}).map.arcs == area.arcs


def test_a_border_that_would_cross_however_little_is_left_out_stays_and_is_told(page):
    notch = [(10, 10), (50, 10), (50, 50), (35, 50), (30, 49.5), (25, 50), (10, 50)]
    areas = edits.add(page, Path.polyline(notch, closed=True)).map
    spike = Path.polyline([(20, 70), (40, 70), (30, 49.75)], closed=True)
    areas = edits.add(areas, spike).map
    (k,) = (k for k, arc in areas.arcs.items() if {arc.left, arc.right} == {PAGE, 1})
    outcome = moves.simplify(areas, [k], 27.0)
    assert outcome.notes == (f"border {k} stays as it is: simpler, it would cross another",)
    assert outcome.map.arcs == areas.arcs
    fine = moves.simplify(areas, [k], 10.0)  # halved five times it leaves the notch as it is
    assert fine.notes == ()
    assert size(fine.map, 1) == pytest.approx(1597.5)


def test_an_island_is_not_reshaped_to_a_point(page):
    areas = edits.add(page, box(10, 10, 50, 50)).map
    (k,) = (k for k, arc in areas.arcs.items() if {arc.left, arc.right} == {PAGE, 1})
    point = Path(areas.arcs[k].path.vertices[:1].copy())
    with pytest.raises(GeometryError, match="would lose its length"):
        moves.reshape(areas, {k: point})


@pytest.mark.parametrize("length", [0.05, 3.0])
def test_short_handles_are_as_smooth_as_long_ones_and_turn_each_other(length):
    node, to = np.array([20.0, 3.0]), np.array([0.8, -0.6]) * length
    path = path_of_cubics(
        [np.array([(0.0, 0.0), (4.0, 9.0), node - to, node]),
         np.array([node, node + 2 * to, (33.0, 8.0), (40.0, 10.0)])]
    )  # fmt: skip
    at = path.nodes()[1]
    assert nodes.is_smooth(path, at)
    bent = path_of_cubics([pieces_of(path)[0], np.array(
        [node, node + 2 * to + (0.0, 0.1 * length), (33.0, 8.0), (40.0, 10.0)]
    )])  # fmt: skip
    assert not nodes.is_smooth(bent, at)
    cusp = path_of_cubics([pieces_of(path)[0], np.array(
        [node, node - 2 * to, (33.0, 8.0), (40.0, 10.0)]
    )])  # fmt: skip
    assert not nodes.is_smooth(cusp, at)
    turned = nodes.move_handle(path, at, "in", (20.0, 3.0 + length / 2))
    handles = nodes.handles_at(turned, turned.nodes()[1])
    assert handles["in"] == pytest.approx((20.0, 3.0 + length / 2), abs=1e-6)
    assert handles["out"] == pytest.approx((20.0, 3.0 - 2 * length), abs=1e-6)


def test_a_curve_with_uneven_times_run_back_has_them_from_the_other_end():
    at = (0.0, 0.1, 0.3, 0.9, 1.0)
    points = on_cubic(CURVE, np.array(at))
    path = Path(
        np.rint(points / UNIT_MM).astype(np.int64),
        (Curve(0, 4, (tuple(CURVE[1]), tuple(CURVE[2])), at),),
    )
    (back,) = path.reversed().curves
    assert back.at == pytest.approx((0.0, 0.1, 0.7, 0.9, 1.0))
    assert back.handles_mm == (tuple(CURVE[2]), tuple(CURVE[1]))
    assert path.reversed().reversed().curves[0].at == pytest.approx(at)


def test_pieces_of_a_border_are_told_from_end_to_end():
    way = Path.polyline([(k, k % 2) for k in range(10)])
    for policies, wanted in (
        ((), ((0, 9, ""),)),
        (((0, 9, "wall"),), ((0, 9, "wall"),)),
        (((2, 4, "wall"), (4, 5, "through")), ((0, 2, ""), (2, 4, "wall"), (4, 5, "through"),
                                               (5, 9, ""))),
        (((0, 3, "wall"), (6, 9, "bleed")), ((0, 3, "wall"), (3, 6, ""), (6, 9, "bleed"))),
    ):  # fmt: skip
        arc = Arc(way, 1, 2, policies)
        assert policies_of(arc) == wanted
        told = [policy for first, last, policy in wanted for _ in range(last - first)]
        assert said(arc) == told


def test_what_is_said_of_a_border_that_is_not_there_is_refused(two):
    for act in (lambda: with_policy(two, {999: ()}),
                lambda: moves.follow(two, {999: box(1, 1, 2, 2)})):  # fmt: skip
        with pytest.raises(GeometryError, match=r"border 999.*is not there"):
            act()
