"""Dots at equal distances, and in rows along a direction; all lengths are pixels."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_TRIES = 10
_ROWS = 1.25  # distance of rows, of the mean spacing in a middle tone
_OFF = 0.3  # of its distance to the next, that a dot lies off within its row
_SAMPLES = 6.0  # places along a row at which a spacing is looked at


def grid(density: NDArray[np.float32], kind: str, angle_rad: float, n_wanted: int | None) -> Floats:
    """Lay a turned grid over all that is not white, of about as many dots as the density asks.

    Parameters
    ----------
    density : (h, w) float32
        Dots per square pixel.
    kind : {"hexagonal", "square"}
    """
    inked = int(np.count_nonzero(density))
    wanted = float(density.sum(dtype=np.float64)) if n_wanted is None else float(n_wanted)
    if inked == 0 or wanted < 0.5:
        return np.empty((0, 2))
    pitch = math.sqrt(0.75) if kind == "hexagonal" else 1.0
    spacing = math.sqrt(inked / wanted / pitch)
    shift = 0.5 if kind == "hexagonal" else 0.0

    def laid(spacing: float) -> Floats:
        return _on_ink(_turned_lattice(density.shape, spacing, pitch, shift, angle_rad), density)

    return _met(laid, spacing, wanted)


def rows_along(
    density: NDArray[np.float32], angle_rad: float, n_wanted: int | None, seed: int
) -> Floats:
    """Set dots in rows along a direction, as close in each row as the density asks.

    Within its row each dot lies a little off by chance, so that no second direction shows.
    """
    total = float(density.sum(dtype=np.float64))
    wanted = total if n_wanted is None else float(n_wanted)
    if total <= 0.0 or wanted < 0.5:
        return np.empty((0, 2))
    typical = float(np.square(density).sum(dtype=np.float64)) / total  # where most dots are
    spacing = 1.0 / math.sqrt(typical)

    def laid(factor: float) -> Floats:
        return _rows(density / np.float32(factor**2), _ROWS * spacing, angle_rad, seed)

    return _met(laid, 1.0, wanted)


def _rows(density: NDArray[np.float32], gap: float, angle_rad: float, seed: int) -> Floats:
    h, w = density.shape
    step = gap / _SAMPLES
    reach = 0.5 * math.hypot(w, h)
    along = np.arange(-reach, reach, step)
    across = np.arange(-reach + 0.5 * gap, reach, gap)
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    x = 0.5 * w + c * along[None, :] - s * across[:, None]
    y = 0.5 * h + s * along[None, :] + c * across[:, None]
    inside = (x >= 0) & (x < w) & (y >= 0) & (y < h)
    at = np.where(inside, x, 0).astype(np.intp), np.where(inside, y, 0).astype(np.intp)
    charge = np.where(inside, density[at[1], at[0]], 0.0) * (gap * step)
    sums = np.cumsum(charge, axis=1, dtype=np.float64)
    rng = np.random.default_rng([seed, len(across)])
    phase = rng.random(len(across))[:, None]
    passed = np.floor(sums + phase)
    before = np.concatenate((np.floor(phase), passed[:, :-1]), axis=1)
    row, column = np.nonzero(passed > before)
    over = (sums + phase)[row, column] - passed[row, column]
    back = over / np.maximum(charge[row, column], 1e-12)
    t = along[column] + (0.5 - np.minimum(back, 1.0)) * step
    t += step / np.maximum(charge[row, column], 1e-12) * rng.uniform(-_OFF, _OFF, len(t))
    points = np.column_stack((0.5 * w + c * t - s * across[row], 0.5 * h + s * t + c * across[row]))
    return _on_ink(points, density)


def _turned_lattice(
    shape: tuple[int, ...], spacing: float, pitch: float, shift: float, angle_rad: float
) -> Floats:
    h, w = shape
    reach = 0.5 * math.hypot(w, h)
    rows = np.arange(
        -math.ceil(reach / (pitch * spacing)), math.ceil(reach / (pitch * spacing)) + 1
    )
    columns = np.arange(-math.ceil(reach / spacing) - 1, math.ceil(reach / spacing) + 2)
    along = (columns[None, :] + shift * np.mod(rows, 2)[:, None] + 0.25) * spacing
    across = np.broadcast_to(((rows + 0.25) * pitch * spacing)[:, None], along.shape)
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    x, y = 0.5 * w + c * along - s * across, 0.5 * h + s * along + c * across
    return np.column_stack((x.ravel(), y.ravel()))


def _on_ink(points: Floats, density: NDArray[np.float32]) -> Floats:
    h, w = density.shape
    x, y = points.T
    inside = (x >= 0) & (x < w) & (y >= 0) & (y < h)
    points = points[inside]
    column, row = points.astype(np.intp).T
    kept: Floats = points[density[row, column] > 0.0]
    return kept


def _met(laid: Callable[[float], Floats], spacing: float, wanted: float) -> Floats:
    """Change the spacing until there are nearly as many dots as wanted; return the best try."""
    best = points = laid(spacing)
    for _ in range(_TRIES):
        if abs(len(points) - wanted) <= 0.002 * wanted:
            break
        spacing *= math.sqrt(max(len(points), 0.25 * wanted) / wanted)
        points = laid(spacing)
        if abs(len(points) - wanted) < abs(len(best) - wanted):
            best = points
    return best
