"""Numbers of dots that were missed, dots off the page, and pages refused after the work."""

import numpy as np
import pytest
import shapely
from shapely.geometry import Point, Polygon, box

import stippler
from stippler.errors import GeometryError, ParameterError
from stippler.stippling import ground

COARSE = Polygon([(0.4, 0.6), (3.6, 0.3), (3.2, 2.7), (0.8, 2.1)])


@pytest.mark.parametrize("start", ["top", "border"])
@pytest.mark.parametrize("n", [1, 100, 1000])
def test_an_area_of_a_coarse_picture_gets_its_dots(n, start):
    points, radii = stippler.pulse_density(np.full((3, 4), 0.4), n, area=COARSE, start=start)
    assert len(points) == len(radii) == n
    assert shapely.contains_xy(COARSE.buffer(1e-9), *points.T).all()


@pytest.mark.parametrize("width", [2.0, 0.5, 0.01])
def test_a_narrow_area_gets_its_dots(width):
    area = box(10.2, 200.3, 390.0, 200.3 + width)  # between two rows of pixels
    points, _ = stippler.pulse_density(np.full((400, 400), 0.4), 10_000, area=area)
    assert len(points) == 10_000
    assert shapely.contains_xy(area.buffer(1e-9), *points.T).all()


def test_an_area_too_narrow_for_its_box_is_refused():
    thin = Polygon([(0, 0), (400, 400), (400, 399.999), (0.001, 0)])
    with pytest.raises(GeometryError, match="too narrow"):
        stippler.pulse_density(np.full((400, 400), 0.4), 10_000, area=thin)


@pytest.mark.parametrize("first", ["hexagonal", "floyd-steinberg", "random", "pulse-density"])
@pytest.mark.parametrize("grey", [0.5, 0.3])
def test_every_way_to_begin_meets_the_number(first, grey):
    drawing = stippler.stipple(np.full((100, 150), grey), 10_000, first_dots=first, iterations=2)
    assert abs(len(drawing.dots) - 10_000) <= 1


@pytest.mark.parametrize("shape", [(1, 5000), (2, 9_000), (3, 20_000), (9, 20_000)])
def test_dots_of_a_strip_stay_on_it(shape):
    drawing = stippler.stipple(np.full(shape, 0.4), 500, 148)
    position = drawing.dots.position_mm
    assert len(position) == 500
    assert (position >= 0).all()
    assert (position <= (drawing.page.width_mm, drawing.page.height_mm)).all()


def test_a_page_too_high_is_refused_before_the_work(monkeypatch):
    monkeypatch.setattr(ground, "raster_for", None)  # the work
    with pytest.raises(ParameterError, match="height"):
        stippler.stipple(np.full((7200, 100), 0.5), 2000, 148)


def test_one_black_pixel_takes_its_dots_and_little_room():
    picture = np.ones((700, 700))
    picture[350, 350] = 0.0
    drawing = stippler.stipple(picture, 2000, 70)
    assert len(drawing.dots) == 2000
    assert np.abs(drawing.dots.position_mm - 35.05).max() < 0.06


@pytest.mark.parametrize("width", [1e-6, 1e-12])
def test_the_thinnest_ring_is_filled(width):
    ring = Point(0, 0).buffer(100).difference(Point(0, 0).buffer(100 - width))
    points = stippler.fill(ring, 500, "random")
    assert len(points) == 500
    assert shapely.contains_xy(ring, *points.T).all()
    assert np.hypot(*points.mean(axis=0)) < 15  # all around


def test_sizes_by_region_say_how_far_they_are_off():
    tones = np.kron(np.array([[0.85, 0.1]]), np.ones((200, 200)))
    notes = stippler.stipple(tones, 5000, sizes="regions", tone="perceptual").notes
    assert any("sizes by region draw a darkness of" in note for note in notes)
