"""An edge from 5e-143 to 4e-286 lost its slope as products came to 0; a dot beside it: its area."""

import numpy as np
import shapely

from stippler.drawing.partition import Partition


def test_dots_beside_an_edge_that_is_nearly_level_lie_in_their_area():
    outline = shapely.Polygon([(4.8e-143, 0.0), (0.0, 1.0), (2.0, 4.0e-286)])
    inside = np.array([[0.16, 0.13], [0.5, 0.01], [1.2, 0.3], [4.8e-143, 0.0], [2.0, 4.0e-286]])
    assert Partition({1: outline}).area_at(inside).tolist() == [1] * 5
    outside = np.array([[0.5, -0.01], [1.2, 0.5], [-0.01, 0.5]])
    assert (Partition({1: outline}).area_at(outside) != 1).all()
    assert (Partition({1: outline}).area_at(np.full((1, 2), np.nan)) != 1).all()
