"""A knife that went nowhere made a line of one point, and shapely has none; found by the soak."""

import numpy as np

from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import PlanarMap
from stippler.editor.tools.knife_tool import crossed_by


def test_a_line_of_one_point_crosses_nothing():
    point = Path(np.array([[5, 5]], np.int64))
    assert crossed_by(PlanarMap.of_page(100.0, 80.0), point) == []
