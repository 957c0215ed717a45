"""Rows of dots along an area's border: pulse-density from the border begins at them.

Deussen et al. 2000, section 4: outlines enhanced by a row that the other dots line up with.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_NEAR = 1.5  # spacings from the edge, within which a dot may be of its row
_NEXT = 1.7  # spacings, within which a dot of a row has another on both sides


def behind_rows(density: NDArray[np.float32], points: Floats) -> NDArray[np.bool_]:
    """Tell which pixels lie between rows of dots and the edge that the rows lie along.

    Parameters
    ----------
    density : (h, w) float32, dots per square pixel
        As if no dots were there; 0 outside what has to be filled.
    points : (n, 2) float64, pixels
        Dots that are there.
    """
    from scipy.ndimage import distance_transform_edt  # a quarter of a second to import

    inside = density > 0.0
    h, w = density.shape
    x, y = points.astype(np.intp).T
    at = (np.clip(y, 0, h - 1), np.clip(x, 0, w - 1))
    depth = distance_transform_edt(np.pad(inside, 1))[1:-1, 1:-1]
    room = 1.0 / np.sqrt(np.maximum(density[at], 1e-12))
    of_row = np.flatnonzero(inside[at] & (depth[at] <= _NEAR * room))
    of_row = of_row[_have_two_next(points[of_row], _NEXT * room[of_row])]
    if not len(of_row):
        return np.zeros(density.shape, np.bool_)
    which = np.full(density.shape, -1, np.int64)
    which[at[0][of_row], at[1][of_row]] = of_row
    away, (i, j) = distance_transform_edt(which < 0, return_indices=True)
    nearest = which[i, j]
    deep = depth[at][nearest]
    aside = np.hypot(_NEXT / 2 * room[nearest], deep)
    return np.asarray(inside & (depth <= deep) & (away <= aside))


def _have_two_next(points: Floats, within: Floats) -> NDArray[np.bool_]:
    """Tell which points have two others within a distance of theirs."""
    from scipy.spatial import cKDTree  # which takes a while to import

    if len(points) < 3:
        return np.zeros(len(points), np.bool_)
    away, _ = cKDTree(points).query(points, k=3)
    return np.asarray(np.asarray(away)[:, 2] <= within)
