"""What one frame shows, as data: nothing of it stays behind when it has been drawn."""

from __future__ import annotations

from dataclasses import dataclass

from stippler.camera import Camera, Size
from stippler.drawing.adjustment import NEUTRAL, Adjustment
from stippler.drawing.preview import Preview
from stippler.render.paper import Color

PAPER: Color = (0.984, 0.980, 0.965)
DESK: Color = (0.827, 0.816, 0.792)
INK: Color = (0.086, 0.082, 0.094)
FIXED: Color = (0.72, 0.30, 0.12)
SELECTED: Color = (0.10, 0.42, 0.80)
GUIDE: Color = (0.16, 0.55, 0.60)
PATTERN: Color = (0.72, 0.45, 0.20)


@dataclass(frozen=True, slots=True)
class Frame:
    """A view of a scene.

    Attributes
    ----------
    camera, size_px
        What is seen, on a screen of which size.
    paper, desk, ink : (r, g, b)
        0..1, encoded for display.
    marks : (colour, colour) or None
        Of fixed and of selected dots; None draws them like all others, and no guides.
    dots : bool
        False leaves them out.
    patterns : bool
        Whether outlines of patterns are marked.
    preview : Preview or None
        Shows dots as a brush or a panel would leave them; by uniforms only.
    opacity : float
        Of the reference under the dots; 0 leaves it out.
    adjustment : Adjustment
        Of the reference.
    """

    camera: Camera
    size_px: Size
    paper: Color = PAPER
    desk: Color = DESK
    ink: Color = INK
    marks: tuple[Color, Color] | None = (FIXED, SELECTED)
    dots: bool = True
    patterns: bool = False
    preview: Preview | None = None
    opacity: float = 0.0
    adjustment: Adjustment = NEUTRAL
