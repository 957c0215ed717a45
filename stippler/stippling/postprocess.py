"""The last touches to relaxed dots, before their sizes are solved."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.cells.close_pairs import find_close, push_apart
from stippler.kernels.cells.grid import sort_by_grid_cell
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tone.edge_ink import even_rim as even_along
from stippler.stippling.compartments import Compartments
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.radii import solve_radii
from stippler.stippling.tessellation import made

_APART = 0.5  # of the distance to the seventh neighbour
_ENOUGH = 1.0  # of the spacing that the density asks for
_ROUNDS = 5
_BAND = 3.0  # mean spacings; dots that moves across the edge may come close to
_CELLS = 6.0  # mean spacings; dots whose cells bound those of dots at the edge
_NEAR = 1.6  # radii; dots so near the edge may come to touch it
_LINE = 0.15  # radii; how far inside the edge the ink is compared, whatever the pixels


def part_close(
    points: NDArray[np.float64],
    raster: PageRaster,
    awake: NDArray[np.bool_] | None = None,
    within: tuple[Compartments, NDArray[np.int32]] | None = None,
) -> NDArray[np.float64]:
    """Push dots apart that lie closer than half as far as their seventh neighbours.

    Relaxed dots keep a few such pairs, one in a hundred, where rows of dots end. Those at the
    page's edge slide along it.

    Parameters
    ----------
    points : (n, 2) float64, pixels
        Not modified.
    awake : (n,) bool, optional
        Look only at these and their nearest; None: at all.
    within : Compartments and (n,) int32, optional
        In pixels, and the compartment of each dot: none leaves its own.
    """
    n = len(points)
    points = np.array(points)
    if n < 2:
        return points
    order, cell_start, frame = sorted_by_place(points, raster.darkness)
    xy = points[order]  # few dots move, and not far: the grid of the first round serves all
    radii, density = raster.wanted_at(xy)
    enough = _ENOUGH / np.sqrt(np.maximum(density, 1e-12))
    rim = radii if raster.bleed else np.zeros(n)
    up = np.ones(n, bool) if awake is None else awake[order]
    nearest, rows = np.zeros(n, np.int32), np.empty(n, np.int32)
    lack, moves = np.empty(n), np.zeros((n, 2))
    for _ in range(_ROUNDS):
        before = xy.copy() if within else xy
        parallel_for(find_close, n, xy, cell_start, frame, _APART, enough, up, nearest, lack)
        if not push_apart(xy, nearest, lack, raster.darkness, rim, moves, rows, up):
            break
        if within:
            moved = np.flatnonzero((xy != before).any(axis=1))
            out = moved[~within[0].contain(xy[moved], within[1][order[moved]])]
            xy[out], up[out] = before[out], False
    points[order] = xy
    return points


def at_edge(points: NDArray[np.float64], raster: PageRaster) -> NDArray[np.bool_]:
    """Tell which dots have to do with the page's edge."""
    return _inwards(points, raster) < _BAND * _spacing(points, raster)


def even_rim(points: NDArray[np.float64], raster: PageRaster, give: float) -> NDArray[np.float64]:
    """Move dots at the page's edge across it until the ink along the edge meets the tone.

    Without this the edge cuts dots as chance will have it, and the rim looks frayed: here too
    dark, there too light, over a few dots.

    Parameters
    ----------
    points : (n, 2) float64, pixels
        Not modified.
    give : float
        How far a dot may move, in its radius.
    """
    points = np.array(points)
    darkness = raster.darkness
    inwards, width = _inwards(points, raster), _CELLS * _spacing(points, raster)
    strip = np.flatnonzero(inwards < 2.0 * width)
    within = np.flatnonzero(inwards[strip] < width)
    band = strip[within]
    if not len(band):
        return points
    radii = solve_radii(made(raster.cells(points[strip], within, 2.0 * width)), raster.rule)
    line = _LINE * raster.rule.radius_min
    for axis, far, edge in (
        (1, False, darkness[0]),
        (1, True, darkness[-1]),
        (0, False, darkness[:, 0]),
        (0, True, darkness[:, -1]),
    ):
        size = darkness.shape[1 - axis]
        inwards = points[band, axis]
        if far:
            inwards = size - inwards
        near = np.flatnonzero(inwards < _NEAR * radii)
        near = near[np.argsort(points[band[near], 1 - axis], kind="stable")]
        which, inwards = band[near], inwards[near]
        asked = np.concatenate(([0.0], np.cumsum(edge, dtype=np.float64)))
        even_along(points[which, 1 - axis], inwards, radii[near], asked, line, give)
        inwards = np.clip(inwards, 1e-9 * size, (1.0 - 1e-9) * size)
        points[which, axis] = size - inwards if far else inwards
    return points


def _inwards(points: NDArray[np.float64], raster: PageRaster) -> NDArray[np.float64]:
    """Return how far dots lie from the nearest edge of the page."""
    size = np.array(raster.darkness.shape[::-1], np.float64)
    distance: NDArray[np.float64] = np.minimum(points, size - points).min(axis=1)
    return distance


def sorted_by_place(
    points: NDArray[np.float64], darkness: NDArray[np.float32]
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float64]]:
    """Sort dots into a uniform grid; return the order, each grid cell's start, and the frame.

    The frame holds width and height of the page, side of a grid cell, columns and rows.
    """
    n, (h, w) = len(points), darkness.shape
    inked = max(float(np.count_nonzero(darkness[::4, ::4])) * 16.0, 0.05 * h * w)
    side = max(math.sqrt(1.2 * min(inked, h * w) / n), max(h, w) / 30_000)
    columns, rows = max(1, math.ceil(w / side)), max(1, math.ceil(h / side))
    column = np.clip((points[:, 0] / side).astype(np.int32), 0, columns - 1)
    row = np.clip((points[:, 1] / side).astype(np.int32), 0, rows - 1)
    cell_start = np.zeros(columns * rows + 1, np.int32)
    order = np.empty(n, np.int32)
    sort_by_grid_cell(row * np.int32(columns) + column, cell_start, order)
    return order, cell_start, np.array([w, h, side, columns, rows], np.float64)


def _spacing(points: NDArray[np.float64], raster: PageRaster) -> float:
    return math.sqrt(raster.darkness.size / max(len(points), 1))
