"""A dot in a corner where holes touch stands in one of its two pieces, not in neither."""

import pytest
from shapely.geometry import Polygon

from stippler.stippling.tessellation import Tessellation


def test_the_dot_has_one_piece():
    outer = [(3, 2), (3, 3), (5, 3), (5, 2), (6, 3), (7, 2), (7, 0), (4, 0), (4, 1), (2, 1)]
    shape = Polygon(outer, [[(4, 2), (5, 1), (6, 1), (6, 2), (5, 2)]])
    assert shape.is_valid
    cells = Tessellation.of([[5, 2], [5, 3], [7, 0]], shape)
    assert (cells.area > 0).all()
    assert cells.area[0] == pytest.approx(1.25) or cells.area[0] == pytest.approx(4.5)
