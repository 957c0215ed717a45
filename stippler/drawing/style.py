"""How an area is drawn, as it was asked for; importing it costs nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Self

from stippler.drawing.validation import whole
from stippler.errors import ParameterError

FIRST_DOTS = ("pulse-density", "floyd-steinberg", "random", "hexagonal")
"""Ways to place the first dots."""

GROWTHS = ("circular", "triangular")
"""Orders in which a region takes cells; the first has the better spectrum."""

STARTS = ("top", "border")
"""Where the first region lies: from the top down, or from the border inwards."""

SIZES = ("tone", "regions")
"""Dot sizes: solved for the tone, or as the paper has them, by how far regions had to grow."""

SPACINGS = ("even", "lloyd", "delaunay-mean", "springs")
"""Ways to space dots: evenly without rows, Lloyd alone, and the paper's comparisons."""

ARRANGEMENTS = ("hexagonal", "random")
"""How an area is filled where there is no picture."""

DEFAULT_DOTS = 20_000
DEFAULT_PEN = "technical-pen"
MAX_DOTS = 20_000_000


@dataclass(frozen=True, slots=True)
class Style:
    """How an area is drawn: what was asked for, not what came out; areas may share it.

    Attributes
    ----------
    name : str
        As a person calls it.
    n_dots : int or None
        None: follows from the size range; without one, what suits the page and the picture.
    size_range_mm : (min, max) or None
        Radii; None: the range of 1:2 that meets the tone with `n_dots`.
    iterations : int
        Relaxation steps.
    seed : int
        Chooses what is left to chance.
    first_dots : {"pulse-density", "floyd-steinberg", "random", "hexagonal"}
    growth : {"circular", "triangular"}
        Order in which pulse-density regions take cells.
    start : {"top", "border"}
        Where pulse-density begins.
    sizes : {"tone", "regions"}
        "regions" is the paper's modified pulse-density modulation: dots of small regions are
        enlarged, of large ones reduced, of still larger ones dropped.
    weighted : bool
        Relax by the wanted density; False is the paper's unweighted form.
    spacing : {"even", "lloyd", "delaunay-mean", "springs"}
        "even" leaves no rows; "lloyd" is the paper's relaxation alone, and what unweighted dots
        get; the last two are the paper's comparisons.
    pen : str
        Whose shapes the dots have; see `stippler.drawing.pens`.
    """

    n_dots: int | None = None
    size_range_mm: tuple[float, float] | None = None
    iterations: int = 20
    seed: int = 1
    first_dots: str = "pulse-density"
    growth: str = "circular"
    start: str = "top"
    sizes: str = "tone"
    weighted: bool = True
    spacing: str = "even"
    pen: str = DEFAULT_PEN
    name: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return it in JSON's types."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make a style of what `to_json` gave."""
        values = dict(data)
        if values.get("size_range_mm") is not None:
            values["size_range_mm"] = tuple(values["size_range_mm"])
        return cls(**values)

    def __post_init__(self) -> None:
        if self.n_dots is not None and not 1 <= whole(self.n_dots, "dots") <= MAX_DOTS:
            raise ParameterError(
                f"{self.n_dots} dots cannot be drawn", "dots", f"give 1 to {MAX_DOTS:,}"
            )
        if self.size_range_mm is not None:
            _check_range(self.size_range_mm)
        if not 0 <= whole(self.iterations, "iterations") <= 100_000:
            raise ParameterError(
                f"{self.iterations} steps cannot be run", "iterations", "give 0 to 100,000"
            )
        if not 0 <= whole(self.seed, "seed") < 2**63:
            raise ParameterError(f"{self.seed} is no seed", "seed", "give 0 or more")
        for name, value, known in (
            ("first dots", self.first_dots, FIRST_DOTS),
            ("growth", self.growth, GROWTHS),
            ("start", self.start, STARTS),
            ("sizes", self.sizes, SIZES),
            ("spacing", self.spacing, SPACINGS),
        ):
            if value not in known:
                raise ParameterError(f"{value!r} is unknown", name, f"one of {', '.join(known)}")
        if self.sizes == "regions" and self.first_dots != "pulse-density":
            raise ParameterError(
                f"{self.first_dots} has no regions", "sizes", "take pulse-density, or sizes by tone"
            )
        if self.pen != DEFAULT_PEN:
            from stippler.drawing.pens import pen_named

            pen_named(self.pen)


def _check_range(size_range_mm: tuple[float, float]) -> None:
    try:
        low, high = (float(radius) for radius in size_range_mm)
    except (TypeError, ValueError):
        low = high = math.nan
    if not 0 < low <= high < math.inf:
        text = f"{low:g}:{high:g}" if low == low else f"{size_range_mm!r}"
        raise ParameterError(
            f"{text} is no range of radii", "size range", "give MIN:MAX in mm with 0 < MIN <= MAX"
        )
