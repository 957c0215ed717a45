"""*Relax all* keeps the tone of a finished drawing, and what a person has set."""

import numpy as np
import pytest
import shapely
from scipy.spatial import KDTree
from shapely.geometry import Point, box

from stippler.analysis.tone_error import measure_tone
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.pipeline import run
from stippler.stippling.stipple import stages
from stippler.stippling.task import RELAX, STIPPLE, Standing, Task

W = 100.0
PAGE = box(0.0, 0.0, W, W)


@pytest.fixture(scope="module")
def made():
    """A drawing of smooth tones and an edge, and its reference."""
    reference = Reference(with_an_edge().astype(np.float32), W)
    *_, last = stages(reference, Style(n_dots=4000), snapshots=False)
    return reference, np.array(last.position_mm), np.array(last.radius_mm)


def pressed(reference, position, radius, fixed=None, steps=20):
    standing = Standing(position, radius, fixed)
    *_, last = run(Task(Style(), reference, RELAX, (PAGE,), standing, steps=steps))
    return np.array(last.position_mm), last.radius_mm


def tone_error(reference, position, radius):
    px = 240 / W
    error = measure_tone(position * px, radius.astype(float) * px, reference.darkness)
    return error.tone_rmse


def with_an_edge():
    """Smooth tones and an edge."""
    y, x = np.mgrid[0:240, 0:240] / 240.0
    darkness = 0.1 + 0.7 * x * (0.6 + 0.4 * np.sin(7 * y))
    darkness[60:120, 60:150] = 0.8
    return np.clip(darkness, 0, 1)


def coins():
    """Discs of several tones on a darker ground, as coins lie."""
    y, x = np.mgrid[0:240, 0:240] / 240.0
    darkness = 0.55 + 0.2 * y
    for k, (u, v) in enumerate(((0.2, 0.25), (0.55, 0.2), (0.8, 0.6), (0.4, 0.65))):
        off = np.hypot(x - u, y - v)
        darkness = np.where(off < 0.15, 0.12 + 0.1 * k + 0.1 * np.cos(40 * off), darkness)
    return darkness


@pytest.mark.parametrize("area", [None, Point(45, 55).buffer(30)], ids=["page", "area"])
@pytest.mark.parametrize("picture", [with_an_edge, coins])
def test_pressed_ten_times_it_keeps_the_tone_and_changes_nothing_more(picture, area):
    darkness, n_dots = picture(), 4000
    if area is not None:
        x, y = (np.mgrid[0:240, 0:240][::-1] + 0.5) * (W / 240)
        darkness, n_dots = darkness * shapely.intersects_xy(area, x, y), 1500
    reference = Reference(darkness.astype(np.float32), W)
    parts = () if area is None else (area,)
    *_, last = run(Task(Style(n_dots=n_dots), reference, STIPPLE, parts), snapshots=False)
    position, radius, moves = last.position_mm, last.radius_mm, []
    before = tone_error(reference, position, radius)
    for _ in range(10):
        standing = Standing(position, radius)
        *_, last = run(Task(Style(), reference, RELAX, parts or (PAGE,), standing, steps=20))
        moves.append(np.hypot(*(last.position_mm - position).T))
        position, radius = last.position_mm, last.radius_mm
    assert tone_error(reference, position, radius) <= 1.005 * before
    assert moves[-1].max() == 0.0


def test_dots_spoilt_by_hand_are_evened_out_and_true_again(made):
    reference, position, radius = made
    rng = np.random.default_rng(3)
    mine = np.flatnonzero(np.hypot(*(position - [30, 70]).T) < 12)
    spoilt = position.copy()
    spoilt[mine] += rng.normal(0, 0.4, (len(mine), 2))
    moved, sizes = pressed(reference, spoilt, radius)
    assert tone_error(reference, moved, sizes) <= 1.02 * tone_error(reference, position, radius)
    apart = [KDTree(p).query(p[mine], k=2)[0][:, 1].min() for p in (position, spoilt, moved)]
    assert apart[2] > 0.8 * apart[0] > 1.5 * apart[1]


def test_sizes_that_a_person_has_set_stay(made):
    reference, position, radius = made
    mine = np.hypot(*(position - [70, 40]).T) < 10
    own = radius.copy()
    own[mine] *= np.float32(1.4)
    fixed = np.zeros(len(position), bool)
    fixed[::9] = True
    moved, sizes = pressed(reference, position, own, fixed)
    assert (sizes[mine] == own[mine]).all()
    assert (moved[fixed] == position[fixed]).all()
    assert tone_error(reference, moved, sizes) < tone_error(reference, position, own)


def test_without_a_picture_dots_even_out_and_keep_their_sizes():
    rng = np.random.default_rng(5)
    position, radius = rng.random((500, 2)) * W, np.full(500, 0.3, np.float32)
    moved, sizes = pressed(None, position, radius, steps=400)
    assert (sizes == radius).all()
    assert KDTree(moved).query(moved, k=2)[0][:, 1].min() > 0.6 * W / np.sqrt(500)
