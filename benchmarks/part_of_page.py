"""What the dots of a small area cost on a large picture: ``stippler bench --only first_dots``."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import shapely

from benchmarks.figures import Figure, median_s
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.jobs.processing import process_now
from stippler.stippling.halftone_area import pulses_inside
from stippler.stippling.picture_field import PictureField
from stippler.stippling.radii import solve_radii
from stippler.stippling.relax import Relaxation
from stippler.stippling.spacing import TO_INK, Wanted
from stippler.stippling.stipple import stages

_N_DOTS, _N_OTHERS, _STEPS, _WIDTH_MM = 2_000, 200_000, 20, 200.0


def figures(repeats: int) -> list[Figure]:
    """Time what a page of 16 megapixels takes, and an area of a hundredth of it."""
    side = np.linspace(0.2, 0.9, 4000, dtype=np.float32)
    reference = Reference(side[:, None] * side, _WIDTH_MM)
    turn = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    reach = 11.0 + 2.0 * np.cos(5.0 * turn)
    area = shapely.Polygon(np.column_stack([np.cos(turn), np.sin(turn)]) * reach[:, None] + 100.0)
    style = Style(n_dots=_N_DOTS)
    first = pulses_inside(reference, style, area)
    return [
        Figure(
            f"{_N_DOTS:,} dots of a page of 16 megapixels",
            1e3 * median_s(lambda: _whole(reference, style), repeats), "ms", 150.0, 60.0,
        ),
        Figure(
            f"{_N_DOTS:,} dots in an area of 16 megapixels, first dots to sizes",
            1e3 * median_s(lambda: _stippled(reference, style, area), repeats), "ms", 150.0, 60.0,
        ),
        Figure(
            f"{_N_DOTS:,} dots of an area processed in a drawing of {_N_OTHERS:,}, undoable",
            1e3 * median_s(_processing(reference, area), repeats), "ms", 150.0, 60.0,
        ),
        Figure(
            f"{_STEPS} weighted steps of them",
            1e3 * median_s(lambda: _relaxed(reference, first.position_mm, area), repeats), "ms",
        ),
    ]  # fmt: skip


def _whole(reference: Reference, style: Style) -> None:
    for _ in stages(reference, style, snapshots=False):
        pass


def _stippled(reference: Reference, style: Style, area: shapely.Polygon) -> None:
    first = pulses_inside(reference, style, area)
    field = PictureField.of(reference)
    wanted = Wanted.by_rule(first.rule, 1.0)
    engine = Relaxation(first.position_mm, area, density=field, method="even", wanted=wanted)
    engine.run(_STEPS - 1)
    engine.set_rules(TO_INK)
    engine.step()
    solve_radii(engine.tessellation(), first.rule)


def _processing(reference: Reference, area: shapely.Polygon) -> Callable[[], object]:
    """Return what processes an area of a document of many dots anew."""
    drawing = Drawing.blank(Page(_WIDTH_MM, _WIDTH_MM), Style(n_dots=_N_OTHERS))
    drawing.reference = reference
    drawing.styles[1] = Style(n_dots=_N_DOTS)
    drawing.areas[1] = Area("area", area, 1)
    document = Document(drawing)
    document.begin("Fill")
    places = np.random.default_rng(0).random((_N_OTHERS, 2)) * _WIDTH_MM
    document.insert(Dots.round(places, 0.1))
    document.commit()
    return lambda: process_now(document, [1])


def _relaxed(reference: Reference, points: np.ndarray, area: shapely.Polygon) -> None:
    field = PictureField.of(reference, [[np.square]])
    Relaxation(points, area, density=field).run(_STEPS)
