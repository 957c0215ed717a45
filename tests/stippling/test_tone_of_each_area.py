"""Areas that are drawn as one: each by itself meets the tone, by the exact union of its discs."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon, box

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.files.read.picture import read_picture
from stippler.jobs.processing import process_now, tasks_of
from stippler.kernels.machine import pool
from stippler.kernels.tone.ink_of_areas import ink_beyond, ink_in_cells
from stippler.resources import assets
from stippler.stippling.pipeline import run
from stippler.stippling.style_tone import toned
from tests.conftest import EXAMPLES

W, H = 60.0, 40.0
PAGE = box(0, 0, W, H)
MANY = 30
"""Dots from which on an area meets the tone."""


def pictured(kind: str) -> Reference:
    x, y = np.meshgrid(np.linspace(0, 1, 480), np.linspace(0, 1, 320))
    dark = {
        "light": 0.05 + 0.1 * x,
        "middle": 0.25 + 0.25 * x,
        "dark": 0.7 + 0.22 * x,
        "all": 0.02 + 0.9 * x,
        "waves": 0.4 + 0.3 * np.sin(20 * x) * np.cos(14 * y),
        "edges": np.where((np.floor(9 * x) + np.floor(6 * y)) % 2 > 0, 0.6, 0.2),
    }[kind]
    return Reference(dark.astype(np.float32), W)


def asked(reference: Reference, part: shapely.Geometry) -> float:
    """Return the integral of the darkness over a part of the page, pixel by pixel."""
    side = reference.pixel_mm
    x0, y0, x1, y1 = np.array(part.bounds) / side
    left, top = max(int(x0) - 1, 0), max(int(y0) - 1, 0)
    dark = reference.darkness[top : int(y1) + 2, left : int(x1) + 2]
    height, width = dark.shape
    line = shapely.get_coordinates(shapely.segmentize(part.boundary, 0.5 * side)) / side
    met = np.zeros((height + 4, width + 4), bool)  # pixels at the outline, and those around them
    j, i = np.clip(np.floor(line).astype(int) - (left, top), -1, (width, height)).T + 2
    for down, right in np.ndindex(3, 3):
        met[i + down - 1, j + right - 1] = True
    met = met[2:-2, 2:-2]
    shapely.prepare(part)
    y, x = np.mgrid[top : top + height, left : left + width]
    area = np.where(shapely.contains_xy(part, (x + 0.5) * side, (y + 0.5) * side), side**2, 0.0)
    x, y = x[met] * side, y[met] * side
    cut = shapely.intersection(shapely.box(x, y, x + side, y + side), part)
    area[met] = shapely.area(cut)
    return float((area * dark).sum())


def laid(position, radius, part: shapely.Geometry) -> float:
    """Return how much of a part of the page discs cover, in mm²."""
    near = shapely.dwithin(shapely.points(position), part, radius)
    discs = shapely.buffer(shapely.points(position[near]), radius[near] * 1.0001, quad_segs=48)
    return shapely.disjoint_subset_union_all(discs).intersection(part).area


def errors(document: Document) -> dict[int, tuple[float, int]]:
    """Return by how much of its ink each area is off, and how many dots it has."""
    dots, reference = document.dots, document.drawing.reference
    radius = dots.radius_mm.astype(float)
    found = {}
    for k in document.drawing.areas:
        part, n = document.partition.part_of(k), int(np.count_nonzero(dots.area == k))
        if n:
            found[k] = laid(dots.position_mm, radius, part) / asked(reference, part) - 1.0, n
    return found


def divided(reference: Reference, n_areas: int, seed: int, **style) -> Document:
    """Return a page of areas that see through their borders, as Voronoi's cells lie."""
    style = Style(border="through", **{"iterations": 12, **style})
    drawing = Drawing.from_reference(reference, np.empty((0, 2)), np.empty(0, np.float32), style)
    size = reference.width_mm, reference.height_mm
    seeds = shapely.multipoints(np.random.default_rng(seed).random((n_areas, 2)) * size)
    whole = box(0, 0, *size)
    cells = shapely.voronoi_polygons(seeds, extend_to=whole).geoms
    for k, cell in enumerate(list(cells)[1:], start=1):
        drawing.areas[k] = Area(f"area {k}", cell.intersection(whole), 0)
    return Document(drawing)


def assert_met(document: Document, least: int = 5) -> None:
    many = [off for off, n in errors(document).values() if n >= MANY]
    assert len(many) >= least
    assert np.abs(many).max() < 0.005


@pytest.mark.parametrize(
    ("kind", "seed"),
    [
        ("light", 1),
        ("middle", 1),
        ("middle", 2),
        ("dark", 1),
        ("dark", 2),
        ("all", 1),
        ("all", 2),
        ("waves", 2),
        ("edges", 1),
    ],
)
def test_each_of_many_areas_meets_the_tone(kind, seed):
    document = divided(pictured(kind), 36, seed, n_dots=1500)
    process_now(document, list(document.drawing.areas))
    assert_met(document, 15)


@pytest.mark.parametrize("name", ["ammonite.png", "honey-bee.jpg", "sandstone.jpg"])
def test_each_area_of_a_picture_meets_the_tone(name):
    reference = read_picture(assets() / "samples" / name, tone="illustration", width_mm=60.0)
    reference = Reference(np.ascontiguousarray(reference.darkness[::4, ::4]), 60.0)
    document = divided(reference, 40, 3, n_dots=2500)
    process_now(document, list(document.drawing.areas))
    assert_met(document, 15)


@settings(max_examples=4 * EXAMPLES, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from(["middle", "dark", "waves"]))
def test_any_division_meets_the_tone(seed, kind):
    rng = np.random.default_rng(seed)
    document = divided(pictured(kind), int(rng.integers(8, 30)), seed, n_dots=1000)
    process_now(document, list(document.drawing.areas))
    assert_met(document, 3)


def test_an_area_made_again_alone_meets_the_tone_among_dots_that_stay():
    for kind in ("dark", "waves"):
        document = divided(pictured(kind), 16, 5, n_dots=1500)
        process_now(document, list(document.drawing.areas))
        large = [k for k, (_, n) in errors(document).items() if n >= 1.3 * MANY]
        for k in large[1:3]:
            others = document.dots.copy()
            process_now(document, [k])
            off, n = errors(document)[k]
            assert n >= MANY
            assert abs(off) < 0.005
            rows = document.rows(others.id[others.area != k])
            np.testing.assert_array_equal(
                document.dots.radius_mm[rows], others.radius_mm[others.area != k]
            )


def test_holes_islands_and_fixed_dots_are_part_of_it():
    document = divided(pictured("waves"), 1, 1, n_dots=1600)
    shapes = [Point(20, 20).buffer(12).difference(Point(21, 19).buffer(5)), Point(21, 19).buffer(5),
              box(40, 5, 46, 11).union(box(48, 22, 55, 30))]  # fmt: skip
    for k, shape in enumerate(shapes, start=1):
        document.drawing.areas[k] = Area(f"area {k}", shape, 0)
    document = Document(document.drawing)
    process_now(document, [0, 1, 2, 3])
    assert_met(document, 4)
    mine = np.flatnonzero(document.dots.area == 1)[::9]
    document.begin("Fix")
    document.change("constraint", mine, np.ones(len(mine), document.dots.constraint.dtype))
    document.commit()
    process_now(document, [0, 1, 2, 3])
    assert np.count_nonzero(document.dots.fixed) == len(mine)
    assert_met(document, 4)


def test_areas_of_other_styles_meet_the_tone_beside_each_other():
    document = divided(pictured("middle"), 12, 4, n_dots=1200)
    drawing = document.drawing
    drawing.styles[1] = Style(n_dots=900, border="through", iterations=12, tone_gamma=1.5)
    for k in (2, 3, 5, 6, 8):
        drawing.areas[k] = replace(drawing.areas[k], style=1)
    document = Document(drawing)
    tasks = tasks_of(document, list(drawing.areas))[0]
    assert {drawing.areas[k].style for task in tasks for k in task.areas[1:]} == {0, 1}
    together = [k for task in tasks for k in task.areas if len(task.areas) > 1]
    process_now(document, list(document.drawing.areas))
    dots, met = document.dots, 0
    for k in together:
        part, style = document.partition.part_of(k), drawing.style_of(k)
        ink = laid(dots.position_mm, dots.radius_mm.astype(float), part)
        if np.count_nonzero(dots.area == k) >= MANY:
            assert ink == pytest.approx(asked(toned(drawing.reference, style), part), rel=0.005)
            met += 1
    assert met > 6


def test_tone_that_sizes_cannot_reach_is_left():
    """Of dots of one size no factor helps: they stay as they are solved for all areas together."""
    document = divided(pictured("middle"), 12, 4, n_dots=1200, size_range_mm=(0.4, 0.4))
    process_now(document, list(document.drawing.areas))
    assert np.unique(document.dots.radius_mm).tolist() == [np.float32(0.4)]
    (task,), _ = tasks_of(document, list(document.drawing.areas))
    short = replace(task.task, style=replace(task.task.style, size_range_mm=(0.1, 0.3)))
    *_, made = run(short, snapshots=False)
    *_, alone = run(replace(short, areas_mm=()), snapshots=False)
    np.testing.assert_array_equal(made.radius_mm, alone.radius_mm)


def test_long_dots_are_sized_as_before():
    document = divided(pictured("middle"), 12, 4, n_dots=1200, elongation=2.0)
    (task,), _ = tasks_of(document, list(document.drawing.areas))
    *_, made = run(task.task, snapshots=False)
    *_, alone = run(replace(task.task, areas_mm=()), snapshots=False)
    np.testing.assert_array_equal(made.radius_mm, alone.radius_mm)


def test_sizes_change_by_little_and_dots_stay_in_place():
    document = divided(pictured("waves"), 36, 1, n_dots=1500)
    (task,), _ = tasks_of(document, list(document.drawing.areas))
    *_, made = run(task.task, snapshots=False)
    *_, alone = run(replace(task.task, areas_mm=()), snapshots=False)
    np.testing.assert_array_equal(made.position_mm, alone.position_mm)
    ratio = made.radius_mm / alone.radius_mm
    assert 0.94 < ratio.min() < ratio.max() < 1.06
    assert (ratio != 1.0).any()


def test_any_number_of_threads_gives_the_same_sizes():
    found, before = [], pool.n_threads()
    try:
        for n in (1, 3):
            pool.set_threads(n)
            document = divided(pictured("edges"), 20, 2, n_dots=9000, iterations=3)
            process_now(document, list(document.drawing.areas))
            found.append(document.dots.radius_mm.copy())
    finally:
        pool.set_threads(before)
    np.testing.assert_array_equal(*found)


@settings(max_examples=300 * EXAMPLES, deadline=None)
@given(st.integers(0, 10**6))
def test_ink_of_a_dot_in_a_polygon(seed):
    """Its disc within its cell, less what lies beyond the polygon's sides, is what is in it."""
    rng = np.random.default_rng(seed)
    cell = shapely.convex_hull(
        shapely.multipoints(rng.normal(0.0, 1.0, (int(rng.integers(6, 12)), 2)))
    )
    turn, reach = np.sort(rng.uniform(0, 2 * np.pi, 9)), rng.uniform(0.2, 2.0, 9)
    around = np.column_stack([np.cos(turn), np.sin(turn)]) * reach[:, None]
    polygon = Polygon(around + rng.normal(0.0, 0.6, 2))
    if not (polygon.is_valid and cell.contains(Point(0, 0))):
        return
    polygon = shapely.orient_polygons(polygon)
    cell = np.array(shapely.orient_polygons(cell).exterior.coords)[:-1]
    side = np.array(polygon.exterior.coords)
    r, n = float(rng.uniform(0.1, 1.5)), len(side) - 1
    first, here = np.array([0, len(cell)], np.int32), np.zeros(n, np.int64)
    whole, beyond = np.empty(1), np.empty(n)
    following = np.roll(np.arange(len(cell), dtype=np.int32), -1)
    ink_in_cells(0, 1, first, cell, following, here[:1], np.full(1, r), whole)
    ink_beyond(0, n, first, cell, here, np.hstack([side[:-1], side[1:]]), np.full(n, r), beyond)
    disc = Point(0, 0).buffer(r, quad_segs=2000).intersection(Polygon(cell))
    inside = float(polygon.contains(Point(0, 0)))
    assert whole[0] == pytest.approx(disc.area, abs=1e-5)
    assert inside * whole[0] - beyond.sum() == pytest.approx(
        disc.intersection(polygon).area, abs=1e-5
    )
