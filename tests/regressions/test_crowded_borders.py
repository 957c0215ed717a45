"""Borders too crowded for the grid were split 40 times, for half a minute, and refused then."""

import time

import numpy as np
import pytest

from stippler.drawing.planar.noding import node_segments
from stippler.errors import GeometryError


@pytest.mark.parametrize("n", [100, 400])
def test_what_has_no_end_is_refused_after_a_few_rounds(n):
    xy = np.random.default_rng(1).integers(0, 9, (n, 4))
    xy = xy[(xy[:, :2] != xy[:, 2:]).any(axis=1)]
    node_segments(np.array([[0, 0, 9, 9]]), np.ones(1, np.bool_))
    began = time.process_time()
    with pytest.raises(GeometryError, match="too close together"):
        node_segments(xy, np.ones(len(xy), np.bool_))
    assert time.process_time() - began < 3.0
