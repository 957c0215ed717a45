"""What publishers ask for, each with its source: `assets/profiles/NAME.json`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from stippler.errors import ParameterError
from stippler.resources import assets


@dataclass(frozen=True, slots=True)
class Profile:
    """A publisher's demands on line art; None where its source gives none.

    Attributes
    ----------
    name, title : str
        As the command line takes it, and as a person reads it.
    widths_mm : dict
        By the name of the column.
    height_mm : float or None
        At most.
    dpi : float or None
        Of a bitmap.
    bits : int or None
        A pixel.
    files : tuple of str
        Endings, the best first.
    smallest_line_mm : float or None
        Dots should not be smaller either: no publisher says anything of dots.
    source, url, dated, read : str or None
        Where that stands, of when it is, and when it was read.
    """

    name: str
    title: str
    widths_mm: dict[str, float]
    height_mm: float | None
    dpi: float | None
    bits: int | None
    files: tuple[str, ...]
    smallest_line_mm: float | None
    source: str
    url: str | None
    dated: str | None
    read: str
    note: str

    def width_mm(self, column: str | None = None) -> float | None:
        """Return the width of a column, of the only or the first one by default.

        Raises
        ------
        ParameterError
            If there is no column of that name.
        """
        if column is None:
            return next(iter(self.widths_mm.values()), None)
        if column not in self.widths_mm:
            known = ", ".join(self.widths_mm) or "none is known"
            raise ParameterError(f"{self.title} has no {column!r}", "column", f"one of: {known}")
        return self.widths_mm[column]


@cache
def profiles() -> dict[str, Profile]:
    """Return all profiles by name."""
    paths = sorted((assets() / "profiles").glob("*.json"))
    return {path.stem: _read(path.stem, json.loads(path.read_text("utf-8"))) for path in paths}


def _read(name: str, data: dict[str, Any]) -> Profile:
    return Profile(
        name,
        data["title"],
        {column: float(width) for column, width in data["widths_mm"].items()},
        data.get("height_mm"),
        data["dpi"],
        data["bits"],
        tuple(data["files"]),
        data["smallest_line_mm"],
        data["source"],
        data["url"],
        data["dated"],
        data["read"],
        data["note"],
    )


def profile_named(name: str) -> Profile:
    """Find a profile.

    Raises
    ------
    ParameterError
        If there is none of that name.
    """
    known = profiles()
    if name not in known:
        raise ParameterError(f"{name!r} is unknown", "profile", f"one of {', '.join(known)}")
    return known[name]


def with_profile(given: Mapping[str, Any], own: tuple[str, ...]) -> dict[str, Any]:
    """Return the values given, with what a profile says of those that are not.

    Parameters
    ----------
    own : tuple of str
        Names of the format's own options.
    """
    values = dict(given)
    name = values.get("profile")
    if name is None:
        if values.get("column") is not None:
            raise ParameterError("is one of a profile's", "column", "name a profile, too")
        return values
    profile = profile_named(name)
    found: dict[str, Any] = {
        "print_width": profile.width_mm(values.get("column")),
        "dpi": profile.dpi,
        "bits": None if profile.bits is None else str(profile.bits),
    }
    for key, value in found.items():
        if value is not None and values.get(key) is None and (key == "print_width" or key in own):
            values[key] = value
    return values
