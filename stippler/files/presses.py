"""Presses, pens and papers that were calibrated: how far their ink spreads, kept under a name."""

from __future__ import annotations

import datetime
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from stippler.errors import ParameterError
from stippler.settings import read_document, settings_folder, write_document

FILE = "presses.json"


@dataclass(frozen=True, slots=True)
class Press:
    """A press, pen or printer on a paper.

    Attributes
    ----------
    gain_mm : float
        By how much every edge grows.
    least_dot_mm : float
        Diameter of the smallest dots that it holds; 0 is not known.
    measured : tuple of float
        What the calibration sheet measured, if it was by that.
    dated : str
        When that was.
    """

    name: str
    gain_mm: float
    least_dot_mm: float = 0.0
    measured: tuple[float, ...] = ()
    dated: str = ""

    def __post_init__(self) -> None:
        if not self.name.strip() or len(self.name) > 80 or not self.name.isprintable():
            raise ParameterError(f"{self.name!r} is no name", "press", "give up to 80 letters")
        for what, value, low, high in (
            ("dot gain", self.gain_mm, -1.0, 1.0),
            ("least dot", self.least_dot_mm, 0.0, 10.0),
        ):
            if not (math.isfinite(value) and low <= value <= high):
                raise ParameterError(f"{value:g} mm is none", what, f"give {low:g} to {high:g} mm")


def presses(folder: Path | None = None) -> dict[str, Press]:
    """Return all that were calibrated, by name; entries that are broken are left out."""
    path = (folder or settings_folder()) / FILE
    try:
        status = path.stat()
    except OSError:
        return {}
    return dict(_read_all(path, status.st_mtime_ns, status.st_size))


@lru_cache(maxsize=2)
def _read_all(path: Path, *of_file: int) -> dict[str, Press]:
    """Return what a file holds, read once for each state of it."""
    document, _ = read_document(path)
    found = {}
    for name, entry in document.items():
        try:
            found[name] = _read(name, entry)
        except (ParameterError, TypeError, ValueError, KeyError):
            continue
    return dict(sorted(found.items()))


def _read(name: str, entry: Mapping[str, Any]) -> Press:
    entry = dict(entry)
    measured = tuple(float(value) for value in entry.get("measured", ()))
    return Press(
        name, float(entry["gain_mm"]), float(entry.get("least_dot_mm", 0.0)), measured,
        str(entry.get("dated", "")),
    )  # fmt: skip


def press_named(name: str, folder: Path | None = None) -> Press:
    """Find a press.

    Raises
    ------
    ParameterError
        If there is none of that name.
    """
    known = presses(folder)
    if name not in known:
        listed = f"one of {', '.join(known)}" if known else "calibrate one first"
        raise ParameterError(f"{name!r} is unknown", "press", listed)
    return known[name]


def keep_press(press: Press, folder: Path | None = None) -> None:
    """Keep a press under its name; one of that name before is replaced.

    Raises
    ------
    StipplerError
        If it cannot be written.
    """
    path = (folder or settings_folder()) / FILE
    document, _ = read_document(path)
    entry = {key: value for key, value in asdict(press).items() if key != "name"}
    document[press.name] = entry
    write_document(path, document)


def calibrated(name: str, measured: list[float], least_dot_mm: float = 0.0) -> Press:
    """Return a press of what the patches of a calibration sheet measured; see `keep_press`."""
    from stippler.files.checks import gain_of

    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    gain = round(gain_of(measured), 5)
    return Press(name, gain, least_dot_mm, tuple(measured), today)
