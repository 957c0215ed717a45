"""G-code and HPGL: what a pen does, one file for each layer."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stippler.files.write.format import Values
from stippler.files.write.names import plain
from stippler.files.write.pen_paths import Paths, paths_of
from stippler.files.write.sheet import Sheet
from stippler.kernels.shapes.number_text import number_rows_of_kinds

HPGL_PER_MM = 40
_BLOCK = 50_000


def paths_by_layer(sheet: Sheet, values: Values) -> Iterator[tuple[str, Paths]]:
    """Yield what the pen does for each layer that has something to draw."""
    for layer in sheet.layers:
        paths = paths_of(layer, sheet, values["pen_width"], sort=values["sort"])
        if len(paths):
            yield layer.name, paths


def duration_s(sheet: Sheet, values: Values) -> float:
    """Return how long drawing all layers takes, in s."""
    feed, travel, lift = values["feed"], values["travel"], values["lift_time"]
    return sum(paths.duration_s(feed, travel, lift) for _, paths in paths_by_layer(sheet, values))


def gcode(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield G-code in mm, y up from the lower left corner; the pen is up between paths."""
    up, down = values["pen_up"], values["pen_down"]
    feed, travel = f"{values['feed']:g}", f"{values['travel']:g}"
    first = (b"G0X", b"Y", f"F{travel}\n{down}\nG1F{feed}\n".encode())
    pieces = (
        first,
        (b"G1X", b"Y", b"\n"),
        (b"G1X", b"Y", f"\n{up}\n".encode()),
        (b"G0X", b"Y", f"F{travel}\n{down}\n{up}\n".encode()),
    )
    yield f"; Stippler, {sheet.width_mm:g} x {sheet.height_mm:g} mm\nG21\nG90\n{up}\n".encode()
    for name, paths in paths_by_layer(sheet, values):
        taken = paths.duration_s(values["feed"], values["travel"], values["lift_time"])
        yield f"; layer {plain(name)}, {len(paths)} paths, {taken / 60:.1f} min\n".encode()
        yield from _rows(paths, sheet, pieces, 1.0, 3)
    yield f"{up}\nG0X0Y0F{travel}\n".encode()


def hpgl(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield HPGL in units of 1/40 mm, y up, a pen a layer."""
    pieces = (
        (b"PU", b",", b";PD;\n"),
        (b"PA", b",", b";\n"),
        (b"PA", b",", b";PU;\n"),
        (b"PU", b",", b";PD;PU;\n"),
    )
    yield b"IN;PA;PU;\n"
    for k, (_, paths) in enumerate(paths_by_layer(sheet, values)):
        yield f"SP{k % 8 + 1};VS{max(round(values['feed'] / 600), 1)};\n".encode()
        yield from _rows(paths, sheet, pieces, HPGL_PER_MM, 0)
    yield b"PU;SP0;IN;\n"


def _rows(
    paths: Paths,
    sheet: Sheet,
    pieces: tuple[tuple[bytes, ...], ...],
    per_mm: float,
    decimals: int,
) -> Iterator[bytes]:
    x = paths.points_mm[:, 0] * per_mm
    y = (sheet.height_mm - paths.points_mm[:, 1]) * per_mm
    kinds = paths.kinds
    for start in range(0, len(x), _BLOCK):
        some = slice(start, start + _BLOCK)
        columns = np.ascontiguousarray(x[some]), np.ascontiguousarray(y[some])
        yield number_rows_of_kinds(columns, (decimals, decimals), pieces, kinds[some])
