"""Stippling carried on with the dots that are there."""

from dataclasses import replace

import numpy as np
import pytest

from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.pipeline import run
from stippler.stippling.stipple import stages
from stippler.stippling.task import SETTLE, Standing, Task

STYLE = Style(n_dots=1500, iterations=12)


def carry_on(reference, style, position_mm, radius_mm, n_done):
    return run(Task(style, reference, SETTLE, (), Standing(position_mm, radius_mm), n_done))


@pytest.fixture(scope="module")
def reference() -> Reference:
    ramp = np.linspace(0, 0.8, 120, dtype=np.float32)
    return Reference(np.tile(ramp, (80, 1)), 60.0)


@pytest.fixture(scope="module")
def half_done(reference):
    return next(p for p in stages(reference, STYLE) if p.stage == "relax" and p.done == 4)


def test_as_many_steps_are_left_as_were_asked_for_and_every_dot_keeps_its_place_in_line(
    reference, half_done
):
    results = list(carry_on(reference, STYLE, half_done.position_mm, half_done.radius_mm, 4))
    assert [p.done for p in results if p.stage == "relax"] == list(range(5, 13))
    assert results[-1].stage == "done"
    last = results[-1].position_mm
    assert last.shape == half_done.position_mm.shape
    gone = np.hypot(*(last - half_done.position_mm).T)
    assert 0.0 < np.median(gone) < 1.0  # mm: dots settle, they do not change places
    assert (last >= 0).all()
    assert (last <= (60.0, 40.0)).all()


def test_the_tone_is_that_of_a_stippling_that_nobody_painted_on(reference, half_done):
    *_, alone = stages(reference, STYLE)
    *_, carried = carry_on(reference, STYLE, half_done.position_mm, half_done.radius_mm, 4)

    def ink(p, low, high):
        inside = (p.position_mm[:, 0] >= low) & (p.position_mm[:, 0] < high)
        return float(np.square(p.radius_mm[inside].astype(float)).sum())

    for low in (20, 30, 40, 50):
        assert ink(carried, low, low + 10) == pytest.approx(ink(alone, low, low + 10), rel=0.06)


def test_with_no_step_left_only_radii_are_solved(reference, half_done):
    *_, last = carry_on(
        reference, STYLE, half_done.position_mm, half_done.radius_mm, STYLE.iterations
    )
    assert np.allclose(last.position_mm, half_done.position_mm, atol=1e-6)
    assert not np.array_equal(last.radius_mm, half_done.radius_mm)


def test_without_dots_there_is_nothing_to_do(reference):
    *_, last = carry_on(reference, STYLE, np.empty((0, 2)), np.empty(0, np.float32), 0)
    assert last.stage == "done"
    assert len(last.position_mm) == 0


def test_sizes_by_region_stay_with_their_dots(reference):
    style = replace(STYLE, sizes="regions")
    made = next(p for p in stages(reference, style) if p.stage == "relax" and p.done == 4)
    *_, last = carry_on(reference, style, made.position_mm, made.radius_mm, 4)
    assert last.radius_mm == pytest.approx(made.radius_mm)
    assert not np.array_equal(last.position_mm, made.position_mm)
