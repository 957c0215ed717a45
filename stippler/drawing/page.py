"""The paper."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Self

from stippler.errors import ParameterError

MIN_PAGE_MM, MAX_PAGE_MM = 0.01, 10_000.0
"""A page below a hundredth of a millimetre has no size in a file, and holds no dot."""


@dataclass(frozen=True, slots=True)
class Page:
    """The paper: origin top left, x right, y down."""

    width_mm: float
    height_mm: float

    def __post_init__(self) -> None:
        for name, value in (("width", self.width_mm), ("height", self.height_mm)):
            if not (math.isfinite(value) and MIN_PAGE_MM <= value <= MAX_PAGE_MM):
                raise ParameterError(
                    f"a {name} of {value:g} mm is no paper",
                    "page",
                    f"give {MIN_PAGE_MM:g} to {MAX_PAGE_MM:g} mm",
                )

    def to_json(self) -> dict[str, Any]:
        """Return it in JSON's types."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make a page of what `to_json` gave."""
        return cls(**data)
