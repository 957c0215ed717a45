"""A style by the name that it had before areas could have several."""

from stippler.drawing.style import (
    ARRANGEMENTS,
    DEFAULT_DOTS,
    DEFAULT_PEN,
    FIRST_DOTS,
    GROWTHS,
    MAX_DOTS,
    SIZES,
    SPACINGS,
    STARTS,
)
from stippler.drawing.style import Style as Plan

__all__ = [
    "ARRANGEMENTS",
    "DEFAULT_DOTS",
    "DEFAULT_PEN",
    "FIRST_DOTS",
    "GROWTHS",
    "MAX_DOTS",
    "SIZES",
    "SPACINGS",
    "STARTS",
    "Plan",
]
