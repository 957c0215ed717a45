"""Strokes of every type of brush on a drawing: what holds for all, and what each does."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from stippler.brushes import effects
from stippler.brushes.brush import Brush
from stippler.brushes.kinds import KINDS
from stippler.brushes.local_cells import areas_of, centroids_of
from stippler.brushes.stroke import Stroke
from stippler.brushes.stroke_path import PointerSample
from stippler.brushes.tip import Tip
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.errors import ParameterError
from stippler.stippling.relax import Relaxation

NAMES = [f.name for f in fields(Dots)]
PAINTING = [kind.name for kind in KINDS if kind.rhythm != "select"]
HARD = Tip(hardness=1.0)


def make_editing(n=600, seed=1, hole=False):
    rng = np.random.default_rng(seed)
    drawing = Drawing.blank(Page(40, 30))
    ramp = np.tile(np.linspace(0, 1, 80, dtype=np.float32), (60, 1))
    drawing.reference = Reference(ramp, 40.0)
    points = rng.uniform(0, 1, (n, 2)) * (40, 30)
    if hole:
        ring = Polygon(
            [(0, 0), (40, 0), (40, 30), (0, 30)], [[(18, 13), (22, 13), (22, 17), (18, 17)]]
        )
        drawing.areas = {0: Area("ring", ring)}
        points = points[(np.abs(points - (20, 15)) > 2.001).any(axis=1)]
    drawing.dots = Dots.round(points, rng.uniform(0.1, 0.3, len(points)))
    drawing.dots.constraint[:] = rng.uniform(size=len(points)) < 0.1
    return Document(drawing)


def choices(kind):
    drawn = {}
    for p in kind.parameters:
        if p.values:
            drawn[p.name] = st.sampled_from(p.values)
        elif isinstance(p.default, bool):
            drawn[p.name] = st.booleans()
        else:
            drawn[p.name] = st.floats(p.low, min(p.high, 400))
    return st.fixed_dictionaries(drawn)


TIPS = st.builds(Tip, st.sampled_from(["circle", "ellipse", "square"]), st.floats(0, 1))
TOOLES = st.sampled_from(PAINTING).flatmap(
    lambda name: st.builds(
        Brush,
        name=st.just(name),
        kind=st.just(name),
        radius_mm=st.floats(0.5, 8),
        tip=TIPS,
        smoothing=st.sampled_from(["none", "rope", "window"]),
        values=choices(next(kind for kind in KINDS if kind.name == name)),
    )
)
PATHS = st.lists(
    st.tuples(st.floats(-2, 42), st.floats(-2, 32), st.floats(0.1, 1)), min_size=1, max_size=5
)


def draw(document, brush, corners, seed=1, end=True):
    samples = [PointerSample(x, y, p, t=0.1 * k) for k, (x, y, p) in enumerate(corners)]
    stroke = Stroke(document, brush, samples[0], seed)
    for sample in samples[1:]:
        stroke.follow(sample)
    stroke.rest(samples[-1].t + 0.1)
    if end:
        stroke.commit(replace(samples[-1], t=samples[-1].t + 0.1))
    return stroke


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in NAMES)


@settings(max_examples=120)
@given(TOOLES, PATHS, st.booleans(), st.integers(0, 5))
def test_whatever_a_brush_does_can_be_taken_back_and_keeps_the_rules(brush, corners, hole, seed):
    document = make_editing(hole=hole)
    start = document.dots.copy()
    draw(document, brush, corners, seed)
    dots = document.dots
    end = dots.copy()
    assert len(np.unique(dots.id)) == len(dots)
    assert (document.partition.area_at(dots.position_mm) == dots.area).all()
    stay = np.isin(dots.id, start.id[start.fixed])
    old = start.take(np.searchsorted(start.id, dots.id[stay]))
    assert np.array_equal(dots.position_mm[stay], old.position_mm)
    assert np.isfinite(dots.radius_mm).all()
    assert (dots.radius_mm > 0).all()
    assert ((dots.elongation >= 1) & (dots.elongation <= 4)).all()
    assert ((dots.roughness >= 0) & (dots.roughness <= 1)).all()
    n_steps = len(document.history.steps)
    assert n_steps == (0 if same(start, end) else 1)
    if n_steps:
        document.undo()
        assert same(document.dots, start)
        document.redo()
        assert same(document.dots, end)
        document.undo()
    draw(document, brush, corners, seed, end=False).cancel()
    assert same(document.dots, start)
    again = make_editing(hole=hole)
    draw(again, brush, corners, seed)
    assert same(again.dots, end)


@pytest.mark.parametrize("kind", [name for name in PAINTING if name not in ("add", "spray")])
def test_dots_away_from_the_stroke_stay_as_they_are(kind):
    document = make_editing()
    start = document.dots.copy()
    draw(document, Brush(kind, kind, radius_mm=3.0), [(10, 10, 1), (14, 12, 1)])
    there = document.rows(start.id)
    spine = np.array([(10 + 4 * t, 10 + 2 * t) for t in np.linspace(0, 1, 200)])
    away = np.hypot(*(start.position_mm[:, None] - spine).transpose(2, 0, 1)).min(axis=1) > 3.01
    assert same(start.take(away), document.dots.take(there[away]))
    assert not same(start, document.dots)


@pytest.mark.parametrize("kind", list(effects.EFFECTS))
def test_a_failing_effect_takes_its_stroke_back(kind, monkeypatch):
    document = make_editing()
    start = document.dots.copy()
    calls = []
    effect = effects.EFFECTS[kind]

    def failing(touch):
        calls.append(touch)
        if len(calls) == 2:
            raise RuntimeError("broken")
        effect(touch)

    monkeypatch.setitem(effects.EFFECTS, kind, failing)
    stroke = Stroke(document, Brush(kind, kind), PointerSample(10, 10), 1)
    if kind in ("add", "remove"):
        assert len(calls) == 1
        return
    with pytest.raises(RuntimeError):
        stroke.follow(PointerSample(20, 10, t=0.5))
    assert same(document.dots, start)
    assert not document.in_stroke


def test_spray_adds_by_time_and_keeps_a_distance():
    for n_looks in (1, 7, 60):
        document = make_editing(0)
        values = {"per_s": 120.0, "apart_mm": 0.0}
        brush = Brush("s", "spray", tip=HARD, values=values)
        stroke = Stroke(document, brush, PointerSample(20, 15), 3)
        for k in range(n_looks):
            stroke.rest((k + 1) / n_looks)
        stroke.commit(PointerSample(20, 15, t=1.0))
        assert abs(len(document.dots) - 120) <= 4
        assert np.hypot(*(document.dots.position_mm - (20, 15)).T).max() <= 4.0
    document = make_editing(0)
    draw(document, replace(brush, values={"per_s": 2000.0, "apart_mm": 0.7}), [(20, 15, 1)] * 5)
    position = document.dots.position_mm
    between = np.hypot(*(position[:, None] - position).transpose(2, 0, 1))
    np.fill_diagonal(between, np.inf)
    assert len(position) > 20
    assert between.min() >= 0.7


def test_spray_by_tone_puts_fewer_dots_where_the_picture_is_light():
    document = make_editing(0)
    values = {"per_s": 4000.0, "apart_mm": 0.0, "by_tone": True}
    brush = Brush("s", "spray", radius_mm=15.0, tip=HARD, values=values)
    draw(document, brush, [(20, 15, 1)] * 10)
    x = document.dots.position_mm[:, 0]
    lean = 4 * 15 / (3 * math.pi) / 40  # of a half disc's darkness from its middle's
    assert (x > 20).mean() == pytest.approx(0.5 + lean, abs=0.04)


def test_thinning_removes_by_time():
    document = make_editing(5000)
    stroke = Stroke(document, Brush("t", "thin", values={"per_s": 60.0}), PointerSample(20, 15), 1)
    stroke.rest(1.0)
    stroke.commit(PointerSample(20, 15, t=1.0))
    assert abs(5000 - len(document.dots) - 60) <= 2


def test_erasing_leaves_no_dot_under_the_path():
    document = make_editing(5000)
    draw(document, Brush("e", "erase", tip=HARD, spacing=0.1), [(5, 15, 1), (35, 15, 1)])
    x, y = document.dots.position_mm.T
    assert not ((x > 5) & (x < 35) & (np.abs(y - 15) < 3.9)).any()
    assert ((np.abs(y - 15) > 4) & (x > 5) & (x < 35)).any()


def test_growing_and_shrinking_take_each_other_back():
    document = make_editing()
    start = document.dots.radius_mm.copy()
    larger = Brush("b", "size", values={"how": "enlarge", "amount": 10.0})
    draw(document, larger, [(10, 10, 1), (30, 20, 1)])
    assert (document.dots.radius_mm >= start).all()
    assert document.dots.radius_mm.max() > start.max()
    draw(document, larger.with_value("how", "reduce"), [(10, 10, 1), (30, 20, 1)])
    assert np.allclose(document.dots.radius_mm, start, rtol=1e-5)


def test_sizes_are_set_under_a_hard_tip():
    document = make_editing()
    brush = Brush("b", "size", tip=HARD, values={"how": "set", "dot_mm": 0.5})
    draw(document, brush, [(20, 15, 1)])
    under = np.hypot(*(document.dots.position_mm - (20, 15)).T) <= 4.0
    assert (document.dots.radius_mm[under] == 0.5).all()
    assert (document.dots.radius_mm[~under] < 0.5).all()


def test_sizes_follow_the_tone():
    document = make_editing(4000)
    brush = Brush("b", "size", 8.0, tip=HARD, values={"how": "tone", "amount": 100.0})
    draw(document, brush, [(20, 15, 1)])
    under = np.hypot(*(document.dots.position_mm - (20, 15)).T) <= 7.5
    ink = (math.pi * document.dots.radius_mm[under].astype(float) ** 2).sum()
    assert ink / (math.pi * 7.5**2) == pytest.approx(0.5, abs=0.05)  # the ramp's darkness there


def test_relaxing_is_a_step_of_lloyd():
    document = make_editing(1500)
    start = document.dots.copy()
    stroke = Stroke(document, Brush("r", "relax", 6.0, tip=HARD), PointerSample(15, 15), 1)
    stroke.cancel()
    document.begin("one step")
    under = np.hypot(*(start.position_mm - (15, 15)).T) <= 6.0
    rows = np.flatnonzero(under & ~start.fixed)
    page = np.array([(0, 0), (40, 0), (40, 30), (0, 30)], float)
    whole = Relaxation(start.position_mm, page, fixed=~np.isin(np.arange(1500), rows))
    assert np.allclose(areas_of(document, rows), whole.cell_areas()[rows], rtol=1e-9)
    whole.step()
    assert np.allclose(centroids_of(document, rows), whole.points[rows], atol=1e-9)
    document.cancel()
    draw(document, Brush("r", "relax", 6.0, tip=HARD), [(15, 15, 1)] * 8)
    inner = np.flatnonzero(np.hypot(*(document.dots.position_mm - (15, 15)).T) <= 4.5)
    spread = np.std(document.nearest_distances(inner, 9.0))
    before = np.flatnonzero(np.hypot(*(start.position_mm - (15, 15)).T) <= 4.5)
    assert spread < 0.75 * np.std(make_editing(1500).nearest_distances(before, 9.0))


def test_jitter_moves_no_further_than_its_share():
    document = make_editing(1500)
    start = document.dots.copy()
    brush = Brush("j", "jitter", 6.0, tip=HARD, values={"amount": 30.0})
    draw(document, brush, [(20, 15, 1)])
    under = np.flatnonzero((np.hypot(*(start.position_mm - (20, 15)).T) <= 6.0) & ~start.fixed)
    moved = np.hypot(*(document.dots.position_mm - start.position_mm)[under].T)
    mean = make_editing(1500).nearest_distances(under, 12.0).mean()
    assert 0.2 * mean < moved.max() <= 0.3 * mean * (1 + 1e-9)
    assert (moved > 0).all()


def test_pushing_takes_dots_along():
    document = make_editing(1500)
    start = document.dots.position_mm.copy()
    brush = Brush("p", "push", 3.0, tip=HARD, spacing=0.05)
    draw(document, brush, [(10, 15, 1), (20, 15, 1)])
    moved = document.dots.position_mm - start
    ahead = (np.abs(start - (10, 15)) < 1.5).all(axis=1) & ~document.dots.fixed
    assert (moved[ahead, 0] > 8.5).all()
    assert np.abs(moved[:, 1]).max() < 1e-12


def test_combing_draws_dots_onto_lines():
    document = make_editing(1500)
    values = {"teeth_mm": 1.0, "strength": 50.0}
    brush = Brush("c", "comb", 3.0, tip=HARD, spacing=0.1, values=values)
    draw(document, brush, [(5, 15, 1), (35, 15, 1)])
    x, y = document.dots.position_mm.T
    under = (x > 8) & (x < 32) & (np.abs(y - 15) < 2.3) & ~document.dots.fixed
    assert under.sum() > 50
    assert np.abs((y[under] + 0.5) % 1.0 - 0.5).max() < 0.02


def test_dots_stretch_along_stroke_angle_and_edge():
    for values, direction in (
        ({"along": "stroke"}, math.atan2(1, 2)),
        ({"along": "angle", "angle": 60.0}, math.radians(60)),
        ({"along": "edge"}, math.pi / 2),  # the ramp runs along x
    ):
        document = make_editing()
        brush = Brush("w", "shape", 4.0, HARD, values={"amount": 50.0, **values})
        draw(document, brush, [(10, 10, 1), (20, 15, 1)])
        long = document.dots.elongation > 1.2
        off = document.dots.angle_rad[long] - direction
        assert long.sum() > 20
        assert np.abs(np.sin(off)).max() < 1e-3
        draw(document, brush.with_value("how", "round"), [(10, 10, 1), (20, 15, 1)] * 4)
        assert document.dots.elongation[long].mean() < 1.2


def test_a_dot_is_dragged_and_a_fixed_one_is_not():
    document = make_editing(0)
    document.begin("two")
    document.insert(Dots.round([(10, 10), (20, 10)], 0.2))
    document.change("constraint", np.array([1]), np.array([1], np.int8))
    document.commit()
    draw(document, Brush("g", "drag"), [(10.5, 10, 1), (15.5, 20, 1)])
    draw(document, Brush("g", "drag"), [(20.5, 10, 1), (25, 25, 1)])
    assert np.allclose(document.dots.position_mm, [(15, 20), (20, 10)])


def test_going_by_a_picture_needs_one():
    document = make_editing()
    document.drawing.reference = None
    brush = Brush("b", "size", values={"how": "tone"})
    with pytest.raises(ParameterError, match="picture"):
        Stroke(document, brush, PointerSample(20, 15), 1)
    assert not document.in_stroke
