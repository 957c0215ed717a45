"""Areas over shared borders: edits, refusals and what known programs get wrong."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.random_areas import run
from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.path import TOLERANCE_MM, UNIT_MM, Path, on_cubic, path_of_cubics
from stippler.drawing.planar.planar_map import OUTSIDE, PAGE, PlanarMap
from stippler.drawing.planar.swept import dots_in_strip
from stippler.errors import GeometryError


def circle(x, y, r, n=40):
    t = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return Path.polyline(np.column_stack([x + r * np.cos(t), y + r * np.sin(t)]), closed=True)


def box(x0, y0, x1, y1):
    return Path.polyline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], closed=True)


@pytest.fixture
def page():
    return PlanarMap.of_page(100, 80)


@pytest.fixture
def quarters(page):
    """Four areas that meet in the middle of the page and fill it."""
    areas = page
    for x0, y0 in ((0, 0), (50, 0), (0, 40), (50, 40)):
        areas = edits.add(areas, box(x0, y0, x0 + 50, y0 + 40)).map
    return areas


def size(areas, k):
    return areas.outline(k).area


def node_at(areas, x, y):
    for k, arc in areas.arcs.items():
        for i, p in enumerate(arc.path.points_mm):
            if np.allclose(p, (x, y)):
                return k, i
    raise AssertionError("no node there")


class TestAdding:
    def test_a_new_area_takes_from_those_below(self, page):
        one = edits.add(page, circle(30, 30, 15))
        two = edits.add(one.map, circle(45, 30, 15))
        two.map.check()
        assert two.made == (2,)
        assert size(two.map, 2) == pytest.approx(size(one.map, 1), rel=1e-3)
        assert size(two.map, 1) < 0.7 * size(one.map, 1)
        assert sum(size(two.map, k) for k in two.map.areas) == pytest.approx(8000)

    def test_it_can_be_cut_by_those_below(self, page):
        one = edits.add(page, circle(30, 30, 15)).map
        two = edits.add(one, circle(45, 30, 15), edits.IS_CUT).map
        assert size(two, 1) == pytest.approx(size(one, 1), rel=1e-5)
        assert size(two, 2) < 0.7 * size(one, 1)

    def test_it_can_be_refused(self, page):
        one = edits.add(page, circle(30, 30, 15)).map
        with pytest.raises(GeometryError, match="lies on area 1"):
            edits.add(one, circle(45, 30, 15), edits.REFUSED)
        assert edits.add(one, circle(70, 30, 5), edits.REFUSED).made == (2,)

    def test_locked_areas_give_nothing(self, page):
        one = edits.add(page, circle(30, 30, 15)).map
        two = edits.add(one, circle(45, 30, 15), locked=[1]).map
        assert size(two, 1) == pytest.approx(size(one, 1), rel=1e-5)

    def test_an_area_within_another_is_a_hole_of_it(self, page):
        areas = edits.add(edits.add(page, circle(30, 30, 15)).map, circle(30, 30, 4)).map
        assert len(areas.outline(1).interiors) == 1
        areas.check()

    def test_an_area_that_covers_another_leaves_nothing_of_it(self, page):
        outcome = edits.add(edits.add(page, circle(30, 30, 4)).map, circle(30, 30, 15))
        assert outcome.gone == (1,)
        assert outcome.map.areas == [0, 2]

    def test_a_crossing_outline_is_repaired_and_said(self, page):
        turn = np.arange(5) * 4 * np.pi / 5
        star = Path.polyline(
            np.column_stack([50 + 20 * np.cos(turn), 40 + 20 * np.sin(turn)]), closed=True
        )
        outcome = edits.add(page, star)
        assert "crossed itself" in outcome.notes[0]
        outcome.map.check()
        ring = shapely.make_valid(shapely.Polygon(star.points_mm))
        middle = shapely.Polygon(shapely.get_coordinates(ring)).convex_hull
        assert 0 < size(outcome.map, 1) < middle.area
        hollow = edits.add(page, star, rule=edits.EVEN_ODD).map
        assert size(hollow, 1) == pytest.approx(ring.area, abs=0.01)
        assert size(hollow, 1) < size(outcome.map, 1)

    def test_what_lies_off_the_page_is_left_out_and_said(self, page):
        outcome = edits.add(page, circle(98, 30, 8))
        assert "off the page" in outcome.notes[0]
        assert outcome.map.outline(1).bounds[2] == 100
        with pytest.raises(GeometryError, match="no place"):
            edits.add(page, circle(150, 30, 8))

    @pytest.mark.parametrize(
        "path",
        [
            Path.polyline([(1, 1), (1, 1)]),
            Path.polyline([(1, 1), (2, 2)], closed=True),
            Path.polyline([(1, 1), (5, 1), (9, 1)], closed=True),
            box(5, 5, 5.001, 5.001),
        ],
    )
    def test_outlines_of_no_extent_are_refused(self, page, path):
        with pytest.raises(GeometryError):
            edits.add(page, path)

    def test_points_that_are_none_are_refused(self):
        with pytest.raises(GeometryError, match="not finite"):
            Path.polyline([(0, 0), (np.nan, 1)])
        with pytest.raises(GeometryError, match="reaches beyond"):
            Path.polyline([(0, 0), (1e9, 1)])

    def test_outlines_within_a_hair_of_a_border_leave_no_sliver(self, page):
        areas = edits.add(page, box(10, 10, 50, 50)).map
        areas = edits.add(areas, box(50.0005, 10, 80, 50)).map
        areas.check()
        assert areas.neighbours(1) == [0, 2]
        assert len(areas.parts(PAGE)) == 1

    def test_a_thousand_areas(self, page):
        areas = page
        rng = np.random.default_rng(4)
        for x, y in rng.random((1000, 2)) * (100, 80):
            areas = edits.add(areas, box(x, y, x + 3, y + 2)).map
        areas.check()
        assert len(areas.areas) > 500


class TestFaces:
    def test_split_keeps_the_larger_part(self, page):
        one = edits.add(page, box(10, 10, 50, 50)).map
        outcome = edits.split(one, Path.polyline([(0, 20), (60, 20)]), 1)
        assert outcome.made == (2,)
        assert size(outcome.map, 1) == pytest.approx(40 * 30, rel=1e-4)
        assert size(outcome.map, 2) == pytest.approx(40 * 10, rel=1e-4)
        with pytest.raises(GeometryError, match="does not part"):
            edits.split(one, Path.polyline([(0, 20), (30, 20)]), 1)

    def test_a_line_that_crosses_itself_splits_off_its_loop(self, page):
        one = edits.add(page, box(10, 10, 50, 50)).map
        line = Path.polyline([(0, 30), (30, 30), (30, 40), (20, 40), (20, 20)])
        outcome = edits.split(one, line, 1)
        assert len(outcome.made) == 1
        assert size(outcome.map, 2) == pytest.approx(100, rel=1e-3)

    def test_unite_and_remove(self, quarters):
        outcome = edits.unite(quarters, [1, 2])
        assert size(outcome.map, 1) == pytest.approx(4000)
        assert outcome.gone == (2,)
        outcome.map.check()
        outcome = edits.remove(quarters, 3)
        assert outcome.map.areas == [0, 1, 2, 4]
        assert size(outcome.map, 0) == pytest.approx(2000)

    def test_subtract_extend_and_cut(self, page):
        one = edits.add(page, box(10, 10, 50, 50)).map
        less = edits.subtract(one, circle(10, 10, 8, 200), [1]).map
        assert size(less, 1) == pytest.approx(1600 - np.pi * 16, rel=1e-3)
        more = edits.extend(one, box(40, 40, 60, 60), 1).map
        assert size(more, 1) == pytest.approx(1600 + 300)
        outcome = edits.cut(one, box(40, 40, 60, 60), 1)
        assert size(outcome.map, 2) == pytest.approx(100)
        assert size(outcome.map, 0) == pytest.approx(size(one, 0))


class TestMoving:
    """QGIS, without topological editing, moves one polygon's edge and leaves gaps."""

    def test_a_node_takes_all_that_meet_there_along(self, quarters):
        after = moves.move_nodes(quarters, {node_at(quarters, 50, 40): (57, 33)}).map
        after.check()
        for k in (1, 2, 3, 4):
            assert (57, 33) in map(tuple, shapely.get_coordinates(after.outline(k)))

    def test_a_segment_takes_both_neighbours_along(self, page):
        areas = edits.add(page, box(10, 10, 50, 50)).map
        areas = edits.add(areas, box(50, 10, 90, 50)).map
        ends = [node_at(areas, 50, 10), node_at(areas, 50, 50)]
        after = moves.move_by(areas, ends, (5, 0)).map
        after.check()
        assert size(after, 1) == pytest.approx(45 * 40)
        assert size(after, 2) == pytest.approx(35 * 40)

    def test_several_nodes_take_all_neighbours_along(self, quarters):
        chosen = [node_at(quarters, 50, 40), node_at(quarters, 0, 40), node_at(quarters, 100, 40)]
        after = moves.move_by(quarters, chosen, (0, 6.25)).map
        after.check()
        assert [size(after, k) for k in (1, 2, 3, 4)] == [
            50 * 46.25, 50 * 46.25, 50 * 33.75, 50 * 33.75,
        ]  # fmt: skip

    def test_nodes_of_the_page_slide_along_its_edge(self, quarters):
        after = moves.move_by(quarters, [node_at(quarters, 50, 0)], (3, 5)).map
        after.check()
        assert after.outline(1).bounds == (0, 0, 53, 40)

    def test_crossing_is_refused(self, page, quarters):
        one = edits.add(page, box(10, 10, 50, 50)).map
        with pytest.raises(GeometryError, match="lie across"):
            moves.move_by(one, [node_at(one, 10, 10)], (60, 20))
        island = edits.add(quarters, circle(20, 20, 3)).map
        with pytest.raises(GeometryError, match=r"jump over|lie across"):
            moves.move_by(island, [(k, i) for k in island.arcs_of(5) for i in range(40)], (50, 0))

    def test_an_island_moves_freely_within_its_area(self, quarters):
        island = edits.add(quarters, circle(20, 20, 3)).map
        ring = island.arcs_of(5)[0]
        after = moves.move_by(island, [(ring, i) for i in range(40)], (10, 5)).map
        after.check()
        assert after.outline(5).centroid.coords[0] == pytest.approx((30, 25), abs=1e-3)

    def test_a_border_does_not_jump_over_an_island(self, page):
        areas = edits.add(page, box(10, 10, 50, 50)).map
        areas = edits.add(areas, circle(55, 30, 1)).map
        ends = [node_at(areas, 50, 10), node_at(areas, 50, 50)]
        with pytest.raises(GeometryError, match="jump over"):
            moves.move_by(areas, ends, (20, 0))

    def test_touching_borders_become_shared(self, page):
        areas = edits.add(page, box(10, 10, 50, 50)).map
        areas = edits.add(areas, box(60, 20, 90, 40)).map
        ends = [node_at(areas, 60, 20), node_at(areas, 60, 40)]
        after = moves.move_by(areas, ends, (-10, 0)).map
        after.check()
        assert after.neighbours(2) == [0, 1]

    def test_handles_bend_a_border_for_both_sides(self, page):
        path = Path.bezier(
            [((20, 20), (30, 10), (40, 10)), ((50, 20), (50, 30), (50, 40)),
             ((40, 50), (30, 50), (20, 40))], closed=True,
        )  # fmt: skip
        areas = edits.add(page, path).map
        arc = areas.arcs_of(1)[0]
        before = size(areas, 1)
        after = moves.move_handles(areas, arc, 0, ((42, 8), (54, 20))).map
        after.check()
        assert size(after, 1) > before + 1
        assert len(after.arcs[after.arcs_of(1)[0]].path.curves) == 3

    def test_simplify_keeps_neighbours_together(self, page):
        areas = edits.add(page, circle(40, 40, 20, 400)).map
        areas = edits.add(areas, box(40, 10, 80, 70)).map
        after = moves.simplify(areas, list(areas.arcs), 0.2).map
        after.check()
        assert len(after.segments.xy) < 0.3 * len(areas.segments.xy)
        difference = after.outline(1).symmetric_difference(areas.outline(1))
        assert difference.area < 0.2 * areas.outline(1).length

    def test_untouched_areas_keep_their_polygons(self, quarters):
        island = edits.add(quarters, circle(20, 20, 3)).map
        for k in island.areas:
            island.parts(k)
        after = moves.move_by(island, [(island.arcs_of(5)[0], 3)], (0.5, 0)).map
        assert after.parts(4) is island.parts(4)
        assert set(after.changes(island)) == {island.arcs_of(5)[0]}


class TestCurves:
    def test_flattening_keeps_to_the_tolerance(self):
        cubic = np.array([(0, 0), (40, 50), (-20, 60), (30, 10)], float)
        path = path_of_cubics([cubic])
        line = shapely.linestrings(path.points_mm)
        fine = shapely.points(on_cubic(cubic, np.linspace(0, 1, 5000)))
        assert shapely.distance(line, fine).max() < TOLERANCE_MM + UNIT_MM

    def test_curves_that_are_cut_stay_curves(self, page):
        path = Path.bezier(
            [((30, 30), (20, 40), (30, 50)), ((50, 50), (60, 40), (50, 30))], closed=True
        )
        areas = edits.add(page, path).map
        areas = edits.add(areas, box(40, 0, 41, 80)).map
        areas.check()
        curves = [c for k in areas.arcs_of(1) for c in areas.arcs[k].path.curves]
        assert len(curves) == 4
        for k in areas.arcs_of(1):
            p = areas.arcs[k].path
            again = Path.from_json(p.to_json())
            assert again == p
            rebuilt = shapely.linestrings(path_of_cubics(_pieces(p)).points_mm)
            assert rebuilt.hausdorff_distance(shapely.linestrings(p.points_mm)) < 2 * TOLERANCE_MM


def _pieces(path):
    from stippler.drawing.planar.path import pieces_of

    return pieces_of(path)


def test_a_map_survives_json(quarters):
    areas = edits.add(quarters, circle(30, 30, 15)).map
    assert PlanarMap.from_json(areas.to_json()) == areas
    damaged = areas.to_json()
    damaged["arcs"].popitem()
    with pytest.raises(GeometryError):
        PlanarMap.from_json(damaged)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=8, deadline=None)
def test_dots_change_hands_in_the_strip_alone(seed):
    rng = np.random.default_rng(seed)
    areas, _ = run(seed, 25, check_every=25)
    dots = rng.random((500, 2)) * (100, 80)
    owner = areas.area_at(dots)
    assert (owner != OUTSIDE).all()
    for k in areas.areas:
        inside = shapely.contains_xy(areas.outline(k), dots[:, 0], dots[:, 1])
        assert np.array_equal(inside, owner == k)
    arc = int(rng.choice([k for k, a in areas.arcs.items() if OUTSIDE not in (a.left, a.right)]))
    try:
        after = moves.move_by(areas, [(arc, 0)], tuple(rng.normal(0, 1, 2))).map
    except GeometryError:
        return
    which, new = dots_in_strip(areas, after, dots, owner)
    fresh = PlanarMap(after.arcs, after.next_arc, after.next_area).area_at(dots)
    assert np.array_equal(np.flatnonzero(fresh != owner), which)
    assert np.array_equal(fresh[which], new)


def test_points_on_borders_belong_to_one_area(quarters):
    on = np.array([(50.0, 10.0), (10.0, 40.0), (50.0, 40.0), (0.0, 0.0), (0.0, 40.0)])
    owner = quarters.area_at(on)
    assert set(owner.tolist()) <= {1, 2, 3, 4}


@pytest.mark.parametrize("seed", range(3))
def test_random_edits_leave_no_gap_overlap_or_sliver(seed):
    areas, count = run(seed, 100, check_every=2)
    assert sum(n for name, n in count.items() if not name.endswith(", refused")) > 40
    assert len(areas.areas) > 3
