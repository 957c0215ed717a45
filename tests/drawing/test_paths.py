"""Paths: pieces and nodes, handles by hand, and what is refused as none."""

import numpy as np
import pytest

from stippler.drawing.planar import nodes
from stippler.drawing.planar.path import (
    UNIT_MM,
    Curve,
    Path,
    on_cubic,
    path_of_cubics,
    pieces_of,
    with_handles,
)
from stippler.errors import GeometryError

ARCH = ((0.0, 0.0), (0.0, 8.0), (10.0, 8.0), (10.0, 0.0))


def zigzag(closed=False):
    return Path.polyline([(0, 0), (10, 0), (20, 10), (30, 0)], closed=closed)


def loop():
    """A closed path: two curves, then a straight side back to the start."""
    down = ((10.0, 0.0), (12.0, -4.0), (18.0, -4.0), (20.0, 0.0))
    return path_of_cubics([ARCH, down, [(20.0, 0.0), (0.0, 0.0)]])


def node_at(path, x, y):
    return next(k for k in path.nodes() if np.allclose(path.points_mm[k], (x, y)))


class TestPieces:
    def test_pieces_that_go_nowhere_are_left_out(self):
        dot = [(10.0, 0.0)] * 4
        path = path_of_cubics([ARCH, dot, [(10.0, 0.0), (10.0, 0.0)], [(10.0, 0.0), (20.0, 0.0)]])
        assert len(path.curves) == 1
        assert path.nodes() == [0, path.curves[0].last, len(path) - 1]
        assert [len(p) for p in pieces_of(path)] == [4, 2]

    def test_points_of_a_curve_that_fall_together_keep_their_times(self):
        """A curve that stands still at its begin: its first points round to one."""
        cubic = np.array([(0, 0), (0, 0), (0, 0), (0.02, 0.0)])
        path = path_of_cubics([cubic], tolerance_mm=1e-7)
        (curve,) = path.curves
        assert len(curve.at) == len(path)
        away = on_cubic(cubic, curve.parameters()) - path.points_mm
        assert np.abs(away).max() <= UNIT_MM / 2 + 1e-12

    def test_a_ring_of_curves_is_closed_by_a_straight_side(self):
        path = path_of_cubics([ARCH], closed=True)
        assert path.is_closed
        assert [len(p) for p in pieces_of(path)] == [4, 2]
        assert path_of_cubics([], closed=True).vertices.shape == (0, 2)

    def test_handles_of_the_second_curve_are_changed_alone(self):
        path = with_handles(loop(), 1, ((13.0, -9.0), (17.0, -9.0)))
        assert path.curves[0].handles_mm == ((0.0, 8.0), (10.0, 8.0))
        assert path.curves[1].handles_mm == ((13.0, -9.0), (17.0, -9.0))
        assert path.points_mm[:, 1].min() == pytest.approx(-9.0 * 0.75, abs=0.01)

    @pytest.mark.parametrize(
        "damage",
        [
            {"vertices": [[0, 0]]},
            {"vertices": [[0, 0], [0, 0]]},
            {"vertices": [[0, 0], [2**40, 0]]},
            {"vertices": [[0, 0], [-(2**63), 0]]},
            {"vertices": [[0, 0], [2**70, 0]]},
            {"vertices": [0, 1, 2]},
            {"vertices": "none"},
            {},
            {"curves": [[0, 3, [0, 1], [2, 3], []]]},
            {"curves": [[0, 0, [0, 1], [2, 3], []]]},
            {"curves": [[1, 2, [0, 1], [2, 3], []], [0, 1, [0, 1], [2, 3], []]]},
            {"curves": [[0, 2, [0, 1], [2, 3], [0.0, 1.0]]]},
            {"curves": [[0, 2, [0, float("nan")], [2, 3], []]]},
            {"curves": [[0, 2, [0, 1, 2], [2, 3], []]]},
            {"curves": [[0, 2, [0, 1]]]},
            {"curves": 7},
        ],
    )
    def test_damaged_paths_are_refused(self, damage):
        good = {"vertices": [[0, 0], [5, 0], [5, 9]], "curves": [[0, 2, [0, 1], [2, 3], []]]}
        assert Path.from_json(good).curves == (Curve(0, 2, ((0.0, 1.0), (2.0, 3.0))),)
        with pytest.raises(GeometryError, match=r"is no path|is none"):
            Path.from_json(damage and {**good, "curves": [], **damage})


class TestNodes:
    def test_what_is_no_node_has_no_pieces(self):
        path = loop()
        assert nodes.pieces_at(path, 0) == (2, 0)
        assert nodes.pieces_at(path, len(path) - 1) == (2, 0)
        assert nodes.pieces_at(zigzag(), 0) == (None, 0)
        assert nodes.pieces_at(zigzag(), 3) == (2, None)
        with pytest.raises(GeometryError, match="is no node"):
            nodes.pieces_at(path, 1)

    def test_smooth_is_where_both_handles_lie_in_line(self):
        path = loop()
        assert not nodes.is_smooth(path, 0)  # one handle only
        assert not nodes.is_smooth(path, node_at(path, 10, 0))
        made = nodes.make_smooth(path, [node_at(path, 10, 0)])
        assert nodes.is_smooth(made, node_at(made, 10, 0))

    def test_both_names_of_the_first_node_of_a_ring_move_it(self):
        ring = zigzag(closed=True)
        for vertex in (0, len(ring) - 1):
            moved = nodes.move_nodes(ring, {vertex: (-5.0, 5.0)})
            assert moved.is_closed
            assert moved.points_mm.tolist() == [[-5, 5], [10, 0], [20, 10], [30, 0], [-5, 5]]

    def test_handles_go_with_their_nodes(self):
        path = loop()
        moved = nodes.move_nodes(path, {node_at(path, 10, 0): (11.0, 1.0)})
        assert moved.curves[0].handles_mm == ((0.0, 8.0), (11.0, 9.0))
        assert moved.curves[1].handles_mm == ((13.0, -3.0), (18.0, -4.0))

    def test_a_handle_of_a_smooth_node_turns_the_other(self):
        path = nodes.make_smooth(loop(), [node_at(loop(), 10, 0)])
        k = node_at(path, 10, 0)
        before = np.array(nodes.handles_at(path, k)["out"]) - (10, 0)
        turned = nodes.move_handle(path, k, "in", (10.0, 3.0))
        out = np.array(nodes.handles_at(turned, node_at(turned, 10, 0))["out"]) - (10, 0)
        assert out == pytest.approx((0.0, -np.hypot(*before)))
        free = nodes.move_handle(path, k, "in", (10.0, 3.0), free=True)
        assert nodes.handles_at(free, node_at(free, 10, 0))["out"] == pytest.approx(
            (before[0] + 10, before[1])
        )
        other = nodes.move_handle(path, k, "out", (14.0, 0.0))
        handle = nodes.handles_at(other, node_at(other, 10, 0))["in"]
        assert handle[0] < 10
        assert handle[1] == pytest.approx(0.0)

    def test_a_handle_laid_on_its_node_leaves_the_other(self):
        path = nodes.make_smooth(loop(), [node_at(loop(), 10, 0)])
        k = node_at(path, 10, 0)
        before = nodes.handles_at(path, k)["out"]
        drawn_in = nodes.move_handle(path, k, "in", (10.0, 0.0))
        assert nodes.handles_at(drawn_in, node_at(drawn_in, 10, 0)) == {"out": before}

    def test_a_straight_piece_has_no_handle(self):
        with pytest.raises(GeometryError, match="no handle"):
            nodes.move_handle(loop(), 0, "in", (1.0, 1.0))
        with pytest.raises(GeometryError, match="no handle"):
            nodes.move_handle(zigzag(), 0, "in", (1.0, 1.0))

    def test_the_ends_of_an_open_path_are_not_made_smooth(self):
        path = zigzag()
        assert nodes.make_smooth(path, [0, 3]) == path
        made = nodes.make_smooth(path, [0, 1])
        assert [len(p) for p in pieces_of(made)] == [4, 4, 2]

    def test_there_and_back_has_no_direction_to_be_smooth_in(self):
        path = Path.polyline([(0, 0), (10, 0), (0, 0), (0, 10)])
        assert nodes.make_smooth(path, [1]) == path

    def test_corners_of_straight_pieces_and_ends_stay_as_they_are(self):
        assert nodes.make_corner(zigzag(), [0, 1, 3]) == zigzag()
        path = loop()
        k = node_at(path, 10, 0)
        made = nodes.make_corner(path, [k])
        assert nodes.handles_at(made, node_at(made, 10, 0)) == {}
        assert [len(p) for p in pieces_of(made)] == [4, 4, 2]
        straight = nodes.make_corner(path, [0, k, node_at(path, 20, 0)])
        assert [len(p) for p in pieces_of(straight)] == [2, 2, 2]

    def test_pieces_beside_a_removed_node_become_one(self):
        assert nodes.remove_nodes(zigzag(), [1]) == Path.polyline([(0, 0), (20, 10), (30, 0)])
        assert nodes.remove_nodes(zigzag(), [0]) == Path.polyline([(10, 0), (20, 10), (30, 0)])
        assert nodes.remove_nodes(zigzag(), [3]) == Path.polyline([(0, 0), (10, 0), (20, 10)])
        ring = nodes.remove_nodes(zigzag(closed=True), [0])
        assert ring.points_mm.tolist() == [[10, 0], [20, 10], [30, 0], [10, 0]]

    def test_a_curve_and_a_side_become_a_curve_of_their_outer_tangents(self):
        path = path_of_cubics([ARCH, [(10.0, 0.0), (20.0, 0.0)], [(20.0, 0.0), (30.0, 5.0)]])
        made = nodes.remove_nodes(path, [node_at(path, 10, 0)])
        first, second = pieces_of(made)
        assert len(second) == 2
        a, out, back, b = first
        assert (a.tolist(), b.tolist()) == ([0, 0], [20, 0])
        assert out[0] == pytest.approx(0.0)  # upwards, as before, twice as long
        assert out[1] == pytest.approx(16.0)
        assert back == pytest.approx((20 - 20 / 3, 0.0))

    def test_long_tangents_are_held_to_the_length_of_the_whole(self):
        far = ((0.0, 0.0), (0.0, 400.0), (10.0, 8.0), (10.0, 0.0))
        path = path_of_cubics([far, [(10.0, 0.0), (20.0, 0.0)]])
        made = nodes.remove_nodes(path, [node_at(path, 10, 0)])
        assert pieces_of(made)[0][1] == pytest.approx((0.0, 20.0))

    def test_a_path_keeps_its_extent(self):
        with pytest.raises(GeometryError, match="lose its extent"):
            nodes.remove_nodes(zigzag(), [0, 1, 2])
        with pytest.raises(GeometryError, match="lose its extent"):
            nodes.remove_nodes(zigzag(closed=True), [1, 2])
        with pytest.raises(GeometryError, match="lose its length"):
            nodes.move_nodes(Path.polyline([(0, 0), (10, 0)]), {1: (0.0, 0.0)})

    def test_the_middle_of_a_curve_lies_on_it(self):
        path = loop()
        last = len(path) - 1
        found = nodes.middles(path, [last, node_at(path, 10, 0)])
        assert found == [pytest.approx((5.0, 6.0))]
        assert nodes.middles(path, [0, node_at(path, 20, 0)]) == [pytest.approx((10.0, 0.0))]
        assert nodes.middles(path, [0]) == []
