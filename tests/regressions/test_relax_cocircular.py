"""A hundred dots on a circle: their bisectors meet in one point, where rounding decides nothing.

A bisector that found one corner at the centre out and its neighbour in cut there, at nothing, and
left the far side of the cell whole.
"""

import numpy as np
import pytest
from shapely.geometry import box

from stippler.stippling.relax import Relaxation


@pytest.mark.parametrize("n", [7, 30, 90, 400])
@pytest.mark.parametrize("turn", [0.0, 0.1, 1.0])
def test_cells_share_out_the_square(n, turn):
    angle = turn + 2 * np.pi * np.arange(n) / n
    dots = 0.5 + 0.4 * np.c_[np.cos(angle), np.sin(angle)]
    areas = Relaxation(dots, box(0, 0, 1, 1)).cell_areas()
    assert areas.sum() == pytest.approx(1.0, rel=1e-12)
    # a wedge of the square, from its centre: known by the rays between the dots
    rays = angle - np.pi / n
    ends = np.c_[np.cos(rays), np.sin(rays)]
    ends *= 0.5 / np.abs(ends).max(axis=1, keepdims=True)
    inside = np.abs(np.cross(np.c_[ends, 0 * rays], np.roll(np.c_[ends, 0 * rays], -1, 0))[:, 2])
    sides = np.abs(ends).argmax(axis=1) * 2 + (ends[np.arange(n), np.abs(ends).argmax(1)] > 0)
    flat = sides == np.roll(sides, -1)  # wedges without a corner of the square
    np.testing.assert_allclose(areas[flat], inside[flat] / 2, rtol=0, atol=1e-12)
