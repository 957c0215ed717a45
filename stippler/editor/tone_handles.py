"""The curve of a picture's tones as a thing to take hold of: its ends, and all between.

Places are (tone, ink), each 0..1: the picture's darkness as it was read, and the ink for it.
"""

from __future__ import annotations

import math
from dataclasses import replace
from enum import Enum

import numpy as np

from stippler.drawing.adjustment import GAMMA_RANGE, MIN_SPAN, NEUTRAL, Adjustment

Place = tuple[float, float]
_LEAST, _MOST = 0.002, 0.998  # ink, beyond which no power leads through a place


class Handle(Enum):
    """What can be taken hold of."""

    WHITE = "White point"
    BLACK = "Black point"
    MIDDLE = "Middle tones"


def place_of(handle: Handle, now: Adjustment) -> Place:
    """Return where a handle is: the ends below and above, the middle on the curve."""
    if handle is Handle.WHITE:
        return _seen(now.white, now), 0.0
    if handle is Handle.BLACK:
        return _seen(now.black, now), 1.0
    tone = middle_of(now)
    return tone, ink_at(tone, now)


def middle_of(now: Adjustment) -> float:
    """Return the tone in the midst of those that the curve makes neither white nor black."""
    _, taken, factor, _, _ = now.curve
    return _seen(0.5 * (min(taken, 1.0) + min(taken + 1.0 / factor, 1.0)), now)


def ink_at(tone: float, now: Adjustment) -> float:
    """Return the ink for a tone."""
    return float(now.apply(np.full((1, 1), tone, np.float32))[0, 0])


def nearest(place: Place, now: Adjustment) -> Handle:
    """Return what a press beside all handles takes: an end from beyond it, else the curve."""
    tone = _seen(place[0], now)
    if tone < now.white:
        return Handle.WHITE
    return Handle.BLACK if tone > now.black else Handle.MIDDLE


def moved(handle: Handle, place: Place, now: Adjustment) -> Adjustment:
    """Return the curve with a handle brought to a place, as near as bounds allow.

    The ends go by the tone alone; the middle takes the power that leads through the place.
    """
    tone = _seen(place[0], now)
    if handle is Handle.WHITE:
        return replace(now, white=round(min(max(tone, 0.0), now.black - MIN_SPAN), 2))
    if handle is Handle.BLACK:
        return replace(now, black=round(max(min(tone, 1.0), now.white + MIN_SPAN), 2))
    straight = ink_at(place[0], replace(now, gamma=1.0))
    if not 0.0 < straight < 1.0:
        return now
    gamma = math.log(min(max(place[1], _LEAST), _MOST)) / math.log(straight)
    return replace(now, gamma=round(min(max(gamma, GAMMA_RANGE[0]), GAMMA_RANGE[1]), 2))


def let_go(handle: Handle, now: Adjustment) -> Adjustment:
    """Return the curve with a handle where it is by itself."""
    if handle is Handle.WHITE:
        return replace(now, white=NEUTRAL.white)
    if handle is Handle.BLACK:
        return replace(now, black=NEUTRAL.black)
    return replace(now, gamma=NEUTRAL.gamma)


def _seen(tone: float, now: Adjustment) -> float:
    """Return a tone of the picture as the adjustment counts it, or the other way about."""
    return 1.0 - tone if now.invert else tone
