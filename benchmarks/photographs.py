"""First drawings of samples and photographs: ``python -m benchmarks.photographs [PICTURE...]``.

Each as a person gets it who gives nothing but the picture, 130 mm wide: how many dots and how
large, how much ink, and how much of the page is so dark that dots close up. A Markdown table, as in
docs/quality.md.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.quality import SAMPLES
from stippler.analysis.tone_error import measure_tone
from stippler.drawing.style import Style
from stippler.drawing.tone_curve import DEEPEST
from stippler.files.read.picture import read_picture
from stippler.resources import assets
from stippler.stippling.default_number import default_number
from stippler.stippling.stipple import stages

WIDTH_MM = 130.0
_CLOSED = DEEPEST + 0.01  # of the paper inked; the deepest tone itself is still open
_HEAD = (
    "picture", "dots", "mean, mm", "smallest, mm", "on 105 mm, mm", "on 594 mm, mm",
    "mean ink", "closed up, %", "tone error", "seconds",
)  # fmt: skip


def main(pictures: list[str]) -> None:
    """Print a row for each picture."""
    print("| " + " | ".join(_HEAD) + " |")
    print("|" + "---|" * len(_HEAD))
    for path in [assets() / "samples" / name for name in SAMPLES] + [Path(p) for p in pictures]:
        print("| " + " | ".join(row(path)) + " |", flush=True)


def row(path: Path) -> tuple[str, ...]:
    """Draw a picture with everything by default; return its figures."""
    reference = read_picture(path, tone="illustration", width_mm=WIDTH_MM)
    began = time.process_time()
    *_, last = stages(reference, Style(), snapshots=False)
    spent = time.process_time() - began
    darkness = np.asarray(reference.darkness, np.float64)
    radii_mm = np.asarray(last.radius_mm, np.float64)
    px = darkness.shape[1] / WIDTH_MM
    points = np.array(last.position_mm) * px
    return (
        path.stem,
        f"{len(points):,}",
        f"{2.0 * np.sqrt(np.mean(radii_mm**2)):.2f}",
        f"{2.0 * np.percentile(radii_mm, 1):.2f}",
        *(f"{mean_diameter(path, width_mm):.2f}" for width_mm in (105.0, 594.0)),
        f"{darkness.mean():.2f}",
        f"{100.0 * np.mean(darkness > _CLOSED):.1f}",
        f"{measure_tone(points, radii_mm * px, darkness).tone_rmse:.4f}",
        f"{spent:.1f}",
    )


def mean_diameter(path: Path, width_mm: float) -> float:
    """Return how large a picture's dots are on a page of another width."""
    reference = read_picture(path, tone="illustration", width_mm=width_mm)
    area = reference.width_mm * reference.height_mm
    ink = float(reference.darkness.mean(dtype=np.float64)) * area
    return float(2.0 * np.sqrt(ink / np.pi / default_number(reference)))


if __name__ == "__main__":
    main(sys.argv[1:])
