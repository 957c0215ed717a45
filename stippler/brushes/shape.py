"""What a stamp of a size or shape brush does to the dots under it, as a change of shape.

The same change is made by a stamp and shown by a preview.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.brushes.brush import Brush
from stippler.drawing.document import Document
from stippler.drawing.preview import Preview
from stippler.drawing.reference import Reference
from stippler.drawing.shape_change import Edges, Floats, LinearChange, ShapeChange, to
from stippler.drawing.store import Rows
from stippler.errors import ParameterError

_EDGE_SHARE = 0.25  # of the brush's radius, over which the reference's slope is measured


def size_change(brush: Brush) -> ShapeChange | None:
    """Return what a size brush does; None where each dot has a goal of its own."""
    how = brush.value("how")
    if how == "tone":
        return None
    if how == "set":
        return ShapeChange(radius=to(float(brush.value("dot_mm"))))
    return resized(float(brush.value("amount")) * (1.0 if how == "enlarge" else -1.0))


def resized(percent: float) -> ShapeChange:
    """Return what enlarges radii by a percentage, or below 0 takes that back."""
    factor = 1.0 + abs(percent) / 100.0
    return ShapeChange(radius=LinearChange(factor if percent > 0.0 else 1.0 / factor))


def form_change(
    brush: Brush, direction_rad: float, reference: Reference | None
) -> ShapeChange | None:
    """Return what a shape brush does.

    Parameters
    ----------
    direction_rad : float
        Of the stroke; NaN before it has one, and what goes along it does nothing then.

    Raises
    ------
    ParameterError
        If the brush goes by a picture and there is none.
    """
    how, amount = brush.value("how"), float(brush.value("amount")) / 100.0
    if how in ("roughen", "smooth"):
        return ShapeChange(roughness=LinearChange(addend=amount if how == "roughen" else -amount))
    if how == "round":
        return ShapeChange(elongation=LinearChange(addend=-amount))
    along = brush.value("along")
    if along == "random":
        return ShapeChange(stretch=amount, angle_rad=0.0, scatter_rad=math.pi / 2)
    if along == "edge":
        return ShapeChange(stretch=amount, edges=_edges(brush, reference))
    angle = direction_rad if along == "stroke" else math.radians(float(brush.value("angle")))
    return None if math.isnan(angle) else ShapeChange(stretch=amount, angle_rad=angle)


def _edges(brush: Brush, reference: Reference | None) -> Edges:
    if reference is None:
        raise ParameterError(
            "goes by the picture, and there is none", brush.name, "open a picture first"
        )
    return Edges(reference, max(_EDGE_SHARE * brush.radius_mm, reference.pixel_mm))


def preview_of(
    brush: Brush,
    at_mm: tuple[float, float],
    direction_rad: float,
    strength: float,
    reference: Reference | None,
) -> Preview | None:
    """Return what a stamp would do, to be shown; None for a brush of which that cannot be said.

    Parameters
    ----------
    strength : float
        What stands in for a pen's pressure.
    """
    change = None
    if brush.kind == "size":
        change = size_change(brush)
    elif brush.kind == "shape" and (reference is not None or brush.value("along") != "edge"):
        change = form_change(brush, direction_rad, reference)
    footprint = brush.tip.footprint(at_mm, brush.radius_mm, strength)
    return Preview(change, footprint) if change and footprint else None


def reshape(
    document: Document, rows: Rows, change: ShapeChange, weight: float | Floats = 1.0
) -> None:
    """Change the shapes of some dots, within a stroke."""
    new: Any = change.of(document.dots.take(rows), weight)
    for field, values in new.items():
        document.change(field, rows, values)
