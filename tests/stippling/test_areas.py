"""Processing areas: their own dots anew, all others untouched to the bit, undo exact."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon, box

import stippler
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import FIRST_DOTS, SPACINGS, Style
from stippler.errors import GeometryError, ParameterError
from stippler.jobs.processing import process_now, tasks_of
from stippler.stippling.pipeline import run
from stippler.stippling.task import Task
from stippler.stippling.tasks import relaxing
from tests.conftest import EXAMPLES

PAGE = Page(60.0, 40.0)
L_SHAPE = Polygon([(5, 5), (25, 5), (25, 12), (12, 12), (12, 30), (5, 30)])
RING = Point(42, 20).buffer(12).difference(Point(42, 20).buffer(5))
FIELDS = ("id", "position_mm", "radius_mm", "elongation", "angle_rad", "seed", "area", "constraint")


def picture() -> Reference:
    y, x = np.mgrid[0:80, 0:120] / 120.0
    return Reference((0.45 + 0.4 * np.sin(7 * x) * np.cos(5 * y)).astype(np.float32), 60.0)


def document(**style) -> Document:
    """A page of dots by chance with two areas, one of which has a hole."""
    drawing = Drawing.blank(PAGE, Style(n_dots=900))
    drawing.reference = picture()
    drawing.styles[1] = Style(**{"n_dots": 220, "iterations": 4, **style})
    drawing.styles[2] = Style(n_dots=150, iterations=3)
    drawing.areas[1] = Area("L", L_SHAPE, 1)
    drawing.areas[2] = Area("ring", RING, 2)
    made = Document(drawing)
    made.begin("Fill")
    made.insert(Dots.round(np.random.default_rng(1).random((900, 2)) * (60, 40), 0.2))
    made.commit()
    return made


def state(document: Document, areas: tuple[int, ...] | None = None) -> list[np.ndarray]:
    dots = document.dots.by_id()
    rows = slice(None) if areas is None else np.isin(dots.area, areas)
    return [getattr(dots, name)[rows].copy() for name in FIELDS]


def same(one, two) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(one, two, strict=True))


def inside(document: Document) -> bool:
    dots = document.dots
    return np.array_equal(document.partition.area_at(dots.position_mm), dots.area)


@pytest.mark.parametrize(
    "style",
    [
        {}, *({"first_dots": name} for name in FIRST_DOTS[1:]),
        *({"spacing": name} for name in SPACINGS[1:]), {"sizes": "regions"}, {"weighted": False},
        {"n_dots": None, "size_range_mm": (0.2, 0.4)}, {"iterations": 0}, {"start": "border"},
        {"pen": "brush"}, {"n_dots": None, "density_per_cm2": 90.0}, {"jitter": 60.0},
        {"jitter": 60.0, "jitter_by": "spacing"}, {"elongation": 2.0, "direction_by": "edges"},
        {"size_noise": 30.0}, {"polarity": "white-on-black"}, {"tone_gamma": 2.0},
    ],
    ids=str,
)  # fmt: skip
def test_others_stay_and_undo_is_exact_in_every_style(style) -> None:
    made = document(**style)
    start, others = state(made), state(made, (0, 2))
    process_now(made, [1])
    mine = made.dots.area == 1
    assert same(state(made, (0, 2)), others)
    assert inside(made)
    wanted = made.drawing.styles[1].n_dots
    if wanted is not None:
        assert abs(int(mine.sum()) - wanted) <= max(0.03 * wanted, 2)
    made.undo()
    assert same(state(made), start)
    made.redo()
    assert same(state(made, (0, 2)), others)


def test_ink_meets_the_tone_within_an_area_with_a_hole() -> None:
    made = document()
    process_now(made, [2, 1])
    y, x = np.mgrid[0:400, 0:600] / 10.0 + 0.05
    fine = made.drawing.reference.at(np.column_stack((x.ravel(), y.ravel())))
    for area, outline in ((1, L_SHAPE), (2, RING)):
        under = shapely.contains_xy(outline, x.ravel(), y.ravel())
        mine = made.dots.take(np.flatnonzero(made.dots.area == area))
        discs = shapely.buffer(shapely.points(mine.position_mm), mine.radius_mm, quad_segs=64)
        ink = shapely.disjoint_subset_union_all(discs).intersection(outline).area
        assert ink == pytest.approx(fine[under].sum() * 0.01, rel=0.005)


def test_fixed_dots_stay_and_new_ones_keep_clear_of_them_and_of_neighbours() -> None:
    made = document()
    rows = np.flatnonzero(made.dots.area == 1)[:40]
    made.begin("Fix")
    made.change("constraint", rows, np.ones(40, made.dots.constraint.dtype))
    made.commit()
    assert made.dots.fixed[rows].all()
    fixed = made.dots.id[rows]
    before = made.dots.position_mm[rows].copy()
    process_now(made, [1])
    assert np.array_equal(made.dots.position_mm[made.rows(fixed)], before)
    new = made.dots.position_mm[(made.dots.area == 1) & ~made.dots.fixed]
    assert abs(len(new) + 40 - 220) <= 5
    spacing = np.sqrt(L_SHAPE.area / 220)
    apart = np.hypot(*(new[:, None] - before[None]).transpose(2, 0, 1)).min()
    assert apart > 0.3 * spacing
    beyond = made.dots.position_mm[made.dots.area != 1]
    near = np.hypot(*(new[:, None] - beyond[None]).transpose(2, 0, 1)).min(axis=1)
    assert np.quantile(near, 0.02) > 0.25 * spacing


@settings(max_examples=8 * EXAMPLES)
@given(st.integers(0, 10**6), st.integers(3, 9), st.integers(1, 120))
def test_areas_of_any_shape_and_number(seed: int, n: int, n_dots: int) -> None:
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(n)) * 2 * np.pi
    radius = rng.uniform(0.3, 18.0, n)
    star = Polygon(np.column_stack((30 + radius * np.cos(angle), 20 + radius * np.sin(angle))))
    star = shapely.make_valid(star)
    if not isinstance(star, Polygon) or star.area < 0.01:
        return
    made = document(n_dots=n_dots)
    made.begin("Area")
    made.set("area", 3, Area("star", star, 1))
    made.own_by_place(np.arange(len(made.dots)))
    made.commit()
    start, others = state(made), state(made, (0, 1, 2))
    process_now(made, [3])
    assert same(state(made, (0, 1, 2)), others)
    assert inside(made)
    made.undo()
    assert same(state(made), start)


def test_relaxing_an_area_keeps_its_tone_and_leaves_it_alone_then() -> None:
    made = document()
    process_now(made, [1])
    drawing, others = made.drawing.snapshot(), state(made, (0, 2))
    for _ in range(2):
        task, rows, _ = relaxing(drawing, Style(), 20, [1])
        *_, last = run(task)
        drawing.dots.position_mm[rows] = last.position_mm
        drawing.dots.radius_mm[rows] = last.radius_mm
    mine = drawing.dots.area == 1
    assert (drawing.dots.area[rows] == 1).all()
    assert shapely.contains_xy(L_SHAPE, *drawing.dots.position_mm[mine].T).all()
    ink = [
        np.square(d.radius_mm[d.area == 1].astype(float)).sum() for d in (made.dots, drawing.dots)
    ]
    assert ink[1] == pytest.approx(ink[0], rel=0.02)
    assert same(state(Document(drawing), (0, 2)), others)


def test_a_number_is_shared_by_the_areas_of_a_style() -> None:
    made = document()
    made.drawing.areas[2] = Area("ring", RING, 1)
    n = [one.task.style.n_dots for one in tasks_of(made, [1, 2])[0]]
    assert sum(n) == pytest.approx(220, abs=8)
    assert min(n) > 50


def test_the_page_alone_is_drawn_as_a_picture_is() -> None:
    drawing = Drawing.blank(PAGE, Style(n_dots=700, iterations=3))
    drawing.reference = picture()
    made = Document(drawing)
    process_now(made, [0])
    *_, last = run(Task(drawing.style_of(0), drawing.reference), snapshots=False)
    assert np.array_equal(made.dots.by_id().position_mm, last.position_mm)
    assert np.array_equal(made.dots.by_id().radius_mm, last.radius_mm)


def test_areas_in_python(tmp_path) -> None:
    drawing = stippler.stipple(np.full((40, 60), 0.5), 300, width=60.0, iterations=2)
    drawing.areas[1] = Area("ear", box(10, 10, 30, 30))
    with_ear = stippler.process(drawing, "ear", dots=150, iterations=2)
    assert int((with_ear.dots.area == 1).sum()) == pytest.approx(150, abs=3)
    assert len(drawing.dots) == pytest.approx(300, abs=3)  # it is another drawing
    page = with_ear.dots.area == 0
    assert set(with_ear.dots.id[page]) <= set(drawing.dots.id)
    with_ear.save(tmp_path / "ear.stipple")
    assert stippler.open(tmp_path / "ear.stipple").style_of(1).n_dots == 150
    with pytest.raises(ParameterError, match="no area 'nose'"):
        stippler.process(drawing, "nose")


def test_what_cannot_be_processed_is_told_and_changes_nothing() -> None:
    made = document()
    start = state(made)
    with pytest.raises(ParameterError, match="there is no area 9"):
        process_now(made, [1, 9])
    made.drawing.areas[3] = Area("over all", box(0, 0, 60, 40))
    covered = Document(made.drawing)
    with pytest.raises(GeometryError, match="area 1: lies under others"):
        process_now(covered, [1])
    assert same(state(made), start)
