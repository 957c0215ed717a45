"""How many dots a page gets where no one asks for a number.

Dots are to look right on a postcard and on a poster, and to be printable. What is chosen is
their size: it grows with the fourth root of the page's area, since a larger page is looked at
from farther away, but not from as much farther. A picture with more detail than such dots can
show gets smaller ones, a plain one larger ones. The number follows from their size and the ink.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.tone import LEAST_PRINTED_MM
from stippler.stippling.window import Tones

_RADIUS_MM, _ON_MM2 = 0.20, 13_000.0  # mean radius, on a page 130 mm wide
_MEAN_TO_LEAST = 1.35  # radii of a drawing whose dots differ by 1:2
_USUAL_LOSS = 0.06  # what dots of that size leave out of a usual photograph
_FEWEST, _MOST = 0.75, 1.5  # times the number without regard to detail
_LEAST, _LIMIT = 200, 500_000
_LEAST_CELL_PX = 2.0  # pictures of few pixels are no plain ones
_FINE = 4  # blocks a side of a dot's cell; what is finer is grain


def default_number(reference: Reference | Tones, page_mm2: float | None = None) -> int:
    """Return how many dots suit a reference and its page.

    Parameters
    ----------
    reference : Reference or Tones
    page_mm2 : float, optional
        Of the page, where the reference is that of a part.

    Returns
    -------
    int
        200 to 500,000. The smallest dots have a diameter of 0.1 mm or more, unless fewer than
        200 would do.
    """
    area = reference.width_mm * reference.height_mm
    darkness = reference.darkness
    ink = float(darkness.mean(dtype=np.float64)) * area
    radius = _RADIUS_MM * ((page_mm2 or area) / _ON_MM2) ** 0.25
    usual = ink / (math.pi * radius**2)
    if usual < 1.0:
        return _LEAST
    cell_px = math.sqrt(area / usual) / reference.pixel_mm
    detail = _loss(darkness, cell_px) / _USUAL_LOSS
    wanted = usual * min(max(detail, _FEWEST), _MOST)
    least_mean = 0.5 * LEAST_PRINTED_MM * _MEAN_TO_LEAST
    printable = ink / (math.pi * least_mean**2)
    return _rounded(min(max(min(wanted, printable), _LEAST), _LIMIT))


def with_number(style: Style, reference: Reference | Tones, page_mm2: float | None = None) -> Style:
    """Give a style that asks for neither a number nor sizes the number that suits a reference."""
    if style.n_dots is not None or style.size_range_mm is not None:
        return style
    return replace(style, n_dots=default_number(reference, page_mm2))


def _loss(darkness: NDArray[np.float32], cell_px: float) -> float:
    """Return what is left out of a picture by cells of so many pixels a side, for its ink."""
    block = max(1, int(cell_px / _FINE))
    fine = _averaged(darkness, block)
    side = max(cell_px / block, _LEAST_CELL_PX)
    low = int(side)
    coarse = [_variance(_averaged(fine, k)) for k in (low, low + 1)]
    left = coarse[0] + (side - low) * (coarse[1] - coarse[0])
    grain = _variance(darkness) - _variance(fine)  # if it is white, blocks have so much less of it
    lost = _variance(fine) - left - grain / block**2
    return math.sqrt(max(lost, 0.0) / max(float(fine.mean(dtype=np.float64)), 1e-12))


def _variance(field: NDArray[np.float32]) -> float:
    return float(field.var(dtype=np.float64))


def _averaged(field: NDArray[np.float32], side: int) -> NDArray[np.float32]:
    """Average blocks of so many pixels a side; those at the far edges may be smaller."""
    if side == 1:
        return field
    rows, columns = (np.arange(0, n, side) for n in field.shape)
    sums = np.add.reduceat(np.add.reduceat(field, rows, axis=0), columns, axis=1)
    sums /= np.diff(rows, append=field.shape[0]).astype(np.float32)[:, None]
    sums /= np.diff(columns, append=field.shape[1]).astype(np.float32)
    return sums


def _rounded(number: float) -> int:
    """Return two figures of a number; a person sees that it is no exact one."""
    step = 10 ** max(int(math.log10(number)) - 1, 0)
    return int(round(number / step) * step)
