"""The formula of outlines: area kept, closed, free of crossings; against plain trigonometry."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import LinearRing, Polygon

from stippler.drawing.dots import MAX_ELONGATION, Dots
from stippler.errors import ParameterError
from stippler.kernels.shapes import dot_shape

shapes = st.fixed_dictionaries(
    {
        "radius": st.floats(0.0625, 50, width=32),
        "elongation": st.floats(1, MAX_ELONGATION, width=32),
        "angle": st.floats(-10, 10, width=32),
        "roughness": st.floats(0, 1, width=32),
        "seed": st.integers(0, 2**32 - 1),
    }
)


def one(radius=1.0, elongation=1.0, angle=0.0, roughness=0.0, seed=1, at=(0.0, 0.0)) -> Dots:
    dots = Dots.round([at], radius)
    dots.elongation[:], dots.angle_rad[:] = elongation, angle
    dots.roughness[:], dots.seed[:] = roughness, seed
    return dots


def reference_radius(phi: np.ndarray, roughness: float, seed: int) -> np.ndarray:
    """Follow the docstring of `dot_shape` word by word, in Python's integers."""

    def mixed(x: int) -> int:
        x ^= x >> 16
        x = x * 0x7FEB352D % 2**32
        x ^= x >> 15
        x = x * 0x846CA68B % 2**32
        return x ^ (x >> 16)

    vectors = []
    for i, weight in enumerate(dot_shape.WEIGHTS):
        h = mixed((seed + (i + 1) * 0x9E3779B9) % 2**32)
        vectors.append(((h % 65536) / 32767.5 - 1, (h // 65536) / 32767.5 - 1, weight))
    total = sum(math.hypot(x, y) * w for x, y, w in vectors) + 1e-6
    squared = np.ones_like(phi)
    for k, (x, y, w) in enumerate(vectors, 2):
        share = w * roughness * dot_shape.MAX_ROUGH / total
        squared += share * (x * np.cos(k * phi) + y * np.sin(k * phi))
    return np.sqrt(squared)


@given(shapes)
def test_outline_follows_the_formula(shape):
    n = 48
    traced = dot_shape.outlines(one(**shape, at=(3.0, -7.0)), n)[0]
    phi = np.arange(n) * 2 * np.pi / n
    r = reference_radius(phi, np.float32(shape["roughness"]), shape["seed"]) * shape["radius"]
    root = math.sqrt(shape["elongation"])
    along, across = r * np.cos(phi) * root, r * np.sin(phi) / root
    c, s = math.cos(shape["angle"]), math.sin(shape["angle"])
    expected = np.column_stack([3 + along * c - across * s, -7 + along * s + across * c])
    np.testing.assert_allclose(traced, expected, atol=1e-6 * shape["radius"])


@given(shapes)
def test_area_is_that_of_the_round_dot(shape):
    polygon = Polygon(dot_shape.outlines(one(**shape), 2048)[0])
    assert math.isclose(polygon.area, math.pi * shape["radius"] ** 2, rel_tol=2e-5)


@given(shapes)
def test_outline_is_simple_and_runs_from_x_towards_y(shape):
    ring = LinearRing(dot_shape.outlines(one(**shape), 512)[0])
    assert ring.is_simple
    assert ring.is_ccw  # in coordinates with y up, so clockwise on the page


@given(shapes, st.floats(-3, 3, width=32))
def test_turning_a_dot_turns_its_outline(shape, turn):
    before = dot_shape.outlines(one(**shape), 32)[0]
    turned = one(**shape)
    turned.angle_rad += np.float32(turn)
    by = float(turned.angle_rad[0]) - shape["angle"]
    rotation = np.array([[math.cos(by), -math.sin(by)], [math.sin(by), math.cos(by)]])
    after = dot_shape.outlines(turned, 32)[0]
    np.testing.assert_allclose(after, before @ rotation.T, atol=1e-5 * shape["radius"])


@given(shapes)
def test_a_smooth_dot_is_mirrored_by_its_angle(shape):
    shape |= {"roughness": 0.0}
    up = dot_shape.outlines(one(**shape), 32)[0]
    down = dot_shape.outlines(one(**(shape | {"angle": -shape["angle"]})), 32)[0]
    mirrored = np.roll(up[::-1], 1, axis=0) * (1, -1)
    np.testing.assert_allclose(down, mirrored, atol=1e-6 * shape["radius"])


@given(shapes)
def test_extremes_stay_within_the_stated_reach(shape):
    away = np.hypot(*dot_shape.outlines(one(**shape), 256)[0].T) / shape["radius"]
    reach = math.sqrt(shape["elongation"] * (1 + dot_shape.MAX_ROUGH * shape["roughness"]))
    assert away.max() <= reach * (1 + 1e-6)
    assert away.min() > 0.1


def bezier_points(chain: np.ndarray, per_segment: int) -> np.ndarray:
    a, b, c = (chain[k::3, None] for k in range(3))
    d = np.roll(a, -1, axis=0)
    t = (np.arange(per_segment) / per_segment)[None, :, None]
    u = 1 - t
    return (u**3 * a + 3 * u * u * t * b + 3 * u * t * t * c + t**3 * d).reshape(-1, 2)


@given(shapes, st.sampled_from([4, 8, 12, 32]))
def test_bezier_chain_is_smooth_and_passes_the_outline(shape, n):
    dots = one(**shape)
    chain = dot_shape.bezier_outlines(dots, n)[0]
    np.testing.assert_allclose(
        chain[::3], dot_shape.outlines(dots, n)[0], atol=1e-9 * shape["radius"]
    )
    before = chain[::3] - np.roll(chain[2::3], 1, axis=0)
    after = chain[1::3] - chain[::3]
    np.testing.assert_allclose(before, after, atol=1e-9 * shape["radius"])


def test_four_segments_make_an_ellipse():
    dots = one(radius=1.0, elongation=2.0)
    x, y = bezier_points(dot_shape.bezier_outlines(dots, 4)[0], 50).T
    away = np.hypot(x / math.sqrt(2), y * math.sqrt(2))
    np.testing.assert_allclose(away, 1.0, atol=3e-4)


def test_seeds_and_harmonics_differ():
    outlines = [dot_shape.outlines(one(roughness=1.0, seed=s), 64)[0] for s in range(50)]
    for a, b in itertools.pairwise(outlines):
        assert np.abs(a - b).max() > 0.05


def test_rough_dots_are_rough_by_the_same_measure():
    dots = Dots.round(np.zeros((500, 2)), 1.0)
    dots.roughness[:] = 1
    away = np.hypot(*np.moveaxis(dot_shape.outlines(dots, 128), 2, 0))
    spread = away.std(axis=1)
    assert 0.08 < np.median(spread) < 0.2
    assert spread.min() > 0.05


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("elongation", 0.99),
        ("elongation", 4.01),
        ("elongation", math.nan),
        ("roughness", -0.01),
        ("roughness", 1.01),
        ("angle", math.inf),
        ("angle", math.nan),
    ],
)
def test_shapes_outside_the_range_are_refused(name, value):
    with pytest.raises(ParameterError, match=name):
        dot_shape.outlines(one(**{name: value}))


def test_the_range_itself_is_taken():
    dot_shape.check_shapes([1.0, MAX_ELONGATION], [-100.0, 100.0], [0.0, 1.0])


def test_too_few_points_are_refused():
    with pytest.raises(ParameterError):
        dot_shape.outlines(one(), 2)
    with pytest.raises(ParameterError):
        dot_shape.bezier_outlines(one(), 2)


def test_no_dots_have_no_outlines():
    assert dot_shape.outlines(Dots.none(), 16).shape == (0, 16, 2)
