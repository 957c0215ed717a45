"""What the person chose to see; kept for the next time, and no part of the drawing."""

from __future__ import annotations

from dataclasses import dataclass

from stippler.ui.theme import DARK, LIGHT, Theme


@dataclass(slots=True)
class Look:
    """Theme, and how the reference shows under the dots.

    Attributes
    ----------
    scale : float
        Of text and controls, 1 is at 96 dpi; 0 is what the display tells.
    opacity : float
        Of the reference, 0..1; it is not drawn where `reference_shown` is False.
    """

    theme: Theme = LIGHT
    scale: float = 0.0
    reference_shown: bool = False
    opacity: float = 0.35

    def turn_theme(self) -> None:
        """Change between light and dark."""
        self.theme = DARK if self.theme is LIGHT else LIGHT

    @property
    def reference_opacity(self) -> float:
        """What the renderer is to use."""
        return self.opacity if self.reference_shown else 0.0
