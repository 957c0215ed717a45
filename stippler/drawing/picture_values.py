"""How a picture is taken: its tone and its width on the page; importing it costs nothing."""

from __future__ import annotations

from stippler.drawing.parameter import Choice, Kind, Parameter
from stippler.units import DEFAULT_WIDTH_MM

TONE = Parameter(
    "tone",
    Kind.CHOICE,
    "illustration",
    "Tone",
    "As an illustrator draws it, true at arm's length, or as in the file.",
    choices=(
        Choice(
            "illustration", "Drawn",
            "As an illustrator would draw it: highlights are paper, deep parts stay just open.",
        ),
        Choice(
            "linear", "By light",
            "The ink covers as much of the paper as the picture's light is missing: right at arm's "
            "length.",
        ),
        Choice(
            "perceptual", "As in file",
            "The ink follows the numbers in the file: darker, as if each grey value were a share "
            "of ink.",
        ),
    ),
)  # fmt: skip
TONES = TONE.values

WIDTH = Parameter(
    "width_mm",
    Kind.NUMBER,
    DEFAULT_WIDTH_MM,
    "Width",
    "Page width in mm; the height follows from the picture.",
    unit="mm",
    keyword="width",
)
"""Its bounds are the page's."""
