"""Level of detail: tone, spacing, fixed dots and sizes when a drawing is scaled."""

import numpy as np
import pytest
import shapely

from stippler.drawing.dots import FIXED, Dots
from stippler.errors import ParameterError
from stippler.stippling.relax import Relaxation
from stippler.stippling.scale import Scaling, scaled_dots

PAGE = {0: shapely.box(0, 0, 60, 60)}


@pytest.fixture(scope="module")
def dots():
    """A ramp of dots, denser and larger to the right."""
    rng = np.random.default_rng(2)
    at = rng.random((9000, 2)) * 60
    at = at[rng.random(9000) < 0.25 + 0.75 * at[:, 0] / 60]
    engine = Relaxation(at, PAGE[0])
    engine.run(3)
    points = np.array(engine.points)
    return Dots.round(points, 0.15 + 0.1 * points[:, 0] / 60)


def ink(dots, size, n=6):
    """Return the ink of each of n x n parts, as a share of its area."""
    area = np.pi * dots.radius_mm.astype(float) ** 2
    i = np.minimum((dots.position_mm / size * n).astype(int), n - 1)
    return np.bincount(i[:, 1] * n + i[:, 0], area, n * n) / (size / n) ** 2


@pytest.mark.parametrize("n", [1500, 3000, 9000, 14_000])
def test_another_number_of_dots_keeps_the_tone(dots, n):
    found = scaled_dots(dots, PAGE, Scaling(n_dots=n))
    assert len(found) == pytest.approx(n, rel=0.01)
    assert ink(found, 60).sum() == pytest.approx(ink(dots, 60).sum(), rel=1e-3)
    assert np.abs(ink(found, 60) - ink(dots, 60)).max() < 0.03
    assert len(np.unique(found.id)) == len(found)
    assert ((found.position_mm >= 0) & (found.position_mm <= 60)).all()


def test_half_the_size_with_dots_no_smaller_than_a_pen(dots):
    half = {0: shapely.box(0, 0, 30, 30)}
    found = scaled_dots(dots, half, Scaling(0.5, least_radius_mm=0.12))
    assert len(found) < 0.8 * len(dots)
    assert np.quantile(found.radius_mm, 0.05) > 0.1
    assert np.abs(ink(found, 30, 4) - ink(dots, 60, 4)).max() < 0.03


def test_size_alone_scales_all(dots):
    found = scaled_dots(dots, PAGE, Scaling(2.0))
    assert np.array_equal(found.position_mm, dots.position_mm * 2)
    assert np.allclose(found.radius_mm, dots.radius_mm * 2)
    assert np.array_equal(found.id, dots.id)


def test_fixed_dots_stay(dots):
    held = dots.copy()
    held.constraint[::50] = FIXED
    found = scaled_dots(held, PAGE, Scaling(n_dots=2500))
    kept = {tuple(p) for p in found.position_mm[found.fixed].tolist()}
    assert kept == {tuple(p) for p in held.position_mm[held.fixed].tolist()}


def test_dots_are_as_far_apart_as_relaxation_leaves_them(dots):
    from scipy.spatial import cKDTree

    found = scaled_dots(dots, PAGE, Scaling(n_dots=2000))
    near = cKDTree(found.position_mm).query(found.position_mm, k=2)[0][:, 1]
    around = cKDTree(found.position_mm).query(found.position_mm, k=7)[0][:, 1:].mean(axis=1)
    assert np.quantile(near / around, 0.01) > 0.45


def test_bad_values_are_refused():
    for values in ({"factor": 0.0}, {"n_dots": 0}, {"least_radius_mm": float("nan")}):
        with pytest.raises(ParameterError):
            Scaling(**values)


def test_no_dots_are_no_trouble():
    assert len(scaled_dots(Dots.none(), PAGE, Scaling(0.5))) == 0
