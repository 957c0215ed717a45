"""Dots that lie on lines, and join them, while a drawing is relaxed."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, FREE, NO_CURVE, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.planar.moves import smooth_path
from stippler.drawing.planar.path import Path
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.jobs.stippling import relax_drawing
from stippler.kernels.machine.pool import set_threads
from stippler.stippling.on_lines import OnLines
from stippler.stippling.task import MetLines
from stippler.stippling.tasks import relaxing

SIZE = (60.0, 40.0)
STRAIGHT = Path.polyline([(8, 30), (52, 30)])
CURVED = smooth_path(Path.polyline([(6, 8), (25, 25), (40, 12), (53, 22)]))
_T = np.linspace(0, 2 * np.pi, 300)[:-1]
RING = Path.polyline(np.column_stack([30 + 11 * np.cos(_T), 20 + 11 * np.sin(_T)]), closed=True)


def drawing_of(n=900, seed=1, reference=None, **lines):
    drawing = Drawing.blank(Page(*SIZE))
    drawing.dots = Dots.round(np.random.default_rng(seed).random((n, 2)) * SIZE, 0.2)
    drawing.reference = reference
    drawing.lines = dict(enumerate(lines.values()))
    return drawing


def line(path, **values):
    return Line("line", path, (0.0, 0.0), **({"meeting": "adhere", "reach_mm": 2.0} | values))


def relaxed(document, steps=20, style=None):
    """Relax a document as the window does; return how far dots on lines went, step by step."""
    frozen = replace(document.drawing, dots=document.begin_run("Relax all"))
    gone = []
    for work in relax_drawing(frozen, style or Style(weighted=False), steps):
        if work.moved_mm is not None:
            before = document.dots.position_mm.copy()
            document.merge(work.moved_mm, work.held)
            on = document.dots.constraint == ON_CURVE
            gone.append(np.hypot(*(document.dots.position_mm - before)[on].T).max(initial=0.0))
        if work.radius_mm is not None:
            document.merge_radii(work.radius_mm)
    document.end_run()
    return gone


def gaps(document, k):
    dots, of = document.dots, document.drawing.lines[k]
    on = (dots.constraint == ON_CURVE) & (dots.curve == k)
    assert np.allclose(of.at(dots.parameter[on]), dots.position_mm[on], atol=1e-9)
    s = np.sort(dots.parameter[on])
    return np.diff(np.r_[s, s[:1] + of.length_mm]) if of.is_closed else np.diff(s)


@pytest.mark.parametrize("path", [STRAIGHT, CURVED, RING], ids=["straight", "curved", "closed"])
@pytest.mark.parametrize("spacing", ["even", "lloyd"])
def test_free_dots_join_until_the_line_is_full_and_lie_evenly(path, spacing):
    document = Document(drawing_of(a=line(path)))
    before, style = document.dots.copy(), Style(weighted=False, spacing=spacing)
    gone = relaxed(document, 30, style)
    found = gaps(document, 0)
    assert np.ptp(found) < 0.01 * found.mean()
    fits = 1.0746 * np.sqrt(SIZE[0] * SIZE[1] / 900)
    assert found.mean() == pytest.approx(fits, rel=0.12)
    assert max(gone[-4:]) < 1e-9  # it has come to rest
    far = shapely.distance(shapely.linestrings(path.points_mm), shapely.points(before.position_mm))
    assert (far[document.dots.constraint == ON_CURVE] < 4.5).all()  # drawn from nearby
    document.undo()
    for name in ("position_mm", "constraint", "curve", "parameter", "area"):
        assert np.array_equal(getattr(document.dots, name), getattr(before, name))
    document.redo()
    assert len(gaps(document, 0)) == len(found)


def test_others_make_room_for_the_dots_on_a_line():
    document = Document(drawing_of(a=line(CURVED)))
    relaxed(document, 40)
    at, on = document.dots.position_mm, document.dots.constraint == ON_CURVE
    from scipy.spatial import KDTree

    nearest = KDTree(at).query(at, k=2)[0][:, 1]
    assert nearest[on].min() > 0.5 * np.median(nearest)
    between = KDTree(at[on]).query(at[~on])[0]
    assert between.min() > 0.5 * np.median(nearest)


def test_dots_are_denser_where_the_tone_is_darker():
    ramp = np.linspace(0.0, 1.0, 600, dtype=np.float32) * np.ones((400, 1), np.float32)
    document = Document(drawing_of(reference=Reference(ramp, 60.0), a=line(STRAIGHT)))
    relaxed(document, 20, Style(weighted=True))
    found = gaps(document, 0)
    dots = document.dots
    s = np.sort(dots.parameter[dots.constraint == ON_CURVE])
    tone = np.sqrt(0.05 + (8.0 + (s[1:] + s[:-1]) / 2) / 60.0)  # as dense as those around
    assert np.ptp(found * tone) < 0.05 * (found * tone).mean()
    assert found[0] > 1.8 * found[-1]


def held_on(paths, n_each, seed, meeting="ignore"):
    """Return a document whose lines hold dots crowded by chance, and no free dots beside."""
    lines = {str(k): line(path, meeting=meeting) for k, path in enumerate(paths)}
    document = Document(drawing_of(0, **lines))
    rng = np.random.default_rng(seed)
    document.begin("Rows")
    for k in range(len(paths)):
        of = document.drawing.lines[k]
        along = rng.random(n_each) ** 2 * of.length_mm
        rows = document.insert(Dots.round(of.at(along), 0.1))
        document.change("constraint", rows, np.full(n_each, ON_CURVE, np.int8))
        document.change("curve", rows, np.full(n_each, k, np.int32))
        document.change("parameter", rows, along)
    document.commit()
    return document


def energy(document, k):
    """Return the energy of Lloyd's relaxation along a line."""
    dots, of = document.dots, document.drawing.lines[k]
    s = np.sort(dots.parameter[(dots.constraint == ON_CURVE) & (dots.curve == k)])
    if of.is_closed:
        return (np.diff(np.r_[s, s[0] + of.length_mm]) ** 3).sum() / 12
    return (np.diff(s) ** 3).sum() / 12 + (s[0] ** 3 + (of.length_mm - s[-1]) ** 3) / 3


@given(st.integers(0, 9999), st.integers(2, 25))
@settings(max_examples=15, deadline=None)
def test_energy_along_lines_never_rises(seed, n):
    apart = Path.polyline([(8, 36), (52, 36)])  # the two others cross one another
    document = held_on([apart, RING, CURVED], n, seed)
    frozen = replace(document.drawing, dots=document.begin_run("Relax"))
    last = None
    for work in relax_drawing(frozen, Style(weighted=False, spacing="lloyd"), 5):
        if work.moved_mm is None or work.done == 0:
            continue
        document.merge(work.moved_mm, work.held)
        now = [energy(document, k) for k in range(3)]
        assert last is None or all(a <= b * (1 + 1e-9) for a, b in zip(now, last, strict=True))
        last = now
    document.end_run()
    document.undo()
    assert energy(document, 0) >= last[0] * (1 - 1e-9)


def test_one_dot_lies_in_each_crossing_of_two_lines_and_of_a_loop():
    loop = Path.polyline([(10, 10), (40, 10), (40, 30), (25, 30), (25, 2)])
    across = Path.polyline([(5, 20), (55, 20)])
    document = held_on([loop, across], 40, 3)
    relaxed(document, 6)
    at = document.dots.position_mm
    for place in ((25, 10), (40, 20), (25, 20)):
        far = np.sort(np.hypot(*(at - place).T))
        assert far[0] < 1e-9
        assert far[1] > 0.5


def test_a_line_across_areas_is_even_across_their_border():
    drawing = drawing_of(700, a=line(Path.polyline([(5, 20), (55, 21)])))
    right = shapely.box(31.3, 0, 60, 40)
    drawing.areas = {**drawing.areas, 1: Area("right", right)}
    document = Document(drawing)
    document.begin("Own")
    document.own_by_place(np.arange(len(document.dots)))
    document.commit()
    area = document.dots.area.copy()
    relaxed(document, 25)
    found = gaps(document, 0)
    assert np.ptp(found) < 0.01 * found.mean()
    owner = document.partition.area_at(document.dots.position_mm)
    assert np.array_equal(owner, document.dots.area)
    document.undo()
    assert np.array_equal(document.dots.area, area)


def test_a_line_over_a_hole_and_the_edge_lays_dots_only_where_the_area_is():
    drawing = drawing_of(700, a=line(Path.polyline([(-20, 20), (90, 20)])))
    hole = shapely.Point(30, 20).buffer(6)
    drawing.areas = {**drawing.areas, 1: Area("hole", hole)}
    document = Document(drawing)
    document.begin("Own")
    document.own_by_place(np.arange(len(document.dots)))
    document.commit()
    frozen = replace(document.drawing, dots=document.begin_run("Relax areas"))
    for work in relax_drawing(frozen, Style(weighted=False), 20, [0]):
        if work.moved_mm is not None:
            document.merge(work.moved_mm, work.held)
    document.end_run()
    at = document.dots.position_mm[document.dots.constraint == ON_CURVE]
    assert len(at) > 20
    assert (np.hypot(*(at - (30, 20)).T) > 5.99).all()
    assert ((at >= 0) & (at <= SIZE)).all()


def test_what_a_person_does_meanwhile_stays():
    document = Document(drawing_of(a=line(STRAIGHT), b=line(RING)))
    frozen = replace(document.drawing, dots=document.begin_run("Relax all"))
    works = [w for w in relax_drawing(frozen, Style(weighted=False), 12) if w.moved_mm is not None]
    document.merge(works[3].moved_mm, works[3].held)
    on = np.flatnonzero(document.dots.constraint == ON_CURVE)
    document.begin("Fix and free")
    document.change("constraint", on[:3], np.full(3, FIXED, np.int8))
    document.change("curve", on[:3], np.full(3, NO_CURVE, np.int32))
    document.set("line", 1, None)  # the ring goes
    fixed = document.dots.position_mm[on[:3]].copy()
    document.commit()
    for work in works[4:]:
        document.merge(work.moved_mm, work.held)
    document.end_run()
    assert np.array_equal(document.dots.position_mm[on[:3]], fixed)
    assert (document.dots.constraint[on[:3]] == FIXED).all()
    joined = np.setdiff1d(np.flatnonzero(document.dots.constraint == ON_CURVE), on)
    assert (document.dots.curve[joined] == 0).all()  # none came to the line that is gone


def test_locked_areas_hidden_lines_and_fixed_dots_are_left_alone():
    drawing = drawing_of(a=line(STRAIGHT, hidden=True))
    assert relaxing(drawing, Style(), 5)[0].lines is None
    drawing = drawing_of(a=line(STRAIGHT))
    drawing.dots.constraint[:] = FIXED
    document = Document(drawing)
    before = document.dots.position_mm.copy()
    relaxed(document, 3)
    assert np.array_equal(document.dots.position_mm, before)
    drawing = drawing_of(a=line(STRAIGHT))
    drawing.areas = {0: replace(drawing.areas[0], locked=True)}
    document = Document(drawing)
    relaxed(document, 3)
    assert (document.dots.constraint == FREE).all()


@pytest.mark.parametrize("weighted", [False, True])
def test_any_number_of_threads_gives_the_same(weighted):
    ramp = np.linspace(0.2, 0.8, 600, dtype=np.float32) * np.ones((400, 1), np.float32)
    made = []
    try:
        for n in (1, 3):
            set_threads(n)
            document = Document(drawing_of(5000, 4, Reference(ramp, 60.0), a=line(CURVED),
                                           b=line(RING)))  # fmt: skip
            relaxed(document, 6, Style(weighted=weighted))
            made.append(document.dots.copy())
    finally:
        set_threads(0)
    one, many = made
    assert (one.constraint == ON_CURVE).sum() > 20
    for name in ("position_mm", "radius_mm", "constraint", "curve", "parameter"):
        assert np.array_equal(getattr(one, name), getattr(many, name))


def test_a_second_run_leaves_what_is_at_rest():
    ramp = np.full((400, 600), 0.4, np.float32)
    document = Document(drawing_of(900, 1, Reference(ramp, 60.0), a=line(CURVED), b=line(RING)))
    style = Style(weighted=True)
    for _ in range(4):
        relaxed(document, 30, style)
    n = int((document.dots.constraint == ON_CURVE).sum())
    before = document.dots.position_mm.copy()
    relaxed(document, 30, style)
    now = document.dots.constraint == ON_CURVE
    assert abs(int(now.sum()) - n) <= 0.05 * n
    moved = np.hypot(*(document.dots.position_mm - before).T)[now]
    assert np.median(moved) < 0.1


def test_what_is_sent_where_it_cannot_go_is_taken_back():
    lines = (line(STRAIGHT),)
    points = np.array([(20.0, 30.4), (30.0, 30.2), (40.0, 31.0)])
    met = MetLines(lines, (0,), np.full(3, -1, np.int32), np.zeros(3), np.ones(3, bool))
    chooser = OnLines(met, points, [shapely.box(0, 0, *SIZE)])
    sent = chooser(points, points.copy())
    assert chooser.line[1] == 0
    stays = sent.copy()
    stays[1] = points[1]
    chooser.take_back_refused(stays)
    assert chooser.line[1] == -1
    again = chooser(stays, stays.copy())
    assert np.array_equal(again[1], points[1])  # it is not asked once more
