"""Scripted painting on a document that keeps a journal, to be killed at any moment.

``python tests/long/painting.py FOLDER SEED`` paints until it is killed, and prints after each step
how many there are and a digest of the drawing: on the line, the step is done and asked of the
journal; with ``flushed``, it is on disk.
"""

from __future__ import annotations

import hashlib
import random
import sys
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path

import numpy as np
from shapely.geometry import box

from stippler.drawing import records
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.files.native.drawing_file import members_of
from stippler.files.native.edit_log import EditLog
from stippler.files.native.recovery import Keeper


def first_drawing() -> Drawing:
    """Make a drawing of some dots."""
    rng = np.random.default_rng(0)
    drawing = Drawing.blank(Page(50.0, 40.0))
    drawing.dots = Dots.round(rng.random((300, 2)) * (50, 40), 0.1 + rng.random(300))
    return drawing


def digest(drawing: Drawing) -> str:
    """Return what tells a drawing from any other, to the bit.

    The next ids are left out: those that a cancelled stroke had given nobody has seen, and no
    journal tells of them.
    """
    mixed = hashlib.sha256()
    for f in fields(Dots):
        mixed.update(np.ascontiguousarray(getattr(drawing.dots, f.name)).tobytes())
    for kind in (records.AREA, records.STYLE):
        table = drawing.table(kind)
        mixed.update(repr([(i, table[i].to_json()) for i in sorted(table)]).encode())
    mixed.update(repr(drawing.page.to_json()).encode())
    if drawing.reference is not None:
        mixed.update(repr(drawing.reference.to_json()).encode())
    return mixed.hexdigest()


def paint(document: Document, seed: int) -> Iterator[None]:
    """Do one thing after another to a document, of every kind."""
    dice = random.Random(seed)
    rng = np.random.default_rng(seed)
    while True:
        n, what = len(document.dots), dice.randrange(10)
        rows = np.unique(rng.integers(0, max(n, 1), min(n, 30)))
        if what == 0 and n > 100:
            document.begin("Erase")
            document.remove(rows)
        elif what in (1, 2):
            document.begin("Spray")
            document.insert(Dots.round(rng.random((20, 2)) * (50, 40), 0.2))
        elif what == 3:
            document.undo()
        elif what == 4:
            document.redo()
        elif what == 5:
            document.begin("Area")
            x, y = rng.random(2) * (40, 30)
            document.add(records.AREA, Area(f"area {seed}", box(x, y, x + 5, y + 5)))
            document.own_by_place(np.arange(n))
        elif what == 6:
            document.begin("Style")
            document.set(records.STYLE, 0, Style(seed=dice.randrange(1000)))
        elif what == 7 and n:
            dots = document.begin_run("Relax")
            for _ in range(3):
                document.merge(np.clip(dots.position_mm + rng.normal(0, 0.1, (n, 2)), 0, 40))
                document.tell_run()
                yield
            document.end_run()
        elif what == 8:
            document.begin("Reference")
            darkness = rng.random((4, 5)).astype(np.float32)
            document.set(records.REFERENCE, 0, Reference(darkness, 50.0))
        elif n:
            document.begin("Move")
            document.move(rows, document.dots.position_mm[rows] + rng.normal(0, 1, (len(rows), 2)))
            document.change("radius_mm", rows, rng.random(len(rows)).astype(np.float32) + 0.1)
        if document.in_stroke:
            if dice.random() < 0.1:
                document.cancel()
            else:
                document.commit()
        yield


def main(root: Path, seed: int) -> None:
    """Paint and keep a journal until killed."""
    document, keeper = Document(first_drawing()), Keeper(root)
    start = document.drawing.snapshot()
    keeper.begin(lambda: members_of(start), "ear", None, "stippler")
    log = EditLog(keeper.append, document)
    document.follow(log.take)
    say = sys.stdout
    say.write(f"0 {digest(document.drawing)}\n")
    for k, _ in enumerate(paint(document, seed), start=1):
        done = keeper.wait() if k % 5 == 0 else False
        say.write(f"{k} {digest(document.drawing)}{' flushed' if done else ''}\n")
        say.flush()


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
