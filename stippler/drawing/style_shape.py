"""The shapes that a style gives its dots: the pen's, longer, and turned."""

from __future__ import annotations

import math
from dataclasses import replace

from stippler.drawing.dots import MAX_ELONGATION, Dots
from stippler.drawing.pens import pen_named
from stippler.drawing.reference import Reference
from stippler.drawing.shape_change import Edges, LinearChange, ShapeChange
from stippler.drawing.style import Style

_SCATTER_RAD = math.radians(7.0)  # a hand does not draw the same direction twice
_SPREAD = 0.3  # of the length that is added
_REACH = 3.0  # radii around a dot in which the slope of the picture is measured


def shaped(dots: Dots, style: Style, reference: Reference | None = None) -> Dots:
    """Return dots in the shapes of a style; they share the arrays that stay."""
    drawn = pen_named(style.pen).drawn(dots)
    if style.elongation > 1.0:
        more = style.elongation - 1.0
        least = 1.0 + (1.0 - 0.5 * _SPREAD) * more
        longer = ShapeChange(elongation=LinearChange(least, 0.0, _SPREAD * more))
        drawn = replace(drawn, **longer.of(drawn))  # type: ignore[arg-type]
        drawn.elongation.clip(1.0, MAX_ELONGATION, out=drawn.elongation)
    if style.direction_by == "pen" or not len(dots):
        return drawn
    angle = math.radians(style.direction_deg)
    turned = ShapeChange(angle_rad=angle, scatter_rad=_SCATTER_RAD)
    drawn = replace(drawn, **turned.of(drawn))  # type: ignore[arg-type]
    if turns_with_edges(style) and reference is not None:
        reach = _REACH * float(dots.radius_mm.mean()) + reference.pixel_mm
        along = ShapeChange(edges=Edges(reference, reach))
        drawn = replace(drawn, **along.of(drawn))  # type: ignore[arg-type]
    return drawn


def turns_with_edges(style: Style) -> bool:
    """Return whether directions depend on where dots lie."""
    return style.direction_by == "edges"
