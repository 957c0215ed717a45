"""One dot of 20 mm among 80,000 small ones made each upload and PNG 150 times slower."""

import math

import numpy as np
import pytest
import shapely

from stippler.kernels.tone.union_share import shares_of_union, sort_discs


def mixed(n, largest, seed=1):
    rng = np.random.default_rng(seed)
    radius = 0.1 * np.exp(rng.random(n) * math.log(largest / 0.1))
    return np.column_stack([rng.random((n, 2)) * 60, radius]).astype(np.float32)


@pytest.mark.parametrize("largest", [0.2, 2.0, 40.0])
def test_shares_of_dots_of_all_sizes_add_up_to_the_union(largest):
    discs = mixed(300, largest)
    centres, radii = discs[:, :2].astype(float), discs[:, 2].astype(float)
    shapes = shapely.buffer(shapely.points(centres), radii, quad_segs=64)
    shares = shares_of_union(discs).astype(float)
    found = math.pi * float((shares * radii**2).sum())
    assert found == pytest.approx(shapely.union_all(shapes).area, rel=0.01)


def test_cells_hold_few_dots_whatever_the_largest_is():
    discs = mixed(20_000, 0.2)
    discs[7, 2] = 20.0
    order, by_cell = np.empty(len(discs), np.int64), np.empty((len(discs), 3), np.float32)
    grids = sort_discs(discs, order, by_cell)
    assert sorted(order) == list(range(len(discs)))
    for n_x, n_y, base in grids.whole:
        first = grids.first[base : base + n_x * n_y + 1]
        assert np.diff(first).max() < 20
