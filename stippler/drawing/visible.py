"""Dots of hidden areas: on the screen they have no size, in files they are not there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing

NONE: frozenset[int] = frozenset()


def hidden_areas(drawing: Drawing, solo: int | None = None) -> frozenset[int]:
    """Return the areas whose dots are not shown.

    Parameters
    ----------
    solo : int or None
        The one area that is shown, even if it is hidden; None is all that are not.
    """
    areas = drawing.areas
    if solo is not None and solo in areas:
        return frozenset(areas) - {solo}
    hidden = [k for k, area in areas.items() if area.hidden]
    return frozenset(hidden) if hidden else NONE


def sized_zero(dots: Dots, hidden: frozenset[int]) -> Dots:
    """Return dots in the same rows; those of hidden areas without size."""
    if not hidden:
        return dots
    gone = np.isin(dots.area, list(hidden))
    return replace(dots, radius_mm=np.where(gone, np.float32(0.0), dots.radius_mm))


def shown(drawing: Drawing) -> Drawing:
    """Return a drawing without the dots of its hidden areas."""
    hidden = hidden_areas(drawing)
    if not hidden:
        return drawing
    kept = np.flatnonzero(~np.isin(drawing.dots.area, list(hidden)))
    return replace(drawing, dots=drawing.dots.take(kept))
