"""Edits of areas that are refused, each with its reason, and odd ones that are not."""

import json

import numpy as np
import pytest
import shapely

from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.borders import enclosed, paths_of, snap, trace, welded
from stippler.drawing.planar.noding import contacts, node_segments
from stippler.drawing.planar.overlay import Laid, overlay
from stippler.drawing.planar.path import UNIT_MM, Path, path_of_cubics
from stippler.drawing.planar.planar_map import OUTSIDE, PAGE, Arc, PlanarMap
from stippler.drawing.planar.slivers import without_slivers
from stippler.errors import GeometryError, ParameterError
from tests.drawing.test_planar_map import box, circle, node_at, size


@pytest.fixture
def page():
    return PlanarMap.of_page(100, 80)


@pytest.fixture
def two(page):
    """Two boxes side by side, which share the border x = 50."""
    return edits.add(edits.add(page, box(10, 10, 50, 50)).map, box(50, 10, 90, 50)).map


def arcs_between(areas, a, b):
    return [k for k, arc in areas.arcs.items() if {arc.left, arc.right} == {a, b}]


REFUSED = {
    "way to add": (lambda m: edits.add(m, box(1, 1, 5, 5), "shoves"), "'shoves' is unknown"),
    "too many vertices": (
        lambda m: edits.add(m, [Path(np.arange(2_000_002, dtype=np.int64).reshape(-1, 2))] * 2),
        "more than",
    ),
    "no page": (lambda m: PlanarMap.of_page(10.0, 0.00001), "is no page"),
    "one area to unite": (lambda m: edits.unite(m, [1, 1]), "not two areas"),
    "an area not there to unite": (lambda m: edits.unite(m, [1, 7]), "not two areas"),
    "the page removed": (lambda m: edits.remove(m, PAGE), "cannot be removed"),
    "an area not there removed": (lambda m: edits.remove(m, 7), "is not there"),
    "an area not there split": (lambda m: edits.split(m, box(1, 1, 5, 5), 7), "is not there"),
    "a line without length": (
        lambda m: edits.split(m, Path.polyline([(20, 20), (20, 20)]), 1), "no length",
    ),
    "a line beside the area": (
        lambda m: edits.split(m, Path.polyline([(60, 0), (60, 80)]), 1), "does not part",
    ),
    "a sliver split off": (
        lambda m: edits.split(m, Path.polyline([(10.001, 5), (10.001, 55)]), 1), "does not part",
    ),
    "handles of no border": (lambda m: moves.move_handles(m, 99, 0, ((0, 0), (1, 1))), "not there"),
    "handles of no curve": (lambda m: moves.move_handles(m, 1, 0, ((0, 0), (1, 1))), "not there"),
    "another shape for no border": (lambda m: moves.reshape(m, {99: box(1, 1, 2, 2)}), "not there"),
    "another end": (
        lambda m: moves.reshape(m, {arcs_between(m, 1, 2)[0]: Path.polyline([(50, 10), (51, 50)])}),
        "would end elsewhere",
    ),
    "a node that is none": (lambda m: moves.move_nodes(m, {(1, 999): (5, 5)}), "is not there"),
    "a node of no border": (lambda m: moves.move_nodes(m, {(99, 0): (5, 5)}), "is not there"),
    "nodes on each other": (
        lambda m: moves.move_nodes(
            m, {node_at(m, 50, 10): (50, 50)} | {(arcs_between(m, 1, 2)[0], 0): (50, 50)}
        ),
        "lose its length|lie across",
    ),
    "all nodes of an island out": (
        lambda m: moves.remove_nodes(
            edits.add(m, box(20, 60, 30, 70)).map,
            [(edits.add(m, box(20, 60, 30, 70)).map.arcs_of(3)[0], i) for i in (1, 2)],
        ),
        "lose its extent",
    ),
    "an area of no extent left": (
        lambda m: moves.move_nodes(
            edits.add(m, box(20, 60, 30, 70)).map,
            {
                node_at(edits.add(m, box(20, 60, 30, 70)).map, 30, 60): (20.0005, 60),
                node_at(edits.add(m, box(20, 60, 30, 70)).map, 30, 70): (20.0005, 70),
            },
        ),
        "area 3: would lose its extent|lose its extent",
    ),
    "no gap": (lambda m: enclosed(m, (30, 30), -1.0), "no place"),
    "a place narrower than the gap": (
        lambda m: enclosed(edits.add(m, box(20, 60, 30, 61)).map, (25, 60.5), 3.0), "narrower",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_refused(two, name):
    edit, why = REFUSED[name]
    before = two.to_json()
    with pytest.raises((GeometryError, ParameterError), match=why):
        edit(two)
    assert two.to_json() == before


class TestSubtracting:
    def test_an_open_outline_is_closed(self, page):
        made = edits.add(page, Path.polyline([(10, 10), (30, 10), (30, 30)])).map
        assert size(made, 1) == pytest.approx(200)

    def test_rings_of_no_extent_beside_others_are_left_out(self, page):
        made = edits.add(page, [box(10, 10, 20, 20), Path.polyline([(1, 1), (2, 2)])]).map
        assert size(made, 1) == pytest.approx(100)

    def test_an_area_extended_where_others_lie_stops_there(self, two):
        more = edits.extend(two, box(5, 5, 95, 45), 1, edits.IS_CUT).map
        assert size(more, 2) == pytest.approx(size(two, 2))
        assert size(more, 1) == pytest.approx(90 * 40 - 40 * 35 + 40 * 5)
        kept = edits.extend(two, box(5, 5, 95, 45), 1, locked=[2]).map
        assert size(kept, 2) == pytest.approx(size(two, 2))

    def test_a_removed_area_goes_to_the_page_where_the_page_has_no_place(self, page):
        full = page
        for x0 in (0, 50):
            full = edits.add(full, box(x0, 0, x0 + 50, 80)).map
        assert PAGE not in full.areas
        outcome = edits.remove(full, 2)
        outcome.map.check()
        assert outcome.map.areas == [0, 1]
        assert outcome.gone == (2,)
        assert edits.remove(full, 2, to=1).map.areas == [1]
        united = edits.unite(full, [1, 2])
        assert (united.map.areas, united.gone) == ([1], (2,))

    def test_the_page_united_with_an_area_is_not_gone(self, two):
        outcome = edits.unite(two, [1, PAGE])
        assert outcome.gone == ()
        assert outcome.map.areas == [1, 2]


class TestReshaping:
    def test_a_border_takes_another_path(self, two):
        (k,) = arcs_between(two, 1, 2)
        start, end = two.arcs[k].path.points_mm[[0, -1]].tolist()
        after = moves.reshape(two, {k: Path.polyline([start, (60, 30), end])}).map
        after.check()
        assert abs(size(after, 1) - 1600) == pytest.approx(200)

    def test_a_ring_may_begin_elsewhere(self, page):
        areas = edits.add(page, box(10, 10, 50, 50)).map
        (k,) = areas.arcs_of(1)
        turned = Path.polyline([(20, 20), (40, 20), (40, 40), (20, 40)], closed=True)
        if areas.arcs[k].left != 1:
            turned = turned.reversed()
        after = moves.reshape(areas, {k: turned}).map
        after.check()
        assert size(after, 1) == pytest.approx(400)

    def test_what_stays_as_it_is_changes_nothing(self, two):
        (k,) = arcs_between(two, 1, 2)
        assert moves.reshape(two, {k: two.arcs[k].path}).map is two
        assert moves.smooth(two, [k]).map is two  # two nodes: nothing between them

    def test_simplifying_borders_that_are_gone_is_nothing(self, two):
        assert moves.simplify(two, [99], 1.0).map is two

    def test_a_border_that_would_cross_when_simpler_is_told(self, page):
        """A bay with an island in it: every simpler border runs over the island."""
        bay = [(10, 10), (50, 10), (50, 29.9), (30, 30), (50, 30.1), (50, 50), (10, 50)]
        areas = edits.add(page, Path.polyline(bay, closed=True)).map
        areas = edits.add(areas, circle(48, 30, 0.02, 8)).map
        (k,) = arcs_between(areas, 0, 1)
        outcome = moves.simplify(areas, [k], 40.0)
        outcome.map.check()
        assert len(outcome.map.arcs[k].path) < len(areas.arcs[k].path)
        tight = moves.simplify(areas, [k], 640.0)
        assert tight.notes or len(tight.map.arcs[k].path) < len(areas.arcs[k].path)

    def test_vertices_that_fall_together_are_one(self, page):
        areas = edits.add(page, box(10, 10, 50, 50)).map
        (k,) = areas.arcs_of(1)
        to = {(k, i): (10.0, 50.0) for i, p in enumerate(areas.arcs[k].path.points_mm.tolist())
              if p in ([10.0, 50.0], [10.0, 10.0])}  # fmt: skip
        after = moves.move_nodes(areas, to).map
        after.check()
        assert size(after, 1) == pytest.approx(800)


class TestFinding:
    def test_nothing_is_near(self, two):
        assert snap(two, (30.0, 30.0), 5.0) is None
        assert snap(two, (50.0, 30.0), 5.0).vertex is None
        assert snap(two, (51.0, 11.0), 5.0).vertex is not None

    def test_borders_that_do_not_hang_together_have_no_way(self, two):
        areas = edits.add(two, box(20, 60, 30, 70)).map
        with pytest.raises(GeometryError, match="do not hang together"):
            trace(areas, snap(areas, (50, 30), 1), snap(areas, (20, 65), 1))

    def test_a_path_welded_together_keeps_its_curves_or_loses_repeats(self, two):
        close = Path.polyline([(50, 9.999), (50.001, 10.0), (70, 30)])
        assert welded(two, close).points_mm.tolist() == [[50, 10], [70, 30]]
        bent = path_of_cubics([
            [(50, 9.999), (50.001, 10.0)],
            [(50.001, 10.0), (55, 20), (60, 20), (70, 30)],
        ])  # fmt: skip
        assert welded(two, bent) == bent
        far = Path.polyline([(30, 30), (31, 31)])
        assert welded(two, far) is far

    def test_rings_of_two_corners_are_no_outline(self):
        thin = shapely.Polygon([(0, 0), (10, 0), (10, 1e-5), (0, 1e-5)])
        assert paths_of(thin) == []
        assert len(paths_of(shapely.MultiPolygon([thin, shapely.box(0, 0, 5, 5)]))) == 1

    def test_walls_with_a_gap_and_none(self, page):
        wall = np.array([(40.0, -5.0), (40.0, 85.0)])
        (left,) = enclosed(page, (20, 40), 0.0, [wall, wall[:1]])
        assert shapely.Polygon(left.points_mm).area == pytest.approx(40 * 80, rel=1e-3)
        (right,) = enclosed(page, (60, 40), 1.0, [wall])
        assert shapely.Polygon(right.points_mm).bounds == pytest.approx((40, 0, 100, 80), abs=0.01)

    def test_a_point_within_half_a_gap_of_a_border_fills_the_place_beside(self, page):
        (found,) = enclosed(page, (0.2, 40), 1.0)
        assert shapely.Polygon(found.points_mm).area == pytest.approx(8000, rel=1e-3)


class TestCrowds:
    def test_more_contacts_than_there_was_room_for(self):
        """A grid of lines: 60 by 60 contacts, of 120 segments."""
        k = 1000 * np.arange(60, dtype=np.int64)
        low, high = np.full(60, -500), np.full(60, 60_000)
        across = np.column_stack([low, k, high, k])
        down = np.column_stack([k, low, k, high])
        xy = np.concatenate([across, down])
        which, at = contacts(xy, np.ones(120, np.bool_))
        assert len(which) == 2 * 60 * 60
        assert {tuple(p) for p in at.tolist()} == {(x, y) for x in k.tolist() for y in k.tolist()}
        split, parent, moved = node_segments(xy, np.ones(120, np.bool_))
        assert len(split) == 120 * 61
        assert moved.all()
        assert (np.bincount(parent) == 61).all()

    @pytest.mark.parametrize("seed", range(20))
    def test_lines_a_few_points_of_the_grid_long_are_noded_or_refused(self, seed):
        """Splitting bends them into each other, again and again."""
        rng = np.random.default_rng(seed)
        xy = rng.integers(0, 30, (12, 4))
        try:
            split, parent, _ = node_segments(xy, np.ones(len(xy), np.bool_))
        except GeometryError:
            return
        lines = shapely.linestrings(split.reshape(-1, 2, 2).astype(float))
        met = shapely.intersection(lines[:, None], lines[None])
        assert not shapely.crosses(lines[:, None], lines[None]).any()
        points = shapely.get_coordinates(met[shapely.get_type_id(met) == 0])
        assert {tuple(p) for p in points} <= {tuple(p) for p in split.reshape(-1, 2).tolist()}
        assert (np.diff(parent) >= 0).all()


def json_of(areas):
    return json.loads(json.dumps(areas.to_json()))


class TestDamagedMaps:
    """Borders that contradict each other, as only a damaged file has them."""

    def test_maps_that_are_none_are_refused(self, two):
        assert PlanarMap.from_json(json_of(two)) == two
        assert two != 5
        for damage in (
            {"unit_mm": 1.0}, {"arcs": None}, {"arcs": {"x": {}}}, {"next_arc": "x"},
            {"next_arc": 1}, {"next_area": 2},
        ):  # fmt: skip
            with pytest.raises(GeometryError, match=r"another grid|cannot be read|not yet given"):
                PlanarMap.from_json(json_of(two) | damage)

    def test_areas_that_cross_themselves_or_each_other_are_found(self, page):
        """Two boxes over each other, drawn as islands of the page that know nothing of it."""
        bow = Path.polyline([(20, 20), (40, 40), (40, 20), (20, 30)], closed=True)
        arcs = {**page.arcs, 1: Arc(bow, 1, PAGE)}
        with pytest.raises(GeometryError):
            PlanarMap(arcs, 2, 2).check()
        over = {
            **page.arcs, 1: Arc(box(20, 20, 40, 40), 1, PAGE), 2: Arc(box(30, 30, 60, 60), 2, PAGE)
        }  # fmt: skip
        with pytest.raises(GeometryError):
            PlanarMap(over, 3, 3).check()

    def test_areas_that_touch_in_a_node_cover_the_page(self, page):
        areas = edits.add(page, box(10, 10, 30, 30)).map
        areas = edits.add(areas, box(30, 30, 50, 50)).map
        areas = edits.add(areas, [box(30, 10, 50, 30), box(10, 30, 30, 50)]).map
        areas.check()
        assert size(areas, 3) == pytest.approx(800)

    def test_an_edit_over_a_border_with_two_answers_is_refused(self, page):
        """Two arcs on one line that tell different areas beside it."""
        ring = box(20, 20, 40, 40)
        arcs = {**page.arcs, 1: Arc(ring, 1, PAGE), 2: Arc(ring, 2, 3)}
        with pytest.raises(GeometryError, match="lie across"):
            edits.add(PlanarMap(arcs, 3, 4), box(10, 10, 30, 30))

    def test_an_edit_where_sides_contradict_is_refused(self, two):
        (k,) = arcs_between(two, 1, 2)
        a = two.arcs[k]
        arcs = {**two.arcs, k: Arc(a.path, a.right, a.left)}
        with pytest.raises(GeometryError):
            edits.add(PlanarMap(arcs, two.next_arc, 9), box(40, 20, 60, 30))

    def test_an_outline_that_does_not_close_is_refused(self, page):
        laid = Laid([Path.polyline([(10, 10), (30, 10), (30, 30)])], lambda old, w: old)
        with pytest.raises(GeometryError, match="does not close"):
            overlay(page, laid)

    def test_holes_without_an_outline_are_refused(self, page):
        ring = box(20, 20, 40, 40)
        with pytest.raises(GeometryError, match="no outline"):
            PlanarMap({**page.arcs, 1: Arc(ring.reversed(), 1, PAGE)}, 2, 2).outline(1)
        outside = {
            1: Arc(box(20, 20, 40, 40), 1, PAGE),
            2: Arc(box(50, 20, 60, 40), 1, PAGE),
            3: Arc(box(70, 20, 80, 40).reversed(), 1, PAGE),
        }
        with pytest.raises(GeometryError, match="outside of its outline"):
            PlanarMap({**page.arcs, **outside}, 4, 2).outline(1)


class TestSlivers:
    def test_a_sliver_alone_on_the_page_has_nobody_to_go_to(self):
        thin = PlanarMap({0: Arc(box(0, 0, 10, 0.001), 1, OUTSIDE)}, 1, 2)
        assert without_slivers(thin, [1, OUTSIDE]) is thin

    def test_slivers_side_by_side_go_in_turn(self, page):
        """Neither is given while its neighbour is: else both borders would go at once."""
        hair = 8 * UNIT_MM
        areas = PlanarMap(
            {**page.arcs, **{
                k: Arc(box(20 + 5 * k, 20, 20 + 5 * k + hair, 40), k, PAGE) for k in (1, 2)
            }}, 3, 3,
        )  # fmt: skip
        after = without_slivers(areas, [1, 2])
        assert after.areas == [PAGE]
        assert len(after.arcs) == 1
