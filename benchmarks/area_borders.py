"""What borders of areas cost, in ratios, in turns; and how true the tone of small areas is."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import shapely

from benchmarks.figures import Figure
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.jobs.processing import process_now
from stippler.stippling.pipeline import run
from stippler.stippling.task import Task

W, H = 60.0, 40.0
_AT_EDGE = {
    "a box": shapely.box(0.0, 0.0, 25.0, H),
    "slanted": shapely.Polygon([(0.0, 0.0), (40.0, 0.0), (12.0, H), (0.0, H)]),
}
_MANY = 30  # dots from which on an area is to meet the tone


def figures(*, quick: bool = False) -> list[Figure]:
    """Measure processor time of the whole way from picture to sizes."""
    n_dots, repeats = (2_000, 2) if quick else (10_000, 9)
    return [*edge_figures(n_dots, repeats), *long_figures(n_dots, repeats),
            *seen_through_figures(n_dots, repeats), wall_figure(n_dots)]  # fmt: skip


def edge_figures(n_dots: int, repeats: int) -> list[Figure]:
    """Time areas whose dots run off the page's edge against the same within walls."""
    out = []
    for name, part in _AT_EDGE.items():
        runs = [_stippling(Style(n_dots=n_dots, border=b), part) for b in ("automatic", "wall")]
        out.append(_over(f"an area at the page's edge, {name}, over walls", runs, repeats, 1.2))
    return out


def long_figures(n_dots: int, repeats: int) -> list[Figure]:
    """Time a page of long dots against one of round ones."""
    runs = [_stippling(Style(n_dots=n_dots, elongation=e)) for e in (2.0, 1.0)]
    return [_over("a page of long dots, over round ones", runs, repeats, 1.3)]


def seen_through_figures(n_dots: int, repeats: int) -> list[Figure]:
    """Time many areas that see through against one page; tell how true small ones are."""
    runs = [_processing(n_dots, n) for n in (n_dots // 50, 1)]
    small = divided(n_dots, n_dots // 40)
    return [
        _over(f"{n_dots // 50} areas that see through, over one", runs, repeats, None),
        _tone_figure("tone of small areas that see through, at worst", small),
    ]


def wall_figure(n_dots: int) -> Figure:
    """Tell how true small dark areas are between walls, over which their dots reach."""
    small = divided(n_dots, n_dots // 40, "wall", picture(0.6, 0.9))
    return _tone_figure("tone of small dark areas between walls, at worst", small)


def _tone_figure(name: str, document: Document) -> Figure:
    areas = document.drawing.areas
    process_now(document, list(areas))
    off = [_off(document, k) for k in areas if _number(document, k) >= _MANY]
    note = f"{len(off)} of 30 to {max(_number(document, k) for k in areas)} dots"
    return Figure(name, 100.0 * max(off), "% of its ink", 0.5, note=note)


def divided(
    n_dots: int, n_areas: int, border: str = "through", reference: Reference | None = None
) -> Document:
    """Return a page of areas with one kind of borders, without dots yet."""
    style = Style(n_dots=n_dots, border=border)
    nothing = np.empty((0, 2)), np.empty(0, np.float32)
    drawing = Drawing.from_reference(reference or picture(), *nothing, style)
    page = shapely.box(0.0, 0.0, W, H)
    seeds = shapely.multipoints(np.random.default_rng(4).random((n_areas, 2)) * (W, H))
    cells = shapely.voronoi_polygons(seeds, extend_to=page).geoms
    for k, cell in enumerate(list(cells)[1:], start=1):
        drawing.areas[k] = Area(f"area {k}", cell.intersection(page), 0)
    return Document(drawing)


def picture(light: float = 0.25, dark: float = 0.5) -> Reference:
    """Return a ramp, dark enough for dots at the page's edge."""
    return Reference(np.tile(np.linspace(light, dark, 480, dtype=np.float32), (320, 1)), W)


def _stippling(style: Style, part: shapely.Polygon | None = None) -> Callable[[], float]:
    task = Task(style, picture(), parts_mm=() if part is None else (part,))

    def once() -> float:
        start = time.process_time()
        for _ in run(task, snapshots=False):
            pass
        return time.process_time() - start

    return once


def _processing(n_dots: int, n_areas: int) -> Callable[[], float]:
    def once() -> float:
        document = divided(n_dots, n_areas)
        start = time.process_time()
        process_now(document, list(document.drawing.areas))
        return time.process_time() - start

    return once


def _over(name: str, runs: list[Callable[[], float]], repeats: int, reach: float | None) -> Figure:
    """Return the first run's least time over the second's, measured in turns."""
    for once in runs:
        once()
    mine, theirs = (
        min(times)
        for times in zip(*([once() for once in runs] for _ in range(repeats)), strict=True)
    )
    note = f"{1e3 * mine:.0f} over {1e3 * theirs:.0f} ms of processor time"
    return Figure(name, mine / theirs, "x", reach, note=note)


def _number(document: Document, area: int) -> int:
    return int(np.count_nonzero(document.dots.area == area))


def _off(document: Document, area: int) -> float:
    """Return by what share of its ink an area is off: exact unions of discs, pixels cut by it."""
    dots, part = document.dots, document.partition.part_of(area)
    reference, radius = document.drawing.reference, document.dots.radius_mm.astype(float)
    assert reference is not None, "it is drawn from a picture"
    points = shapely.points(dots.position_mm)
    near = shapely.dwithin(points, part, radius)
    discs = shapely.buffer(points[near], radius[near], quad_segs=64)
    laid = float(shapely.area(shapely.intersection(shapely.union_all(discs), part)))
    side = reference.pixel_mm
    columns = np.arange(reference.darkness.shape[1]) * side
    strips = shapely.box(columns, 0.0, columns + side, H)  # the ramp is even from top to bottom
    asked = float((shapely.area(shapely.intersection(strips, part)) * reference.darkness[0]).sum())
    return abs(laid / asked - 1.0)


def main() -> None:
    """Print them."""
    for figure in figures():
        print(f"{figure.name}: {figure.value:.3g} {figure.unit} ({figure.note})")


if __name__ == "__main__":
    main()
