"""Dots as a table of comma-separated values, one dot a line."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from stippler.drawing.dots import MAX_ELONGATION, Dots
from stippler.errors import TableError

COLUMNS = "x_mm,y_mm,radius_mm,elongation,angle_rad,roughness,seed,area,fixed"
_CHUNK = 20_000
_LONGEST_LINE = 1000
_DO = "save it again with stippler render -o NAME.csv"


def csv_chunks(dots: Dots) -> Iterator[bytes]:
    """Yield the table in pieces: header, then a line a dot; fixed as 0 or 1."""
    yield f"{COLUMNS}\n".encode()
    for start in range(0, len(dots), _CHUNK):
        rows = slice(start, start + _CHUNK)
        position = dots.position_mm[rows]
        columns = zip(
            position[:, 0].tolist(),
            position[:, 1].tolist(),
            dots.radius_mm[rows].tolist(),
            dots.elongation[rows].tolist(),
            dots.angle_rad[rows].tolist(),
            dots.roughness[rows].tolist(),
            dots.seed[rows].tolist(),
            dots.area[rows].tolist(),
            dots.fixed[rows].tolist(),
            strict=True,
        )
        lines = [
            f"{x:.6f},{y:.6f},{r:.6f},{e:.6g},{a:.6g},{o:.6g},{s},{n},{f:d}\n"
            for x, y, r, e, a, o, s, n, f in columns
        ]
        yield "".join(lines).encode()


def read_csv(path: str | Path) -> Dots:
    """Read a table that `csv_chunks` wrote.

    Raises
    ------
    TableError
        If there is no such file, or a line in it is none of ours; says which.
    """
    path = Path(path)
    try:
        with path.open(encoding="utf-8", errors="replace") as stream:
            if stream.readline(_LONGEST_LINE).rstrip("\n") != COLUMNS:
                raise TableError("does not begin with our columns", f"{path}, line 1", _DO)
            rows = []
            for number, line in enumerate(iter(lambda: stream.readline(_LONGEST_LINE), ""), 2):
                try:
                    rows.append(_row(line))
                except ValueError as error:
                    raise TableError(str(error), f"{path}, line {number}", _DO) from None
    except FileNotFoundError:
        raise TableError("no such file", path, "check the name") from None
    except IsADirectoryError:
        raise TableError("is a folder", path, "name a table in it") from None
    except OSError as error:
        raise TableError(f"cannot be read ({error.strerror})", path, "check the file") from None
    return _dots(rows)


def _row(line: str) -> tuple[float, ...]:
    """Return a line's values, or raise `ValueError` that says what is wrong."""
    cells = line.split(",")
    if len(cells) != 9:
        raise ValueError(f"has {len(cells)} values, not 9")
    try:
        x, y, r, e, a, o = map(float, cells[:6])
        s, n, f = map(int, cells[6:])
    except ValueError:
        raise ValueError("has a value that is no number") from None
    if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(a)):
        raise ValueError("has a position or angle that is not finite")
    if not 0 < r < math.inf:
        raise ValueError(f"has a radius of {r:g}, which is not above 0")
    if not (1 <= e <= MAX_ELONGATION and 0 <= o <= 1):
        raise ValueError(f"has a shape of no dot (elongation {e:g}, roughness {o:g})")
    if not (0 <= s < 2**32 and 0 <= n < 2**31 and f in (0, 1)):
        raise ValueError("has a seed, area or fixed that no dot has")
    return x, y, r, e, a, o, s, n, f


def _dots(rows: list[tuple[float, ...]]) -> Dots:
    if not rows:
        return Dots.none()
    values = np.array(rows, np.float64)
    dots = Dots.round(values[:, :2], values[:, 2])
    dots.elongation[:], dots.angle_rad[:], dots.roughness[:] = values[:, 3:6].T
    dots.seed[:], dots.area[:], dots.constraint[:] = values[:, 6:9].T
    return dots
