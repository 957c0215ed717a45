"""A grey ramp, step wedges and graded discs, labelled with their darkness in percent."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

Field = NDArray[np.float32]

WIDTH, HEIGHT = 1800, 1500
LEFT, RIGHT = 92, 1708
"""Inner edges of every row."""
FRAME = 3


def _frame(darkness: Field, left: int, top: int, right: int, bottom: int) -> None:
    """Draw a black frame around a box, outside it."""
    f = FRAME
    darkness[top - f : top, left - f : right + f] = 1
    darkness[bottom : bottom + f, left - f : right + f] = 1
    darkness[top:bottom, left - f : left] = 1
    darkness[top:bottom, right : right + f] = 1


def _label(darkness: Field, x: float, y: float, text: str, size: int) -> None:
    """Set black text centred at (x, y)."""
    layer = Image.new("L", (darkness.shape[1], darkness.shape[0]))
    font = ImageFont.load_default(size)
    ImageDraw.Draw(layer).text((x, y), text, 255, font, anchor="mm", stroke_width=1)
    np.maximum(darkness, np.asarray(layer, np.float32) / 255, out=darkness)


def _ramp(darkness: Field, top: int, bottom: int) -> None:
    """Draw darkness that grows evenly from left to right, over a scale."""
    n = RIGHT - LEFT
    darkness[top:bottom, LEFT:RIGHT] = (np.arange(n) + 0.5) / n
    _frame(darkness, LEFT, top, RIGHT, bottom)
    for percent in range(0, 101, 5):
        x = round(LEFT + n * percent / 100)
        long = percent % 10 == 0
        darkness[bottom + FRAME : bottom + (26 if long else 16), x - 2 : x + 2] = 1
        if long:
            _label(darkness, x, bottom + 54, str(percent), 42)


def _steps(darkness: Field, left: int, right: int, top: int, bottom: int, values: range) -> None:
    """Draw steps side by side, without gaps, and their labels below."""
    edges = np.linspace(left, right, len(values) + 1).round().astype(int)
    for percent, start, stop in zip(values, edges[:-1], edges[1:], strict=True):
        darkness[top:bottom, start:stop] = percent / 100
        _label(darkness, (start + stop) / 2, bottom + 40, str(percent), 42)
    _frame(darkness, left, top, right, bottom)


def _disc(darkness: Field, x: float, y: float, radius: float, centre: float, rim: float) -> None:
    """Draw a disc whose darkness runs from `centre` to `rim`; edges are smoothed over a pixel."""
    rows, columns = np.indices(darkness.shape, np.float32) + 0.5
    distance = np.hypot(columns - x, rows - y)
    tone = centre + (rim - centre) * np.minimum(distance / radius, 1)
    cover = np.clip(radius + 0.5 - distance, 0, 1)
    darkness += cover * (tone - darkness)


def draw() -> Field:
    """Draw the test card.

    Returns
    -------
    (1500, 1800) float32
        Encoded luminance, 0..1: 1 minus the labelled darkness.
    """
    darkness = np.zeros((HEIGHT, WIDTH), np.float32)
    _ramp(darkness, 90, 340)
    _steps(darkness, LEFT, RIGHT, 470, 720, range(0, 101, 10))
    middle = (LEFT + RIGHT) // 2
    _steps(darkness, LEFT, middle - 42, 840, 1000, range(0, 13, 2))
    _steps(darkness, middle + 42, RIGHT, 840, 1000, range(88, 101, 2))
    radius, gap = 150, (RIGHT - LEFT - 300) / 4
    discs = [(0.0, 1.0), (1.0, 0.0), (0.25, 0.25), (0.5, 0.5), (0.75, 0.75)]
    for k, (centre, rim) in enumerate(discs):
        _disc(darkness, LEFT + radius + k * gap, 1260, radius, centre, rim)
    return np.float32(1.0) - darkness
