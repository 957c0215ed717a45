"""The camera against plain matrix arithmetic, and the promises its operations make."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.camera import MAX_PX_PER_MM, MIN_PX_PER_MM, Camera
from stippler.drawing.drawing import Page

SIZE = (1280, 800)

coordinate = st.floats(-1000, 1000)
points = st.tuples(coordinate, coordinate)
cameras = st.builds(
    Camera,
    st.tuples(st.floats(0, 300), st.floats(0, 300)),
    st.floats(0.1, 500),
    st.floats(-math.pi, math.pi),
    st.booleans(),
)


@given(cameras, points)
def test_screen_to_page_undoes_page_to_screen(camera, point):
    there = camera.page_to_screen(point, SIZE)
    np.testing.assert_allclose(camera.screen_to_page(there, SIZE), point, atol=1e-8)


@given(cameras, points)
def test_the_matrix_agrees_with_page_to_screen(camera, point):
    x, y = camera.page_to_screen(point, SIZE)
    clip = camera.matrix(SIZE).astype(float) @ [*point, 1.0]
    expected = (2 * x / SIZE[0] - 1, 1 - 2 * y / SIZE[1])
    tolerance = 1e-6 * (1 + np.abs(camera.matrix(SIZE)).max() * 1000)
    np.testing.assert_allclose(clip[:2], expected, atol=tolerance)


@given(cameras, points, st.floats(0.2, 5))
def test_zooming_keeps_the_point_under_the_pointer(camera, at, factor):
    under = camera.screen_to_page(at, SIZE)
    zoomed = camera.zoomed(factor, at, SIZE)
    np.testing.assert_allclose(zoomed.page_to_screen(under, SIZE), at, atol=1e-6)
    assert math.isclose(zoomed.px_per_mm, camera.px_per_mm * factor)


@given(cameras, points, points)
def test_flipping_mirrors_the_screen(camera, at, point):
    x, y = camera.page_to_screen(point, SIZE)
    mirrored = camera.flipped(at, SIZE).page_to_screen(point, SIZE)
    np.testing.assert_allclose(mirrored, (2 * at[0] - x, y), atol=1e-5)


@given(cameras, points, points)
def test_panning_moves_every_point_alike(camera, delta, point):
    moved = camera.panned(delta).page_to_screen(point, SIZE) - camera.page_to_screen(point, SIZE)
    np.testing.assert_allclose(moved, delta, atol=1e-6)


@given(cameras, points)
def test_a_tile_is_cut_out_of_the_whole(camera, point):
    origin, tile = (300, 450), (256, 128)
    whole = camera.page_to_screen(point, SIZE)
    np.testing.assert_allclose(
        camera.tile(origin, tile, SIZE).page_to_screen(point, tile), whole - origin, atol=1e-6
    )


@given(st.floats(1, 2000), st.floats(1, 2000), st.floats(0, 100))
def test_fit_shows_the_whole_page_as_large_as_it_goes(width, height, margin):
    camera = Camera.fit(Page(width, height), SIZE, margin)
    corners = camera.page_to_screen([(0, 0), (width, height)], SIZE)
    slack = np.concatenate([corners[0], np.array(SIZE) - corners[1]])
    assert slack.min() >= margin - 1e-6
    assert math.isclose(slack.min(), margin, abs_tol=1e-6)


def test_a_quarter_turn_is_clockwise_on_the_screen():
    camera = Camera((0, 0), 2.0, math.pi / 2)
    np.testing.assert_allclose(camera.page_to_screen((10, 0), (100, 100)), (50, 70), atol=1e-9)


def test_zoom_has_limits():
    camera = Camera((0, 0), 1.0)
    assert camera.zoomed(1e30, (0, 0), SIZE).px_per_mm == MAX_PX_PER_MM
    assert camera.zoomed(1e-30, (0, 0), SIZE).px_per_mm == MIN_PX_PER_MM


@given(cameras, points, points)
def test_distances_on_the_screen_are_those_on_the_page_at_the_scale(camera, a, b):
    there = camera.page_to_screen([a, b], SIZE)
    expected = math.dist(a, b) * camera.px_per_mm
    assert math.dist(*there) == pytest.approx(expected, rel=1e-9, abs=1e-6)


@given(cameras)
def test_a_mirror_turns_the_other_way_round(camera):
    origin, along, across = camera.page_to_screen([(0, 0), (1, 0), (0, 1)], SIZE)
    area = np.linalg.det([along - origin, across - origin])
    assert (area < 0) == camera.flip


@given(cameras, st.floats(0.01, 2000), st.floats(0.01, 2000), st.floats(0, 100))
def test_a_box_is_fitted_as_it_is_turned(camera, width, height, margin):
    low, high = (7.0, 3.0), (7.0 + width, 3.0 + height)
    fitted = camera.fitted(low, high, SIZE, margin)
    assert (fitted.rotation_rad, fitted.flip) == (camera.rotation_rad, camera.flip)
    corners = fitted.page_to_screen([low, high, (low[0], high[1]), (high[0], low[1])], SIZE)
    slack = np.concatenate([corners.min(axis=0), np.array(SIZE) - corners.max(axis=0)])
    assert slack.min() == pytest.approx(margin, abs=1e-6)
