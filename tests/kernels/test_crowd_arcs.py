"""Bounds of dots along curves: no dot lies beyond them, and on circles they are close."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.kernels.cells.cell_trees import bound_crowds, levels_of, split_crowds
from stippler.kernels.machine.jit import kernel


@kernel
def _levels(n: int) -> int:
    return levels_of(n)


def _bounded(xy):
    """Return the dots in the order of their tree, its boxes, and what is told of arcs."""
    n = len(xy)
    crowd, start, order = np.zeros(1, np.int32), np.array([0, n], np.int32), np.arange(n)
    order = order.astype(np.int32)
    split_crowds(0, 1, crowd, start, *np.ascontiguousarray(xy.T), order)
    depth = _levels(n)
    node, arc = np.zeros((2 << depth, 4)), np.full((2 << depth, 8), np.nan)
    xy = xy[order]
    bound_crowds(0, 1, crowd, np.zeros(1, np.int32), start, *np.ascontiguousarray(xy.T), node, arc)
    return xy, node, arc, depth


def _nodes(n, depth):
    for level in range(depth + 1):
        for v in range(1 << level):
            yield (1 << level) + v, slice((n * v) >> level, (n * (v + 1)) >> level)


@given(
    radius=st.floats(1e-2, 1e3), length=st.floats(1e-6, 6.0), turn=st.floats(0, 6.3),
    noise=st.sampled_from([0.0, 1e-14, 1e-9, 1e-3]), n=st.integers(25, 300),
    seed=st.integers(0, 99),
)  # fmt: skip
def test_all_dots_lie_within(radius, length, turn, noise, n, seed):
    rng = np.random.default_rng(seed)
    angle = turn + length * np.sort(rng.random(n))
    xy = np.c_[np.cos(angle), np.sin(angle)] * (radius + noise * rng.standard_normal((n, 1)))
    xy, node, arc, depth = _bounded(xy)
    if node[0, 0] == 0.0:
        return
    for k, dots in _nodes(n, depth):
        if arc[k, 4] < 0.0:
            continue
        x, y, tx, ty, ratio, ax, ay, least = arc[k]
        o = xy[dots] - [x, y]
        far = np.hypot(tx, ty)
        assert (abs(o @ [tx, ty]) <= far * far * (1 + 1e-9)).all()
        assert (abs(o @ [-ty, tx]) <= ratio * far * far * (1 + 1e-9) + 1e-15 * far * far).all()
        over = (o * o).sum(axis=1) - o @ [ax, ay] - least
        assert (over >= -1e-15 * far * (4 * far + 4 * np.hypot(ax, ay))).all()


@pytest.mark.parametrize("n", [25, 64, 160])
def test_a_circle_through_all_dots_holds_none(n):
    angle = 0.7 + 0.02 * np.arange(n) / n
    _, node, arc, depth = _bounded(np.c_[np.cos(angle), np.sin(angle)])
    assert node[0, 0] == 1.0
    for k, _ in _nodes(n, depth):
        x, y, tx, ty, ratio, ax, ay, least = arc[k]
        slope = np.array([ax + 2 * x, ay + 2 * y])  # the circle's middle is the origin
        spread = abs(slope @ [tx, ty]) + ratio * abs(slope @ [-ty, tx])
        assert x * x + y * y + least - spread == pytest.approx(1.0, abs=1e-13)


def test_nothing_is_told_of_dots_all_over():
    _, node, _, _ = _bounded(np.random.default_rng(0).random((200, 2)))
    assert node[0, 0] == 0.0
