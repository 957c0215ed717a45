"""How much ink the screen, our files and resvg lay down, beside the exact union of all dots.

python -m benchmarks.ink [PICTURE] [--dpi 100,508,...]
"""

from __future__ import annotations

import argparse
import io
import math
import re

import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image

import stippler
from stippler import headless
from stippler.drawing.drawing import Drawing
from stippler.files.write.raster import grey_strips
from stippler.files.write.sheet import sheet_of
from stippler.files.write.svg import svg_chunks
from stippler.resources import assets
from stippler.units import px_per_mm

_DPI = (100, 200, 300, 508, 600, 1200)
_QUARTER = 64  # segments of a disc's outline
_FINER = 4  # resvg is asked for a picture so much larger as well, which is averaged
_TILE = 16
Ink = NDArray[np.float64]


def exact(drawing: Drawing) -> float:
    """Return how much of the page round dots cover, by shapely, as polygons of their area."""
    n = 4 * _QUARTER
    radius = drawing.dots.radius_mm.astype(float)
    radius *= math.sqrt(2 * math.pi / (n * math.sin(2 * math.pi / n)))
    discs = shapely.buffer(shapely.points(drawing.dots.position_mm), radius, quad_segs=_QUARTER)
    page = shapely.box(0, 0, drawing.page.width_mm, drawing.page.height_mm)
    return float(shapely.intersection(shapely.union_all(discs), page).area / page.area)


def by_resvg(svg: str, size: tuple[int, int], finer: int = 1) -> Ink:
    """Return the ink of an SVG by resvg at a size in pixels, or of a larger picture, averaged."""
    import resvg_py

    width, height = (side * finer for side in size)
    text = re.sub(
        r'width="[\d.]+mm" height="[\d.]+mm"', f'width="{width}" height="{height}"', svg, count=1
    )
    with Image.open(io.BytesIO(bytes(resvg_py.svg_to_bytes(svg_string=text)))) as image:
        ink = 1.0 - np.asarray(image.convert("L"), np.float64) / 255.0
    return averaged(ink, finer)


def averaged(ink: Ink, by: int) -> Ink:
    """Return the means of blocks; a rest at the right and the bottom is left out."""
    h, w = (side // by for side in ink.shape)
    return np.asarray(ink[: h * by, : w * by].reshape(h, by, w, by).mean(axis=(1, 3)))


def main() -> None:
    """Print a line for each resolution."""
    Image.MAX_IMAGE_PIXELS = None
    words = argparse.ArgumentParser()
    words.add_argument("picture", nargs="?", default=str(assets() / "samples" / "ammonite.png"))
    words.add_argument("--dpi", default=",".join(map(str, _DPI)))
    asked = words.parse_args()
    drawing = stippler.stipple(asked.picture, dots=20_000, width=100)
    svg, right = b"".join(svg_chunks(drawing)).decode(), exact(drawing)
    print(f"{len(drawing.dots):,} dots cover {right:.4%} of the page; ink of each beside that")
    print("  dpi   screen    files    resvg  resvg, averaged  worst tile: files  resvg")
    for dpi in map(int, asked.dpi.split(",")):
        scale = px_per_mm(dpi)
        screen = 1.0 - headless.render_image(drawing, px_per_mm=scale, grey=True) / 255.0
        files = 1.0 - np.concatenate(list(grey_strips(sheet_of(drawing), dpi))) / 255.0
        size = (screen.shape[1], screen.shape[0])
        plain, fine = by_resvg(svg, size), by_resvg(svg, size, _FINER)
        off = [100 * (ink.mean() / right - 1) for ink in (screen, files, plain, fine)]
        tiles = [averaged(ink, _TILE) for ink in (screen, files, plain)]
        away = [np.abs(tiles[0] - other).max() for other in tiles[1:]]
        print(
            f"{dpi:5} {off[0]:+7.3f} % {off[1]:+6.3f} % {off[2]:+6.2f} % {off[3]:+12.2f} %"
            f" {away[0]:18.4f} {away[1]:8.4f}"
        )


if __name__ == "__main__":
    main()
