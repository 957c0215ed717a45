"""What the preview shows is what the file holds; estimates; and pens in the course of time."""

import io
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

sys.path.insert(0, str(Path(__file__).parent))
from sheets_tried import SHEETS, SIZE

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.export import values_for
from stippler.files.write.course import course_of, moments_of
from stippler.files.write.estimate import estimate
from stippler.files.write.formats import FORMATS, STIPPLE, format_named
from stippler.files.write.options import checked
from stippler.files.write.plate import plate_of
from stippler.files.write.plotter import duration_s
from stippler.files.write.proof import Window, proof
from stippler.files.write.raster import grey_strips
from stippler.files.write.sheet import Layer, Line, Sheet

SIZE_FACTOR, TIME_FACTOR = 1.25, 5.0  # what an estimate may be off; docs/exports.md says so


def pixels_of(sheet, **options):
    one = format_named("tif")
    data = b"".join(one.write(sheet, checked(one.options, options)))
    with Image.open(io.BytesIO(data)) as image:
        return np.asarray(image.convert("L"))


@pytest.mark.parametrize("bits", [1, 8])
def test_a_proof_of_a_bitmap_shows_its_pixels(sheet, bits):
    """Four screen pixels for each of the file's, anywhere on the page."""
    dpi = 300
    file = pixels_of(sheet, dpi=dpi, bits=str(bits))
    mm = 25.4 / dpi
    for column, row in ((0, 0), (200, 90), (600 - 50, 300 - 40)):
        window = Window(column * mm, row * mm, 50 * mm, 40 * mm, 200, 160)
        seen = proof(sheet, window, dpi, bits)
        assert seen.shape == (160, 200)
        truth = file[row : row + 40, column : column + 50].repeat(4, 0).repeat(4, 1)
        assert (seen != truth).mean() < 0.002


def test_a_proof_from_afar_has_the_ink_of_the_pixels(sheet):
    file = pixels_of(sheet, dpi=600, bits="1")
    seen = proof(sheet, Window(0, 0, *SIZE, 150, 75), 600, 1)
    assert (255.0 - seen).mean() == pytest.approx((255.0 - file).mean(), rel=0.005)


def test_a_proof_of_outlines_is_the_page(sheet):
    whole = np.concatenate(list(grey_strips(sheet, 300)))
    part = proof(sheet, Window(SIZE[0] / 4, SIZE[1] / 2, SIZE[0] / 4, SIZE[1] / 4, 150, 75))
    assert np.abs(part.astype(int) - whole[150:225, 150:300]).mean() < 0.5


def many(n=30_000, kind="round") -> Drawing:
    rng = np.random.default_rng(2)
    one = Drawing.blank(Page(120, 80))
    one.dots = Dots.round(rng.uniform((0, 0), (120, 80), (n, 2)), rng.uniform(0.1, 0.2, n))
    if kind == "rough":
        one.dots.elongation[:], one.dots.roughness[:] = 1.5, 0.4
    return one


@pytest.mark.parametrize(
    "one", [f for f in FORMATS if f is not STIPPLE], ids=lambda f: f.endings[0]
)
@pytest.mark.parametrize("kind", ["round", "rough"])
def test_sizes_are_estimated_within_a_stated_factor(one, kind):
    drawing = many(30_000 if kind == "round" else 12_000, kind)
    values = values_for(one, {"dpi": 600} if one.name in ("TIFF", "PNG") else {})
    what = drawing if one.is_data else plate_of(drawing, values)
    told = estimate(one, what, values)
    size = sum(map(len, one.write(what, values)))
    assert size / SIZE_FACTOR < told.n_bytes < size * SIZE_FACTOR
    assert told.seconds > 0


def test_an_estimate_of_few_dots_is_exact():
    drawing = many(800)
    one = format_named("svg")
    values = values_for(one, {})
    sheet = plate_of(drawing, values)
    assert estimate(one, sheet, values).n_bytes == sum(map(len, one.write(sheet, values)))


@pytest.mark.parametrize("pen", [0.15, 1.3])
def test_a_course_takes_the_time_that_the_file_tells(sheet, pen):
    one = format_named("gcode")
    values = checked(one.options, {"pen_width": pen})
    course = course_of(sheet, values)
    assert course.total_s == pytest.approx(duration_s(sheet, values), rel=1e-9)
    assert (np.diff(course.at_s) >= 0).all()
    assert course.names == tuple(layer.name for layer in sheet.layers)
    assert len(np.unique(course.pen)) == len(sheet.layers)
    assert (np.diff(course.pen) >= 0).all()  # pens apart


def test_moments_grow_into_the_drawing():
    sheet = Sheet(*SIZE, SHEETS["round"])
    values = checked(format_named("gcode").options, {"pen_width": 0.25})
    course = course_of(sheet, values)
    window = Window(0, 0, *SIZE, 1016, 508)
    moments = moments_of(course, window)
    last = -1
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        n = int((moments.drawn_s <= share * course.total_s).sum())
        assert n > last
        last = n
    ink = 1 - np.concatenate(list(grey_strips(sheet, 508))) / 255.0
    assert last == pytest.approx(ink.sum(), rel=0.1)
    half = moments.drawn_s <= course.at_s[course.at(course.total_s / 2)]
    done = course.points_mm[: course.at(course.total_s / 2) + 1] * 20
    rows, columns = done[:, 1].astype(int), done[:, 0].astype(int)
    inside = (rows >= 0) & (rows < 508) & (columns >= 0) & (columns < 1016)
    assert half[rows[inside], columns[inside]].mean() > 0.99


def test_travel_is_apart_from_what_is_drawn():
    line = Line(np.array([(5.0, 5.0), (15.0, 5.0)]), 0.3)
    other = Line(np.array([(15.0, 20.0), (5.0, 20.0)]), 0.3)
    sheet = Sheet(20, 25, (Layer("a", lines=(line, other)),))
    course = course_of(sheet, checked(format_named("hpgl").options, {}))
    moments = moments_of(course, Window(0, 0, 20, 25, 200, 250))
    assert np.isfinite(moments.drawn_s[50, 50:150]).all()
    assert not np.isfinite(moments.drawn_s[60:190]).any()
    assert np.isfinite(moments.travelled_s[60:190]).any(axis=1).all()


def test_a_course_of_nothing():
    course = course_of(Sheet(10, 10, ()), checked(format_named("gcode").options, {}))
    assert course.total_s == 0
    assert not np.isfinite(moments_of(course, Window(0, 0, 10, 10, 20, 20)).drawn_s).any()
