"""Brushes: what a stamp, an undo and a dot cost."""

from __future__ import annotations

import math
import statistics
import time
from functools import partial

import numpy as np
import shapely

from benchmarks.figures import Figure, median_s
from stippler.brushes.brush import Brush
from stippler.brushes.kinds import KINDS
from stippler.brushes.stroke import Stroke
from stippler.brushes.stroke_path import PointerSample, Stamp
from stippler.brushes.tip import Tip
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.partition import Partition
from stippler.drawing.reference import Reference

_SIDE_MM = 200.0
_HARD = Tip(hardness=1.0)
_VARIANTS: dict[str, list[dict[str, float | str | bool]]] = {
    "size": [{"how": "enlarge"}, {"how": "tone"}],
    "shape": [{"along": "stroke"}, {"along": "edge"}],
    "jitter": [{"measure": "distance"}, {"measure": "cell"}],
    "spray": [{"per_s": 5000.0, "apart_mm": 0.1}],
    "thin": [{"per_s": 5000.0}],
}


def figures(quick: bool = False) -> list[Figure]:
    """Measure; `quick` uses fewer dots."""
    n = 50_000 if quick else 200_000
    return [*_stamps(n), *_history(n), *_memory(n), *_areas()]


def _document(n: int) -> Document:
    rng = np.random.default_rng(1)
    drawing = Drawing.blank(Page(_SIDE_MM, _SIDE_MM))
    ramp = np.tile(np.linspace(0, 1, 1000, dtype=np.float32), (1000, 1))
    drawing.reference = Reference(ramp, _SIDE_MM)
    # one dot in each square of a grid: as even as a drawing that is being relaxed
    side = math.isqrt(n)
    corner = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    points = (corner + rng.uniform(0.1, 0.9, corner.shape)) * (_SIDE_MM / side)
    drawing.dots = Dots.round(points, 0.1)
    return Document(drawing)


def _drawn_tip() -> Tip:
    """Return a tip with a soft, wavy outline of forty corners."""
    angle = np.linspace(0, math.tau, 40, endpoint=False)
    reach = 0.9 - 0.1 * np.cos(5 * angle)
    return Tip(
        "polygon", corners=tuple(zip(reach * np.cos(angle), reach * np.sin(angle), strict=True))
    )


def _stamps(n: int) -> list[Figure]:
    """Time single stamps in the middle of a stroke, each at another place."""
    document = _document(n)
    radius = math.sqrt(500 / len(document.dots) / math.pi) * _SIDE_MM
    found = []
    for kind in KINDS:
        if kind.rhythm not in ("arc", "time"):
            continue
        for values in _VARIANTS.get(kind.name, [{}]):
            brush = Brush(kind.name, kind.name, radius, _HARD, values=values)
            name = " ".join([kind.name, *(str(v) for v in values.values() if isinstance(v, str))])
            times = _times(document, brush)
            found.append(
                Figure(
                    f"stamp on 500 dots in {len(document.dots) // 1000}k: {name}",
                    statistics.median(times) * 1e3, "ms", 1.0, 0.5,
                    note=f"95 % within {np.percentile(times, 95) * 1e3:.2f} ms",
                )
            )  # fmt: skip
    drawn = Brush("size", "size", 1.2 * radius, _drawn_tip())
    median = statistics.median(_times(document, drawn))
    found.append(
        Figure("the same: size enlarge, soft tip of 40 corners", median * 1e3, "ms", 1.0, 0.5)
    )
    return found


def _times(document: Document, brush: Brush) -> list[float]:
    step = 1.0 / 60.0 if brush.kind != "relax" else 1.0 / float(brush.value("per_s"))
    stroke = Stroke(document, brush, PointerSample(20.0, 20.0), 1)
    times = []
    for k in range(120):
        x = 20.0 + 1.3 * brush.radius_mm * (k % 30)
        y = 20.0 + 2.2 * brush.radius_mm * (k // 30)
        stroke.follow(PointerSample(x, y, t=(k + 1) * step - 1e-6))
        begin = time.perf_counter()
        stroke._apply(Stamp(x, y, 1.0, 0.3, 0.1, 0.05, step))
        times.append(time.perf_counter() - begin)
    stroke.cancel()
    return times[10:]


def _history(n: int) -> list[Figure]:
    document = _document(n)
    rows = np.arange(min(50_000, len(document.dots)))

    def stroke() -> None:
        document.begin("move")
        document.move(rows, document.dots.position_mm[rows] + 0.01)
        document.change("radius_mm", rows, np.full(len(rows), 0.2, np.float32))
        document.commit()

    def erase() -> None:
        document.begin("erase")
        document.remove(rows)
        document.commit()

    out = []
    for name, act in (("move and resize", stroke), ("erase", erase)):
        times = []
        for _ in range(9):
            act()
            begin = time.perf_counter()
            document.undo()
            times.append(time.perf_counter() - begin)
        out.append(
            Figure(
                f"undo of a stroke on 50k dots in {len(document.dots) // 1000}k: {name}",
                statistics.median(times) * 1e3, "ms", 10.0, 3.0,
            )
        )  # fmt: skip
    whole = _document(n)
    frozen = whole.begin_run("relax")
    moved = frozen.position_mm * 0.999
    merge = median_s(lambda: whole.merge(moved), repeats=9)
    out.append(Figure(f"merging a result for {len(frozen) // 1000}k dots", merge * 1e3, "ms"))
    return out


def _memory(n: int) -> list[Figure]:
    document = _document(n)
    return [
        Figure(
            "memory for each dot while edited, without history and GPU buffers",
            document.n_bytes / len(document.dots), "bytes", 200.0, 100.0,
        )
    ]  # fmt: skip


def _areas() -> list[Figure]:
    """Time what 200 areas on the page cost: finding the area of points, and short moves."""
    rng = np.random.default_rng(1)
    page = shapely.box(0, 0, _SIDE_MM, _SIDE_MM)
    seeds = shapely.MultiPoint(rng.random((200, 2)) * _SIDE_MM)
    cells = shapely.get_parts(shapely.voronoi_polygons(seeds, extend_to=page))
    cells = [shapely.segmentize(shapely.intersection(cell, page), 2.0) for cell in cells]
    outlines = {0: page, **{k + 1: cell for k, cell in enumerate(cells)}}
    points = rng.random((100_000, 2)) * _SIDE_MM
    many, one = Partition(outlines), Partition({0: page})
    some, area = points[:220], many.area_at(points[:220])
    found = [
        Figure("finding the areas of 100k dots, 200 areas",
               median_s(lambda: many.area_at(points), 9) * 1e3, "ms", 10.0),
        Figure("preparing 200 areas of 6,600 edges",
               median_s(lambda: Partition(outlines), 5) * 1e3, "ms", 100.0),
    ]  # fmt: skip
    for name, partition, own in (("1 area", one, np.zeros(220, np.int32)),
                                 ("200 areas", many, area)):  # fmt: skip
        ms = median_s(partial(partition.confine, some, some + 0.01, own), 99) * 1e3
        found.append(Figure(f"keeping a stamp's 220 dots in their areas, {name}", ms, "ms", 0.2))
    return found
