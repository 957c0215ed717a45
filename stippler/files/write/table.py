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
    for start in range(0, len(dots), _CHUNK):
        rows = slice(start, start + _CHUNK)
        texts = [_texts(column[rows]) for column in columns.values()]
        yield ("\n".join(map(",".join, zip(*texts, strict=True))) + "\n").encode()


def _texts(column: NDArray[Any]) -> list[str]:
    """Return the shortest texts that keep every bit: nine digits for floats of 32 bits."""
    if (column == column[0]).all():  # most shapes are all the same
        return [_text(column[0].item(), column.dtype)] * len(column)
    values: list[Any] = column.tolist()
    if column.dtype == np.float32:
        return [f"{value:.9g}" for value in values]
    return list(map(repr if column.dtype.kind == "f" else _whole, values))


def _text(value: Any, dtype: np.dtype[Any]) -> str:
    if dtype == np.float32:
        return f"{value:.9g}"
    return repr(value) if dtype.kind == "f" else _whole(value)


def _whole(value: int) -> str:
    return str(int(value))


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
            yield (", " if start else "").encode() + ", ".join(_texts(part)).encode()
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
