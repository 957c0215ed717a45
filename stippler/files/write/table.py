"""Dots as data: CSV, JSON and NPZ with every field, which read back exactly."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import NO_CURVE, Dots
from stippler.drawing.drawing import Drawing
from stippler.files.write.format import Values

FIRST_COLUMNS = "x_mm,y_mm,radius_mm,elongation,angle_rad,roughness,seed,area,fixed"
"""What every table of dots begins with, in this order; further fields follow by name."""

_CHUNK = 20_000


def columns_of(dots: Dots) -> dict[str, NDArray[Any]]:
    """Return the dots' fields by name, in the order that tables have; x and y apart."""
    columns: dict[str, NDArray[Any]] = {
        "x_mm": dots.position_mm[:, 0],
        "y_mm": dots.position_mm[:, 1],
    }
    names = FIRST_COLUMNS.split(",")[2:]
    more = [f.name for f in fields(Dots) if f.name not in ("position_mm", *names)]
    if not (dots.curve != NO_CURVE).any():
        is_plain = np.array_equal(dots.id, np.arange(len(dots)))
        more = [] if is_plain else ["id"]  # what readers take for granted
    for name in (*names, *more):
        columns[name] = getattr(dots, name)
    return columns


def csv_chunks(dots: Dots) -> Iterator[bytes]:
    """Yield the table in pieces: header, then a line a dot; truth values as 0 or 1."""
    columns = columns_of(dots)
    yield (",".join(columns) + "\n").encode()
    form = ",".join(_form(column) for column in columns.values()) + "\n"
    write = form.format
    for start in range(0, len(dots), _CHUNK):
        rows = slice(start, start + _CHUNK)
        values = [_listed(column[rows]) for column in columns.values()]
        yield "".join(map(write, *values)).encode()


def _form(column: NDArray[Any]) -> str:
    """Return the shortest form that keeps every bit: nine digits for floats of 32 bits."""
    if column.dtype == np.float32:
        return "{:.9g}"
    return "{!r}" if column.dtype.kind == "f" else "{:d}"


def _listed(column: NDArray[Any]) -> list[Any]:
    values: list[Any] = column.tolist()
    return values


def csv_of(drawing: Drawing, values: Values) -> Iterator[bytes]:
    """Yield a drawing's dots as a table."""
    return csv_chunks(drawing.dots)


def json_chunks(drawing: Drawing, values: Values) -> Iterator[bytes]:
    """Yield page, areas and a list for each field of the dots."""
    page = {"width_mm": drawing.page.width_mm, "height_mm": drawing.page.height_mm}
    areas = {str(index): area.name for index, area in sorted(drawing.areas.items())}
    head = json.dumps({"format": "stippler dots", "version": 1, "page": page, "areas": areas})
    yield head[:-1].encode() + b', "dots": {'
    for k, (name, column) in enumerate(columns_of(drawing.dots).items()):
        yield f"{', ' if k else ''}\n{json.dumps(name)}: [".encode()
        for start in range(0, len(column), _CHUNK):
            part = column[start : start + _CHUNK]
            form = _form(part).format
            text = ", ".join(map(form, part.tolist()))
            yield (", " if start else "").encode() + text.encode()
        yield b"]"
    yield b"\n}}\n"


def npz_chunks(drawing: Drawing, values: Values) -> Iterator[bytes]:
    """Yield NumPy's archive of the dots' fields and the page, without dates."""
    import zipfile

    stream = io.BytesIO()
    page = np.array([drawing.page.width_mm, drawing.page.height_mm])
    arrays = {**{f.name: getattr(drawing.dots, f.name) for f in fields(Dots)}, "page_mm": page}
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, array in arrays.items():
            held = io.BytesIO()
            np.lib.format.write_array(held, np.ascontiguousarray(array), allow_pickle=False)
            info = zipfile.ZipInfo(f"{name}.npy")
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, held.getvalue())
    yield stream.getvalue()
