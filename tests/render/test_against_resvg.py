"""The frame against resvg's picture of the SVG: a rasteriser that no one here wrote.

At the size of the frame resvg itself loses about 2.5 % of the ink of dots two pixels in radius, so
it is asked for a large picture, which is then averaged.
"""

import functools
import io

import numpy as np
import pytest
import resvg_py
from PIL import Image

from stippler.camera import Camera
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.files.write.svg import svg_chunks

PAGE = Page(40, 30)
LARGE = 96  # pixels a mm
SCALES = (4, 8, 16, 32)  # dots from 0.6 to 8 pixels in radius
KINDS = ("round", "smooth", "rough")
TILE = 16
INK = 0.005  # agreement in ink, of all of it
WORST_TILE = 0.006  # and in the worst tile of 16 pixels, of full black


@functools.cache
def by_resvg(svg: bytes) -> np.ndarray:
    """Return the ink of an SVG; its size in mm is put into pixels, as resvg rounds mm."""
    text = svg.decode()
    size = (round(PAGE.width_mm * LARGE), round(PAGE.height_mm * LARGE))
    assert 'width="40mm" height="30mm"' in text
    text = text.replace('width="40mm" height="30mm"', f'width="{size[0]}" height="{size[1]}"', 1)
    # the paper is a picture of one pixel: smoothed, it would take longer than all dots
    found = resvg_py.svg_to_bytes(svg_string=text, image_rendering="optimize_speed")
    with Image.open(io.BytesIO(bytes(found))) as image:
        assert image.size == size
        return 255 - np.asarray(image.convert("L"))


def averaged(image: np.ndarray, by: int) -> np.ndarray:
    h, w = (side // by for side in image.shape)
    return image[: h * by, : w * by].reshape(h, by, w, by).mean(axis=(1, 3))


def vector_ink(dots: Dots, scale: int) -> np.ndarray:
    drawing = Drawing.blank(PAGE)
    drawing.dots = dots
    svg = b"".join(svg_chunks(drawing, decimals=5))
    return averaged(by_resvg(svg), LARGE // scale) / 255.0


def worst_tile(a: np.ndarray, b: np.ndarray) -> float:
    """Return the largest difference between tiles; a rest at the right and bottom is left out."""
    return float(np.abs(averaged(a, TILE) - averaged(b, TILE)).max())


@pytest.fixture
def screen_ink(renderer, ink):
    def drawn(dots: Dots, scale: int) -> np.ndarray:
        renderer.scene.set_page(PAGE.width_mm, PAGE.height_mm)
        renderer.scene.set_dots(dots)
        return ink(Camera((20, 15), scale), (40 * scale, 30 * scale))

    return drawn


@pytest.mark.parametrize("kind", KINDS)
def test_screen_and_vector_agree(screen_ink, many, kind):
    dots = many(24, 18, kind)
    for scale in SCALES:
        ours, theirs = screen_ink(dots, scale), vector_ink(dots, scale)
        assert ours.sum() == pytest.approx(theirs.sum(), rel=INK), scale
        assert worst_tile(ours, theirs) < WORST_TILE, scale


@pytest.mark.parametrize("kind", KINDS)
def test_one_missing_dot_fails(screen_ink, many, kind):
    """Even the smallest of all dots, at every scale at which it is larger than a pixel."""
    dots = many(24, 18, kind)
    fewer = dots.take(np.arange(len(dots)) != np.argmin(dots.radius_mm))
    for scale in SCALES[1:]:
        assert worst_tile(screen_ink(fewer, scale), vector_ink(dots, scale)) > 1.5 * WORST_TILE
