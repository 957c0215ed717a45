"""Make the pictures of `docs/exports.md`: a plate, one line, and what a pen does.

python docs/make_exports.py
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import stippler
from stippler.files.write.pen_paths import paths_of
from stippler.files.write.raster import grey_strips
from stippler.files.write.sheet import Layer, Line, Sheet, sheet_of

HERE = Path(__file__).parent
SAMPLE = HERE.parent / "assets" / "samples" / "ammonite.png"


def main() -> None:
    """Write the pictures beside this file."""
    drawing = stippler.stipple(SAMPLE, dots=4000, width=90)
    plate = {"magnification": 3, "marks": "all", "letter": "A", "caption": "Fig. 3. Dactylioceras"}
    drawing.save(HERE / "exports-plate.png", dpi=150, **plate)
    drawing.save(HERE / "exports-one-line.png", dpi=150, one_line="closed", line_width=0.3)
    _pen(drawing, 0.25)


def _pen(drawing: stippler.Drawing, pen_mm: float) -> None:
    """Show the pen's way over a part of the page: what it draws black, its travel thin."""
    sheet = sheet_of(drawing)
    paths = paths_of(sheet.layers[0], sheet, pen_mm)
    ways = [paths.points_mm[a:b] for a, b in zip(paths.starts[:-1], paths.starts[1:], strict=True)]
    drawn = tuple(Line(way, 0.08) for way in ways)
    travel = tuple(Line(paths.points_mm[[b - 1, b]], 0.03) for b in paths.starts[1:-1])
    near = replace(Sheet(20.0, 15.0, (Layer("pen", lines=_within((*drawn, *travel), 30, 30)),)))
    from PIL import Image

    rows = [Image.fromarray(strip) for strip in grey_strips(near, 1000)]
    whole = Image.new("L", (rows[0].width, sum(row.height for row in rows)))
    top = 0
    for row in rows:
        whole.paste(row, (0, top))
        top += row.height
    whole.save(HERE / "exports-pen.png")


def _within(lines: tuple[Line, ...], left: float, top: float) -> tuple[Line, ...]:
    moved = [Line(line.points_mm - (left, top), line.width_mm) for line in lines]
    return tuple(
        line for line in moved if (line.points_mm > -2).all() and (line.points_mm < 24).all()
    )


if __name__ == "__main__":
    main()
