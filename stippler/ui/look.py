"""What the person chose to see; kept for the next time, and no part of the drawing."""

from __future__ import annotations

from dataclasses import dataclass

from stippler.ui.theme import DARK, LIGHT, Theme

LENSES = ("none", "reduce", "magnify")
STRENGTHS = (2, 4, 8)
LENS_DIAMETERS = (100.0, 480.0)


@dataclass(slots=True)
class Look:
    """Theme, how the reference shows under the dots, and the lens over the page.

    Attributes
    ----------
    scale : float
        Of text and controls, 1 is at 96 dpi; 0 is what the display tells.
    opacity : float
        Of the reference, 0..1; it is not drawn where `reference_shown` is False.
    patterns_shown : bool
        Whether outlines of patterns are marked; their tool does that.
    marks_shown : bool
        Whether fixed and selected dots have colours of their own.
    rulers_shown, navigator_shown : bool
        Along the edges of the canvas; in its corner.
    split_shown : bool
        Whether the picture takes the left half of the canvas, the drawing the right.
    peek : {"", "picture", "before"}
        What is shown for as long as a key is held, instead of the drawing.
    lens : {"none", "reduce", "magnify"}
    reduction, magnification : int
        How many times smaller or larger than on the page the lens shows things.
    lens_diameter : float
        In the theme's pixels.
    """

    theme: Theme = LIGHT
    scale: float = 0.0
    dots_shown: bool = True
    marks_shown: bool = True
    patterns_shown: bool = False
    reference_shown: bool = False
    opacity: float = 0.35
    rulers_shown: bool = False
    navigator_shown: bool = False
    split_shown: bool = False
    peek: str = ""
    lens: str = "none"
    reduction: int = 4
    magnification: int = 4
    lens_diameter: float = 240.0

    def begin(self) -> None:
        """Make what was kept from another time fit to begin with: in range, and no dots hidden."""
        self.dots_shown = self.marks_shown = True
        self.peek = ""
        self.patterns_shown = False
        self.lens = self.lens if self.lens in LENSES else "none"
        for name in ("reduction", "magnification"):
            kept = getattr(self, name)
            setattr(self, name, min(STRENGTHS, key=lambda n: abs(n - kept)))
        low, high = LENS_DIAMETERS
        self.lens_diameter = min(max(low, self.lens_diameter), high)  # NaN ends at an end

    def turn_theme(self) -> None:
        """Change between light and dark."""
        self.theme = DARK if self.theme is LIGHT else LIGHT

    @property
    def lens_factor(self) -> float:
        """Scale in the lens over scale on the page."""
        return 1.0 / self.reduction if self.lens == "reduce" else float(self.magnification)

    @property
    def reference_opacity(self) -> float:
        """What the renderer is to use."""
        return self.opacity if self.reference_shown else 0.0
