"""The relaxation brush and *Relax* of a selection even out by the area's spacing, tone kept."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from shapely.geometry import box

from stippler.analysis.grain import measure_grain
from stippler.analysis.tone_error import measure_tone
from stippler.brushes import selection
from stippler.brushes.brush import Brush
from stippler.brushes.evening_out import evened_out
from stippler.brushes.local_cells import centroids_of
from stippler.brushes.stroke import Stroke
from stippler.brushes.stroke_path import PointerSample
from stippler.brushes.tip import Tip
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.relax import Relaxation
from stippler.stippling.space_local import LocalSpacing
from stippler.stippling.spacing import AT_LAST
from stippler.stippling.stipple import stages

SIDE_MM, N_DOTS, N_PX = 100.0, 2500, 300
STEPS = 40
SPACING = SIDE_MM / N_DOTS**0.5


@cache
def _made(darkness: float) -> tuple[Reference, np.ndarray, np.ndarray]:
    reference = Reference(np.full((N_PX, N_PX), darkness, np.float32), SIDE_MM)
    *_, last = stages(reference, Style(n_dots=N_DOTS), snapshots=False)
    return reference, np.array(last.position_mm), np.array(last.radius_mm)


def _document(darkness: float, spacing: str = "even") -> Document:
    reference, at, radius = _made(darkness)
    drawing = Drawing.from_reference(reference, at.copy(), radius.copy())
    drawing.styles = {k: Style(n_dots=N_DOTS, spacing=spacing) for k in drawing.styles}
    return Document(drawing)


def _tone_error(document: Document) -> float:
    px = N_PX / SIDE_MM
    dots, reference = document.dots, document.drawing.reference
    at, radius = dots.position_mm * px, dots.radius_mm.astype(float) * px
    return measure_tone(at, radius, reference.darkness).tone_rmse


def _relax(document: Document, steps: int) -> None:
    ids = np.sort(document.dots.id.copy())
    for _ in range(steps):
        document.begin("Relax")
        selection.relax(document, ids)
        document.commit()


@pytest.mark.parametrize("darkness", [0.4, 0.73])
def test_an_even_grey_relaxed_for_long_gets_no_rows_and_keeps_its_tone(darkness) -> None:
    document, by_lloyd = _document(darkness), _document(darkness, "lloyd")
    before = _tone_error(document)
    _relax(document, STEPS)
    _relax(by_lloyd, STEPS)
    grain = measure_grain(document.dots.position_mm)
    rows = measure_grain(by_lloyd.dots.position_mm).rows_at_4
    assert grain.rows_at_4 < 0.015 < rows
    assert grain.least_distance > 0.77
    assert _tone_error(document) < before + 0.006


def test_an_area_spaced_by_lloyd_gets_lloyds_step() -> None:
    document = _document(0.4, "lloyd")
    rows = np.arange(200, 260)
    moved = evened_out(document, rows, by_tone=False).moved_mm
    assert np.array_equal(moved, centroids_of(document, rows, None))


def test_dots_at_rest_stay_and_a_gap_closes() -> None:
    document = _document(0.4)
    at = document.dots.position_mm
    middle = np.flatnonzero(np.hypot(*(at - SIDE_MM / 2).T) < 10.0)
    still = evened_out(document, middle, by_tone=True).moved_mm
    assert np.hypot(*(still - at[middle]).T).mean() < 0.03 * SPACING
    gap = np.flatnonzero(np.hypot(*(at - SIDE_MM / 2).T) < 3.5)
    document.begin("Gap")
    document.remove(gap)
    document.commit()
    at = document.dots.position_mm
    around = np.flatnonzero(np.hypot(*(at - SIDE_MM / 2).T) < 12.0)
    ids = document.dots.id[around]
    nearest = np.hypot(*(at - SIDE_MM / 2).T).min()
    for _ in range(STEPS):
        document.begin("Relax")
        selection.relax(document, ids)
        document.commit()
    assert np.hypot(*(document.dots.position_mm - SIDE_MM / 2).T).min() < 0.5 * nearest


def test_what_few_dots_want_is_what_they_want_among_all() -> None:
    document = _document(0.4)
    at = document.dots.position_mm
    rows = np.flatnonzero(np.hypot(*(at - SIDE_MM / 2).T) < 12.0)
    few = rows[np.hypot(*(at[rows] - SIDE_MM / 2).T) < 6.0]
    among = evened_out(document, rows, by_tone=True).moved_mm[np.isin(rows, few)]
    alone = evened_out(document, few, by_tone=True).moved_mm
    assert np.abs(among - alone).max() < 0.03 * SPACING


def _largest_move(document: Document, before: np.ndarray) -> float:
    return float(np.hypot(*(document.dots.position_mm - before).T).max()) / SPACING


@pytest.mark.parametrize("darkness", [0.15, 0.4, 0.73])
def test_a_stroke_held_on_an_even_grey_comes_to_rest_without_rows_its_tone_kept(darkness) -> None:
    document = _document(darkness)
    before = _tone_error(document)
    everywhere = Brush("relax", "relax", 0.8 * SIDE_MM, Tip(hardness=1.0))
    step_s = 1.0 / float(everywhere.value("per_s"))
    at = SIDE_MM / 2
    stroke = Stroke(document, everywhere, PointerSample(at, at), 1)
    moves = []
    for k in range(60):
        was = document.dots.position_mm.copy()
        stroke.rest((k + 1) * step_s + 1e-6)
        moves.append(_largest_move(document, was))
    stroke.commit(PointerSample(at, at, t=60 * step_s + 2e-6))
    assert moves[0] > 0.02
    assert moves[-1] < 0.005
    assert measure_grain(document.dots.position_mm).rows_at_4 < 0.008
    assert _tone_error(document) <= before


@pytest.mark.parametrize("darkness", [0.15, 0.73])
@pytest.mark.parametrize("reach", [25.0, 80.0])
def test_a_selection_relaxed_ten_times_keeps_its_tone_and_hardly_moves_any_more(
    darkness, reach
) -> None:
    document = _document(darkness)
    before = _tone_error(document)
    off = document.dots.position_mm - SIDE_MM / 2
    ids = np.sort(document.dots.id[np.hypot(*off.T) < reach])
    moves = []
    for _ in range(11):
        was, sizes = document.dots.position_mm.copy(), document.dots.radius_mm.copy()
        document.begin("Relax")
        selection.relax(document, ids)
        document.commit()
        moves.append(_largest_move(document, was))
    assert moves[10] < 0.015
    assert moves[10] < 0.5 * moves[0]
    assert np.abs(document.dots.radius_mm / sizes - 1.0).max() < 0.02
    assert _tone_error(document) <= 1.005 * before


def test_dots_at_rest_are_left_alone() -> None:
    document = _document(0.4)
    ids = np.sort(document.dots.id[np.hypot(*(document.dots.position_mm - 50.0).T) < 15.0])
    for _ in range(80):
        was, sizes = document.dots.position_mm.copy(), document.dots.radius_mm.copy()
        document.begin("Relax")
        selection.relax(document, ids)
        document.commit()
    assert np.array_equal(document.dots.position_mm, was)
    assert np.array_equal(document.dots.radius_mm, sizes)


@pytest.mark.parametrize("darkness", [0.4, 0.73])
def test_what_a_dot_wants_is_what_the_whole_engine_wants_of_it_all_others_held(darkness) -> None:
    _, at, _radius = _made(darkness)
    rng = np.random.default_rng(2)
    at = at + rng.normal(0.0, 0.12 * SPACING, at.shape)
    at = np.clip(at, 0.0, SIDE_MM)
    free = np.flatnonzero(np.hypot(*(at - SIDE_MM / 2).T) < 14.0)
    held = np.ones(len(at), np.bool_)
    held[free] = False
    page = box(0.0, 0.0, SIDE_MM, SIDE_MM)
    whole = Relaxation(at, page, held, method="even")
    whole.set_rules(AT_LAST)
    whole.step()
    local = LocalSpacing(at, [page], movable=~held).space(free, AT_LAST)
    ways = whole.points[free] - at[free], local.moved_mm - at[free]
    assert np.hypot(*ways[0].T).max() > 0.2 * SPACING
    assert np.hypot(*(ways[0] - ways[1]).T).max() < 0.02 * SPACING
    assert np.hypot(*(ways[0] - ways[1]).T).mean() < 0.01 * SPACING
