"""Running sums of a density, for the windows of it that compartments lie in."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.kernels.cells.field import sum_rows
from stippler.kernels.cells.tables import Field
from stippler.kernels.machine.pool import parallel_for
from stippler.stippling.compartments import Compartments
from stippler.stippling.density import DensityField
from stippler.stippling.picture_field import PictureField

Weights = DensityField | PictureField

NO_FIELD = Field(np.empty(0), np.empty((0, 4)), np.empty((0, 6), np.int64))
"""Of relaxation without weights."""

_ROUNDING = 1e-9  # of a pixel
_NO_TABLES = np.empty((0, 0), np.float32)

Whole = NDArray[np.int64]


def running_sums(density: Weights | None, parts: Compartments) -> Field:
    """Return running sums of mass and moment along rows, see `stippler.kernels.cells.field`.

    16 bytes for each pixel in the boxes of compartments; where those of one table overlap so much
    that it is less, in the box around them all. Without a density there are none.
    """
    if density is None:
        return NO_FIELD
    if isinstance(density, DensityField) and len(parts) == 1:
        return _sums_of_one(density, parts)
    sides = np.broadcast_to(np.asarray(density.pixel_mm, np.float64), (2,))
    origin = np.asarray(density.origin_mm, np.float64)
    shape = density.levels.shape if isinstance(density, PictureField) else density.values.shape
    bleed = density.bleed if isinstance(density, PictureField) else 0
    table = _table_of_compartment(density, parts)
    box, table, window_of = _windows(_boxes_px(parts.box, sides, origin, shape, bleed), table)
    size = box[:, 2:] - box[:, :2]
    n_sums = size[:, 1] * (size[:, 0] + 1)
    first = np.cumsum(n_sums) - n_sums
    window = np.column_stack([first, size[:, ::-1], box[:, 1::-1], table])
    values: NDArray[np.uint16] | NDArray[np.float32]
    if isinstance(density, PictureField):
        values, tables = density.levels, density.tables
    else:
        values, tables = _cut_out(density.values, window, box), _NO_TABLES
    row_start = np.concatenate(([0], np.cumsum(size[:, 1])))
    sums = np.empty(2 * max(int(n_sums.sum()), 1))
    parallel_for(sum_rows, int(row_start[-1]), values, tables, row_start, window, sums, grain=64)
    frame = np.column_stack([box[:, :2] * sides + origin, np.broadcast_to(sides, (len(box), 2))])
    return Field(sums, frame[window_of], window[window_of])


def _sums_of_one(density: DensityField, parts: Compartments) -> Field:
    """Return the sums of a field for one compartment: brushes ask for them with each stamp."""
    sides, origin = density.sides_mm, density.origin_mm
    rows, columns = density.values.shape
    x0, y0, x1, y1 = parts.box[0].tolist()
    low, high = [], []
    for axis, (a, b, most) in enumerate(((x0, x1, columns), (y0, y1, rows))):
        first = math.floor((a - origin[axis]) / sides[axis] - _ROUNDING)
        last = math.ceil((b - origin[axis]) / sides[axis] + _ROUNDING)
        low.append(min(max(first, 0), most))
        high.append(max(min(max(last, 0), most), low[axis]))
    h, w = high[1] - low[1], high[0] - low[0]
    window = np.array([[0, h, w, 0, 0, 0]])
    part = density.values[low[1] : high[1], low[0] : high[0]]
    values = np.ascontiguousarray(part, np.float32).view()
    values.flags.writeable = False  # kernels compile for one kind
    sums = np.empty(2 * max(h * (w + 1), 1))
    parallel_for(sum_rows, h, values, _NO_TABLES, np.array([0, h]), window, sums, grain=64)
    corner = [low[axis] * sides[axis] + origin[axis] for axis in (0, 1)]
    return Field(sums, np.array([[*corner, *sides]]), window)


def _table_of_compartment(density: Weights, parts: Compartments) -> Whole:
    of_shape = density.table_of_shape if isinstance(density, PictureField) else None
    if of_shape is None:
        return np.zeros(len(parts), np.int64)
    if len(of_shape) <= int(parts.shape_of[-1]):
        raise ParameterError(
            f"says nothing of shape {len(of_shape)}", "table of shape", "give one for each"
        )
    return of_shape[parts.shape_of]


def _boxes_px(
    box: NDArray[np.float64],
    sides: NDArray[np.float64],
    origin: NDArray[np.float64],
    shape: tuple[int, ...],
    bleed: int,
) -> Whole:
    """Return the pixels that boxes touch: x0, y0, x1, y1."""
    least, most = -bleed, np.array([shape[1], shape[0]]) + bleed
    low = np.clip(np.floor((box[:, :2] - origin) / sides - _ROUNDING), least, most)
    high = np.clip(np.ceil((box[:, 2:] - origin) / sides + _ROUNDING), least, most)
    return np.column_stack([low, np.maximum(low, high)]).astype(np.int64)


def _windows(box: Whole, table: Whole) -> tuple[Whole, Whole, Whole]:
    """Return windows and their tables, and the window of each compartment.

    One for each compartment, or for all of a table together, whichever has fewer pixels.
    """
    window_of = np.arange(len(box))
    boxes, tables = [np.empty((0, 4), np.int64)], [np.empty(0, np.int64)]
    n = 0
    for t in np.unique(table):
        mine = np.flatnonzero(table == t)
        around = np.concatenate([box[mine, :2].min(axis=0), box[mine, 2:].max(axis=0)])[None]
        each = box[mine]
        if _n_pixels(around) <= _n_pixels(each):
            each = around
            window_of[mine] = n
        else:
            window_of[mine] = n + np.arange(len(mine))
        boxes.append(each)
        tables.append(np.full(len(each), t))
        n += len(each)
    return np.concatenate(boxes), np.concatenate(tables), window_of


def _n_pixels(box: Whole) -> int:
    return int((box[:, 2:] - box[:, :2]).prod(axis=1).sum())


def _cut_out(values: NDArray[np.floating], window: Whole, box: Whole) -> NDArray[np.float32]:
    """Return the part of a field around all windows; these are placed in it then."""
    x0, y0 = box[:, :2].min(axis=0)
    x1, y1 = box[:, 2:].max(axis=0)
    window[:, 3:5] -= (y0, x0)
    part = np.ascontiguousarray(values[y0:y1, x0:x1], np.float32).view()
    part.flags.writeable = False  # kernels compile for one kind
    return part
