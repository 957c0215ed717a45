"""Encapsulated PostScript, level 2: the same picture as PDF for older presses."""

from __future__ import annotations

import math
from collections.abc import Iterator

from stippler.files.write.format import Values
from stippler.files.write.names import plain
from stippler.files.write.painting import PS_WORDS, painted
from stippler.files.write.pdf import places_for
from stippler.files.write.sheet import Sheet, smallest_mm
from stippler.units import MM_PER_INCH

_PT = 72 / MM_PER_INCH

_PROLOGUE = b"""%%BeginProlog
/m {moveto} bind def
/l {lineto} bind def
/c {curveto} bind def
/h {closepath} bind def
/f {fill} bind def
/w {setlinewidth} bind def
/d {0 360 arc fill} bind def
%%EndProlog
"""


def chunks(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield a sheet as EPS, piece by piece; the same sheet gives the same bytes."""
    width, height = sheet.width_mm * _PT, sheet.height_mm * _PT
    yield (
        "%!PS-Adobe-3.0 EPSF-3.0\n"
        f"%%BoundingBox: 0 0 {math.ceil(width - 1e-6)} {math.ceil(height - 1e-6)}\n"
        f"%%HiResBoundingBox: 0 0 {width:.4f} {height:.4f}\n"
        "%%Creator: Stippler\n%%LanguageLevel: 2\n%%Pages: 1\n%%EndComments\n"
    ).encode()
    yield _PROLOGUE + b"%%Page: 1 1\ngsave\n"
    yield f"0 {height:.6f} translate {_PT:.9f} {-_PT:.9f} scale\n".encode()
    page = f"0 0 {sheet.width_mm:.6f} {sheet.height_mm:.6f} rectclip\n"
    yield page.encode() + b"1 setlinecap 1 setlinejoin 0.2 setflat\n"
    decimals = places_for(smallest_mm(sheet))
    for layer in sheet.layers:
        if not layer.is_empty:
            yield f"% layer {plain(layer.name)}\n".encode()
            yield from painted(layer, PS_WORDS, decimals)
    yield b"grestore\nshowpage\n%%EOF\n"
