"""The overlaps of many dots are found beside the frames; what ends up on screen is the same."""

from itertools import pairwise

import numpy as np
import pytest

from stippler.drawing.dots import Dots
from stippler.kernels.shapes import gpu_dots
from stippler.render.dot_buffer import DotBuffer

N = 31_000  # more than are weighed at once
ORIGIN = (50.0, 50.0)
NONE_SELECTED = np.zeros(N, np.bool_)


def dots_of(seed: int, n: int = N) -> Dots:
    rng = np.random.default_rng(seed)
    return Dots.round(rng.uniform(0, 100, (n, 2)), rng.uniform(0.1, 0.6, n))


def shares_by_row(buffer: DotBuffer) -> np.ndarray:
    on_gpu = np.frombuffer(buffer.gl.read(buffer.n * 24), np.uint32).reshape(-1, 6)
    return gpu_dots.shares_in(on_gpu)[buffer._slot_of_row]


def weighed_at_once(ctx, dots: Dots) -> np.ndarray:
    buffer = DotBuffer(ctx)
    buffer.set(dots, np.zeros(len(dots), np.bool_), ORIGIN)
    buffer.find_shares()
    assert not buffer.is_weighing
    shares = shares_by_row(buffer)
    buffer.release()
    return shares


@pytest.fixture
def live(ctx):
    buffer = DotBuffer(ctx, live=True)
    buffer.set(dots_of(1), NONE_SELECTED, ORIGIN)
    buffer.find_shares()  # there are none to keep: at once
    assert not buffer.is_weighing
    yield buffer
    buffer.release()


def wait_for(buffer: DotBuffer) -> None:
    assert buffer.is_weighing
    buffer._weighing._thread.join()
    assert buffer.take_shares()
    assert not buffer.is_weighing


def test_dots_keep_their_shares_until_the_new_ones_are_found(ctx, live):
    before, moved = weighed_at_once(ctx, dots_of(1)), weighed_at_once(ctx, dots_of(2))
    assert np.array_equal(shares_by_row(live), before)
    live.set(dots_of(2), NONE_SELECTED, ORIGIN)
    assert np.array_equal(shares_by_row(live), before)
    live.find_shares()
    assert np.array_equal(shares_by_row(live), before)
    wait_for(live)
    assert np.array_equal(shares_by_row(live), moved)
    assert not np.array_equal(before, moved)
    live.find_shares()
    assert not live.is_weighing  # they are known


def test_what_a_run_has_settled_is_weighed_so_too(ctx, live):
    dots = dots_of(2)
    live.set_positions(dots.position_mm, dots.radius_mm, ORIGIN, settled=True)
    live.find_shares()
    wait_for(live)
    assert np.array_equal(shares_by_row(live), weighed_at_once(ctx, dots))


def test_a_stroke_meanwhile_counts_whole_and_moves_no_share(ctx, live):
    dots = dots_of(2)
    live.set(dots, NONE_SELECTED, ORIGIN)
    live.find_shares()
    fewer = dots.take(np.arange(N - 40))
    rows = np.arange(100, 160)
    fewer.radius_mm[rows] = 0.05
    live.update(fewer, rows, NONE_SELECTED[: N - 40], ORIGIN)
    wait_for(live)
    expected = weighed_at_once(ctx, dots)[: N - 40]
    found, others = shares_by_row(live), np.ones(N - 40, np.bool_)
    others[rows] = False
    closed = others & (found != expected)
    assert np.all(found[rows] == 1.0)
    assert closed.sum() <= 40  # the last rows, which have moved into the gaps
    assert np.all(found[closed] == 1.0)


def test_another_number_of_dots_is_weighed_at_once(ctx, live):
    other = dots_of(3, N + 500)
    live.set(other, np.zeros(N + 500, np.bool_), ORIGIN)
    live.find_shares()
    assert not live.is_weighing
    assert np.array_equal(shares_by_row(live), weighed_at_once(ctx, other))


def test_a_run_drops_what_is_being_weighed(ctx, live):
    dots = dots_of(2)
    live.set(dots, NONE_SELECTED, ORIGIN)
    live.find_shares()
    live.set_positions(dots.position_mm, dots.radius_mm, ORIGIN, settled=False)
    assert not live.take_shares()
    live.find_shares()
    assert not live.is_weighing


def test_revisions_grow_when_shares_arrive(live):
    seen = [live.revision]
    live.set(dots_of(2), NONE_SELECTED, ORIGIN)
    seen.append(live.revision)
    live.find_shares()
    wait_for(live)
    seen.append(live.revision)
    assert all(a < b for a, b in pairwise(seen))
