"""Make `docs/quality.md` and its pictures: samples by every method, side by side, with scores.

``python docs/make_quality.py``; needs OpenGL, a software renderer will do.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.quality import SAMPLES, SPHERE, read_darkness, score  # noqa: E402
from stippler.analysis.spacing import measure_spacing  # noqa: E402
from stippler.analysis.spectrum import measure_spectrum  # noqa: E402
from stippler.drawing.drawing import Drawing  # noqa: E402
from stippler.drawing.reference import Reference  # noqa: E402
from stippler.drawing.style import Style  # noqa: E402
from stippler.headless import render_image  # noqa: E402
from stippler.stippling.stipple import Progress, stages  # noqa: E402

DOTS = 8000
PICTURE_PX = 800
SHOWN_PX = 360
GAP = 8
PULSE = "pulse-density"
METHODS: dict[str, dict[str, Any]] = {
    "pulse-density alone": {"first_dots": PULSE, "iterations": 0},
    "and 10 steps": {"first_dots": PULSE, "iterations": 10},
    "and 20 steps": {"first_dots": PULSE, "iterations": 20},
    "unweighted, 20 steps": {"first_dots": PULSE, "iterations": 20, "weighted": False},
    "hexagonal, 20 steps": {"first_dots": "hexagonal", "iterations": 20},
    "Floyd–Steinberg": {"first_dots": "floyd-steinberg", "iterations": 0},
    "random": {"first_dots": "random", "iterations": 0},
}
COLUMNS = ("tone_rmse", "detail_rmse", "tone_bias", "tone_gain", "ssim", "rel_nn_cv", "min_rel")


def main() -> None:
    """Draw every sample by every method; write the page and the pictures."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--out", type=Path, default=ROOT / "docs")
    out = options.parse_args().out
    (out / "quality").mkdir(parents=True, exist_ok=True)
    pictures = (SPHERE, *(ROOT / "assets" / "samples" / name for name in SAMPLES))
    spacing = (ROOT / "docs" / "quality" / "spacing_section.md").read_text(encoding="utf-8")
    parts = [_HEAD, spacing, _spectra(out / "quality")]
    parts += [_sample(path, out / "quality") for path in pictures]
    (out / "quality.md").write_text("\n".join(parts), encoding="utf-8")


_HEAD = f"""# Picture quality

Made by `python docs/make_quality.py`; the scores of larger drawings, beside what was promised,
are printed by `python -m benchmarks.quality`. The measure (`benchmarks/scorer.py`) uses none of
the program's own code. Every drawing here has {DOTS:,} dots with sizes of 1:2, solved for the
tone by the same method, whatever placed the dots; `tone_rmse` is the difference of ink and
darkness seen from two dot spacings, `detail_rmse` from one; 0 is right. `tone_gain` and `ssim`
are right at 1. `rel_nn_cv` tells how uneven the dots lie (a hexagonal grid: 0, chance: 0.47),
`min_rel` how close the closest come (0.58 and 0.05).

The measure draws discs on a grid as coarse as one sample a pixel of the picture, which reads
the thin gaps between dots of dark parts as wider than they are (at nine tenths, by 0.02 and
more), and small discs that stand alone as half a percent to a percent larger. The tone is solved
for the true union of the discs; the column *exact* is `tone_rmse` against that union, sampled
finely enough for the difference not to matter.

Where a picture runs over the edge of the page, dots relaxed on the page alone would line up half a
spacing inside its edge; so they are relaxed on a sheet with a bleed and then trimmed. The edge then
cuts dots as chance will have it, and the ink along it is too dark here and too light there, over a
few dots; so those dots move across it, by six tenths of their radius at most, until the ink along
the edge meets the tone from end to end. Pairs closer than half as far as their seventh neighbours
are parted.

Detail: the last steps of relaxation are weighted by the darkness itself, not by the square of the
density that holds the tone, so that each dot lies in the midst of the ink that its cell asks for.
Neighbours whose cells have about the same tone then even out their sizes; across an edge none do.

First dots: regions line up with the front that they grow from. From the top that is no straight
row: it undulates by chance, by waves of about 24 dot spacings with slopes of 0.8, so that the
lines of dots turn from place to place and no direction is left to the page; and each region's
growth is skewed a little to a side. Against straight rows with more skew (2.3 dB of direction
alone, 3.7 after 20 steps), the dots have less direction and are more even, alone and relaxed.
Also tried, and left out: pulses of unequal size (twice the power below half); shorter waves
(8 spacings: less direction by half a decibel, less even); dots displaced by a fifth of their
spacing before the first step (1.3 dB less after 20, `rel_nn_cv` 0.008 more). Relaxed dots settle
into grains of a hexagonal grid, and what direction is left after 20 steps is theirs: 2.2 dB in the
mean of four seeds, 2.8 with four times the dots. Random first dots show 0.9 dB then, and are less
even.
"""


def _draw(darkness: NDArray[np.float64], dots: int, **options: Any) -> Progress:
    reference = Reference(darkness.astype(np.float32), float(darkness.shape[1]))
    *_, last = stages(reference, Style(n_dots=dots, spacing="lloyd", **options), snapshots=False)
    return last


def _sample(path: Path, folder: Path) -> str:
    darkness = read_darkness(path, PICTURE_PX)
    shown = [Image.fromarray(np.round(255 * (1 - darkness)).astype(np.uint8))]
    rows = []
    for name, options in METHODS.items():
        result = _draw(darkness, DOTS, **options)
        shown.append(_render(darkness, result))
        rows.append(_row(name, score(darkness, result)))
    file = folder / f"{path.stem}.png"
    _strip(shown, 4, SHOWN_PX).quantize(32).save(file, optimize=True)
    head = ["method", *COLUMNS, "exact"]
    table = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *rows]
    order = ", ".join(["the picture", *METHODS])
    return f"## {path.stem}\n\n{order}:\n\n![](quality/{file.name})\n\n" + "\n".join(table) + "\n"


def _row(name: str, found: dict[str, Any]) -> str:
    values = [f"{found[key]:.4f}" for key in (*COLUMNS, "exact")]
    return f"| {name} | " + " | ".join(values) + " |"


def _render(darkness: NDArray[np.float64], result: Progress) -> Image.Image:
    """Draw with the program's own renderer, at twice the size shown."""
    reference = Reference(darkness.astype(np.float32), float(darkness.shape[1]))
    drawing = Drawing.from_reference(reference, result.position_mm, result.radius_mm)
    return Image.fromarray(render_image(drawing, px_per_mm=1.0, grey=True))


def _strip(images: list[Image.Image], columns: int, width: int) -> Image.Image:
    """Lay pictures out in rows, scaled to one width."""
    height = round(width * images[0].height / images[0].width)
    rows = -(-len(images) // columns)
    size = (columns * (width + GAP) - GAP, rows * (height + GAP) - GAP)
    raster = Image.new("L", size, 255)
    for k, image in enumerate(images):
        at = (k % columns * (width + GAP), k // columns * (height + GAP))
        raster.paste(image.resize((width, height), Image.Resampling.BOX), at)
    return raster


def _spectra(folder: Path) -> str:
    """Draw a uniform grey by every method, and the spectrum of its dots."""
    grey = np.full((400, 400), 0.35)
    dots, power, rows = [], [], []
    for name, options in METHODS.items():
        result = _draw(grey, 2500, **options)
        points = np.array(result.position_mm)
        spectrum = measure_spectrum(points, (0, 0, 400, 400))
        spacing = measure_spacing(points)
        dots.append(_render(grey, result).crop((100, 100, 300, 300)))
        seen = np.clip(255 - 80 * spectrum.picture, 0, 255).astype(np.uint8)
        seen[len(seen) // 2, len(seen) // 2] = 255
        power.append(Image.fromarray(seen))
        values = (
            spectrum.low, spectrum.peak, spectrum.direction_db,
            spacing.relative_cv, spacing.edge_variance,
        )  # fmt: skip
        rows.append(f"| {name} | " + " | ".join(f"{value:.3f}" for value in values) + " |")
    _strip([*dots, *power], len(METHODS), 180).quantize(16).save(
        folder / "spectra.png", optimize=True
    )
    head = (
        "| method | power below half | peak | direction, dB | rel_nn_cv | edge variance |\n"
        "|---|---|---|---|---|---|"
    )
    order = ", ".join(METHODS)
    return (
        "## A uniform grey and its spectrum\n\n"
        f"{order}; above the dots, below the power of their spectrum, zero frequency in the "
        "middle. Chance has a power of 1 everywhere; even dots have none at low frequencies "
        "(*power below half* of that of the mean spacing) and a ring at the spacing (*peak*), "
        "and dots without direction vary along the ring as chance does (0 dB).\n\n"
        "![](quality/spectra.png)\n\n" + head + "\n" + "\n".join(rows) + "\n"
    )


if __name__ == "__main__":
    main()
