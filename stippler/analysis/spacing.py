"""How evenly dots are spaced."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Spacing:
    """Distances between neighbouring dots; NaN where there are too few dots.

    Attributes
    ----------
    mean : float
        Mean distance to the nearest dot, in the unit of the points.
    nearest_cv : float
        Standard deviation of that distance over its mean; density gradients raise it too.
    relative_cv : float
        The same for the distance to the nearest dot over that to the seventh: unevenness alone.
    relative_min : float
        First percentile of that ratio; 0.58 on a hexagonal grid.
    edge_variance : float
        Variance of the lengths of Delaunay edges, over the square of their mean (Deussen et al.
        2000, appendix), but for those of the outermost dots.
    """

    mean: float
    nearest_cv: float
    relative_cv: float
    relative_min: float
    edge_variance: float


def measure_spacing(points: NDArray[np.float64]) -> Spacing:
    """Measure the spacing of dots.

    Parameters
    ----------
    points : (n, 2) float64, any unit
    """
    from scipy.spatial import KDTree

    n = len(points)
    if n < 3:
        return Spacing(*[float("nan")] * 5)
    distance = np.asarray(KDTree(points).query(points, k=min(8, n))[0])
    nearest = distance[:, 1]
    ratio = nearest / np.maximum(distance[:, -1], 1e-300)
    return Spacing(
        float(nearest.mean()),
        _variation(nearest),
        _variation(ratio),
        float(np.percentile(ratio, 1)),
        _edge_variance(points),
    )


def _variation(values: NDArray[np.float64]) -> float:
    mean = float(values.mean())
    return float(values.std()) / mean if mean > 0 else float("nan")


def _edge_variance(points: NDArray[np.float64]) -> float:
    from scipy.spatial import Delaunay, QhullError

    try:
        mesh = Delaunay(points)
    except QhullError:  # all dots on one line
        return float("nan")
    triangles = mesh.simplices
    sides = np.concatenate((triangles[:, :2], triangles[:, 1:], triangles[:, ::2]))
    sides = np.unique(np.sort(sides, axis=1), axis=0)
    rim = np.unique(mesh.convex_hull)
    for _ in range(2):  # slivers along the hull reach a dot or two inwards
        rim = np.unique(triangles[np.isin(triangles, rim).any(axis=1)])
    sides = sides[~np.isin(sides, rim).any(axis=1)]
    if len(sides) < 2:
        return float("nan")
    length = np.linalg.norm(points[sides[:, 0]] - points[sides[:, 1]], axis=1)
    return float(length.var() / length.mean() ** 2)
