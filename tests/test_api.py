"""What `import stippler` offers, as the README uses it."""

import subprocess
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from PIL import Image
from shapely.geometry import Polygon

import stippler


def disc(size=80):
    y, x = np.mgrid[-1 : 1 : size * 1j, -1 : 1 : size * 1j]
    return np.where(x * x + y * y < 0.5, 0.4, 1.0)


@pytest.fixture(scope="module")
def drawing():
    return stippler.stipple(disc(), dots=400, width=60, iterations=5, tone="perceptual")


def test_a_drawing_has_the_dots_and_the_page_asked_for(drawing):
    assert isinstance(drawing, stippler.Drawing)
    assert (drawing.page.width_mm, drawing.page.height_mm) == (60, 60)
    assert abs(len(drawing.dots) - 400) <= 4
    distance = np.hypot(*(drawing.dots.position_mm - 30).T)
    assert distance.max() < 30 * np.sqrt(0.5) + 0.5  # none in the white
    assert drawing.style_of(0).n_dots == 400


def test_ink_meets_the_tone(drawing):
    ink = np.pi * (drawing.dots.radius_mm.astype(float) ** 2).sum() / 60**2
    assert ink == pytest.approx((1 - disc()).mean(), rel=0.06)  # a sum, so overlaps count twice


def test_a_pen_gives_dots_at_the_same_places_other_shapes():
    plain, quill = (
        stippler.stipple(disc(40), 150, iterations=2, pen=pen).dots
        for pen in ("technical-pen", "quill")
    )
    assert (plain.elongation == 1).all()
    assert quill.elongation.min() > 1.1
    for name in ("position_mm", "seed"):
        assert (getattr(plain, name) == getattr(quill, name)).all()
    grown = (quill.radius_mm / plain.radius_mm).astype(float)  # long dots overlap more, so that
    assert 0.98 < np.median(grown) < 1.15  # they are larger for the same tone


def test_a_path_an_image_and_an_array_are_the_same(tmp_path):
    array = (disc(40) * 255).astype(np.uint8)
    Image.fromarray(array).save(tmp_path / "disc.png")
    made = [
        stippler.stipple(source, 150, iterations=2).dots
        for source in (array, Image.fromarray(array), tmp_path / "disc.png",
                       str(tmp_path / "disc.png"))
    ]  # fmt: skip
    for dots in made[1:]:
        np.testing.assert_allclose(dots.position_mm, made[0].position_mm, atol=1e-3)


def test_a_notebook_shows_the_drawing(drawing):
    svg = drawing._repr_svg_()
    root = ET.fromstring(svg)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    circles = root.findall(".//{http://www.w3.org/2000/svg}circle")
    assert len(circles) == len(drawing.dots)


def test_save_by_ending(drawing, tmp_path):
    for ending in ("svg", "png", "csv"):
        drawing.save(tmp_path / f"drawing.{ending}", dpi=50)
        assert (tmp_path / f"drawing.{ending}").stat().st_size > 1000
    with pytest.raises(stippler.StipplerError, match=r"\.doc"):
        drawing.save(tmp_path / "drawing.doc")
    with pytest.raises(stippler.StipplerError, match="dpi"):
        drawing.save(tmp_path / "drawing.png", dpi=float("nan"))


def test_pulse_density_gives_points_in_pixels():
    image = np.full((60, 90), 0.5)
    points, radii = stippler.pulse_density(image, dots=300, tone="perceptual")
    assert points.shape == (len(radii), 2)
    assert abs(len(points) - 300) <= 3
    assert (points >= 0).all()
    assert (points <= [90, 60]).all()
    assert (radii > 0).all()
    ink = np.pi * (radii**2).sum()
    assert ink == pytest.approx(0.5 * 90 * 60, rel=0.1)


def test_relax_moves_points_and_keeps_the_fixed(tmp_path):
    rng = np.random.default_rng(2)
    triangle = Polygon([(0, 0), (10, 0), (0, 10)])
    points = rng.uniform(0, 4.9, (50, 2))
    fixed = np.arange(50) < 5
    before = points.copy()
    moved = stippler.relax(points, triangle, iterations=10, fixed=fixed)
    np.testing.assert_array_equal(points, before)
    np.testing.assert_array_equal(moved[fixed], before[fixed])
    assert (np.abs(moved[~fixed] - before[~fixed]).max(axis=1) > 0).all()
    assert (moved.sum(axis=1) <= 10 + 1e-12).all()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"dots": 0}, "dots"),
        ({"width": float("nan")}, "page|width"),
        ({"width": -1}, "page|width"),
        ({"tone": "loud"}, "tone"),
        ({"size_range": (1, 0)}, "size range"),
        ({"iterations": -1}, "iterations"),
        ({"image": None}, "image"),
        ({"image": "nowhere.png"}, "no such file"),
        ({"image": np.full((3, 3), np.nan)}, "finite"),
    ],
)
def test_wrong_arguments_are_refused(arguments, says):
    with pytest.raises(stippler.StipplerError, match=says):
        stippler.stipple(**{"image": disc(10), **arguments})


@pytest.mark.parametrize("array", [np.ones((1, 1)), np.zeros((1, 1)), np.ones((30, 1)),
                                   np.zeros((1, 30)), np.ones((4, 4, 3))])  # fmt: skip
def test_the_smallest_pictures(array):
    drawing = stippler.stipple(array, dots=20, width=20, iterations=2)
    assert (len(drawing.dots) == 0) == bool(array.all())
    assert (drawing.dots.position_mm >= 0).all()
    assert (drawing.dots.position_mm <= [drawing.page.width_mm, drawing.page.height_mm]).all()


def test_an_unknown_name():
    with pytest.raises(AttributeError, match="nothing"):
        _ = stippler.nothing
    assert set(stippler.__all__) <= set(dir(stippler))


def test_importing_imports_nothing_else():
    code = "import sys, stippler; print('numpy' in sys.modules)"
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert result.stdout == "False\n"


def test_an_area_is_filled_without_a_picture():
    square = [(0, 0), (30, 0), (30, 30), (0, 30)]
    for arrangement in ("hexagonal", "random"):
        points = stippler.fill(square, 200, arrangement, seed=4)
        assert abs(len(points) - 200) <= 8
        assert ((points >= 0) & (points <= 30)).all()
    assert len(stippler.fill(Polygon(square), 0)) == 0
    for wrong in ({"area": [1, 2]}, {"area": square, "arrangement": "neat"},
                  {"area": square, "n": -1}, {"area": square[:2]}):  # fmt: skip
        with pytest.raises(stippler.StipplerError):
            stippler.fill(**{"n": 5, **wrong})


def test_pulses_in_an_area_given_by_its_corners():
    corners = [(10, 10), (70, 10), (40, 70)]
    points, _ = stippler.pulse_density(np.full((80, 80), 0.5), 300, area=corners, start="border")
    assert abs(len(points) - 300) <= 6
    assert points[:, 1].max() < 70


def test_what_a_drawing_falls_short_of_is_told():
    drawing = stippler.stipple(np.zeros((20, 20)), 30, 20, size_range=(0.2, 0.4), iterations=2)
    assert "too dark" in " ".join(drawing.notes)
    assert "between 0.0, 0.0 and 20.0, 20.0 mm" in " ".join(drawing.notes)
    assert stippler.stipple(disc(), 300, 20, iterations=2).notes == ()
    crowded = stippler.stipple(disc(), 10**5, 20, size_range=(0.2, 0.4), iterations=0)
    assert "100,000 dots fit" in " ".join(crowded.notes)
    assert 0 < len(crowded.dots) < 10**5
