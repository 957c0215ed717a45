"""The shader's adjustment of the reference and the kernel's are one."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from stippler.camera import Camera
from stippler.drawing.adjustment import Adjustment
from stippler.drawing.reference import Reference

WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
DARKNESS = np.tile(np.arange(256, dtype=np.float32) / 255, (4, 1))  # each pixel of 1 mm a level


@pytest.mark.parametrize(
    "adjustment",
    [
        Adjustment(*values)
        for values in itertools.product((-0.5, 0.0, 0.3), (-0.6, 0.8), (0.4, 2.5), (False, True))
    ],
)
def test_the_screen_shows_what_the_dots_will_be_made_of(renderer, ink, adjustment):
    renderer.scene.set_page(256, 4)
    renderer.scene.set_reference(Reference(DARKNESS, 256.0))
    seen = ink(Camera((128, 2), 1.0), (256, 4), opacity=1.0, adjustment=adjustment)
    np.testing.assert_allclose(seen, adjustment.apply(DARKNESS), atol=1.01 / 255)


def test_unadjusted_it_is_the_picture(renderer, ink):
    renderer.scene.set_page(256, 4)
    renderer.scene.set_reference(Reference(DARKNESS, 256.0))
    seen = ink(Camera((128, 2), 1.0), (256, 4), opacity=1.0)
    np.testing.assert_allclose(seen, DARKNESS, atol=0.51 / 255)
