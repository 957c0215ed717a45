"""The picture that tone is taken from, as a field of darkness over the page."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.adjustment import NEUTRAL, Adjustment
from stippler.drawing.levels import levels_of
from stippler.errors import ParameterError


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A picture as it came, and the darkness that was read from it; equal by its digest.

    Attributes
    ----------
    darkness : (h, w) float32, read-only
        0 (white, weight exactly 0) to 1 (black).
    tone : str
        How darkness was taken from it.
    name : str
        Of its file; empty where it came from no file.
    data : bytes or None
        The file as it came; None where it came from no file, or was not kept.
    """

    darkness: NDArray[np.float32]
    tone: str = "linear"
    name: str = ""
    data: bytes | None = None
    _digest: list[str] = field(default_factory=list)
    _levels: list[NDArray[np.uint16]] = field(default_factory=list)

    def __post_init__(self) -> None:
        values = self.darkness
        if values.ndim != 2 or values.size == 0:
            raise ParameterError("a reference is a 2-d field with at least one pixel", "reference")
        low, high = float(values.min()), float(values.max())
        if not (low >= 0.0 and high <= 1.0):  # also catches NaN
            raise ParameterError("darkness has to lie in 0..1 and be finite", "reference")
        object.__setattr__(self, "darkness", _frozen(values))

    @property
    def levels(self) -> NDArray[np.uint16]:
        """The darkness as 16-bit levels, read-only; made when first asked for, and once."""
        if not self._levels:
            self._levels.append(levels_of(self.darkness))
        return self._levels[0]

    @property
    def digest(self) -> str:
        """What tells this picture, read in this tone, from all others."""
        if not self._digest:
            mixed = hashlib.blake2b(f"{self.tone} {self.darkness.shape}".encode(), digest_size=16)
            mixed.update(self.darkness.data if self.data is None else self.data)
            self._digest.append(mixed.hexdigest())
        return self._digest[0]

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Picture) and self.digest == other.digest)

    def __hash__(self) -> int:
        return hash(self.darkness.shape)


class Reference:
    """Darkness over the page: pixel (0, 0) at the top left corner, square pixels.

    A value: nothing of it changes, and two are equal if picture, width and adjustment are.

    Parameters
    ----------
    darkness : (h, w) array
        0 (white, weight exactly 0) to 1 (black); of a picture that came from no file.
    width_mm : float
        Width of the field on the page.

    Attributes
    ----------
    source : Picture
    adjustment : Adjustment
        How its darkness is changed before dots are made of it.
    """

    __slots__ = ("_darkness", "_plain", "adjustment", "source", "width_mm")

    def __init__(self, darkness: NDArray[np.float32], width_mm: float) -> None:
        self._set(Picture(darkness), width_mm, NEUTRAL)

    @classmethod
    def of(cls, source: Picture, width_mm: float, adjustment: Adjustment = NEUTRAL) -> Self:
        """Make the reference of a picture."""
        made = cls.__new__(cls)
        made._set(source, width_mm, adjustment)
        return made

    def _set(self, source: Picture, width_mm: float, adjustment: Adjustment) -> None:
        if not (np.isfinite(width_mm) and width_mm > 0):
            raise ParameterError(f"{width_mm} mm is no width", "page", "give a width above 0")
        self.source, self.width_mm, self.adjustment = source, width_mm, adjustment
        self._darkness = source.darkness if adjustment == NEUTRAL else None
        self._plain: Reference | None = None

    @property
    def darkness(self) -> NDArray[np.float32]:
        """The picture's darkness as adjusted, read-only; worked out when it is first asked for."""
        if self._darkness is None:
            self._darkness = _frozen(self.adjustment.apply(self.source.darkness))
        return self._darkness

    @property
    def picture(self) -> Reference:
        """The reference as it is without any adjustment."""
        if self.adjustment == NEUTRAL:
            return self
        if self._plain is None:
            self._plain = Reference.of(self.source, self.width_mm)
        return self._plain

    def adjusted(self, adjustment: Adjustment) -> Reference:
        """Return the picture with another adjustment; what was adjusted before does not add up."""
        if adjustment == self.adjustment:
            return self
        if adjustment == NEUTRAL:
            return self.picture
        made = Reference.of(self.source, self.width_mm, adjustment)
        made._plain = self.picture
        return made

    def light(self) -> Reference:
        """Return an equal value that holds no darkness of its own, for a history to keep."""
        made = Reference.of(self.source, self.width_mm, self.adjustment)
        made._plain = self._plain
        return made

    @property
    def pixel_mm(self) -> float:
        """Side of a pixel on the page."""
        columns: int = self.source.darkness.shape[1]
        return self.width_mm / columns

    @property
    def height_mm(self) -> float:
        """Height of the field on the page."""
        rows: int = self.source.darkness.shape[0]
        return self.pixel_mm * rows

    def at(self, position_mm: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the darkness at points of the page, between pixels by interpolation.

        Parameters
        ----------
        position_mm : (n, 2) float64
            Points beside the field take that of its border.
        """
        from stippler.kernels.tone.sampling import (
            sampled,  # numba: late, for the first frame's sake
        )

        return sampled(self.darkness, 1.0 / self.pixel_mm, position_mm)

    def to_json(self) -> dict[str, Any]:
        """Return it in JSON's types; the picture by its digest."""
        return {
            "picture": self.source.digest,
            "width_mm": self.width_mm,
            "adjustment": asdict(self.adjustment),
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any], pictures: Mapping[str, Picture]) -> Self:
        """Make a reference of what `to_json` gave, and of the pictures by their digests."""
        adjustment = Adjustment(**data["adjustment"])
        return cls.of(pictures[data["picture"]], data["width_mm"], adjustment)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Reference):
            return NotImplemented
        mine, others = (self.width_mm, self.adjustment), (other.width_mm, other.adjustment)
        return self is other or (mine == others and self.source == other.source)

    def __hash__(self) -> int:
        return hash((self.width_mm, self.adjustment))


def _frozen(values: NDArray[np.float32]) -> NDArray[np.float32]:
    fresh = np.ascontiguousarray(values, np.float32)
    fresh.flags.writeable = False
    return fresh
