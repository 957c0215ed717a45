"""Make docs/patterns/*.png: the paper's Fig. 3, a set of polygons plain, deformed and filled.

python docs/make_patterns.py [NAME ...]
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely
from PIL import Image, ImageDraw

from stippler.drawing.deformation import Cage
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.pattern import Pattern
from stippler.drawing.style import Style
from stippler.headless import render_image
from stippler.stippling.initial_points import random_in
from stippler.stippling.patterns import builtin, builtin_names, cells_of
from stippler.stippling.relax import Relaxation

SIDE = 50.0
SCALE = 7.0
OUT = Path(__file__).with_name("patterns")


def filled(cells: list[shapely.Polygon]) -> np.ndarray:
    """Return the picture of dots that relaxed in all polygons at once."""
    n = [max(1, round(2.6 * cell.area)) for cell in cells]
    dots = np.concatenate([random_in(cell, k, 1) for cell, k in zip(cells, n, strict=True)])
    engine = Relaxation(dots, cells, compartment_of_dot=np.repeat(np.arange(len(cells)), n))
    engine.run(20)
    drawing = Drawing.blank(Page(SIDE, SIDE))
    drawing.dots = Dots.round(np.array(engine.points), 0.17)
    return render_image(drawing, px_per_mm=SCALE, grey=True)


def outlines(cells: list[shapely.Polygon]) -> np.ndarray:
    """Return the picture of polygons."""
    image = Image.new("L", (round(SIDE * SCALE),) * 2, 255)
    pen = ImageDraw.Draw(image)
    for cell in cells:
        pen.polygon([(x * SCALE, y * SCALE) for x, y in cell.exterior.coords], 225, 60)
    return np.asarray(image)


def plate(name: str) -> Image.Image:
    """Return a set plain, deformed, and filled."""
    area = shapely.Point(SIDE / 2, SIDE / 2).buffer(SIDE / 2 - 1)
    box = (0.0, 0.0, SIDE, SIDE)
    plain = Pattern.over(1, builtin(name), box, SIDE if name == "contour-bands" else SIDE * 0.6)
    bulge = {5: (11.0, 12.0), 6: (36.0, 10.0), 9: (12.0, 40.0), 10: (42.0, 37.0)}
    bent = replace(plain.deformation, cage=Cage.over(box).moved(bulge))
    cells = list(cells_of(area, replace(plain, deformation=bent)).polygons)
    panels = [outlines(list(cells_of(area, plain).polygons)), outlines(cells), filled(cells)]
    gap = np.full((panels[0].shape[0], 12), 255, np.uint8)
    return Image.fromarray(np.hstack([panels[0], gap, panels[1], gap, panels[2]]))


def following_plate(way: str) -> Image.Image:
    """Return bands that follow the ammonite: plain, deformed, and filled by its tone."""
    from stippler.files.read.picture import read_picture
    from stippler.stippling.patterns_of_picture import following
    from stippler.stippling.pipeline import run
    from stippler.stippling.tasks import stippling

    sample = Path(__file__).parents[1] / "assets" / "samples" / "ammonite.png"
    reference = read_picture(sample, tone="illustration", width_mm=SIDE)
    drawing = Drawing.blank(Page(SIDE, reference.height_mm), Style(n_dots=9000))
    drawing.reference = reference
    area = drawing.outlines()[0]
    plain = following(0, area, reference, 2.0, way)
    box = (0.0, 0.0, SIDE, reference.height_mm)
    cage = Cage.over(box)
    places = cage.places_mm()
    moved = {5: tuple(places[5] + (-4.0, -3.0)), 10: tuple(places[10] + (4.0, 3.0))}
    bent = replace(plain, deformation=replace(plain.deformation, cage=cage.moved(moved)))
    drawing.patterns = {0: bent}
    *_, made = run(stippling(drawing, 0).task, snapshots=False)
    drawing.dots = Dots.round(made.position_mm, made.radius_mm)
    panels = [outlines(list(cells_of(area, one).polygons)) for one in (plain, bent)]
    panels.append(render_image(drawing, px_per_mm=SCALE, grey=True))
    height = panels[2].shape[0]
    gap = np.full((height, 12), 255, np.uint8)
    return Image.fromarray(np.hstack([panels[0][:height], gap, panels[1][:height], gap, panels[2]]))


FOLLOWING = {"bands-along-the-tone": "along", "bands-across-edges": "across"}


def main() -> None:
    """Write a plate for each set named, or for all."""
    OUT.mkdir(exist_ok=True)
    for name in sys.argv[1:] or [*builtin_names(), *FOLLOWING]:
        made = following_plate(FOLLOWING[name]) if name in FOLLOWING else plate(name)
        image = made.quantize(16, dither=Image.Dither.NONE)
        image.save(OUT / f"{name}.png", optimize=True)


if __name__ == "__main__":
    main()
