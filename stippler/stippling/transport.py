"""Transport: all long waves of dots evened out at once, on a raster of a few dots a cell.

Relaxation moves dots by less than their spacing, and a wave of a hundred spacings takes it
thousands of steps. What has to flow is known at once: the potential whose gradient carries the
surplus of each cell to where dots are missing solves one sparse system. Its conductance is the
density that is wanted, so nothing flows through what is to stay white. It is the Newton step of
semi-discrete transport (de Goes, Breeden, Ostromoukhov, Desbrun 2012; Kitagawa, Merigot, Thibert
2019) on a raster instead of the dots' own cells, which is enough for what relaxation cannot do.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from shapely import contains_xy
from shapely.geometry import MultiPolygon, Polygon

from stippler.stippling.compartments import Shape

_CELL = 2.0  # mean spacings of the dots a side of the raster's cells
_MOST_CELLS = 62_500
_ROUNDS = 3
_FEWEST = 100  # dots of an outline that can have long waves
_BLOCK = 6.0  # mean spacings a side of the blocks that are counted
_BY_CHANCE = 0.6  # of chance's unevenness, from which on dots are evened out
_FARTHEST = 0.7  # of a cell, in each round
_LEAK = 1e-9  # of the mean wanted: without it a part of the raster has no one solution
_EMPTY = 1e-3  # of the mean wanted in a cell; a cell that wants less takes no part

_Solve = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def evened_out(
    points: NDArray[np.float64],
    wanted: NDArray[np.floating],
    pixel: float = 1.0,
    origin: tuple[float, float] = (0.0, 0.0),
    held: NDArray[np.bool_] | None = None,
) -> NDArray[np.float64]:
    """Move dots so that there are as many everywhere, over longer ways, as is wanted there.

    Parameters
    ----------
    points : (n, 2) float64
    wanted : (h, w) float
        How dense dots are to be, in any unit; white is 0.
    pixel : float
        Side of its pixels, in the unit of the points.
    origin : (float, float)
        Its first corner.
    held : (n,) bool, optional
        Dots that stay; the others even them out.

    Returns
    -------
    (n, 2) float64
        No dot moves farther than about four of its spacings, and none from ink to white.
    """
    h, w = wanted.shape
    inked = int(np.count_nonzero(wanted))
    if len(points) < 2 or not inked:
        return points
    spacing_px = math.sqrt(inked / len(points))
    side = max(_CELL * spacing_px, math.sqrt(h * w / _MOST_CELLS), 1.0)
    n_rows, n_columns = max(1, round(h / side)), max(1, round(w / side))
    mass = _binned(np.asarray(wanted, np.float64), n_rows, n_columns)
    scale = np.array([n_columns / w, n_rows / h]) / pixel  # from the points' unit to cells
    at = (points - origin) * scale
    parts = _shared_out(mass, at)
    solve = _solver(mass)
    in_pixels = np.array([w / n_columns, h / n_rows])
    for _ in range(_ROUNDS):
        moved = at + _flow(at, mass, solve)
        np.clip(moved, 0.0, [n_columns, n_rows], out=moved)
        stays = (_under(moved * in_pixels, wanted) <= 0) | (
            _under(moved, parts) != _under(at, parts)
        )
        if held is not None:
            stays |= held
        at = np.where(stays[:, None], at, moved)
    out: NDArray[np.float64] = at / scale + origin
    if held is not None:
        out[held] = points[held]
    return out


def _binned(field: NDArray[np.float64], n_rows: int, n_columns: int) -> NDArray[np.float64]:
    """Sum a field over cells whose sides need not be whole pixels."""
    for axis, n in ((0, n_rows), (1, n_columns)):
        sums = np.concatenate((np.zeros_like(field.take([0], axis)), field.cumsum(axis)), axis)
        at = np.linspace(0.0, field.shape[axis], n + 1)
        below = np.minimum(at.astype(np.intp), field.shape[axis] - 1)
        shape = [1, 1]
        shape[axis] = -1
        part = (at - below).reshape(shape)
        edges = sums.take(below, axis) * (1.0 - part) + sums.take(below + 1, axis) * part
        field = np.diff(edges, axis=axis)
    return field


def with_long_waves_gone(
    position_mm: NDArray[np.float64],
    outlines: Sequence[Shape | NDArray[np.float64]],
    outline_of_dot: NDArray[np.integer],
    held: NDArray[np.bool_],
    wanted_at: Callable[[NDArray[np.float64]], NDArray[np.floating]] | None = None,
) -> NDArray[np.float64]:
    """Even out, each within its outline, dots that lie as unevenly over longer ways as by chance.

    Dots that are even already are left alone, so that doing it again changes nothing.

    Parameters
    ----------
    position_mm : (n, 2) float64
    outlines : sequence of polygons or (m, 2) arrays, mm
    outline_of_dot : (n,) int
    held : (n,) bool
        Dots that stay.
    wanted_at : function of (m, 2) positions, optional
        How dense dots are to be there, in any unit; without it as dense everywhere.

    Returns
    -------
    (n, 2) float64
    """
    at = position_mm.copy()
    for k, outline in enumerate(outlines):
        shape = outline if isinstance(outline, (Polygon, MultiPolygon)) else Polygon(outline)
        mine = np.flatnonzero(outline_of_dot == k)
        if len(mine) < _FEWEST or held[mine].all():
            continue
        x0, y0, x1, y1 = shape.bounds
        pixel = math.sqrt(shape.area / len(mine))
        x = np.arange(x0 + 0.5 * pixel, x1 + 0.5 * pixel, pixel)
        y = np.arange(y0 + 0.5 * pixel, y1 + 0.5 * pixel, pixel)
        places = np.stack(np.meshgrid(x, y), axis=-1)
        wanted = contains_xy(shape, places[..., 0], places[..., 1]).astype(np.float64)
        if wanted_at is not None:
            wanted *= wanted_at(places.reshape(-1, 2)).reshape(wanted.shape)
        if _unevenness(at[mine], wanted, pixel, (x0, y0)) < _BY_CHANCE:
            continue
        moved = evened_out(at[mine], wanted, pixel, (x0, y0), held[mine])
        inside = contains_xy(shape, moved[:, 0], moved[:, 1])
        at[mine[inside]] = moved[inside]
    return at


def _unevenness(
    points: NDArray[np.float64],
    wanted: NDArray[np.float64],
    pixel: float,
    origin: tuple[float, float],
) -> float:
    """Return by how much blocks of about 36 dots miss what they want; 1 is what chance does."""
    h, w = wanted.shape
    rows, columns = max(1, round(h / _BLOCK)), max(1, round(w / _BLOCK))
    mass = _binned(wanted, rows, columns)
    if not mass.any():
        return 0.0
    mass *= len(points) / mass.sum()
    row = np.clip((points[:, 1] - origin[1]) / (h * pixel) * rows, 0, rows - 1).astype(np.intp)
    column = np.clip((points[:, 0] - origin[0]) / (w * pixel) * columns, 0, columns - 1)
    found = np.bincount(row * columns + column.astype(np.intp), minlength=mass.size)
    full = mass.ravel() > 0.5 * mass.max()
    off = (found - mass.ravel())[full] / np.sqrt(mass.ravel()[full])
    return float(np.sqrt(np.mean(np.square(off))))


def _shared_out(mass: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.intp]:
    """Make each part of the raster that hangs together want the dots it has; return the parts."""
    from scipy.ndimage import label  # a quarter of a second to import

    mass[mass <= _EMPTY * mass.mean()] = 0.0
    parts, n_parts = label(mass > 0.0)
    n_dots = np.bincount(_under(at, parts), minlength=n_parts + 1)
    wants = np.bincount(parts.ravel(), mass.ravel(), n_parts + 1)
    mass *= (n_dots / np.maximum(wants, 1e-300))[parts]
    return np.asarray(parts, np.intp)


def _flow(at: NDArray[np.float64], mass: NDArray[np.float64], solve: _Solve) -> NDArray[np.float64]:
    """Return the way of each dot, in cells, by which cells come to hold the dots they want."""
    n_rows, n_columns = mass.shape
    surplus = np.where(mass > 0.0, _spread(at, n_rows, n_columns) - mass, 0.0)
    along_x = np.zeros((n_rows, n_columns + 1))
    along_y = np.zeros((n_rows + 1, n_columns))
    potential = solve(surplus.ravel()).reshape(mass.shape)
    open_ = mass > 0.0
    along_x[:, 1:-1] = np.where(
        open_[:, 1:] & open_[:, :-1], potential[:, :-1] - potential[:, 1:], 0.0
    )
    along_y[1:-1] = np.where(open_[1:] & open_[:-1], potential[:-1] - potential[1:], 0.0)
    x, y = at.T
    column = np.clip(x.astype(np.intp), 0, n_columns - 1)
    row = np.clip(y.astype(np.intp), 0, n_rows - 1)
    t, u = x - column, y - row
    way = np.column_stack((
        (1.0 - t) * along_x[row, column] + t * along_x[row, column + 1],
        (1.0 - u) * along_y[row, column] + u * along_y[row + 1, column],
    ))  # fmt: skip
    np.clip(way, -_FARTHEST, _FARTHEST, out=way)
    return way


def _spread(at: NDArray[np.float64], n_rows: int, n_columns: int) -> NDArray[np.float64]:
    """Share each dot out to the four cells whose middles are nearest; the border's keep all."""
    total = np.zeros(n_rows * n_columns)
    x, y = at[:, 0] - 0.5, at[:, 1] - 0.5
    left, top = np.floor(x).astype(np.intp), np.floor(y).astype(np.intp)
    t, u = x - left, y - top
    for k, weight_x in ((0, 1.0 - t), (1, t)):
        column = np.clip(left + k, 0, n_columns - 1)
        for n, weight_y in ((0, 1.0 - u), (1, u)):
            row = np.clip(top + n, 0, n_rows - 1)
            total += np.bincount(row * n_columns + column, weight_x * weight_y, len(total))
    return total.reshape(n_rows, n_columns)


def _solver(mass: NDArray[np.float64]) -> _Solve:
    """Return what solves for the potential whose flow takes a surplus away.

    It flows as easily as dots are dense. The matrix is factored once; unlike conjugate gradients
    that gives the same result for any number of threads.
    """
    from scipy.sparse import csc_matrix, diags  # these, too
    from scipy.sparse.linalg import splu

    number = np.arange(mass.size).reshape(mass.shape)
    first: list[NDArray[np.intp]] = []
    second: list[NDArray[np.intp]] = []
    weight: list[NDArray[np.float64]] = []
    for a, b in ((np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:-1], np.s_[1:])):
        conducts = (mass[a] > 0.0) & (mass[b] > 0.0)
        first.append(number[a][conducts])
        second.append(number[b][conducts])
        weight.append(0.5 * (mass[a] + mass[b])[conducts])
    pairs = np.concatenate(first), np.concatenate(second)
    through = csc_matrix((np.concatenate(weight), pairs), shape=(mass.size, mass.size))
    through = through + through.T
    degree = np.asarray(through.sum(axis=1)).ravel() + _LEAK * mass.mean()
    solve: _Solve = splu(
        (diags(degree) - through).tocsc(), permc_spec="MMD_AT_PLUS_A",
        options={"SymmetricMode": True},
    ).solve  # fmt: skip
    return solve


def _under(at: NDArray[np.float64], field: NDArray[Any]) -> NDArray[Any]:
    """Return the values of the cells that dots lie in."""
    n_rows, n_columns = field.shape
    column = np.clip(at[:, 0].astype(np.intp), 0, n_columns - 1)
    row = np.clip(at[:, 1].astype(np.intp), 0, n_rows - 1)
    under: NDArray[Any] = field[row, column]
    return under
