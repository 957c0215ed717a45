"""Dots as a table of comma-separated values, one dot a line."""

from __future__ import annotations

from collections.abc import Iterator

from stippler.drawing.dots import Dots

COLUMNS = "x_mm,y_mm,radius_mm,elongation,angle_rad,roughness,seed,area,fixed"
_CHUNK = 20_000


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
