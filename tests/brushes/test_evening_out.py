"""The relaxation brush and *Relax* of a selection even out by the area's spacing, tone kept."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from stippler.analysis.grain import measure_grain
from stippler.analysis.tone_error import measure_tone
from stippler.brushes import selection
from stippler.brushes.evening_out import evened_out
from stippler.brushes.local_cells import centroids_of
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
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
