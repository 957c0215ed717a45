"""Outlines and lines from files: what they hold, what was left out, and how much is too much."""

from __future__ import annotations

import gzip
from dataclasses import dataclass
from pathlib import Path as FilePath

from stippler.drawing.planar.path import Path
from stippler.errors import StipplerError

MOST_BYTES = 256 * 2**20
MOST_SHAPES = 200_000
MOST_VERTICES = 5_000_000


class OutlineError(StipplerError):
    """A file of outlines that cannot be read."""


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """One element of a file.

    Attributes
    ----------
    name : str
        Its id or label; may be empty.
    paths : tuple of Path
        Its rings or lines, in mm from the page's corner.
    rule : {"non-zero", "even-odd"}
    is_closed : bool
        Whether all its paths were closed in the file; open ones were not closed here.
    """

    name: str
    paths: tuple[Path, ...]
    rule: str = "non-zero"
    is_closed: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Outlines:
    """What a file holds.

    Attributes
    ----------
    shapes : tuple of Shape
        In the order they are drawn.
    size_mm : (width, height) or None
        Of the file's page.
    notes : tuple of str
        What was left out or repaired, named.
    """

    shapes: tuple[Shape, ...]
    size_mm: tuple[float, float] | None = None
    notes: tuple[str, ...] = ()


def read_outlines(path: FilePath) -> Outlines:
    """Read an .svg, .svgz, .geojson or .json file of outlines.

    Raises
    ------
    OutlineError
        If it cannot be read, is too large, or holds no outline.
    """
    from stippler.files.read.geojson import outlines_of_geojson
    from stippler.files.read.svg_outlines import outlines_of_svg

    data = _bytes_of(path)
    ending = path.suffix.lower()
    if ending in (".svg", ".svgz"):
        return outlines_of_svg(data, path)
    if ending in (".geojson", ".json"):
        return outlines_of_geojson(data, path)
    raise OutlineError(
        f"{ending or 'no ending'} is no kind of outlines", path, "give .svg, .svgz or .geojson"
    )


def _bytes_of(path: FilePath) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
        if data[:2] == b"\x1f\x8b":
            with gzip.open(path) as unpacked:
                data = unpacked.read(MOST_BYTES + 1)
    except (OSError, EOFError) as error:
        raise OutlineError("cannot be read", path, str(error)) from error
    if len(data) > MOST_BYTES:
        raise OutlineError(f"is larger than {MOST_BYTES >> 20} MB", path, "simplify it first")
    return data
