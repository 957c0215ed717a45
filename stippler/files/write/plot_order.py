"""Dots of a layer in an order of little travel."""

from __future__ import annotations

from dataclasses import replace

from stippler.files.write.sheet import Layer
from stippler.stippling.tour import tour


def sorted_dots(layer: Layer) -> Layer:
    """Return a layer whose dots follow a short way through them."""
    return replace(layer, dots=layer.dots.take(tour(layer.dots.position_mm)))
