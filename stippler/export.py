"""A drawing to files, by the file's ending or a format's name."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.atomic_write import STDOUT, check_writable, replacing
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import ParameterError
from stippler.files.write.format import Format
from stippler.files.write.formats import ENDINGS, STIPPLE, format_named, format_of, options_of
from stippler.files.write.options import checked

if TYPE_CHECKING:
    from stippler.files.write.sheet import Sheet

__all__ = ["ENDINGS", "check_output", "check_size", "chosen", "save", "values_for"]

Show = Callable[[int], None]
"""Told how many bytes have been written."""


def chosen(path: str | Path, form: str = "") -> Format:
    """Return the format that a file is written in, or raise if there is none.

    Parameters
    ----------
    form : str
        The format by its ending, such as "svg", where the file's own is not to be asked.
    """
    if form:
        return format_named(form)
    if os.fspath(path) == STDOUT:
        raise ParameterError("needs a format", "standard output", "give --format svg or another")
    return format_of(path)


def values_for(one: Format, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return a value for each option of a format, from those given and the profile's.

    Options that are None count as not given.
    """
    own = tuple(option.name for option in one.options)
    given = {name: value for name, value in options.items() if value is not None}
    if "dpi" not in own:
        given.pop("dpi", None)  # whoever asks for one means: if it has pixels
    if given.get("profile") is not None or given.get("column") is not None:
        from stippler.files.write.profiles import with_profile

        given = with_profile(given, own)
    return checked(options_of(one), given)


def check_output(
    path: str | Path, inputs: Iterable[str | Path] = (), form: str = "", **options: Any
) -> None:
    """Raise now what `save` would raise later: a wrong ending, folder or value.

    Parameters
    ----------
    inputs : paths
        What the drawing is made from; the output may be none of these files, by whatever name.
    form : str
        As for `chosen`.
    """
    values_for(chosen(path, form), options)
    check_writable(path, inputs)


def check_size(path: str | Path, page: Page, form: str = "", **options: Any) -> None:
    """Raise now what `save` would raise later: a page that has too many pixels, or none."""
    one = chosen(path, form)
    values = values_for(one, options)
    if "dpi" in values:
        from stippler.files.write.plate import plate_of
        from stippler.files.write.raster import size_px

        size_px(plate_of(Drawing.blank(page), values), values["dpi"])


def save(
    drawing: Drawing,
    path: str | Path,
    *,
    inputs: Iterable[str | Path] = (),
    form: str = "",
    show: Show | None = None,
    **options: Any,
) -> list[Path]:
    """Write a drawing in the format of the file's ending, whole or not at all.

    Several files take their names together, when all of them are written.

    Parameters
    ----------
    path : path
        Its ending chooses the format; ``-`` is standard output. Formats for pens write a file a
        layer, where there are several: the layer's number and name are put before the ending.
    inputs : paths
        What the drawing was made from, which is never written over.
    form : str
        The format by its ending, whatever the file's own.
    show : callable, optional
        Told how many bytes have been written; whatever it raises ends the writing.
    options
        Those of the format and of every picture; see `docs/exports.md`.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    OutputError
        If the ending is unknown or the file cannot be written; what stood there stays.
    ParameterError
        If there is no option of a name, or its value is out of range.
    """
    inputs = list(inputs)
    check_output(path, inputs, form, **options)
    one = chosen(path, form)
    files = list(_files(one, drawing, path, values_for(one, options), show))
    for file, _ in files:
        check_writable(file, inputs)
    with contextlib.ExitStack() as all_or_none:
        n_written = 0
        for file, chunks in files:
            stream = all_or_none.enter_context(replacing(file))
            for chunk in chunks:
                stream.write(chunk)
                n_written += len(chunk)
                if show is not None:
                    show(n_written)
    return [Path(file) for file, _ in files]


def _files(
    one: Format,
    drawing: Drawing,
    path: str | Path,
    values: Mapping[str, Any],
    show: Show | None,
) -> Iterator[tuple[str | Path, Iterator[bytes]]]:
    """Yield the names of files and what goes into them."""
    from stippler.drawing.visible import shown

    if one is not STIPPLE:
        drawing = shown(drawing)
    if one.is_data:
        yield path, one.write(drawing, values)
        return
    from dataclasses import replace

    from stippler.files.write.plate import plate_of

    def cancelled() -> bool:
        if show is not None:
            show(0)  # ends it by an exception
        return False

    sheet = plate_of(drawing, values, cancelled)
    layers = [layer for layer in sheet.layers if not layer.is_empty]
    if not one.a_file_a_layer or len(layers) < 2 or os.fspath(path) == STDOUT:
        yield path, one.write(sheet, values)
        return
    for file, layer in zip(files_of(one, sheet, Path(path)), layers, strict=True):
        yield file, one.write(replace(sheet, layers=(layer,)), values)


def files_of(one: Format, sheet: Sheet, path: Path) -> list[Path]:
    """Return the files that a sheet is written to: of several pens a file for each."""
    from stippler.files.write.names import plain, unique

    layers = [layer for layer in sheet.layers if not layer.is_empty]
    if not one.a_file_a_layer or len(layers) < 2:
        return [path]
    names = unique(plain(layer.name) for layer in layers)
    return [
        path.with_name(f"{path.stem}-{k}-{name}{path.suffix}") for k, name in enumerate(names, 1)
    ]
