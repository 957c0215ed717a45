"""A drawing to a file, by the file's ending."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from stippler.atomic_write import STDOUT, check_writable, replacing
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import OutputError, ParameterError
from stippler.units import px_per_mm

DEFAULT_DPI = 300.0


def check_ending(path: str | Path, form: str = "") -> str:
    """Return the ending that names a file's format, or raise `OutputError` if none writes it.

    Parameters
    ----------
    form : str
        The format by name, such as "svg", where the file's own ending is not to be asked.
    """
    ending = f".{form.lower().removeprefix('.')}" if form else Path(path).suffix.lower()
    if os.fspath(path) == STDOUT and not ending:
        raise ParameterError("needs a format", "standard output", f"give --format {_FORMS}")
    if form and ending not in ENDINGS:
        raise ParameterError(f"{form!r} is no format", "format", f"choose {_FORMS}")
    if ending not in ENDINGS:
        what = f"the ending {ending!r} is not written" if ending else "the name has no ending"
        raise OutputError(what, path, f"end it in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")
    return ending


def check_output(
    path: str | Path,
    dpi: float = DEFAULT_DPI,
    inputs: Iterable[str | Path] = (),
    form: str = "",
) -> None:
    """Raise now what `save` would raise later: a wrong ending, folder or resolution.

    Parameters
    ----------
    inputs : paths
        What the drawing is made from; the output may be none of these files, by whatever name.
    form : str
        As for `check_ending`.
    """
    check_ending(path, form)
    if not (math.isfinite(dpi) and dpi > 0):
        raise ParameterError(f"{dpi:g} is no resolution", "dpi", "give a number above 0")
    check_writable(path, inputs)


def check_size(path: str | Path, page: Page, dpi: float = DEFAULT_DPI, form: str = "") -> None:
    """Raise now what `save` would raise later: a page that has too many pixels, or none."""
    if check_ending(path, form) == ".png":
        from stippler.headless import image_size

        image_size(Drawing.blank(page), px_per_mm(dpi))


def save(
    drawing: Drawing,
    path: str | Path,
    *,
    dpi: float = DEFAULT_DPI,
    inputs: Iterable[str | Path] = (),
    form: str = "",
) -> None:
    """Write a drawing as SVG, PNG, CSV or a drawing of our own kind, whole or not at all.

    Parameters
    ----------
    path : path
        Its ending chooses the format; ``-`` is standard output.
    dpi : float
        Pixels an inch of a PNG; ignored for others.
    inputs : paths
        What the drawing was made from, which is never written over.
    form : str
        The format by name, whatever the file's ending.

    Raises
    ------
    OutputError
        If the ending is unknown or the file cannot be written; what stood there stays.
    ParameterError
        If `dpi` is not a finite number above 0.
    DisplayError
        If a PNG is asked for and there is no OpenGL.
    """
    check_output(path, dpi, inputs, form)
    chunks = _WRITERS[check_ending(path, form)](drawing, dpi)
    with replacing(path) as stream:
        stream.writelines(chunks)


def _svg(drawing: Drawing, dpi: float) -> Iterator[bytes]:
    from stippler.files.svg import svg_chunks

    return svg_chunks(drawing)


def _csv(drawing: Drawing, dpi: float) -> Iterator[bytes]:
    from stippler.files.table import csv_chunks

    return csv_chunks(drawing.dots)


def _png(drawing: Drawing, dpi: float) -> Iterator[bytes]:
    from stippler.files.png import png_chunks
    from stippler.headless import image_size, render_strips

    scale = px_per_mm(dpi)
    strips = render_strips(drawing, px_per_mm=scale, grey=True)
    return png_chunks(strips, image_size(drawing, scale), dpi)


def _stipple(drawing: Drawing, dpi: float) -> Iterator[bytes]:
    from stippler.files.native.drawing_file import file_bytes

    yield file_bytes(drawing)


_WRITERS: dict[str, Callable[[Drawing, float], Iterator[bytes]]] = {
    ".svg": _svg,
    ".png": _png,
    ".csv": _csv,
    ".stipple": _stipple,
}
ENDINGS = tuple(_WRITERS)
_FORMS = " or ".join(ending[1:] for ending in ENDINGS)
