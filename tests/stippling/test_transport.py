"""Transport: long waves of dots evened out at once."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import contains_xy
from shapely.geometry import box

from stippler.analysis.grain import measure_grain
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.pipeline import run
from stippler.stippling.relax import Relaxation
from stippler.stippling.task import RELAX, Standing, Task
from stippler.stippling.transport import evened_out, with_long_waves_gone


def off_by(points, wanted, pixel, cells=8):
    """How far the dots in each of 8 x 8 cells are off what is wanted there, over chance."""
    h, w = wanted.shape
    asked = wanted.reshape(cells, h // cells, cells, w // cells).sum(axis=(1, 3))
    asked = asked * (len(points) / asked.sum())
    found, *_ = np.histogram2d(
        points[:, 1], points[:, 0], cells, [[0, h * pixel], [0, w * pixel]]
    )  # fmt: skip
    return np.sqrt(np.mean((found - asked) ** 2 / np.maximum(asked, 1.0)))


def ramp(size=160):
    x = np.linspace(0.1, 1.0, size)
    return np.outer(np.ones(size), x)


@pytest.mark.parametrize("wanted", [np.ones((80, 80)), ramp()])
def test_dots_by_chance_come_to_be_as_many_as_are_wanted(wanted):
    pixel = 100.0 / len(wanted)
    points = np.random.default_rng(3).random((8_000, 2)) * 100.0
    if wanted.min() < 1.0:  # chance, but with the density that is wanted
        points[:, 0] = 100.0 * (np.sqrt(0.01 + 0.99 * points[:, 0] / 100.0) - 0.1) / 0.9
    before, after = (off_by(p, wanted, pixel) for p in (points, evened_out(points, wanted, pixel)))
    assert before == pytest.approx(1.0, abs=0.2)
    assert after < 0.35


def test_a_wave_of_the_whole_page_goes_at_once():
    points = np.random.default_rng(4).random((5_000, 2)) * [[50.0, 50.0]]
    points[:, 0] = 25.0 + (points[:, 0] - 25.0) * (1.0 - 0.12 * (1 - abs(points[:, 0] - 25) / 25))
    moved = evened_out(points, np.ones((50, 50)))
    left = [np.mean(abs(p[:, 0] - 25.0) < 5.0) for p in (points, moved)]
    assert abs(left[1] - 0.2) < 0.25 * abs(left[0] - 0.2)


def test_relaxed_dots_from_chance_have_no_clouds():
    points = np.random.default_rng(1).random((10_000, 2)) * 100.0
    clouds = []
    for start in (points, evened_out(points, np.ones((100, 100)))):
        engine = Relaxation(start, box(0, 0, 100, 100), method="even")
        for _ in range(15):
            engine.step()
        clouds.append(measure_grain(np.asarray(engine.points)).clouds)
    assert clouds[0] > 0.002 > 0.001 > clouds[1]


def test_nothing_flows_through_white_or_onto_it():
    wanted = np.ones((60, 100))
    wanted[:, 50:60] = 0.0
    rng = np.random.default_rng(2)
    points = np.vstack([rng.random((1_000, 2)) * [49.0, 60.0],
                        [60.5, 0.0] + rng.random((300, 2)) * [39.0, 60.0]])  # fmt: skip
    moved = evened_out(points, wanted)
    assert np.array_equal(moved[:, 0] < 55.0, points[:, 0] < 55.0)
    assert not ((moved[:, 0] > 50.0) & (moved[:, 0] < 60.0)).any()
    assert off_by(moved[:1_000], wanted[:48, :48], 1.0) < off_by(
        points[:1_000], wanted[:48, :48], 1.0
    )


def test_held_dots_stay_and_the_others_make_up_for_them():
    rng = np.random.default_rng(5)
    points = rng.random((3_000, 2)) * 60.0
    held = rng.random(3_000) < 0.3
    moved = evened_out(points, np.ones((60, 60)), held=held)
    assert np.array_equal(moved[held], points[held])
    assert off_by(moved, np.ones((64, 64)), 60 / 64) < 0.6 * off_by(
        points, np.ones((64, 64)), 60 / 64
    )


def relaxed(points, radii, outlines, owner, reference=None, steps=20):
    standing = Standing(points, radii, part_of_dot=owner)
    *_, last = run(Task(Style(), reference, RELAX, tuple(outlines), standing, steps=steps))
    return np.array(last.position_mm), last.radius_mm


@pytest.mark.parametrize("darkness", [None, 0.4])
def test_relaxing_all_evens_out_a_fill_by_chance(darkness):
    points = np.random.default_rng(1).random((6_000, 2)) * 100.0
    page = box(0, 0, 100, 100)
    reference = None
    if darkness is not None:
        reference = Reference(np.full((300, 300), darkness, np.float32), 100.0)
    owner = np.zeros(len(points), np.int32)
    moved, _ = relaxed(points, np.full(6_000, 0.3, np.float32), [page], owner, reference)
    assert measure_grain(points).clouds > 0.5
    assert measure_grain(moved).clouds < 0.0012


def test_dots_that_are_even_are_left_to_relaxation():
    page = box(0, 0, 100, 100)
    points = np.random.default_rng(1).random((3_000, 2)) * 100.0
    owner, held = np.zeros(3_000, np.int32), np.zeros(3_000, np.bool_)
    even, _ = relaxed(points, np.full(3_000, 0.3, np.float32), [page], owner)
    assert np.array_equal(with_long_waves_gone(even, [page], owner, held), even)
    assert not np.array_equal(with_long_waves_gone(points, [page], owner, held), points)


def test_each_outline_keeps_its_dots():
    """Two areas of unlike density beside each other, one with a hole."""
    left = box(0, 0, 50, 60).difference(box(10, 10, 25, 25))
    right = box(50, 0, 80, 60)
    rng = np.random.default_rng(8)
    both = rng.random((6_000, 2)) * [80.0, 60.0]
    inside = [contains_xy(shape, both[:, 0], both[:, 1]) for shape in (left, right)]
    points = np.vstack([both[inside[0]], both[inside[1]][::4]])
    owner = np.repeat([0, 1], [inside[0].sum(), len(points) - inside[0].sum()])
    moved = with_long_waves_gone(points, [left, right], owner, np.zeros(len(points), np.bool_))
    for k, shape in enumerate((left, right)):
        assert contains_xy(shape, *moved[owner == k].T).all()
    assert (moved != points).any(axis=1).mean() > 0.9


@given(
    st.integers(0, 40), st.integers(1, 12), st.integers(1, 12), st.integers(0, 2**32 - 1),
    st.floats(0.01, 100.0),
)  # fmt: skip
def test_any_field_and_any_dots(n, h, w, seed, pixel):
    rng = np.random.default_rng(seed)
    wanted = np.where(rng.random((h, w)) < 0.3, 0.0, rng.random((h, w))).astype(np.float32)
    origin = (-3.0, 7.0)
    points = rng.random((n, 2)) * [w * pixel, h * pixel] + origin
    moved = evened_out(points, wanted, pixel, origin)
    assert moved.shape == points.shape
    assert np.isfinite(moved).all()
    assert (moved >= np.array(origin) - 1e-9).all()
    assert (moved - origin <= np.array([w, h]) * pixel + 1e-6).all()
    assert np.array_equal(moved, evened_out(points, wanted, pixel, origin))
