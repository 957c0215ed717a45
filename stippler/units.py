"""Conversions between the drawing's millimetres and other units."""

from __future__ import annotations

MM_PER_INCH = 25.4

DEFAULT_WIDTH_MM = 148.0
"""Width of a page nobody gave one: A5."""


def px_per_mm(dpi: float) -> float:
    """Return pixels a millimetre at a resolution in dots per inch."""
    return dpi / MM_PER_INCH
