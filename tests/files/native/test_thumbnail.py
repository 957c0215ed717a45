"""The small picture in a file: size, ink, dots at the edges of the page, and that it is a PNG."""

import io

import numpy as np
import pytest
from PIL import Image

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.files.native import thumbnail as module
from stippler.files.native.thumbnail import SIDE_PX, thumbnail, thumbnail_png


def drawn(places, radius, page=(64.0, 32.0)):
    drawing = Drawing.blank(Page(*page))
    drawing.dots = Dots.round(np.array(places, np.float64).reshape(-1, 2), radius)
    return drawing


def ink(picture):
    return (255 - picture.astype(float)) / 255


@pytest.mark.parametrize(
    ("page", "shape"),
    [((64.0, 32.0), (128, 256)), ((32.0, 64.0), (256, 128)), ((100.0, 0.01), (1, 256))],
)
def test_the_longer_side_has_so_many_pixels(page, shape):
    assert thumbnail(drawn([], 0.1, page)).shape == shape
    assert (thumbnail(drawn([], 0.1, page)) == 255).all()


@pytest.mark.parametrize("radius", [0.02, 0.05, 0.5, 3.0])
def test_it_has_the_ink_of_the_dots(radius):
    places = np.random.default_rng(1).uniform((4, 4), (60, 28), (9, 2))
    places = places[[0]] if radius > 1 else places
    found = ink(thumbnail(drawn(places, radius)))
    assert found.sum() == pytest.approx(len(places) * np.pi * (radius * 4) ** 2, rel=0.03, abs=0.03)


CELLS = [(0.0, 0.0), (63.9, 0.1), (0.1, 31.9), (63.99, 31.99), (20.13, 10.4)]


@pytest.mark.parametrize(("x", "y"), CELLS)
def test_a_small_dot_inks_the_pixel_it_lies_in_and_no_other(x, y):
    found = ink(thumbnail(drawn([(x, y)], 0.06)))
    assert np.argwhere(found > 0).tolist() == [[int(y * 4), int(x * 4)]]


@pytest.mark.parametrize(("x", "y"), [(-0.01, 5.0), (64.0, 5.0), (5.0, -0.01), (5.0, 32.0)])
def test_a_small_dot_beside_the_page_inks_nothing(x, y):
    assert ink(thumbnail(drawn([(x, y)], 0.06))).sum() == 0


def test_of_very_many_dots_a_part_stands_for_all(monkeypatch):
    places = np.random.default_rng(1).uniform((1, 1), (63, 31), (3000, 2))
    whole = ink(thumbnail(drawn(places, 0.03)))
    monkeypatch.setattr(module, "_MOST_DOTS", 1000)
    part = ink(thumbnail(drawn(places, 0.03)))
    assert part.sum() == pytest.approx(whole.sum(), rel=0.04)
    assert (part > 0).sum() < 0.5 * (whole > 0).sum()


def test_it_is_a_png_of_the_same_picture():
    drawing = drawn([(20, 10)], 3.0)
    with Image.open(io.BytesIO(thumbnail_png(drawing))) as image:
        assert image.format == "PNG"
        assert max(image.size) == SIDE_PX
        assert np.array_equal(np.asarray(image), thumbnail(drawing))
