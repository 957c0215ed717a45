"""Points through a homography, then moved by a cubic B-spline over a cage, then by pins."""

from __future__ import annotations

import math

from stippler.kernels.machine.jit import inline, kernel


@inline
def _basis(t):
    """Return the four cubic B-splines over one knot span."""
    s = 1.0 - t
    return (
        s * s * s / 6.0,
        (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
        (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
        t * t * t / 6.0,
    )


@inline
def _span(u, n):
    """Return the first of four coefficients for a place in 0..n-1, and the place within."""
    k = min(max(math.floor(u), 0), n - 2)
    return k, min(max(u - k, 0.0), 1.0)


@inline
def _dot4(row, first, b):
    return row[first] * b[0] + row[first + 1] * b[1] + row[first + 2] * b[2] + row[first + 3] * b[3]


@inline
def caged(x, y, box, cx, cy):
    """Return where the cage takes a point; beyond its box it moves like the nearest place."""
    n_rows, n_columns = cx.shape[0] - 2, cx.shape[1] - 2
    u = (x - box[0]) / (box[2] - box[0]) * (n_columns - 1)
    v = (y - box[1]) / (box[3] - box[1]) * (n_rows - 1)
    i, tu = _span(u, n_columns)
    j, tv = _span(v, n_rows)
    bu, bv = _basis(tu), _basis(tv)
    dx = (
        bv[0] * _dot4(cx[j], i, bu) + bv[1] * _dot4(cx[j + 1], i, bu)
        + bv[2] * _dot4(cx[j + 2], i, bu) + bv[3] * _dot4(cx[j + 3], i, bu)
    )  # fmt: skip
    dy = (
        bv[0] * _dot4(cy[j], i, bu) + bv[1] * _dot4(cy[j + 1], i, bu)
        + bv[2] * _dot4(cy[j + 2], i, bu) + bv[3] * _dot4(cy[j + 3], i, bu)
    )  # fmt: skip
    return x + dx, y + dy


@inline
def _pinned(x, y, pins, weights):
    """Return where pins take a point: a thin plate through them; the last rows are affine."""
    n = len(pins)
    dx = weights[n, 0] + weights[n + 1, 0] * x + weights[n + 2, 0] * y
    dy = weights[n, 1] + weights[n + 1, 1] * x + weights[n + 2, 1] * y
    for k in range(n):
        px, py = x - pins[k, 0], y - pins[k, 1]
        r = px * px + py * py
        if r > 0.0:
            u = r * math.log(r)
            dx += weights[k, 0] * u
            dy += weights[k, 1] * u
    return x + dx, y + dy


@kernel
def deform(begin, stop, points, h, has_cage, box, cx, cy, pins, weights, out) -> None:
    """Move points.

    Parameters
    ----------
    points : (n, 2) float64
    h : (3, 3) float64
        The homography.
    has_cage : bool
    box : (4,) float64
        What the cage lies over.
    cx, cy : (rows + 2, columns + 2) float64
        Coefficients of the spline.
    pins, weights : (k, 2), (k + 3, 2) float64
    out : (n, 2) float64
        Is filled.
    """
    is_affine = h[2, 0] == 0.0 and h[2, 1] == 0.0 and h[2, 2] == 1.0
    for k in range(begin, stop):
        px, py = points[k, 0], points[k, 1]
        x = h[0, 0] * px + h[0, 1] * py + h[0, 2]
        y = h[1, 0] * px + h[1, 1] * py + h[1, 2]
        if not is_affine:
            w = h[2, 0] * px + h[2, 1] * py + h[2, 2]
            x, y = x / w, y / w
        if has_cage:
            x, y = caged(x, y, box, cx, cy)
        if len(pins):
            x, y = _pinned(x, y, pins, weights)
        out[k, 0], out[k, 1] = x, y


@kernel
def find_folds(grid, folded) -> int:
    """Mark the cells of a deformed grid that are turned over; return how many are.

    Parameters
    ----------
    grid : (rows, columns, 2) float64
    folded : (rows - 1, columns - 1) bool
        Is filled.
    """
    n = 0
    rows, columns = grid.shape[0], grid.shape[1]
    turn = 0.0
    for j in range(rows - 1):
        for i in range(columns - 1):
            turn += _corner(grid, j, i, 1, 1)
    way = 1.0 if turn >= 0.0 else -1.0
    for j in range(rows - 1):
        for i in range(columns - 1):
            worst = min(
                min(way * _corner(grid, j, i, 1, 1), way * _corner(grid, j + 1, i + 1, -1, -1)),
                min(-way * _corner(grid, j, i + 1, 1, -1), -way * _corner(grid, j + 1, i, -1, 1)),
            )
            folded[j, i] = not worst > 0.0
            n += 1 if folded[j, i] else 0
    return n


@inline
def _corner(grid, j, i, dj, di):
    ax, ay = grid[j, i + di, 0] - grid[j, i, 0], grid[j, i + di, 1] - grid[j, i, 1]
    bx, by = grid[j + dj, i, 0] - grid[j, i, 0], grid[j + dj, i, 1] - grid[j, i, 1]
    return ax * by - ay * bx
