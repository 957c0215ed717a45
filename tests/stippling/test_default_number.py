"""The number of dots where no one asks for one."""

import numpy as np
import pytest

import stippler
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.files.read.picture import read_picture
from stippler.resources import assets
from stippler.stippling.default_number import default_number, with_number


def waves(period_px, size=600, mean=0.4):
    x = np.arange(size)
    row = mean * (1.0 + np.sin(2 * np.pi * x / period_px))
    return np.ascontiguousarray(np.broadcast_to(row, (size, size)), dtype=np.float32)


def radius_of(reference):
    ink = float(reference.darkness.mean()) * reference.width_mm * reference.height_mm
    return np.sqrt(ink / default_number(reference) / np.pi)


def test_dots_of_a_larger_page_are_more_and_larger():
    numbers, radii = [], []
    for width in (30.0, 60.0, 148.0, 420.0, 594.0):
        reference = Reference(waves(300.0), width)
        numbers.append(default_number(reference))
        radii.append(radius_of(reference))
    assert numbers == sorted(numbers)
    assert radii == sorted(radii)
    # sixteen times the area: four times the dots, of four times the ink
    small, large = (default_number(Reference(waves(2_000.0), w)) for w in (100.0, 400.0))
    assert large / small == pytest.approx(4.0, rel=0.1)


def test_a_picture_with_more_detail_gets_more_dots_within_bounds():
    numbers = [default_number(Reference(waves(p), 130.0)) for p in (10_000.0, 25.0, 9.0)]
    assert numbers == sorted(numbers)
    assert numbers[0] < numbers[2] <= 4 * numbers[0] + 2_000


def test_grain_finer_than_any_dot_is_no_detail():
    rng = np.random.default_rng(1)
    smooth = waves(1_500.0, 2_000)
    grainy = np.clip(smooth + rng.normal(0.0, 0.1, smooth.shape), 0, 1).astype(np.float32)
    ratio = default_number(Reference(grainy, 130.0)) / default_number(Reference(smooth, 130.0))
    assert 0.9 < ratio < 1.2


def test_a_picture_of_few_pixels_gets_no_fewer_dots_on_a_larger_page():
    rng = np.random.default_rng(2)
    few = np.clip(waves(7.0, 200) + rng.normal(0.0, 0.05, (200, 200)), 0, 1).astype(np.float32)
    numbers = [default_number(Reference(few, w)) for w in (40, 60, 80, 105, 130, 210, 420, 594)]
    assert numbers == sorted(numbers)


@pytest.mark.parametrize("name", ["ammonite.png", "honey-bee.jpg", "sandstone.jpg"])
@pytest.mark.parametrize(("width", "least", "most"), [(105, 0.28, 0.38), (594, 0.7, 1.1)])
def test_samples_have_dots_of_a_pen_on_a_postcard_and_of_a_marker_on_a_poster(
    name, width, least, most
):
    picture = read_picture(assets() / "samples" / name, tone="illustration", width_mm=width)
    assert least <= 2.0 * radius_of(picture) <= most


def test_white_margins_change_no_dot_s_size_much():
    inner = waves(60.0, 400)
    framed = np.pad(inner, 100)
    narrow, wide = (Reference(f, w) for f, w in ((inner, 100.0), (framed, 150.0)))
    assert radius_of(wide) == pytest.approx(radius_of(narrow), rel=0.35)
    assert default_number(wide) < 1.5 * default_number(narrow)


@pytest.mark.parametrize("width", [12.0, 30.0, 90.0])
def test_the_smallest_dots_of_small_pages_can_be_printed(width):
    drawing = stippler.stipple(waves(30.0, 300), width=width, iterations=2)
    assert len(drawing.dots) >= 200
    assert 2 * np.percentile(drawing.dots.radius_mm, 1) > 0.097
    assert not any("print" in note for note in drawing.notes)


def test_dots_too_small_for_a_press_are_told():
    drawing = stippler.stipple(waves(300.0, 300), 30_000, width=20.0, iterations=1)
    assert any("0.1 mm" in note for note in drawing.notes)


def test_what_a_person_asks_for_stands():
    reference = Reference(waves(30.0, 100), 130.0)
    for asked in (Style(n_dots=77), Style(size_range_mm=(0.2, 0.4))):
        assert with_number(asked, reference) == asked
    assert with_number(Style(), reference).n_dots == default_number(reference)


@pytest.mark.parametrize("darkness", [np.zeros((5, 7)), np.ones((1, 1)), np.eye(3000)[:2]])
def test_odd_pages(darkness):
    reference = Reference(darkness.astype(np.float32), 50.0)
    assert 200 <= default_number(reference) <= 500_000
