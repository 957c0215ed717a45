"""What the lens shows: the page at another scale to the pixel, its tone as light, a round rim."""

from __future__ import annotations

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest

from stippler.camera import Camera
from stippler.drawing.reference import Reference
from stippler.render.frame import Frame
from stippler.render.lens import LensPass

WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
PAPER, DESK, INK = (0.98, 0.97, 0.9), (0.5, 0.5, 0.55), (0.05, 0.1, 0.2)
D, MARGIN = 120, 12


def light(encoded):
    encoded = np.asarray(encoded, float)
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def encoded(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


@pytest.fixture
def lens(ctx: moderngl.Context) -> Iterator[LensPass]:
    one = LensPass(ctx, D, MARGIN, 1.25)
    yield one
    one.release()


def seen_through(lens: LensPass) -> np.ndarray:
    """Return the lens's picture, (h, w, 4) in 0..1, the top row first."""
    side = D + 2 * MARGIN
    return np.frombuffer(lens.texture.read(), np.uint8).reshape(side, side, 4)[::-1] / 255.0


def inside() -> np.ndarray:
    """Return which pixels lie inside the rim."""
    y, x = np.mgrid[: D + 2 * MARGIN, : D + 2 * MARGIN] + 0.5 - MARGIN - D / 2
    return np.hypot(x, y) < D / 2 - 2


@pytest.mark.parametrize("scale", [0.6, 2.0, 40.0])
@pytest.mark.parametrize("turned", [(0.0, False), (0.6, True)])
def test_it_shows_a_plain_drawing_at_its_scale(renderer, ink, lens, many, scale, turned):
    renderer.scene.set_page(40, 30)
    renderer.scene.set_dots(many())
    camera = Camera((19, 14), scale, *turned)
    covered = ink(camera, (D, D))[:, :, None]
    lens.draw(renderer, Frame(camera, (D, D), WHITE, WHITE, BLACK))
    expected = encoded(1.0 - covered)
    glass = seen_through(lens)[MARGIN:-MARGIN, MARGIN:-MARGIN]
    clear = inside()[MARGIN:-MARGIN, MARGIN:-MARGIN]
    # near black a level of the plain drawing's coverage is several of the encoded light's
    slack = np.abs(encoded(np.clip(1.0 - covered + 0.5 / 255, 0, 1)) - expected)
    assert (np.abs(glass[..., :3] - expected)[clear] <= (slack + 1.5 / 255)[clear]).all()
    assert (glass[..., 3][clear] == 1.0).all()


def test_tone_is_the_light_that_ink_and_paper_send_back(renderer, lens, shaped):
    """A screen of dots that covers a fifth looks like a grey of four fifths of the light."""
    x, y = np.meshgrid(np.arange(80) + 0.5, np.arange(80) + 0.5)
    radius = np.sqrt(0.2 / np.pi)
    renderer.scene.set_page(80, 80)
    renderer.scene.set_dots(shaped(np.stack([x.ravel(), y.ravel()], axis=1), radius))
    camera = Camera((40, 40), 0.97 * D / 80 / 8)
    lens.draw(renderer, Frame(camera, (D, D), PAPER, DESK, INK))
    side = D + 2 * MARGIN
    middle = seen_through(lens)[side // 2 - 5 : side // 2 + 5, side // 2 - 5 : side // 2 + 5, :3]
    expected = encoded(0.8 * light(PAPER) + 0.2 * light(INK))
    np.testing.assert_allclose(middle.mean(axis=(0, 1)), expected, atol=1.5 / 255)


def test_the_picture_under_the_dots_is_mixed_as_light_too(renderer, lens):
    renderer.scene.set_page(40, 30)
    renderer.scene.set_reference(Reference(np.full((3, 4), 0.6, np.float32), 40.0))
    frame = Frame(Camera((20, 15), 50.0), (D, D), PAPER, DESK, INK, dots=False, opacity=0.5)
    lens.draw(renderer, frame)
    expected = encoded(0.7 * light(PAPER) + 0.3 * light(INK))
    shown = seen_through(lens)[..., :3][inside()]
    np.testing.assert_allclose(shown, np.broadcast_to(expected, shown.shape), atol=1.5 / 255)


def test_it_is_round_and_its_rim_shows_on_black_and_on_white(renderer, lens):
    renderer.scene.set_page(40, 30)
    lens.draw(renderer, Frame(Camera((20, 15), 50.0), (D, D), WHITE, WHITE, BLACK))
    glass, middle = seen_through(lens), MARGIN + D // 2
    assert glass[0, 0, 3] == 0.0
    row = glass[middle, MARGIN - 4 : MARGIN + 2]
    for ground in (WHITE, BLACK):
        over = row[:, 3:] * row[:, :3] + (1 - row[:, 3:]) * np.array(ground)
        assert over.max() - over.min() > 0.5
    assert np.array_equal(glass, glass[:, ::-1])  # left and right alike; the shadow falls down
    assert glass[-3, middle, 3] > glass[2, middle, 3]


def test_the_page_is_drawn_after_it_as_before(renderer, ink, lens, many):
    renderer.scene.set_page(40, 30)
    renderer.scene.set_dots(many())
    fit = Camera((20, 15), 8.0)
    before = ink(fit, (320, 240))
    for scale in (0.3, 90.0):
        camera = Camera((10, 10), scale, 1.0)
        lens.draw(renderer, Frame(camera, (D, D), PAPER, DESK, INK))
        assert np.array_equal(ink(fit, (320, 240)), before)
