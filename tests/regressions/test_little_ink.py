"""Much asked of a small part of the page: it took all memory, or ended in no dots at all."""

import numpy as np
import pytest

import stippler
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import ParameterError
from stippler.stippling.halftone import supersampling
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.stipple import stages


def two_black_pixels(side: int) -> np.ndarray:
    """At opposite corners, so that all between them is cells."""
    picture = np.ones((side, side))
    picture[1, 1] = picture[-2, -2] = 0.0
    return picture


@pytest.mark.parametrize("n_dots", [1, 2, 3, 7, 50])
def test_few_dots_are_all_drawn(n_dots):
    ramp = np.linspace(0.0, 1.0, 1600).reshape(40, 40)
    for start in ("top", "border"):
        drawing = stippler.stipple(ramp, n_dots, iterations=0, start=start)
        assert len(drawing.dots) == n_dots, start
        assert drawing.notes == ()


def test_a_halftone_of_two_black_pixels_has_bounds():
    """20,000 dots in a pixel of 200 x 200 were 11 gigabytes of cells."""
    darkness = (1.0 - two_black_pixels(200)).astype(np.float32)
    density = PageRaster.of(Reference(darkness, 150.0), 20_000, None, bleeds=False).density()
    assert density.size * supersampling(density) ** 2 <= 1.2e8


def test_what_does_not_fit_two_black_pixels_is_told():
    drawing = stippler.stipple(two_black_pixels(600), 20_000, iterations=1, first_dots="random")
    assert 1 <= len(drawing.dots) < 200
    assert any("of 20,000 dots fit" in note for note in drawing.notes)


def test_dots_without_number_are_refused():
    style = Style(size_range_mm=(1e-5, 1e-5))
    with pytest.raises(ParameterError, match=r"size range: about .* dots of this size"):
        next(iter(stages(Reference(np.ones((9, 9), np.float32), 150.0), style)))


def test_dots_larger_than_the_page_are_not_called_white():
    drawing = stippler.stipple(np.zeros((9, 9)), size_range=(500.0, 900.0), iterations=1)
    assert len(drawing.dots) == 0
    assert len(drawing.notes) == 1
    assert "white" not in drawing.notes[0]


def test_what_does_not_fit_is_told_without_a_number_asked_for():
    drawing = stippler.stipple(two_black_pixels(600), iterations=0, first_dots="random")
    assert any("of 200 dots fit" in note for note in drawing.notes)
