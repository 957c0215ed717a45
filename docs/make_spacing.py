"""Draw the pictures of spacing and tone in quality.md: ``python docs/make_spacing.py [PHOTO...]``.

Photographs given are drawn in the illustrator's tone on a sheet of their own.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import stippler
from stippler.resources import assets

HERE = Path(__file__).parent / "quality"
SAMPLES = ("ammonite.png", "honey-bee.jpg", "sandstone.jpg")
TONES = ("linear", "perceptual", "illustration")
DPI = 300
CROP_MM = 42.0


def drawn(picture: Any, dpi: float = DPI, **options: Any) -> Image.Image:
    """Stipple a picture; return what prints."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "drawing.png"
        stippler.stipple(picture, **options).save(path, dpi=dpi)
        with Image.open(path) as image:
            return image.convert("L")


def sample(name: str, longest: int = 1000) -> Image.Image:
    """Return a sample picture, not too large."""
    image = Image.open(assets() / "samples" / name).convert("RGB")
    image.thumbnail((longest, longest))
    return image


def middle(image: Image.Image) -> Image.Image:
    """Return the middle of a drawing, as large as it prints."""
    side = min(round(CROP_MM / 25.4 * DPI), *image.size)
    x, y = (image.width - side) // 2, (image.height - side) // 2
    return image.crop((x, y, x + side, y + side))


def sheet(rows: list[list[Image.Image]], gap: int = 12) -> Image.Image:
    """Lay pictures out in rows."""
    height = max(i.height for row in rows for i in row)
    width = max(i.width for row in rows for i in row)
    columns = max(len(row) for row in rows)
    out = Image.new("L", (columns * (width + gap) - gap, len(rows) * (height + gap) - gap), 255)
    for r, row in enumerate(rows):
        for c, image in enumerate(row):
            out.paste(image, (c * (width + gap), r * (height + gap)))
    return out


def main() -> None:
    """Draw all."""
    grey = np.full((600, 600), 0.6, np.float32)
    before_after: list[list[Image.Image]] = []
    for spacing in ("lloyd", "even"):
        row = [middle(drawn(grey, dots=10_000, width=100, tone="perceptual", spacing=spacing))]
        row += [
            middle(drawn(sample(name), dots=20_000, width=130, spacing=spacing)) for name in SAMPLES
        ]
        before_after.append(row)
    sheet(before_after).save(HERE / "rows.png", optimize=True)
    by_tone = [
        [drawn(sample(name), 110, dots=12_000, width=90, tone=tone) for tone in TONES]
        for name in SAMPLES
    ]
    sheet(by_tone).save(HERE / "tones.png", optimize=True)
    photographs = [Path(name) for name in sys.argv[1:]]
    if photographs:
        made = []
        for path in photographs:
            image = Image.open(path).convert("RGB")
            image.thumbnail((900, 900))
            made.append(drawn(image, 110, width=90))
            made[-1].thumbnail((390, 390), Image.Resampling.LANCZOS)
        rows = [made[k : k + 5] for k in range(0, len(made), 5)]
        sheet(rows).save(HERE / "photographs.png", optimize=True)


if __name__ == "__main__":
    main()
