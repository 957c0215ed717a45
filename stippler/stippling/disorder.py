"""Stages that spoil the order: dots moved by chance, sizes that change from place to place."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from stippler.stippling.draft import Draft
from stippler.stippling.progress import TONED, Step
from stippler.stippling.size_noise import noise_at

_SALT = 11
_LEAST = 0.15  # of its size, that a dot keeps


def jitter(draft: Draft, watched: bool) -> Iterator[Step]:
    """Move each dot by chance, by up to a share of the mean spacing or of its own cell.

    Deussen et al. 2000, section 5.1: by the cell, dots in the dark move less.
    """
    style, raster, points = draft.style, draft.raster, draft.points
    if len(points):
        density = np.maximum(raster.density_under(points), 1e-12)
        spacing = 1.0 / np.sqrt(density)
        if style.jitter_by == "spacing":
            spacing = np.full(len(points), float(np.median(spacing)))
        rng = np.random.default_rng([style.seed, len(points), _SALT])
        turn, far = rng.random((2, len(points)))
        reach = 0.01 * style.jitter * spacing * np.sqrt(far)
        moved = (
            points
            + np.column_stack((np.cos(math.tau * turn), np.sin(math.tau * turn))) * (reach[:, None])
        )
        size = np.array(raster.darkness.shape[::-1])
        out = ((moved < 0.0) | (moved >= size)).any(axis=1)
        out[~out] = raster.darkness_under(moved[~out]) <= 0.0
        moved[out] = points[out]
        draft.points = draft.ground.inside(moved * raster.pixel_mm) / raster.pixel_mm
    yield Step(TONED, 200, 1000)


def mottle(draft: Draft, watched: bool) -> Iterator[Step]:
    """Make dots larger here and smaller there, in places much wider than they are apart."""
    style, sizes = draft.style, draft.radii
    if sizes is not None and len(sizes):
        at = draft.points * draft.raster.pixel_mm + np.array(draft.ground.origin_mm)
        noise = noise_at(
            at, style.size_noise_mm, style.seed,
            stretch=style.size_noise_stretch, angle_rad=math.radians(style.direction_deg),
        )  # fmt: skip
        draft.radii = sizes * np.maximum(1.0 + 0.01 * style.size_noise * noise, _LEAST)
    yield Step(TONED, 1000, 1000)
