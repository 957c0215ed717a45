"""Files of our own: saving and opening drawings, journals, recovery."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.figures import Figure, median_s
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.files.native.drawing_file import drawing_of, members_of, open_drawing, save_drawing
from stippler.files.native.edit_log import EditLog, replay
from stippler.files.native.journal import Journal, read_journal
from stippler.files.read.picture import picture_of_bytes

_PAGE = Page(200.0, 150.0)


def _drawing(n: int) -> Drawing:
    rng = np.random.default_rng(1)
    drawing = Drawing.blank(_PAGE)
    drawing.dots = Dots.round(rng.random((n, 2)) * (200, 150), 0.1 + 0.1 * rng.random(n))
    return drawing


def _stroke(document: Document, rng: np.random.Generator, n: int) -> None:
    document.begin("Jitter")
    rows = np.sort(rng.choice(len(document.dots), n, replace=False))
    document.move(rows, document.dots.position_mm[rows] + rng.normal(0, 0.05, (n, 2)))
    document.commit()


def figures(quick: bool = False) -> list[Figure]:
    """Measure all of it."""
    repeats = 3 if quick else 7
    out: list[Figure] = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "one.stipple"
        for n, save_ms, open_ms in ((100_000, 100.0, 150.0), (1_000_000, 1000.0, 1200.0)):
            drawing = _drawing(n)
            save_s = median_s(lambda d=drawing: save_drawing(d, path), repeats)  # type: ignore[misc]
            open_s = median_s(lambda: open_drawing(path, picture_of_bytes), repeats)
            out += [
                Figure(f"{n:,} dots: save", 1e3 * save_s, "ms", save_ms),
                Figure(f"{n:,} dots: open", 1e3 * open_s, "ms", open_ms),
            ]
            if n == 100_000:
                size_mb = path.stat().st_size / 1e6
                frame_s = median_s(lambda d=drawing: d.snapshot(), repeats)  # type: ignore[misc]
                out += [
                    Figure("100,000 dots: file", size_mb, "MB", 4.0),
                    Figure(
                        "100,000 dots: what the frame loop sees of a save", 1e3 * frame_s, "ms", 5.0
                    ),
                ]
        out += _journal(Path(folder), 200 if quick else 2000)
    return out


def _journal(folder: Path, n_strokes: int) -> list[Figure]:
    rng = np.random.default_rng(2)
    document = Document(_drawing(100_000))
    members = members_of(document.drawing)
    journal = Journal(folder / "one.journal", bytes(16))
    document.follow(EditLog(journal.append, document).take)
    spent: list[float] = []
    for _ in range(20):
        _stroke(document, rng, 300)
        began = time.perf_counter()
        journal.flush()
        spent.append(time.perf_counter() - began)
    for _ in range(n_strokes - 20):
        _stroke(document, rng, 300)
    journal.flush(60.0)
    journal.close()
    began = time.perf_counter()
    records = read_journal(folder / "one.journal").records
    again = Document(drawing_of(members, picture_of_bytes, "base")[0])
    replay(again, records, picture_of_bytes)
    recovery_s = time.perf_counter() - began
    assert again.dots.position_mm.tobytes() == document.dots.position_mm.tobytes()
    return [
        Figure("a stroke of 300 dots, on disk", 1e3 * float(np.median(spent)), "ms", 2.0),
        Figure(f"recovery of {n_strokes:,} strokes", recovery_s, "s", 1.0 * n_strokes / 2000),
    ]
