"""What each value of a dot has to be: the one list that files and journals are held to."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import FREE, MAX_ELONGATION, ON_CURVE, Dots

LARGEST_ID = 2**53
"""Ids are below it: exact in any program's numbers."""

LARGEST_MM = 1e7
"""Places farther from the page than that are none."""

_Rule = Callable[[NDArray[Any]], NDArray[np.bool_]]

_NOWHERE = "position is not finite, or far from any page"

RULES: Mapping[str, tuple[_Rule, str]] = {
    "position_mm": (lambda v: np.asarray((np.abs(v) < LARGEST_MM).all(axis=1)), _NOWHERE),
    "radius_mm": (lambda v: np.isfinite(v) & (v > 0), "radius is not above 0"),
    "elongation": (lambda v: (v >= 1) & (v <= MAX_ELONGATION), "elongation is out of range"),
    "angle_rad": (np.isfinite, "angle is not finite"),
    "roughness": (lambda v: (v >= 0) & (v <= 1), "roughness is out of range"),
    "constraint": (lambda v: (v >= FREE) & (v <= ON_CURVE), "constraint is unknown"),
    "parameter": (np.isfinite, "place along a line is not finite"),
    "id": (lambda v: (v >= 0) & (v < LARGEST_ID), "id is out of range"),
}
"""By field: which values are fine, and what to say of others."""

LIKE = {f.name: getattr(Dots.none(), f.name) for f in fields(Dots)}
"""An empty array of each field, for its type and shape."""


def first_fault(name: str, values: NDArray[Any]) -> tuple[int, str] | None:
    """Return the first row whose value is none, and why; None if all are fine."""
    if name not in RULES:
        return None
    rule, why = RULES[name]
    with np.errstate(invalid="ignore"):
        fine = rule(values)
    return None if fine.all() else (int(np.flatnonzero(~fine)[0]), why)
