"""Long lines that cross themselves took minutes: their zones, and where they cross."""

import numpy as np
import shapely

from stippler.drawing.line import Line
from stippler.drawing.planar.path import Path
from stippler.stippling.lines import crossings
from stippler.stippling.part_of_area import zone_of


def test_the_zone_of_a_long_scribble_is_what_it_is_at_once():
    t = np.linspace(0.0, 2 * np.pi, 2300)
    at = np.column_stack([50 + 20 * np.cos(7 * t), 30 + 15 * np.sin(6 * t)])
    line = Line("scribble", Path.polyline(at), (0.1, 0.1), meeting="distance", distance_mm=0.4)
    found = zone_of(line)
    near = shapely.buffer(shapely.linestrings(at), 0.45, quad_segs=16)
    assert found.is_valid
    assert shapely.difference(near, found).area < 1e-9  # no place nearer is left out of it
    assert found.area < 1.002 * near.area


def test_a_tangle_is_left_without_crossings_and_a_loop_is_not():
    rng = np.random.default_rng(1)
    tangle = Line("tangle", Path.polyline(rng.random((4000, 2)) * 100))
    assert crossings([tangle]) == []
    t = np.linspace(0.0, 2 * np.pi, 3001)
    loop = np.column_stack([50 + 20 * np.cos(3 * t), 30 + 15 * np.sin(2 * t)])
    assert len(crossings([Line("loop", Path.polyline(loop))])) == 7
