"""Paths: stamps by arc length and ticks by time, however often the pointer was looked at."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.brushes.stroke_path import (
    PointerSample,
    Rope,
    Spacer,
    Ticker,
    Window,
    between,
    smoothing_of,
)

CORNERS = st.lists(
    st.tuples(st.floats(0, 50), st.floats(0, 50)), min_size=2, max_size=6, unique=True
)


def path(corners, n):
    """The same path, looked at n times between corners; even in time."""
    samples = [PointerSample(*corners[0], t=0.0)]
    for k, (a, b) in enumerate(itertools.pairwise(corners)):
        p, q = PointerSample(*a, t=float(k)), PointerSample(*b, t=k + 1.0)
        samples += [between(p, q, (i + 1) / n) for i in range(n)]
    return samples


def stamps(pacer, samples):
    return [stamp for sample in samples for stamp in pacer.feed(sample)]


def places(things):
    return np.array([(thing.x, thing.y) for thing in things])


@given(CORNERS, st.integers(1, 30), st.floats(0.3, 5))
def test_stamps_do_not_depend_on_the_event_rate(corners, n, spacing):
    length = sum(math.dist(a, b) for a, b in itertools.pairwise(corners))
    few = stamps(Spacer(spacing), path(corners, 1))
    many = stamps(Spacer(spacing), path(corners, n))
    least = min(len(few), len(many))
    assert abs(len(few) - len(many)) <= 1  # a stamp at the very end may be lost to rounding
    assert abs(len(few) - (1 + length / spacing)) <= 1 + 1e-6
    assert np.allclose(places(few)[:least], places(many)[:least], atol=1e-6)
    steps = np.hypot(*np.array([(s.dx, s.dy) for s in few]).T)
    assert (steps <= spacing * (1 + 1e-9)).all()


@given(CORNERS, st.integers(1, 30), st.sampled_from([1 / 60, 0.11]))
def test_ticks_do_not_depend_on_the_event_rate(corners, n, step):
    few = stamps(Ticker(step), path(corners, 1))
    many = stamps(Ticker(step), path(corners, n))
    least = min(len(few), len(many))
    assert abs(len(few) - len(many)) <= 1
    assert np.allclose(places(few)[:least], places(many)[:least], atol=1e-6)
    assert abs(len(few) - (1 + (len(corners) - 1) / step)) <= 1


def test_ticks_go_on_while_the_pointer_rests():
    ticker = Ticker(0.1)
    first = list(ticker.feed(PointerSample(1, 2, t=0.0)))
    rest = [stamp for k in range(1, 101) for stamp in ticker.rest(k * 0.01)]
    assert len(first) == 1
    assert len(rest) in (9, 10)
    assert {(stamp.x, stamp.y) for stamp in rest} == {(1, 2)}
    assert not list(ticker.rest(0.5))  # time does not go back


@given(CORNERS, st.integers(2, 30))
def test_a_window_does_not_depend_on_the_event_rate(corners, n):
    def followed(samples):
        window = Window(4.0)
        points = [p for s in samples for p in window.feed(s)]
        return points + list(window.end())

    few, many = followed(path(corners, 1)), followed(path(corners, n))
    least = min(len(few), len(many)) - 17
    if least > 0:
        assert np.allclose(places(few)[:least], places(many)[:least], atol=1e-6)
    assert np.allclose(places(few)[-1], corners[-1])


@given(CORNERS, st.integers(1, 30))
def test_a_rope_is_never_longer_than_it_is(corners, n):
    rope = Rope(3.0)
    for sample in path(corners, n):
        (at,) = rope.feed(sample)
        assert math.dist((at.x, at.y), (sample.x, sample.y)) <= 3.0 + 1e-9


def test_a_loose_rope_moves_nothing_and_a_window_calms():
    rope = smoothing_of("rope", 5.0)
    list(rope.feed(PointerSample(0, 0)))
    assert next(iter(rope.feed(PointerSample(3, 3)))).x == 0
    zigzag = [PointerSample(k * 0.5, (-1.0) ** k, t=k * 0.01) for k in range(100)]
    window = Window(20.0)
    calm = [p for s in zigzag for p in window.feed(s)]
    assert max(abs(p.y) for p in calm[40:]) < 0.3


@pytest.mark.parametrize(("kind", "length"), [("none", 3.0), ("rope", 0.0), ("window", 0.0)])
def test_no_smoothing_follows_the_pointer(kind, length):
    samples = path([(0, 0), (3, 4)], 5)
    smoothing = smoothing_of(kind, length)
    assert [p for s in samples for p in smoothing.feed(s)] == samples
    assert not list(smoothing.end())
