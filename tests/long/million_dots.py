"""A million dots, read by others: ``python -m tests.long.million_dots``.

Writes SVG, PDF, PNG and CSV of a page of a million round and of a million deformed dots, and holds
what resvg, poppler, Pillow and our own reader find to the page. Minutes.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path += [str(ROOT / "files" / "write"), str(ROOT.parent)]
PRINT_MM, DPI, FINER = 600, 100, 6
WORST = 0.05
INK = {"svg": 0.025, "pdf": 0.07, "png": 1e-6}
"""Dots have three pixels here: resvg flattens such curves, and poppler draws strokes thinner."""


def main() -> int:
    """Return how many files were wrong."""
    import consumers

    from benchmarks.rendering import drawing
    from stippler.export import save
    from stippler.files.write.raster import grey_strips
    from stippler.files.write.sheet import sheet_of
    from stippler.opening import open_file

    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("round", "rough"):
            page = drawing(1_000_000, kind)
            sheet = sheet_of(page).scaled(PRINT_MM / page.page.width_mm)
            ours = 1 - np.concatenate(list(grey_strips(sheet, DPI))).astype(np.float32) / 255
            for ending, read in (
                ("svg", consumers.resvg), ("pdf", consumers.poppler), ("png", consumers.pillow),
            ):  # fmt: skip
                path = Path(folder) / f"a.{ending}"
                save(page, path, dpi=DPI, print_width=PRINT_MM)
                by = 1 if ending == "png" else FINER
                theirs = read(path, DPI, by)
                h, w = (min(a, b) for a, b in zip(ours.shape, theirs.shape, strict=True))
                a, b = ours[:h, :w], theirs[:h, :w]
                ink = float(b.sum() / a.sum() - 1)
                tile = float(np.abs(consumers.averaged(a - b, 16)).max())
                fine = abs(ink) < INK[ending] and tile < WORST
                wrong += not fine
                print(f"{kind} {ending}: ink {ink:+.4%}, worst tile {tile:.4f}", flush=True)
                path.unlink()
            path = Path(folder) / "a.csv"
            save(page, path)
            same = np.array_equal(open_file(path).dots.position_mm, page.dots.position_mm)
            wrong += not same
            print(f"{kind} csv: {'the same' if same else 'not the same'}", flush=True)
    return wrong


if __name__ == "__main__":
    sys.exit(main())
