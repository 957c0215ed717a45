"""Make `docs/styles.md`, its picture, and the swatches in `assets/styles`: every style, drawn.

``python docs/make_styles.py``; needs OpenGL, a software renderer will do.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from stippler.drawing.drawing import Drawing  # noqa: E402
from stippler.drawing.parameter import Kind  # noqa: E402
from stippler.drawing.reference import Reference  # noqa: E402
from stippler.drawing.style import PARAMETERS  # noqa: E402
from stippler.drawing.style_presets import Preset, presets  # noqa: E402
from stippler.headless import render_image  # noqa: E402
from stippler.stippling.stipple import stages  # noqa: E402

SIZE_MM = (44.0, 30.0)
FIELD_PX_MM = 16
SHOWN_PX_MM = 9.0
SWATCH_PX = (220, 150)
COLUMNS, GAP, LABEL = 3, 26, 34

_HEAD = """# Styles

A style says how an area is drawn. These come with the program; each is a file in `assets/styles`,
and all of them draw the same picture here: a ball on a ground, in a soft light from the left, and a
ramp; white dots have a black ground. Ask for one by `stippler render photo.jpg -o out.svg --style
wood`, by `stippler.stipple("photo.jpg", style="wood")`, or by *Style* in the panel *Drawing*. What
is given beside a style counts before it (`--style wood --dots 9000`).
`python docs/make_styles.py` makes this page, its picture and the small pictures in the panel.

![Every style, drawn from the same picture](styles.png)

"""


def main() -> None:
    """Draw every style; write the page, its picture and the swatches."""
    light, dark = (Reference(scene(at_night), SIZE_MM[0]) for at_night in (False, True))
    drawn = [(p, draw(dark if p.style.is_inverse else light, p)) for p in presets().values()]
    for one, image in drawn:
        small = Image.fromarray(image).resize(SWATCH_PX, Image.Resampling.LANCZOS)
        small.save(one.swatch, optimize=True)
    sheet(drawn).save(ROOT / "docs" / "styles.png", optimize=True)
    table = "".join(f"| {p.label} | `{p.key}` | {p.about} |\n" for p, _ in drawn)
    page = f"{_HEAD}| style | name | for |\n|---|---|---|\n{table}\n{_parameters()}"
    (ROOT / "docs" / "styles.md").write_text(page, encoding="utf-8")


def scene(at_night: bool) -> NDArray[np.float32]:
    """Return the darkness of a ball on a ground with its shadow, beside a ramp, or before black."""
    w, h = (round(side * FIELD_PX_MM) for side in SIZE_MM)
    y, x = np.mgrid[0:h, 0:w] / FIELD_PX_MM
    u, v = (x - 16.0) / 11.5, (y - 13.5) / 11.5
    r2 = u * u + v * v
    z = np.sqrt(np.clip(1.0 - r2, 0.0, 1.0))
    lit = np.clip(-0.52 * u - 0.58 * v + 0.63 * z, 0.0, 1.0)
    bounce = 0.16 * np.clip(v * 0.8 + 0.2, 0.0, 1.0) * (1.0 - z)
    ball = np.clip(0.93 - 0.93 * lit**0.85 - bounce, 0.03, 0.93)
    e, f = (x - 20.5) / 14.0, (y - 25.6) / 3.0
    shadow = 0.75 * np.exp(-1.6 * np.clip(e * e + f * f - 0.15, 0.0, None) ** 0.9)
    ground = np.where(y > 19.0, shadow, 0.0) * np.clip((y - 19.0) / 3.0, 0.0, 1.0)
    field = np.where(r2 < 1.0, ball, 1.0 if at_night else ground)
    ramp = np.clip((y - 1.0) / 28.0, 0.0, 1.0) * 0.95
    field = np.where((x > 36.5) & (x < 43.0) & (y > 1.0) & (y < 29.0), ramp, field)
    field[field < 0.012] = 0.0
    return field.astype(np.float32)


def draw(picture: Reference, one: Preset) -> NDArray[np.uint8]:
    """Return the picture in a style, grey."""
    *_, last = stages(picture, one.style, snapshots=False)
    drawing = Drawing.from_reference(picture, last.position_mm, last.radius_mm, one.style)
    fine = Image.fromarray(render_image(drawing, px_per_mm=2 * SHOWN_PX_MM, grey=True))
    size = (round(SIZE_MM[0] * SHOWN_PX_MM), round(SIZE_MM[1] * SHOWN_PX_MM))
    return np.asarray(fine.resize(size, Image.Resampling.LANCZOS))


def sheet(drawn: list[tuple[Preset, NDArray[np.uint8]]]) -> Image.Image:
    """Lay the pictures out side by side, each above its name."""
    h, w = drawn[0][1].shape
    rows = math.ceil(len(drawn) / COLUMNS)
    size = (COLUMNS * (w + GAP) + GAP, rows * (h + LABEL + GAP) + GAP)
    page = Image.new("L", size, 255)
    pen = ImageDraw.Draw(page)
    font = ImageFont.load_default(19)
    for k, (one, image) in enumerate(drawn):
        x = GAP + (k % COLUMNS) * (w + GAP)
        y = GAP + (k // COLUMNS) * (h + LABEL + GAP)
        page.paste(Image.fromarray(image), (x, y))
        pen.text((x + w / 2, y + h + 7), one.label, 30, font, anchor="ma")
    return page


def _parameters() -> str:
    lines = ["## What a style is made of", "", "| in the panel | command line | | what it does |",
             "|---|---|---|---|"]  # fmt: skip
    for one in PARAMETERS:
        kind = ", ".join(one.values) if one.kind is Kind.CHOICE else str(one.kind)
        if one.unit:
            kind += f", {one.unit}"
        lines.append(f"| {one.label} | `{one.option}` | {kind} | {one.help} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
