"""Pictures as levels, and weights of the compartments' windows alone."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon, box

from stippler.drawing.adjustment import Adjustment
from stippler.drawing.levels import N_LEVELS, Levels, table_of
from stippler.drawing.reference import Reference
from stippler.errors import ParameterError
from stippler.kernels.cells.field import COLUMNS, ROWS
from stippler.stippling.compartments import Compartments
from stippler.stippling.density import DensityField
from stippler.stippling.field_sums import running_sums
from stippler.stippling.picture_field import PictureField
from stippler.stippling.relax import Relaxation
from stippler.stippling.tessellation import Tessellation
from stippler.stippling.window import Window
from tests.conftest import EXAMPLES

L_SHAPE = Polygon([(2, 2), (17, 2), (17, 6), (9, 6), (9, 15), (2, 15)])


def picture(seed=1, shape=(120, 160), width=20.0):
    values = np.random.default_rng(seed).random(shape).astype(np.float32)
    values[30:50, 40:90] = 0.0
    return Reference(values, width)


def test_levels_are_near_and_only_white_is_white():
    values = np.concatenate([np.linspace(0, 1, 5000), [1e-30, 1e-7]]).astype(np.float32)[None]
    levels = Levels.rounded(values).of_pixel
    assert np.abs(levels / 65535.0 - values)[values > 1e-5].max() <= 0.51 / 65535
    assert ((levels == 0) == (values == 0)).all()
    assert levels[0, 4999] == N_LEVELS - 1
    with pytest.raises(ValueError, match="read-only"):
        levels[0, 0] = 1


def test_a_table_is_all_curves_one_after_the_other():
    change = Adjustment(brightness=0.2, gamma=1.5)
    table = table_of(change.apply, np.square)
    darkness = np.arange(N_LEVELS, dtype=np.float32) / np.float32(65535)
    np.testing.assert_allclose(table, change.apply(darkness) ** 2, rtol=1e-6)


@settings(max_examples=15 * EXAMPLES, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 12))
def test_masses_are_those_of_the_whole_picture(seed, n_parts):
    rng = np.random.default_rng(seed)
    reference = picture(seed)
    low = rng.random((n_parts, 2)) * (14, 9)
    shapes = [box(*xy, *(xy + rng.uniform(1, 6, 2))) for xy in low]
    places = [
        s.bounds[:2] + rng.random((8, 2)) * (np.subtract(s.bounds[2:], s.bounds[:2]))
        for s in shapes
    ]
    owner = np.repeat(np.arange(n_parts), 8)
    cells = Tessellation.of(
        np.concatenate(places), shapes, owner, PictureField.of(reference, [[np.square]])
    )
    whole = DensityField(np.square(reference.darkness), reference.pixel_mm)
    for k, shape in enumerate(shapes):
        alone = Tessellation.of(places[k], shape, None, whole)
        np.testing.assert_allclose(cells.mass[owner == k], alone.mass, rtol=2e-4, atol=1e-5)


def test_areas_of_different_styles_share_a_run():
    reference = picture()
    shapes = [L_SHAPE, box(10, 7, 19, 14)]
    rng = np.random.default_rng(3)
    dots = [rng.random((300, 2)) * (6, 12) + (2.5, 2.5), rng.random((200, 2)) * (9, 7) + (10, 7)]
    curves = [[np.square], [lambda d: 1.0 - d]]
    field = PictureField.of(reference, curves, [0, 1])
    engine = Relaxation(np.concatenate(dots), shapes, None, np.repeat([0, 1], [300, 200]), field)
    alone = []
    for mine, shape, curve in zip(dots, shapes, curves, strict=True):
        alone.append(Relaxation(mine, shape, density=PictureField.of(reference, [curve])))
    for one in (engine, *alone):
        one.run(5)
    expected = np.concatenate([one.points for one in alone])
    np.testing.assert_allclose(engine.points, expected, atol=1e-7)


def test_even_spacing_of_different_styles_shares_a_run():
    reference = picture()
    shapes = [box(0, 0, 9, 15), box(10, 0, 20, 15)]
    rng = np.random.default_rng(3)
    dots = [rng.random((300, 2)) * (9, 15), rng.random((200, 2)) * (10, 15) + (10, 0)]
    curves = [[np.sqrt], [np.square]]
    field = PictureField.of(reference, curves, [0, 1])
    owner = np.repeat([0, 1], [300, 200])
    engine = Relaxation(np.concatenate(dots), shapes, None, owner, field, method="even")
    engine.run(4)
    found = engine.points
    for k, (mine, shape) in enumerate(zip(dots, shapes, strict=True)):
        alone = PictureField.of(reference, [curves[k]])
        other = Relaxation(mine, shape, density=alone, method="even")
        other.run(4)
        np.testing.assert_allclose(found[owner == k], other.points, atol=1e-6)


def test_only_the_part_is_summed():
    reference = picture(shape=(600, 800))
    parts = Compartments.of([box(1, 1, 2, 2), box(15, 10, 17, 12)])
    sums = running_sums(PictureField.of(reference), parts)
    assert len(sums.sums) < 2 * 12_000  # of 480,000 pixels
    together = running_sums(PictureField.of(reference), Compartments.of([L_SHAPE, L_SHAPE]))
    assert (together.window[0] == together.window[1]).all()
    outside = running_sums(PictureField.of(reference), Compartments.of(box(30, 30, 31, 31)))
    assert outside.window[0, ROWS] == outside.window[0, COLUMNS] == 0
    assert len(outside.sums)


def test_dots_beyond_the_picture_have_no_weight_and_stay():
    dots = np.random.default_rng(1).random((50, 2)) + 30.0
    engine = Relaxation(dots, box(30, 30, 31, 31), density=PictureField.of(picture()))
    engine.step()
    assert (engine.points == dots).all()


def test_what_is_no_field_is_refused():
    reference = picture()
    with pytest.raises(ParameterError, match="below 0"):
        PictureField.of(reference, [[lambda d: d - 0.5]])
    with pytest.raises(ParameterError, match="1 tables"):
        PictureField.of(reference, table_of_shape=[1])
    field = PictureField.of(reference, table_of_shape=[0])
    with pytest.raises(ParameterError, match="shape 1"):
        Relaxation(np.ones((1, 2)), [box(0, 0, 2, 2), box(2, 0, 4, 2)], density=field)


@pytest.mark.parametrize("adjustment", [Adjustment(), Adjustment(gamma=2.0, invert=True)])
def test_a_window_is_the_mean_of_its_pixels(adjustment):
    reference = picture(shape=(600, 800)).adjusted(adjustment)
    window = Window.of(reference, (5.0, 2.5, 10.03, 7.5), 100)
    assert window.origin_mm == pytest.approx((5.0, 2.5))
    k = int(window.scale)
    assert k == 2
    assert window.pixel_mm == pytest.approx(k * reference.pixel_mm)
    part = reference.darkness[100:300, 200:402]
    expected = part.reshape(100, k, 101, k).mean(axis=(1, 3))
    np.testing.assert_allclose(window.darkness, expected, atol=2e-5)


def test_a_window_beside_the_page_is_its_nearest_pixel():
    window = Window.of(picture(), (30.0, 20.0, 31.0, 21.0), 10)
    assert window.darkness.shape == (1, 1)
