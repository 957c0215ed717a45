"""All that a person may do, done once to something small: no kernel loads under a hand."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import box

from stippler.brushes.brush import Brush
from stippler.brushes.kinds import KINDS
from stippler.brushes.stroke import Stroke
from stippler.brushes.stroke_path import PointerSample
from stippler.brushes.tip import Tip
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.ids import IdTable
from stippler.drawing.partition import Partition
from stippler.drawing.reference import Reference
from stippler.kernels.shapes import gpu_dots
from stippler.kernels.tone.union_share import shares_of_union

_SIDE_MM = 10.0
_MANY_IDS = np.arange(3000)
"""More than a table of ids has room for at first."""


@cache
def warm_up_brushes() -> None:
    """Use every brush, a run, undo, and what brings dots to the GPU; once a process."""
    drawing = Drawing.blank(Page(_SIDE_MM, _SIDE_MM))
    place = np.stack(np.meshgrid(np.arange(1.0, 10.0), np.arange(1.0, 10.0)), axis=-1)
    drawing.dots = Dots.round(place.reshape(-1, 2), 0.2)
    ramp = np.linspace(0.0, 1.0, 64, dtype=np.float32).reshape(8, 8)
    drawing.reference = Reference(ramp, _SIDE_MM)
    document = Document(drawing)
    brushes = [Brush(kind.name, kind.name, 3.0) for kind in KINDS]
    brushes.append(Brush("along edges", "shape", 3.0, values={"along": "edge"}))
    for brush in brushes:
        stroke = Stroke(document, brush, PointerSample(5.0, 5.0), 1)
        stroke.commit(PointerSample(6.0, 5.0, t=0.1))
    Tip("polygon", corners=((-1.0, -1.0), (1.0, 0.0), (0.0, 1.0))).weight(
        document.dots.position_mm, 9.0
    )
    Partition({0: box(0, 0, 9, 9), 1: box(1, 1, 2, 2)}).area_at(document.dots.position_mm)
    document.merge(_as_result(document.begin_run("relax")))
    document.end_run()
    while document.undo():
        pass
    IdTable().put(_MANY_IDS, _MANY_IDS)
    _upload(document.dots)


def _as_result(dots: Dots) -> NDArray[np.float64]:
    """Copy places as a worker hands them back: read-only, which numba takes for another type."""
    result = dots.position_mm.copy()
    result.flags.writeable = False
    return result


def _upload(dots: Dots) -> None:
    """Pack dots as an upload does: all, places alone by hand and by a worker, those in view."""
    half = (_SIDE_MM / 2, _SIDE_MM / 2)
    words = gpu_dots.words(len(dots))
    order = gpu_dots.nearby_order(dots.position_mm, (_SIDE_MM, _SIDE_MM))
    gpu_dots.pack(dots, half, np.zeros(len(dots), np.bool_), order, words)
    radius = np.broadcast_to(dots.radius_mm, (len(dots),))  # read-only
    for position in (dots.position_mm, _as_result(dots)):
        gpu_dots.pack_places(position, radius, half, order, words)
    gpu_dots.set_shares(words, shares_of_union(words.view(np.float32)))
    gpu_dots.choose(words, (-_SIDE_MM, -_SIDE_MM, _SIDE_MM, _SIDE_MM), 1.0, (0.0, 1.0))
