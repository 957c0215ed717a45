"""A dot on the topmost corner of a polygon took another piece of its cell for its own."""

import numpy as np
import pytest
import shapely
from shapely import affinity
from shapely.geometry import Polygon

from stippler.stippling.relax import Relaxation

SHAPE = Polygon([(-0.01, 0.0), (-0.6, 0.58), (-0.01, 0.01), (0.0, 0.84), (0.89, 0.46)])
DOTS = np.array([(0.5, 0.42), (0.0, 0.84)])


@pytest.mark.parametrize("offset", [0.0, 1e3, 1e6])
@pytest.mark.parametrize("quarter_turns", range(4))
def test_a_dot_on_an_outermost_corner_stays_inside(quarter_turns, offset):
    def placed(geometry):
        turned = affinity.rotate(geometry, 90 * quarter_turns, origin=(0, 0))
        return affinity.translate(turned, offset, offset)

    shape = placed(SHAPE)
    dots = shapely.get_coordinates([placed(shapely.Point(xy)) for xy in DOTS])
    dots[1] = shapely.get_coordinates(shape.exterior)[3]
    engine = Relaxation(dots, shape)
    assert engine.cell_areas()[1] > 0.05
    for _ in range(5):
        engine.step()
        assert shapely.intersects_xy(shape, *engine.points.T).all()
