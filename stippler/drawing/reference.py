"""The picture that tone is taken from, as a field of darkness over the page."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.adjustment import NEUTRAL, Adjustment
from stippler.drawing.levels import Curve, Levels
from stippler.errors import ParameterError

_DIGEST = re.compile("[0-9a-f]{32}")


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A picture as it came, and the darkness that was read from it; equal by its digest.

    Attributes
    ----------
    levels : Levels
        Its darkness; the only form in which it is kept.
    tone : str
        How darkness was taken from it.
    name : str
        Of its file; empty where it came from no file.
    data : bytes or None
        The file as it came; None where it came from no file, or was not kept.
    """

    levels: Levels
    tone: str = "linear"
    name: str = ""
    data: bytes | None = None
    _digest: list[str] = field(default_factory=list)

    @classmethod
    def of(
        cls, darkness: NDArray[np.floating], tone: str = "linear", name: str = "", digest: str = ""
    ) -> Self:
        """Make the picture of a field of darkness, 0..1, that came from no file.

        Parameters
        ----------
        digest : str
            The one it was kept under; else, and if this is none, its own. Fields that files of
            earlier versions hold may be rounded now, and what names them is to find them still.
        """
        known = [digest] if _DIGEST.fullmatch(digest) else []
        return cls(Levels.of(darkness), tone, name, None, known)

    @property
    def digest(self) -> str:
        """What tells this picture, read in this tone, from all others."""
        if not self._digest:
            mixed = hashlib.blake2b(f"{self.tone} {self.levels.shape}".encode(), digest_size=16)
            if self.data is not None:
                mixed.update(self.data)
            else:
                for band in self.levels.bands():
                    mixed.update(band.data)
            self._digest.append(mixed.hexdigest())
        return self._digest[0]

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Picture) and self.digest == other.digest)

    def __hash__(self) -> int:
        return hash(self.levels.shape)


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

    __slots__ = ("_levels", "_plain", "adjustment", "source", "width_mm")

    def __init__(self, darkness: NDArray[np.floating], width_mm: float) -> None:
        self._set(Picture.of(darkness), width_mm, NEUTRAL)

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
        self._levels = source.levels if adjustment == NEUTRAL else None
        self._plain: Reference | None = None

    @property
    def levels(self) -> Levels:
        """The picture's levels with their values as adjusted; worked out when first asked for."""
        if self._levels is None:
            plain = self.source.levels
            self._levels = Levels(plain.of_pixel, self.adjustment.apply(plain.values))
        return self._levels

    @property
    def values(self) -> NDArray[np.float32]:
        """What the picture's levels are as adjusted, read-only, (n,)."""
        return self.levels.values

    @property
    def darkness(self) -> NDArray[np.float32]:
        """The darkness of all pixels as adjusted, (h, w), read-only; worked out each time."""
        return self.levels.darkness()

    def table(self, *curves: Curve) -> NDArray[np.float32]:
        """Return what the adjustment and then curves make of each level; see `Levels.table`."""
        return self.source.levels.table(self.adjustment.apply, *curves)

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
        """Return an equal value that holds no table of its own, for a history to keep."""
        made = Reference.of(self.source, self.width_mm, self.adjustment)
        made._plain = self._plain
        return made

    @property
    def pixel_mm(self) -> float:
        """Side of a pixel on the page."""
        return self.width_mm / self.source.levels.shape[1]

    @property
    def height_mm(self) -> float:
        """Height of the field on the page."""
        return self.pixel_mm * self.source.levels.shape[0]

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

        of_pixel = self.source.levels.of_pixel
        return sampled(of_pixel, self.values, 1.0 / self.pixel_mm, position_mm)

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
