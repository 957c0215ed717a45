"""Cells of some dots, made for a brush, are their cells in the whole drawing."""

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon, box

from stippler.brushes import selection
from stippler.brushes.local_cells import areas_of, cells_of, centroids_of
from stippler.drawing.area import PAGE_AREA, Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.page import Page
from stippler.stippling.relax import Relaxation
from tests.stippling.shapes import comb, points_in

SETTINGS = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))


def document_of(xy: np.ndarray, outline: Polygon | None = None) -> Document:
    drawing = Drawing.blank(Page(100.0, 80.0))
    if outline is not None:
        drawing.areas[PAGE_AREA] = Area("page", outline)
    drawing.dots = Dots.round(xy, 0.3)
    return Document(drawing)


def outline_named(name: str, seed: int) -> Polygon:
    if name == "page":
        return box(0, 0, 100, 80)
    if name == "comb":
        return shapely.transform(comb(6), lambda xy: xy * (16, 70) + (1, 5))
    ring = Point(50, 40).buffer(38).difference(Point(50 + seed % 7, 40).buffer(25))
    return ring.difference(box(48, 0, 50, 30))


@SETTINGS
@given(
    seed=st.integers(0, 10**6), n=st.integers(2, 1500), kind=st.sampled_from(["even", "clusters"]),
    name=st.sampled_from(["page", "comb", "ring"]), chosen=st.sampled_from(["row", "few", "one"]),
)  # fmt: skip
def test_local_cells_are_those_of_the_whole_drawing(seed, n, kind, name, chosen):
    outline = outline_named(name, seed)
    xy = points_in(outline, n, seed)
    rng = np.random.default_rng(seed)
    if kind == "clusters":
        xy = xy[rng.integers(0, min(n, 5), n)] + rng.normal(0, 0.5, (n, 2))
        xy = np.vstack([xy[shapely.contains_xy(outline, *xy.T)], points_in(outline, 3, seed + 1)])
    document = document_of(xy, outline)
    xy = document.dots.position_mm
    if chosen == "row":
        rows = np.argsort(np.abs(xy[:, 1] - 40.0))[: len(xy) // 10 + 1]
    else:
        rows = rng.choice(len(xy), 1 if chosen == "one" else len(xy) // 20 + 1, replace=False)
    rows = np.sort(rows)
    whole = Relaxation(xy, outline, fixed=~np.isin(np.arange(len(xy)), rows)).tessellation()
    local = cells_of(document, rows)
    np.testing.assert_allclose(local.area_mm2, whole.area[rows], rtol=1e-8, atol=1e-9)
    engine = Relaxation(xy, outline, fixed=~np.isin(np.arange(len(xy)), rows))
    engine.step()
    np.testing.assert_allclose(local.moved_mm, engine.points[rows], atol=1e-7)


def test_a_row_of_a_hexagonal_fill_stays():
    side = np.sqrt(5.0 * 2.0 / np.sqrt(3.0))  # cells of 5 mm²
    row, column = np.mgrid[0 : int(79 / (side * np.sqrt(0.75))), 0 : int(98 / side)]
    x, height = side * (column + 0.5 * (row % 2) + 0.25), side * np.sqrt(0.75) * (row + 0.5)
    document = document_of(np.c_[x.ravel(), height.ravel()])
    y = np.unique(document.dots.position_mm[:, 1])[20]
    corners = [(30, y - 0.3), (70, y - 0.3), (70, y + 0.3), (30, y + 0.3)]
    ids = selection.in_outline(document, corners)
    rows = np.sort(document.rows(ids))
    before = document.dots.position_mm[rows].copy()
    assert areas_of(document, rows) == pytest.approx(5.0, rel=0.02)
    for _ in range(20):
        document.begin("relax")
        selection.relax(document, ids)
        document.commit()
    assert np.abs(document.dots.position_mm[rows] - before).max() < 0.02


@pytest.mark.parametrize("corner_deg", [360.0, 2.0])
def test_coinciding_dots_are_parted(corner_deg):
    outline, at = box(0, 0, 100, 80), np.array([50.0, 40.0])
    if corner_deg < 180:
        half = np.tan(np.radians(corner_deg / 2))
        outline, at = (
            Polygon([(0, 40), (90, 40 - 90 * half), (90, 40 + 90 * half)]),
            np.array([0, 40.0]),
        )
    xy = np.vstack([points_in(outline, 200, 1), np.tile(at, (5, 1))])
    document = document_of(xy, outline)
    ids = document.dots.id[-5:].copy() if corner_deg > 180 else document.dots.id.copy()
    for _ in range(30):
        document.begin("relax")
        selection.relax(document, ids)
        document.commit()
    last = document.dots.position_mm[document.rows(document.dots.id[-5:])]
    assert len(np.unique(last.round(6), axis=0)) == 5
    assert shapely.intersects_xy(outline.buffer(1e-9), *last.T).all()


def test_dots_of_the_page_keep_out_of_areas_on_it():
    drawing = Drawing.blank(Page(100.0, 80.0))
    drawing.areas[1] = Area("leaf", box(30, 20, 70, 60))
    drawing.dots = Dots.round(np.array([[20.0, 40.0], [80.0, 40.0]]), 0.3)
    document = Document(drawing)
    areas = areas_of(document, np.array([0, 1]))
    assert areas == pytest.approx([(100 * 80 - 40 * 40) / 2] * 2)
    assert centroids_of(document, np.array([0]))[0, 0] < 30
