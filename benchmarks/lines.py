"""Figures of lines, patterns, deformations and scale."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import NDArray

from benchmarks.areas import best_ms, curves
from benchmarks.figures import Figure
from benchmarks.quality import SPHERE, read_darkness
from benchmarks.scorer import measure
from stippler.drawing.area_edits import edit_areas
from stippler.drawing.deformation import Cage, Deformation
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import ADHERE, DISTANCE, Line
from stippler.drawing.line_index import keeping_distance
from stippler.drawing.pattern import Pattern
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.editor.area_choice import AreaChoice
from stippler.editor.events import LEFT, Moved, Pressed
from stippler.editor.tools.selection import Selection
from stippler.editor.tools.tool import Desk
from stippler.editor.tools.warp_tool import WarpTool
from stippler.stippling.initial_points import random_in
from stippler.stippling.lines import spread
from stippler.stippling.on_lines import OnLines
from stippler.stippling.part_of_area import part_for_dots
from stippler.stippling.patterns import builtin
from stippler.stippling.pipeline import run
from stippler.stippling.relax import Relaxation
from stippler.stippling.scale import Scaling, scaled_drawing
from stippler.stippling.task import MetLines, Task

PAGE = (200.0, 150.0)


def figures(*, quick: bool = False) -> list[Figure]:
    """Measure all; the best of several, since other work disturbs."""
    repeats = 5 if quick else 30
    return [
        *_bending(repeats),
        *_lines(repeats),
        _relaxing(3 if quick else 8),
        *_detail(quick=quick),
    ]


def _bending(repeats: int) -> list[Figure]:
    rng = np.random.default_rng(1)
    bent = Deformation(cage=Cage.over((0.0, 0.0, *PAGE)).moved({5: (60.0, 45.0)}))
    pattern = Pattern(1, builtin("hexagons"), 8, 8, bent)
    dots = rng.random((200_000, 2)) * PAGE
    return [
        Figure("cage over 5,120 polygons", best_ms(pattern.rings_mm, repeats), "ms", 16),
        Figure("cage over 200k dots", best_ms(lambda: bent.apply(dots), repeats), "ms", 8),
        _warping(dots, repeats),
    ]


def _warping(dots: NDArray[np.float64], repeats: int) -> Figure:
    """Drag a point of a cage over all dots and the borders of 12 areas, as the window does."""
    drawing = Drawing.blank(Page(*PAGE))
    drawing.dots = Dots.round(dots, 0.1)
    document, turn = Document(drawing), np.linspace(0.0, 2 * np.pi, 150)[:-1]
    for k in range(12):
        middle = np.array([29 + 46 * (k % 4), 25 + 47 * (k // 4)])
        ring = Path.polyline(
            middle + 20 * np.column_stack([np.cos(turn), np.sin(turn)]), closed=True
        )
        edit_areas(document, "Add", lambda areas, ring=ring: edits.add(areas, ring, edits.IS_CUT))  # type: ignore[misc]
    desk = Desk(document, Selection(), lambda x, y: (x, y), 4.0, lambda: 1, lambda *_: None,
                AreaChoice())  # fmt: skip
    tool = WarpTool()
    tool.set("what", "all")
    held = tool.begin(Pressed(LEFT, PAGE[0] / 3, PAGE[1] / 3), desk)
    assert held is not None
    places = iter(np.linspace(1.0, 9.0, repeats + 2).tolist())

    def update() -> None:
        by = next(places)
        held.take(Moved(PAGE[0] / 3 + by, PAGE[1] / 3 + by / 2), desk)
        assert held.overlay.has_borders

    update()
    found = best_ms(update, repeats)
    held.cancel(desk)
    return Figure("warp of 200k dots and 12 areas, an update", found, "ms", 8)


def _lines(repeats: int) -> list[Figure]:
    rng = np.random.default_rng(1)
    lines, loose = curves(500, rng), rng.random((20_000, 2)) * 100
    apart = [
        Line(one.name, one.path, (0.4, 0.4), meeting=DISTANCE, distance_mm=0.5)
        for one in curves(20, rng)
    ]
    moved, held = keeping_distance(apart).keep_distance(loose)
    axes = shapely.union_all([shapely.linestrings(one.path.points_mm) for one in apart])
    nearest = shapely.distance(axes, shapely.points(moved[held])).min()
    t = np.linspace(0.0, 2 * np.pi, 500)[:-1]
    ring = Path.polyline(50 + 20 * np.column_stack([np.cos(t), np.sin(t)]), closed=True)
    uneven = max(
        _unevenness(one, rng)
        for one in (Line("straight", Path.polyline([(10, 10), (90, 10)])), Line("ring", ring),
                    *apart[:3])
    )  # fmt: skip
    return [
        *_on_lines(lines, loose),
        Figure("nearer to a line than asked, at worst", max(0.7 - float(nearest), 0.0), "mm", 1e-6),
        Figure("dots that find no place between lines", float((~held).mean()), "share"),
        Figure("spacing along a line, largest over mean", uneven, "", 0.01,
               note="straight, closed, curved"),
    ]  # fmt: skip


def _on_lines(lines: list[Line], dots: NDArray[np.float64]) -> list[Figure]:
    """Measure what lines add to steps of relaxation, while dots join them and once full."""
    met = [replace(line, meeting=ADHERE, reach_mm=1.0) for line in lines]
    n = len(dots)
    everyone = MetLines(tuple(met), tuple(range(len(met))), np.full(n, -1, np.int32), np.zeros(n),
                        np.ones(n, np.bool_))  # fmt: skip
    chooser, at, ms = OnLines(everyone, dots, [shapely.box(0, 0, 100, 100)]), dots, []
    for _ in range(20):
        started = time.process_time()
        at = chooser(at, at.copy())
        ms.append(1e3 * (time.process_time() - started))
    note = f"{np.count_nonzero(chooser.on):,} on lines in the end; processor time"
    return [
        Figure("20k dots adhere to 500 curves, a step, mean of 20", float(np.mean(ms)), "ms", 10,
               note=note),
        Figure("the same once curves are full", ms[-1], "ms", 10),
    ]  # fmt: skip


def _unevenness(line: Line, rng: np.random.Generator) -> float:
    along = np.sort(spread(line, np.sort(rng.random(80)) * line.length_mm))
    gaps = np.diff(along)
    return float(np.ptp(gaps) / gaps.mean())


def _relaxing(steps: int) -> Figure:
    """Relax the same dots in 200 areas' 2,000 polygons and in one square, step by step in turns."""
    n, side = 50_000, 100.0
    drawing = Drawing.blank(Page(side, side))
    rng = np.random.default_rng(4)
    seeds = shapely.multipoints(rng.random((200, 2)) * side)
    areas = shapely.voronoi_polygons(seeds, extend_to=shapely.box(0, 0, side, side))
    whole = shapely.box(0, 0, side, side)
    cells: list[shapely.Polygon] = []
    hexagons = Pattern.over(0, builtin("hexagons"), (0, 0, side, side), side / 3.6)
    for area in areas.geoms:
        drawing.patterns = {0: hexagons}
        cells += shapely.get_parts(part_for_dots(drawing, 0, area.intersection(whole))).tolist()
    cells = [cell for cell in cells if cell.area > 0.05]
    total = sum(cell.area for cell in cells)
    counts = [max(1, round(n * cell.area / total)) for cell in cells]
    dots = np.concatenate([random_in(cell, k, 1) for cell, k in zip(cells, counts, strict=True)])
    owner = np.repeat(np.arange(len(cells)), counts)
    pattern = Relaxation(dots, cells, compartment_of_dot=owner)
    square = Relaxation(rng.random((len(dots), 2)) * side, whole)
    ratios = [best_ms(pattern.step, 1) / best_ms(square.step, 1) for _ in range(steps)]
    return Figure("relaxing 50k dots in pattern polygons, over a square", float(np.median(ratios)),
                  "x", 1.5, note=f"{len(cells):,} polygons of 200 areas")  # fmt: skip


def _detail(*, quick: bool) -> list[Figure]:
    """Take a drawing of the sphere to a quarter of its dots, and stipple it with as many anew."""
    dark = read_darkness(SPHERE)
    h, w = dark.shape
    n = 12_000 if quick else 60_000
    reference = Reference(dark.astype(np.float32), float(w))

    def drawn(n_dots: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        *_, made = run(Task(Style(n_dots=n_dots), reference), snapshots=False)
        return np.array(made.position_mm), made.radius_mm.astype(np.float64)

    drawing = Drawing.blank(Page(float(w), float(h)), Style(n_dots=n))
    drawing.dots, drawing.reference = Dots.round(*drawn(n)), reference
    scaling = Scaling(n_dots=n // 4)
    seconds = best_ms(lambda: scaled_drawing(drawing, scaling), 2) / 1e3
    fewer = scaled_drawing(drawing, scaling).dots
    ours = measure(fewer.position_mm, fewer.radius_mm.astype(np.float64), dark)
    anew = measure(*drawn(n // 4), dark)
    name = f"level of detail, {n // 1000}k to {n // 4000}k dots"
    return [
        Figure(name, seconds, "s", 1.0),
        Figure(f"{name}: tone_rmse over stippling anew", ours["tone_rmse"] / anew["tone_rmse"],
               "x", 1.0, note=f"{ours['tone_rmse']:.4f} and {anew['tone_rmse']:.4f}"),
        Figure(f"{name}: min_rel", ours["min_rel"], "", 0.45, higher_is_better=True,
               note=f"anew {anew['min_rel']:.2f}"),
        Figure(f"{name}: gain off 1", abs(ours["tone_gain"] - 1.0), "",
               note=f"anew {abs(anew['tone_gain'] - 1.0):.4f}"),
    ]  # fmt: skip
