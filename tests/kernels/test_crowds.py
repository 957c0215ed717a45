"""Trees of crowded grid cells: every dot once, few to a leaf, and within its boxes."""

import numpy as np
import pytest

from stippler.kernels.cells.cell_trees import (
    CROWD,
    LEAF,
    bound_crowds,
    link_crowds,
    split_crowds,
)


@pytest.mark.parametrize("n", [CROWD + 1, 64, 65, 1000])
@pytest.mark.parametrize("kind", ["even", "line", "same"])
def test_leaves_are_small_and_boxes_hold_their_dots(n, kind):
    xy = np.random.default_rng(n).random((n + 7, 2))
    if kind != "even":
        xy[:, 1] = 0.5
    if kind == "same":
        xy[:, 0] = 0.25
    crowd, cell_start = np.array([1], np.int32), np.array([0, 3, 3 + n, n + 7], np.int32)
    order = np.random.default_rng(1).permutation(n + 7).astype(np.int32)
    before = order.copy()
    split_crowds(0, 1, crowd, cell_start, *np.ascontiguousarray(xy.T), order)
    np.testing.assert_array_equal(np.sort(order[3 : 3 + n]), np.sort(before[3 : 3 + n]))
    np.testing.assert_array_equal(
        np.delete(order, np.s_[3 : 3 + n]), before[[0, 1, 2, *range(3 + n, n + 7)]]
    )
    depth = int(np.ceil(np.log2(n / LEAF)))
    node = np.full((4 + (2 << depth), 4), np.nan)
    arc = np.full((4 + (2 << depth), 8), np.nan)
    tree_of_cell = np.array([-1, 2, -1], np.int32)
    moved = xy[order] + 0.01 * np.random.default_rng(2).standard_normal((n + 7, 2))
    bound_crowds(0, 1, crowd, tree_of_cell, cell_start, *np.ascontiguousarray(moved.T), node, arc)
    for level in range(depth + 1):
        for v in range(1 << level):
            dots = moved[3 + (n * v >> level) : 3 + (n * (v + 1) >> level)]
            assert 0 < len(dots) <= max(LEAF, -(-n >> level))
            box = node[2 + (1 << level) + v]
            np.testing.assert_array_equal(box, [*dots.min(axis=0), *dots.max(axis=0)])
    assert np.isnan(node[[0, 1, -1, -2]]).all()
    link = np.full((len(node), 2), -9, np.int32)
    link_crowds(0, 1, crowd, tree_of_cell, cell_start, link)
    assert _ends_of_leaves(link, 3) == sorted(
        {3 + (n * v >> depth) for v in range(1, (1 << depth) + 1)}
    )
    assert (link[[0, 1, 2, -1, -2]] == -9).all()


def _ends_of_leaves(link, top):
    """Return where the dots of each leaf end, from left to right; leaves follow one another."""
    first, second = link[top]
    if first < 0:
        return [int(second)]
    left, right = (_ends_of_leaves(link, k) for k in (first, second))
    k = second
    while link[k, 0] >= 0:
        k = link[k, 0]
    assert -1 - link[k, 0] == left[-1]
    return left + right


def test_halves_lie_on_either_side():
    """Of a crowd four times as wide as high, the first two cuts go across its width."""
    xy = np.random.default_rng(0).random((32, 2)) * [4, 1]
    order = np.arange(32, dtype=np.int32)
    start = np.array([0, 32], np.int32)
    split_crowds(0, 1, np.zeros(1, np.int32), start, *np.ascontiguousarray(xy.T), order)
    quarters = xy[order, 0].reshape(4, 8)
    assert (quarters[:-1].max(axis=1) <= quarters[1:].min(axis=1)).all()
