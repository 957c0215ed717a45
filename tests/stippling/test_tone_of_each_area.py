"""Each area by itself meets the tone, by the exact union of all discs: walls, bleeds, through."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Point, box

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.pattern import Pattern
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.files.read.picture import read_picture
from stippler.jobs.processing import process_now, tasks_of
from stippler.jobs.stippling import relax_drawing
from stippler.kernels.machine import pool
from stippler.resources import assets
from stippler.stippling.area_tone import Borders, InkOfDiscs
from stippler.stippling.part_of_area import part_for_dots
from stippler.stippling.patterns import builtin
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
        "darkest": np.full_like(x, 0.94),
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


def errors(document: Document, some: Sequence[int] = ()) -> dict[int, tuple[float, int]]:
    """Return by how much of its ink each area, or some, is off, and how many dots it has."""
    dots, reference = document.dots, document.drawing.reference
    radius = dots.radius_mm.astype(float)
    found = {}
    for k in some or document.drawing.areas:
        part, n = document.partition.part_of(k), int(np.count_nonzero(dots.area == k))
        if n:
            found[k] = laid(dots.position_mm, radius, part) / asked(reference, part) - 1.0, n
    return found


def divided(reference: Reference, n_areas: int, seed: int, **style) -> Document:
    """Return a page of areas as Voronoi's cells lie, that see through their borders unless told."""
    style = Style(**{"border": "through", "iterations": 12, **style})
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


@pytest.mark.parametrize(
    ("kind", "border", "seed"),
    [
        ("dark", "wall", 1),
        ("darkest", "wall", 1),
        ("all", "automatic", 2),
        ("waves", "bleed", 2),
    ],
)
def test_each_of_many_areas_between_walls_meets_the_tone(kind, border, seed):
    document = divided(pictured(kind), 12, seed, n_dots=600, border=border, iterations=4)
    process_now(document, list(document.drawing.areas))
    assert_met(document, 5)


@settings(max_examples=2 * EXAMPLES, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from(["dark", "all", "waves"]))
def test_areas_of_any_borders_meet_the_tone_beside_each_other(seed, kind):
    rng = np.random.default_rng(seed)
    document = divided(pictured(kind), int(rng.integers(6, 14)), seed, n_dots=600, iterations=4)
    areas = document.drawing.areas
    for k in areas:
        areas[k] = replace(areas[k], border=str(rng.choice(["wall", "through", "bleed", ""])))
    document = Document(document.drawing)
    process_now(document, list(areas))
    assert_met(document, 3)


def test_halves_of_a_dark_page_meet_the_tone():
    for dark, n_dots in ((0.7, 80), (0.8, 80), (0.9, 300)):
        reference = Reference(np.full((320, 480), dark, np.float32), W)
        document = divided(reference, 1, 1, n_dots=n_dots, border="wall")
        document.drawing.areas[1] = Area("right", box(W / 2, 0, W, H), 0)
        document = Document(document.drawing)
        process_now(document, [0, 1])
        assert_met(document, 2)


def test_areas_that_no_dots_reach_keep_their_sizes_to_the_bit():
    document = divided(pictured("light"), 16, 1, n_dots=900, border="wall", iterations=6)
    alone = [
        made for one in tasks_of(document, list(document.drawing.areas))[0]
        for *_, made in [run(one.task, snapshots=False)]
    ]  # fmt: skip
    process_now(document, list(document.drawing.areas))
    for k, made in zip(document.drawing.areas, alone, strict=True):
        mine = document.dots.area == k
        np.testing.assert_array_equal(document.dots.radius_mm[mine], made.radius_mm)


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


@pytest.mark.parametrize("border", ["through", "wall"])
def test_an_area_made_again_alone_meets_the_tone_among_dots_that_stay(border):
    for kind in ("dark", "waves"):
        document = divided(pictured(kind), 16, 5, n_dots=1500, border=border)
        process_now(document, list(document.drawing.areas))
        number = np.bincount(document.dots.area)
        large = [k for k in document.drawing.areas if number[k] >= 1.3 * MANY]
        for k in large[1:3]:
            others = document.dots.copy()
            process_now(document, [k])
            off, n = errors(document, [k])[k]
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


def test_polygons_of_a_pattern_meet_the_tone_and_so_does_their_area():
    document = divided(pictured("darkest"), 1, 1, n_dots=3000, iterations=6)
    drawing = document.drawing
    drawing.areas[1] = Area("wall", box(10, 5, 50, 35), 0)
    drawing.patterns[1] = Pattern.over(1, builtin("bricks"), (10, 5, 50, 35), 60.0)
    document = Document(drawing)
    process_now(document, [0, 1])
    dots = document.dots
    whole = part_for_dots(drawing, 1, document.partition.part_of(1))
    met = 0
    for part in (whole, *whole.geoms):
        n = shapely.intersects_xy(part, *dots.position_mm.T).sum()
        if n >= MANY:
            ink = laid(dots.position_mm, dots.radius_mm.astype(float), part)
            assert ink == pytest.approx(asked(drawing.reference, part), rel=0.005)
            met += 1
    assert met > 10


@pytest.mark.parametrize(("kind", "border"), [("dark", "wall"), ("waves", "through")])
def test_areas_that_are_relaxed_meet_the_tone(kind, border):
    document = divided(pictured(kind), 10, 5, n_dots=800, iterations=3, border=border)
    process_now(document, list(document.drawing.areas))
    by_hand = np.flatnonzero(document.dots.area == 2)[:2]
    document.begin("Size")
    document.change("radius_mm", by_hand, np.full(2, 0.3, np.float32))
    document.commit()
    for areas in (None, [1, 2, 3, 4]):
        before = document.dots.radius_mm.copy()
        style = document.drawing.styles[0]
        *_, last = relax_drawing(document.drawing, style, 4, areas)
        document.begin_run("Relax")
        document.merge(last.moved_mm)
        document.merge_radii(last.radius_mm)
        document.end_run()
        moved = document.dots.radius_mm != before
        assert moved.any()
        assert areas is None or set(document.dots.area[moved].tolist()) <= set(areas)
        assert (document.dots.radius_mm[by_hand] == np.float32(0.3)).all()
        off = [off for off, n in errors(document, areas or ()).values() if n >= MANY]
        assert len(off) >= 3
        assert np.abs(off).max() < 0.005


def solved(document: Document) -> tuple[np.ndarray, np.ndarray]:
    """Return places and sizes as they are solved before each area's tone is looked at."""
    (one,), _ = tasks_of(document, list(document.drawing.areas))
    *_, made = run(one.task, snapshots=False)
    each = [progress for _, progress in one.of_each(made)]
    return (
        np.concatenate([part.position_mm for part in each]),
        np.concatenate([part.radius_mm for part in each]),
    )


def drawn(document: Document) -> tuple[np.ndarray, np.ndarray]:
    """Return places and sizes of new dots, area by area."""
    process_now(document, list(document.drawing.areas))
    dots = document.dots.take(np.argsort(document.dots.area, kind="stable"))
    return dots.position_mm, dots.radius_mm


def test_tone_that_sizes_cannot_reach_is_left():
    """Of dots of one size no factor helps: they stay as they are solved for all areas together."""
    document = divided(pictured("middle"), 12, 4, n_dots=1200, size_range_mm=(0.4, 0.4))
    process_now(document, list(document.drawing.areas))
    assert np.unique(document.dots.radius_mm).tolist() == [np.float32(0.4)]
    document = divided(pictured("middle"), 12, 4, n_dots=1200, size_range_mm=(0.1, 0.3))
    np.testing.assert_array_equal(solved(document)[1], drawn(document)[1])


def test_long_dots_are_sized_as_before():
    document = divided(pictured("middle"), 12, 4, n_dots=1200, elongation=2.0)
    np.testing.assert_array_equal(solved(document)[1], drawn(document)[1])


def test_sizes_change_by_little_and_dots_stay_in_place():
    document = divided(pictured("waves"), 36, 1, n_dots=1500)
    (position, before), (at, radius) = solved(document), drawn(document)
    np.testing.assert_array_equal(at, position)
    ratio = radius / before
    assert 0.94 < ratio.min() < ratio.max() < 1.06
    assert (ratio != 1.0).any()


@pytest.mark.parametrize(("kind", "border"), [("edges", "through"), ("dark", "wall")])
def test_any_number_of_threads_gives_the_same_sizes(kind, border):
    found, before = [], pool.n_threads()
    try:
        for n in (1, 3):
            pool.set_threads(n)
            style = {"n_dots": 9000, "iterations": 3, "border": border}
            document = divided(pictured(kind), 20, 2, **style)
            process_now(document, list(document.drawing.areas))
            found.append(document.dots.radius_mm.copy())
    finally:
        pool.set_threads(before)
    np.testing.assert_array_equal(*found)


@settings(max_examples=60 * EXAMPLES, deadline=None)
@given(st.integers(0, 10**6), st.booleans(), st.booleans())
def test_ink_of_discs_in_areas(seed, is_lattice, is_doubled):
    """Areas of unions, of any sizes, at one place or touching, on corners and edges, with holes."""
    rng = np.random.default_rng(seed)
    n, n_areas = int(rng.integers(1, 50)), int(rng.integers(2, 8))
    position, radius = rng.random((n, 2)) * 10.0, rng.uniform(0.05, 2.0, n)
    if is_lattice:
        position, radius = np.round(position), np.ceil(2.0 * radius) / 2.0
    if is_doubled:
        position[: n // 2], radius[: n // 2] = position[n - n // 2 :], radius[n - n // 2 :]
    page = box(0.0, 0.0, 10.0, 10.0)
    seeds = shapely.multipoints(rng.random((n_areas, 2)) * 10.0)
    areas = [cell & page for cell in shapely.voronoi_polygons(seeds, extend_to=page).geoms]
    areas[0] = areas[0].difference(areas[0].representative_point().buffer(0.3, quad_segs=3))
    if n_areas > 4:
        areas = [areas[0].union(areas[2]), *areas[3:]]  # two pieces, maybe; a gap
    borders = Borders(areas, position, 1.02 * radius)
    laid, free = InkOfDiscs(borders, np.ones(len(areas), np.bool_)).laid(radius)
    union = shapely.union_all(shapely.buffer(shapely.points(position), radius, quad_segs=128))
    assert laid == pytest.approx([union.intersection(area).area for area in areas], abs=3e-3)
    assert (free >= 0.0).all()
    assert free.sum() <= union.length * 1.001
