"""Trees over all dots of a compartment: each dot once below the root, and within all bounds."""

import numpy as np
import pytest
from shapely.geometry import box

from stippler.stippling.relax import Relaxation


def _dots_below(k, crowds, xy, rows):
    """Return the dots below node k; its box and what is told of its curve hold for them."""
    first, second = crowds.link[k]
    if first < 0:
        dots = list(range(-1 - first, second))
    else:
        dots = _dots_below(first, crowds, xy, rows) + _dots_below(second, crowds, xy, rows)
    assert k not in rows, "a node is below two"
    rows.add(k)
    at = xy[dots]
    np.testing.assert_array_equal(crowds.node[k], [*at.min(axis=0), *at.max(axis=0)])
    x, y, tx, ty, ratio, ax, ay, least = crowds.arc[k]
    if ratio >= 0.0:
        o, far2 = at - [x, y], tx * tx + ty * ty
        assert (abs(o @ [tx, ty]) <= far2 * (1 + 1e-9)).all()
        assert (abs(o @ [-ty, tx]) <= ratio * far2 * (1 + 1e-9) + 1e-14 * far2).all()
        assert ((o * o).sum(axis=1) - o @ [ax, ay] - least >= -1e-14).all()
    return dots


def _engine(n_each):
    """Return dots in boxes side by side, along circles in every other one, here and there else."""
    rng = np.random.default_rng(3)
    parts, dots, owner = [], [], []
    for k, n in enumerate(n_each):
        parts.append(box(2 * k, 0, 2 * k + 1.5, 1.5))
        if k % 2:
            xy = 0.1 + 1.3 * rng.random((n, 2))
        else:
            angle = 2 * np.pi * rng.random(n)
            xy = 0.75 + 0.6 * np.c_[np.cos(angle), np.sin(angle)]
        dots.append(xy + np.array([2 * k, 0]))
        owner.append(np.full(n, k))
    return Relaxation(np.vstack(dots), parts, compartment_of_dot=np.concatenate(owner))


@pytest.mark.parametrize("n_each", [[3000], [900, 700, 2000, 40, 1], [50, 2000], [0, 300, 5000]])
def test_all_dots_lie_below_the_root_of_their_compartment(n_each):
    cells = _engine(n_each)._cells
    cells._sort()
    crowds, n = cells._crowds, sum(n_each)
    xy, owner = np.c_[cells.xs[:n], cells.ys[:n]], cells.compartment_of_dot
    rows = set()
    roots = crowds.root if len(crowds.root) else np.full(len(n_each), -1)
    assert len(roots) == len(n_each)
    for k, root in enumerate(roots):
        if root < 0:
            assert k % 2 or n_each[k] < 1000, "dots along a curve have no tree"
            continue
        below = _dots_below(int(root), crowds, xy, rows)
        np.testing.assert_array_equal(np.sort(below), np.flatnonzero(owner == k))


def test_bounds_follow_dots_that_have_moved():
    cells = _engine([4000, 500])._cells
    cells._sort()
    cells.xs[:4500] += 0.01 * np.random.default_rng(0).random(4500)
    cells._crowds.bound(cells.xs, cells.ys)
    xy = np.c_[cells.xs[:4500], cells.ys[:4500]]
    assert len(_dots_below(int(cells._crowds.root[0]), cells._crowds, xy, set())) == 4000


def test_dots_all_over_need_no_such_tree():
    cells = Relaxation(np.random.default_rng(0).random((5000, 2)) ** 4, box(0, 0, 1, 1))._cells
    cells._sort()
    assert len(cells._crowds.cell) > 0
    assert len(cells._crowds.root) == 0
