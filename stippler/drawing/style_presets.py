"""Styles that come with the program, as data; importing it costs nothing."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from stippler.drawing.style import Style
from stippler.errors import ParameterError, StipplerError
from stippler.resources import assets


@dataclass(frozen=True, slots=True)
class Preset:
    """A style under a name.

    Attributes
    ----------
    key : str
        As the command line and Python call it.
    about : str
        What it is for: a sentence.
    swatch : Path
        A picture of it, made by ``python docs/make_styles.py``.
    """

    key: str
    about: str
    style: Style
    swatch: Path

    @property
    def label(self) -> str:
        """As a person calls it."""
        return self.style.name


@cache
def presets() -> dict[str, Preset]:
    """Return the styles that come with the program, by their keys."""
    return {path.stem: _read(path) for path in sorted((assets() / "styles").glob("*.json"))}


def preset_keys() -> tuple[str, ...]:
    """Return their keys, without reading them."""
    return tuple(sorted(path.stem for path in (assets() / "styles").glob("*.json")))


def preset(key: str) -> Style:
    """Return a style by its key.

    Raises
    ------
    ParameterError
        If there is none of that name.
    """
    if key not in preset_keys():
        raise ParameterError(f"{key!r} is unknown", "style", f"one of {', '.join(preset_keys())}")
    return presets()[key].style


def _read(path: Path) -> Preset:
    """Read one; a fault in it is told with its file."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        style = replace(Style.from_json(data["style"]), name=data["name"])
        return Preset(path.stem, data["about"], style, path.with_suffix(".png"))
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise StipplerError(
            f"is no style ({error})", path, "mend it, or install the program anew"
        ) from None
