"""Figures of areas."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable

import numpy as np
import shapely
from numpy.typing import NDArray

from benchmarks import area_borders
from benchmarks.figures import Figure
from stippler.drawing.line import ADHERE, Line
from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import OUTSIDE, Arc, PlanarMap
from stippler.drawing.planar.swept import dots_in_strip
from stippler.stippling.initial_points import random_in
from stippler.stippling.relax import Relaxation

SIZE = (200.0, 150.0)
_SETTLING = 60


def figures(*, quick: bool = False) -> list[Figure]:
    """Measure all; the best of several, since other work disturbs."""
    repeats = 5 if quick else 30
    rng = np.random.default_rng(1)
    areas = three_hundred_areas(rng)
    dots = rng.random((200_000, 2)) * SIZE
    owner = areas.area_at(dots)
    arc = next(k for k, a in areas.arcs.items() if OUTSIDE not in (a.left, a.right))

    def edit() -> None:
        after = moves.move_by(areas, [(arc, 6)], (0.3, 0.2)).map
        for k in edits.touched(areas, after):
            after.outline(k)
        dots_in_strip(areas, after, dots, owner)

    return [
        Figure("one border of 300 areas moved, 200k dots", best_ms(edit, repeats), "ms", 30, 5),
        Figure("the same as a step, to the buffers of the next frame",
               step_ms(areas, dots, repeats), "ms", 30, 5),
        *settled_figures(5_000 if quick else 50_000, 3 if quick else 9),
        *picture_figures(3 if quick else 5),
        *area_borders.figures(quick=quick),
    ]  # fmt: skip


def settled_figures(n_dots: int, steps: int) -> list[Figure]:
    """Time a settled step of dots in many areas against one of as many in a square, in turns."""
    whole = shapely.box(0, 0, 100, 100)
    square = _settled([whole], n_dots)
    out = []
    for n, stretch, reach in ((200, 1.25, 1.5), (2_200, 1.6, 2.5)):
        seeds = shapely.multipoints(np.random.default_rng(4).random((n, 2)) * 100.0)
        cells = shapely.voronoi_polygons(seeds, extend_to=whole).geoms
        many = _settled([cell.intersection(whole) for cell in cells], n_dots)
        pairs = [(_step_s(many), _step_s(square)) for _ in range(steps)]
        mine, theirs = (min(times) for times in zip(*pairs, strict=True))
        name = f"a settled step of {n_dots // 1000}k dots in {n:,} areas, over a square"
        note = f"{1e3 * mine:.1f} over {1e3 * theirs:.1f} ms"
        out.append(Figure(name, mine / theirs, "x", reach, stretch, note=note))
    return out


def _settled(cells: list[shapely.Polygon], n_dots: int) -> Relaxation:
    """Return dots in some polygons after so many steps of Lloyd's that few cells change."""
    total = sum(cell.area for cell in cells)
    counts = [max(1, round(n_dots * cell.area / total)) for cell in cells]
    dots = [random_in(cell, k, 1) for cell, k in zip(cells, counts, strict=True)]
    engine = Relaxation(
        np.concatenate(dots), cells, compartment_of_dot=np.repeat(np.arange(len(cells)), counts)
    )
    engine.run(_SETTLING)
    return engine


def _step_s(engine: Relaxation) -> float:
    """Return the processor time of a step."""
    start = time.process_time()
    engine.step()
    return time.process_time() - start


def step_ms(areas: PlanarMap, dots: NDArray[np.float64], repeats: int) -> float:
    """Return what a drag's release takes in a document: history, dots, nodes, GPU buffers."""
    from stippler.drawing.area_edits import edit_areas
    from stippler.drawing.document import Document
    from stippler.drawing.dots import Dots
    from stippler.drawing.drawing import Drawing, Page
    from stippler.editor.tools.node_index import NodeIndex
    from stippler.editor.tools.node_source import BorderNodes
    from stippler.headless import open_context
    from stippler.render.scene import Scene

    drawing = Drawing.blank(Page(*SIZE))
    drawing.dots = Dots.round(dots, 0.1)
    document = Document(drawing)
    edit_areas(document, "Areas", lambda _: edits.Outcome(areas, tuple(areas.areas[1:])))
    scene, nodes, source = Scene(open_context()), NodeIndex(joins=True), BorderNodes()
    arc = next(k for k, a in areas.arcs.items() if OUTSIDE not in (a.left, a.right))
    by = itertools.cycle([(0.3, 0.2), (-0.3, -0.2)])

    def step() -> None:
        edit_areas(document, "Move", lambda m: moves.move_by(m, [(arc, 6)], next(by)))
        nodes.update(source.paths(document))
        scene.sync(document)

    return best_ms(step, repeats)


def picture_figures(repeats: int) -> list[Figure]:
    """Measure proposals from a megapixel."""
    from PIL import Image

    from stippler.analysis.picture_parts import parts_of
    from stippler.analysis.region_outlines import outlines_of
    from stippler.resources import assets

    with Image.open(assets() / "samples" / "ammonite.png") as picture:
        grey = np.asarray(picture.convert("L").resize((1095, 913)), np.float32)
    darkness = 1.0 - grey / 255.0
    parts = parts_of(darkness)
    regions = parts.regions(24)

    def propose() -> None:
        found = parts_of(darkness)
        outlines_of(found.regions(24)[found.labels], 0.1)

    def split() -> None:
        outlines_of(parts.split(regions, parts.n // 2)[parts.labels], 0.1)

    def grow() -> None:
        outlines_of(parts.grown({parts.n // 2}, {0}).astype(np.int32)[parts.labels], 0.1)

    return [
        Figure("areas proposed from a megapixel", best_ms(propose, repeats) / 1e3, "s", 1),
        Figure("a region split, to its outlines", best_ms(split, repeats), "ms", 100),
        Figure("a scribble, to the outline grown", best_ms(grow, repeats), "ms", 100),
    ]


def best_ms(call: Callable[[], object], repeats: int) -> float:
    """Return the shortest wall time of some calls, after one uncounted."""
    call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


def three_hundred_areas(rng: np.random.Generator) -> PlanarMap:
    """Return 300 cells with borders of 10,000 edges that wind."""
    page = shapely.box(0, 0, *SIZE)
    seeds = rng.random((300, 2)) * SIZE
    cells = []
    for _ in range(3):
        found = shapely.voronoi_polygons(shapely.multipoints(seeds), extend_to=page)
        cells = [cell.intersection(page) for cell in found.geoms]
        seeds = np.array([cell.centroid.coords[0] for cell in cells])
    areas = PlanarMap.of_page(*SIZE)
    for cell in cells[:-1]:
        ring = Path.polyline(shapely.get_coordinates(cell.exterior), closed=True)
        areas = edits.add(areas, ring, edits.IS_CUT).map
    t = np.linspace(0, 1, 13)[1:-1, None]
    wound: dict[int, Arc | None] = {}
    for k, arc in areas.arcs.items():
        if OUTSIDE in (arc.left, arc.right):
            continue
        at = arc.path.points_mm
        parts = [at[:1]]
        for p, q in itertools.pairwise(at):
            d = q - p
            across = np.array([-d[1], d[0]]) * 0.04 * np.sin(2 * np.pi * t)
            parts += [p + d * t + across, q[None]]
        wound[k] = Arc(Path.polyline(np.concatenate(parts)), arc.left, arc.right)
    return areas.with_arcs(wound)


def curves(n: int, rng: np.random.Generator) -> list[Line]:
    """Return smooth curves of about 20 mm."""
    starts = rng.random((n, 2)) * 90
    walks = [s + np.cumsum(rng.normal(0, 3, (6, 2)), axis=0) for s in starts]
    paths = [moves.smooth_path(Path.polyline(at)) for at in walks]
    return [Line(f"curve {k}", path, meeting=ADHERE) for k, path in enumerate(paths)]
