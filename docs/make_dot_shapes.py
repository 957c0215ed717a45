"""Make docs/dot-shapes.png: the whole space of dot shapes, and what each pen makes of a tone.

python docs/make_dot_shapes.py [OUT]
"""

from __future__ import annotations

import math
import sys
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from stippler.api import stipple
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.pens import PENS, Pen
from stippler.headless import render_image
from stippler.render.renderer import INK, PAPER

WIDTH, HEIGHT = 250.0, 256.0
SCALE = 6.4
ELONGATIONS = (1.0, 1.5, 2.0, 3.0, 4.0)
ROUGHNESSES = (0.0, 0.25, 0.5, 0.75, 1.0)
PEN_TOP = 92.0
PATCH = 44.0
PICTURE = 104.0  # mm, width of the sample of which each pen draws a part
MIDDLE = (0.41, 0.41)  # of that part, in shares of the width


def plate() -> tuple[Dots, list[tuple[float, float, str]]]:
    """Return all dots of the plate, and its words."""
    parts: list[Dots] = []
    words = [
        (
            8.0,
            5.0,
            "Elongation 1 to 4 (across), roughness 0 to 1 (down), all of one area",
        ),
        (172.0, 5.0, "Sixteen seeds, roughness 0.5"),
        (8.0, PEN_TOP - 3, "Pens: twelve dots, enlarged; a tone from 5 to 75 %; the same picture"),
    ]
    for j, roughness in enumerate(ROUGHNESSES):
        words.append((8.0, 17.0 + 15 * j, f"{roughness:g}"))
        for i, elongation in enumerate(ELONGATIONS):
            x, y = 26.0 + 29 * i, 19.0 + 15 * j
            parts.append(
                dots([(x, y)], 4.3, elongation, math.radians(-25), roughness, 40 + i + 7 * j)
            )
    for i, elongation in enumerate(ELONGATIONS):
        words.append((24.0 + 29 * i, 10.0, f"{elongation:g}"))
    for k in range(16):
        x, y = 180.0 + 18 * (k % 4), 20.0 + 18 * (k // 4)
        parts.append(dots([(x, y)], 5.0, 1.0, 0.0, 0.5, 900 + k))
    picture = part_of_picture()
    for k, pen in enumerate(PENS):
        left = 8.0 + 48.5 * k
        words.append((left, PEN_TOP + 3, pen.label))
        parts += [samples(pen, left), tone(pen, left, PEN_TOP + 42)]
        place = (left, PEN_TOP + 114)
        parts.append(pen.drawn(replace(picture, position_mm=picture.position_mm + place)))
    together = {f.name: np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Dots)}
    return Dots(**together), words


def dots(
    position: object, radius: object, elongation: float, angle: float, rough: float, seed: int
) -> Dots:
    """Return dots of one shape."""
    made = Dots.round(position, radius)  # type: ignore[arg-type]
    made.elongation[:], made.angle_rad[:], made.roughness[:] = elongation, angle, rough
    made.seed[:] = seed
    return made


def samples(pen: Pen, left: float) -> Dots:
    """Return twelve large dots."""
    grid = np.stack(np.meshgrid(np.arange(4), np.arange(3)), -1).reshape(-1, 2)
    return pen.drawn(Dots.round(grid * 11.0 + (left + 5.0, PEN_TOP + 15.0), 2.4))


def tone(pen: Pen, left: float, top: float) -> Dots:
    """Return small dots, evenly spread, whose size makes a ramp."""
    position = relaxed(900) * (PATCH, 66.0) + (left, top)
    dark = np.interp(position[:, 1], (top, top + 66), (0.05, 0.75))
    radius = np.sqrt(dark * PATCH * 66.0 / (900 * math.pi))
    return pen.drawn(Dots.round(position, radius, first_id=7))


def part_of_picture() -> Dots:
    """Return the round dots of a square part of a sample, from its corner."""
    path = Path(__file__).resolve().parent.parent / "assets" / "samples" / "ammonite.png"
    dots = stipple(path, dots=7_000, width=PICTURE).dots
    dots.position_mm -= np.multiply(MIDDLE, PICTURE) - PATCH / 2
    return dots.take(((dots.position_mm > 0) & (dots.position_mm < PATCH)).all(axis=1))


def relaxed(n: int) -> NDArray[np.float64]:
    """Return evenly spread points of the patch, in units of its sides."""
    from scipy.spatial import cKDTree

    rng = np.random.default_rng(8)
    aspect = np.array([PATCH, 66.0])
    points = rng.random((n, 2)) * aspect
    grid = np.stack(np.meshgrid(np.arange(264), np.arange(396)), -1).reshape(-1, 2)
    many = (grid + 0.5) * (aspect / (264, 396))
    for _ in range(40):
        near = cKDTree(points).query(many)[1]
        count = np.maximum(np.bincount(near, minlength=n), 1)
        points = np.column_stack([np.bincount(near, m, n) for m in many.T]) / count[:, None]
    return np.asarray(points / aspect)


def main() -> None:
    """Write the plate."""
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("dot-shapes.png")
    drawing = Drawing.blank(Page(WIDTH, HEIGHT))
    drawing.dots, words = plate()
    image = Image.fromarray(render_image(drawing, px_per_mm=SCALE, paper=PAPER, ink=INK))
    pen = ImageDraw.Draw(image)
    font = ImageFont.load_default(size=3.4 * SCALE)
    for x, y, text in words:
        pen.text((x * SCALE, y * SCALE), text, (90, 88, 92), font)
    image.quantize(64, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(
        out, optimize=True
    )


if __name__ == "__main__":
    main()
