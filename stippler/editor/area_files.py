"""Areas from and to files of outlines: SVG and GeoJSON."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from stippler.editor.area_jobs import Step
from stippler.errors import GeometryError, OutputError, StipplerError

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.planar.path import Path
    from stippler.drawing.planar.planar_map import PlanarMap
    from stippler.files.read.outlines import Shape

READ = (".svg", ".svgz", ".geojson", ".json")
WRITTEN = (".svg", ".geojson")
_EVERY = 4


@dataclass(frozen=True, slots=True, eq=False)
class Imported:
    """Areas that a file's outlines make of a map.

    Attributes
    ----------
    before, map : PlanarMap
    names : dict of int to str
        Of the new areas.
    notes : tuple of str
    """

    before: PlanarMap
    map: PlanarMap
    names: dict[int, str]
    notes: tuple[str, ...]


def import_job(
    path: FilePath, before: PlanarMap, size_mm: tuple[float, float], locked: list[int]
) -> Callable[[], Iterator[Step]]:
    """Return a job that reads outlines and lays them over a map one after the other."""

    def job() -> Iterator[Step]:
        from stippler.files.read.outlines import read_outlines

        yield Step(-1.0)
        read = read_outlines(path)
        notes = list(read.notes)
        if read.size_mm is not None and not _alike(read.size_mm, size_mm):
            w, h = read.size_mm
            notes.append(f"the file's page is {w:.4g} x {h:.4g} mm; outlines stand from its corner")
        closed = [shape for shape in read.shapes if shape.is_closed]
        if n_open := len(read.shapes) - len(closed):
            notes.append(f"left out: {n_open} x open line")
        yield from _laid(before, closed, locked, notes)

    return job


def _laid(
    before: PlanarMap, shapes: list[Shape], locked: list[int], notes: list[str]
) -> Iterator[Step]:
    from stippler.drawing.planar.edits import add

    after, names, refused = before, dict[int, str](), dict[str, int]()
    for n, shape in enumerate(shapes):
        if n % _EVERY == 0:
            yield Step(n / len(shapes))
        try:
            outcome = add(after, list(shape.paths), locked=locked, rule=shape.rule)
        except GeometryError as error:
            why = str(error).partition(";")[0]
            refused[why] = refused.get(why, 0) + 1
            continue
        after = outcome.map
        names.update(dict.fromkeys(outcome.made, shape.name))
        notes += [note for note in outcome.notes if note not in notes]
    notes += [f"left out: {n} x {why}" for why, n in refused.items()]
    names = {k: name for k, name in names.items() if k in set(after.areas)}
    if not names:
        raise StipplerError("holds no outline that makes an area", "file", "; ".join(notes[-2:]))
    yield Step(1.0, Imported(before, after, names, tuple(notes)))


def lay_job(
    before: PlanarMap, outlines: Sequence[Sequence[Path]], locked: list[int], name: str
) -> Callable[[], Iterator[Step]]:
    """Return a job that lays outlines over a map, each a list of rings."""

    def job() -> Iterator[Step]:
        from stippler.files.read.outlines import Shape

        shapes = [
            Shape(f"{name} {n}", tuple(rings), "even-odd") for n, rings in enumerate(outlines, 1)
        ]
        yield from _laid(before, shapes, locked, [])

    return job


def _alike(a: tuple[float, float], b: tuple[float, float]) -> bool:
    return all(abs(x - y) <= 0.01 * max(y, 1.0) for x, y in zip(a, b, strict=True))


def write_areas(drawing: Drawing, path: FilePath) -> int:
    """Write the outlines of all areas; return how many.

    Raises
    ------
    OutputError
        If the ending is another one, or the file cannot be written.
    """
    from stippler.atomic_write import replacing
    from stippler.drawing.area_edits import map_of
    from stippler.files.write.outlines import geojson_of_areas, svg_of_areas

    areas = map_of(drawing)
    names = {k: area.name for k, area in drawing.areas.items()}
    page = drawing.page
    ending = path.suffix.lower()
    if ending == ".svg":
        text = svg_of_areas(areas, (page.width_mm, page.height_mm), names)
    elif ending in (".geojson", ".json"):
        text = geojson_of_areas(areas, names)
    else:
        raise OutputError(f"{ending or 'no ending'} holds no areas", path, "give .svg or .geojson")
    with replacing(path) as file:
        file.write(text.encode())
    return len(areas.areas)
