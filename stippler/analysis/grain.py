"""How much dots that should be even lie in visible rows, and how even they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, KDTree

from stippler.errors import ParameterError

Floats = NDArray[np.float64]

_MARGIN = 0.06  # of the box, left out
_LOOKED_AT, _TURNS = 4000, 4
_LONGEST = 0.25  # frequency, in one over the spacing, of the clouds a person sees
_LEAST_DOTS = 100


@dataclass(frozen=True, slots=True)
class Grain:
    """Order and evenness of dots of one grey; lengths over those of the hexagonal grid.

    Attributes
    ----------
    rows_at_4, rows_at_8 : float
        Correlation of six-fold or four-fold order, the larger, between dots so many spacings apart:
        hexagonal 1, chance 0.
    order : float
        Mean six-fold order of a dot's neighbours: hexagonal 1, chance 0.36.
    least_distance : float
        Of neighbours.
    distance_cv : float
        Deviation of the neighbours' distance over its mean.
    largest_hole : float
        Largest empty circle.
    clouds : float
        Mean power of waves longer than four spacings; chance 1.
    """

    rows_at_4: float
    rows_at_8: float
    order: float
    least_distance: float
    distance_cv: float
    largest_hole: float
    clouds: float


def measure_grain(points: Floats) -> Grain:
    """Measure dots of one grey that fill their bounding box.

    Raises
    ------
    ParameterError
        If there are too few of them.
    """
    if len(points) < _LEAST_DOTS:
        raise ParameterError(f"{len(points)} dots are too few", "grain", f"give {_LEAST_DOTS}")
    low, span = points.min(axis=0), np.ptp(points, axis=0)
    spacing = float(np.sqrt(span.prod() / len(points)))
    hexagonal = spacing * np.sqrt(2.0 / np.sqrt(3.0))

    def is_inside(at: Floats) -> NDArray[np.bool_]:
        return np.asarray((np.abs((at - low) / span - 0.5) < 0.5 - _MARGIN).all(axis=1))

    mesh, tree = Delaunay(points), KDTree(points)
    six, square = _order_of_neighbours(points, mesh), _order_of_four(points, tree)
    inner = np.flatnonzero(is_inside(points))
    rows = [
        max(_correlation(points, tree, inner, order, k * spacing) for order in (six, square))
        for k in (4, 8)
    ]
    nearest = np.asarray(tree.query(points[inner], k=2)[0])[:, 1]
    radius, middle = _circles(points, mesh)
    return Grain(
        rows[0],
        rows[1],
        float(np.abs(six[inner]).mean()),
        float(nearest.min() / hexagonal),
        float(nearest.std() / nearest.mean()),
        float(radius[is_inside(middle)].max() / hexagonal * np.sqrt(3.0)),
        _power_of_long_waves(points, low, span, spacing),
    )


def _order_of_neighbours(points: Floats, mesh: Delaunay) -> NDArray[np.complex128]:
    first, other = mesh.vertex_neighbor_vertices
    degree = np.diff(first)
    owner = np.repeat(np.arange(len(points)), degree)
    step = points[other] - points[owner]
    bond = np.exp(6j * np.arctan2(step[:, 1], step[:, 0]))
    total = np.bincount(owner, bond.real, len(points)) + 1j * np.bincount(
        owner, bond.imag, len(points)
    )
    return np.asarray(total / np.maximum(degree, 1))


def _order_of_four(points: Floats, tree: KDTree) -> NDArray[np.complex128]:
    near = np.asarray(tree.query(points, k=5)[1])[:, 1:]
    step = points[near] - points[:, None]
    return np.asarray(np.exp(4j * np.arctan2(step[..., 1], step[..., 0])).mean(axis=1))


def _correlation(
    points: Floats,
    tree: KDTree,
    inner: NDArray[np.intp],
    order: NDArray[np.complex128],
    distance: float,
) -> float:
    """Return the mean product of the order of dots and of those so far away in any direction."""
    rng = np.random.default_rng(0)
    chosen = rng.permutation(inner)[:_LOOKED_AT]
    turn = rng.random((len(chosen), _TURNS)) * 2.0 * np.pi
    at = points[chosen, None] + distance * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    other = np.asarray(tree.query(at.reshape(-1, 2))[1]).reshape(turn.shape)
    return float((order[chosen, None] * order[other].conj()).real.mean())


def _circles(points: Floats, mesh: Delaunay) -> tuple[Floats, Floats]:
    """Return the radii of the triangles' circles, and the triangles' middles."""
    corner = points[mesh.simplices]
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    sides = [np.hypot(side[:, 0], side[:, 1]) for side in (a, b, a - b)]
    twice = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    return np.prod(sides, axis=0) / np.maximum(2.0 * twice, 1e-300), corner.mean(axis=1)


def _power_of_long_waves(points: Floats, low: Floats, span: Floats, spacing: float) -> float:
    """Return the mean power of long waves, through a window that keeps the box out."""
    phase = 2.0 * np.pi * (points - low) / span
    terms = (0.35875, -0.48829, 0.14128, -0.01168)  # Blackman and Harris
    window = sum(t * np.cos(k * phase) for k, t in enumerate(terms)).prod(axis=1)  # type: ignore[union-attr]
    u, v = (np.arange(-m, m + 1) for m in (span * _LONGEST / spacing).astype(int))
    down = window * np.exp(-1j * np.outer(v, phase[:, 1]))
    total = down @ np.exp(-1j * np.outer(phase[:, 0], u))
    frequency = np.hypot(u[None, :] / span[0], v[:, None] / span[1]) * spacing
    counted = (np.hypot(u[None, :], v[:, None]) > 6) & (frequency <= _LONGEST)
    if not counted.any():
        return float("nan")
    return float((np.abs(total) ** 2)[counted].mean() / (window**2).sum())
