"""Every brush used once on something small, so that no kernel loads or compiles under a hand."""

from __future__ import annotations

from functools import cache

import numpy as np

from stippler.brushes.brush import Brush
from stippler.brushes.kinds import KINDS
from stippler.brushes.stroke import PointerSample
from stippler.brushes.stroking import Stroke
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.editing import Editing
from stippler.drawing.reference import Reference


@cache
def rehearse() -> None:
    """Use every brush, undo, and a run; once a process."""
    drawing = Drawing.blank(Page(10.0, 10.0))
    place = np.stack(np.meshgrid(np.arange(1.0, 10.0), np.arange(1.0, 10.0)), axis=-1)
    drawing.dots = Dots.round(place.reshape(-1, 2), 0.2)
    ramp = np.linspace(0.0, 1.0, 64, dtype=np.float32).reshape(8, 8)
    drawing.reference = Reference(ramp, 10.0)
    editing = Editing(drawing)
    brushes = [Brush(kind.name, kind.name, 3.0) for kind in KINDS]
    brushes.append(Brush("along edges", "shape", 3.0, values={"along": "edge"}))
    for brush in brushes:
        if brush.about.rhythm != "select":
            stroke = Stroke(editing, brush, PointerSample(5.0, 5.0), 1)
            stroke.commit(PointerSample(6.0, 5.0, t=0.1))
    editing.merge(editing.begin_run("relax").position_mm)
    editing.end_run()
    while editing.undo():
        pass
