"""SVG: valid, the same outlines as everywhere, numbers rounded right, bytes the same anywhere."""

import itertools
import math
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon, box

from stippler.drawing.area import Area
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import ParameterError
from stippler.files.write import svg
from stippler.kernels.machine import pool
from stippler.kernels.shapes import dot_shape, svg_text

INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
NAMESPACE = "{http://www.w3.org/2000/svg}"
NUMBER = re.compile(r"-?(?:\d+\.?\d*|\.\d+)")


def drawing_of(dots: Dots, width=40.0, height=30.0) -> Drawing:
    drawing = Drawing.blank(Page(width, height))
    drawing.dots = dots
    return drawing


def parsed(drawing: Drawing, **options) -> ET.Element:
    return ET.fromstring(b"".join(svg.svg_chunks(drawing, **options)))


def shaped(n: int, seed: int, roughness=(0.0, 1.0)) -> Dots:
    rng = np.random.default_rng(seed)
    dots = Dots.round(rng.uniform(-1, 41, (n, 2)), rng.uniform(0.05, 1.5, n))
    dots.elongation[:] = rng.uniform(1, 4, n)
    dots.angle_rad[:] = rng.uniform(-4, 4, n)
    dots.roughness[:] = rng.uniform(*roughness, n)
    dots.seed[:] = rng.integers(0, 2**32, n, np.uint32)
    return dots


def curve(d: str, per_segment: int = 12) -> np.ndarray:
    """Return points along a path of the form ``Mx yc...s...z``."""
    match = re.fullmatch(r"M([^cs]+)c([^s]+)s(.+)z", d)
    assert match, d
    start, first, rest = (np.array([float(v) for v in NUMBER.findall(g)]) for g in match.groups())
    steps = [first.reshape(3, 2)]
    for pair in rest.reshape(-1, 2, 2):
        mirrored = steps[-1][2] - steps[-1][1]  # what s means: the control before, reflected
        steps.append(np.vstack([mirrored, pair]))
    t = np.linspace(0, 1, per_segment, endpoint=False)[:, None]
    at, points = start, []
    for a, b, c in steps:
        points.append(at + 3 * (1 - t) ** 2 * t * a + 3 * (1 - t) * t**2 * b + t**3 * c)
        at = at + c
    np.testing.assert_allclose(at, start, atol=1e-9)  # closed exactly, rounding included
    return np.concatenate(points)


def test_the_page_is_in_mm_and_white():
    root = parsed(drawing_of(Dots.none(), 148, 105.5))
    assert root.get("width") == "148mm"
    assert root.get("height") == "105.5mm"
    assert root.get("viewBox") == "0 0 148 105.5"
    (image,) = root.findall(f"{NAMESPACE}g/{NAMESPACE}image")
    assert (image.get("width"), image.get("height")) == ("148", "105.5")
    assert image.get("href").startswith("data:image/png;base64,")
    assert not list(root.iter(f"{NAMESPACE}rect")) + list(root.iter(f"{NAMESPACE}path"))


@given(st.integers(0, 2**32 - 1), st.integers(0, 60))
def test_round_dots_are_circles(seed, n):
    rng = np.random.default_rng(seed)
    dots = Dots.round(rng.uniform(-5, 45, (n, 2)), 10.0 ** rng.uniform(-3, 1, n))
    circles = parsed(drawing_of(dots)).findall(f".//{NAMESPACE}circle")
    seen = np.array([[float(c.get(k)) for k in ("cx", "cy", "r")] for c in circles]).reshape(-1, 3)
    off = min(0.05 * float(dots.radius_mm.min(initial=1.0)), 0.005)  # of the smallest radius
    np.testing.assert_allclose(seen[:, :2], dots.position_mm, atol=off + 1e-9)
    np.testing.assert_allclose(seen[:, 2], dots.radius_mm, atol=0.1 * off + 1e-6)


@pytest.mark.parametrize("roughness", [(0.0, 0.0), (0.0, 0.1), (0.1, 0.5), (0.5, 1.0), (1.0, 1.0)])
def test_paths_keep_to_the_outline(roughness):
    """Within 1.5 % of the radius everywhere, 1 % for all but a few, and of the same area."""
    dots = shaped(120, 4, roughness)
    drawing = drawing_of(dots)
    paths = parsed(drawing, decimals=6).findall(f".//{NAMESPACE}path")
    assert len(paths) == len(dots)
    truth = {}
    for i, ring in enumerate(dot_shape.outlines(dots, 720)):
        truth[i] = Polygon(ring)
    worst = []
    for path in paths:
        points = curve(path.get("d"))
        shape = Polygon(points)
        i = min(truth, key=lambda k: truth[k].centroid.distance(shape.centroid))
        radius = float(dots.radius_mm[i])
        away = max(truth[i].exterior.distance(Point(p)) for p in points[::3]) / radius
        worst.append(away)
        assert shape.area == pytest.approx(math.pi * radius**2, rel=0.01)
        del truth[i]
    assert max(worst) < 0.015
    assert np.quantile(worst, 0.95) < 0.01


def test_rounding_does_not_add_up():
    dots = shaped(40, 9)
    fine = parsed(drawing_of(dots), decimals=6).findall(f".//{NAMESPACE}path")
    coarse = parsed(drawing_of(dots), decimals=2).findall(f".//{NAMESPACE}path")
    for a, b in zip(fine, coarse, strict=True):
        assert np.abs(curve(a.get("d")) - curve(b.get("d"))).max() < 0.011


@given(
    st.integers(-(10**9), 10**9),
    st.integers(0, 8),
)
def test_numbers_are_written_in_the_fewest_characters(value, decimals):
    out = np.zeros(40, np.uint8)
    end = svg_text.put_number.dispatcher(out, 3, value, decimals)
    text = out[3:end].tobytes().decode()
    assert math.isclose(float(text), value / 10**decimals, rel_tol=1e-15)
    assert not out[:3].any()
    assert not out[end:].any()
    shortest = f"{value / 10**decimals:.{decimals}f}"
    if "." in shortest:
        shortest = shortest.rstrip("0").rstrip(".")
    shortest = re.sub(r"^(-?)0\.", r"\1.", shortest)
    assert text == (shortest if shortest not in ("-0", "") else "0")


def test_dots_are_grouped_by_area():
    page = Page(40, 30)
    areas = {0: Area("page", box(0, 0, 40, 30)), 1: Area('a "b" & <c>', box(0, 0, 20, 30))}
    dots = Dots.round([(5, 5), (30, 5), (6, 6)], 1.0)
    dots.area[:] = [1, 0, 1]
    root = parsed(Drawing(page, areas, dots))
    groups = root.findall(f"{NAMESPACE}g")[1:]
    assert [g.get("id") for g in groups] == ["layer-1", "layer-2"]
    assert groups[1].get(f"{INKSCAPE}label") == '2 a "b" & <c>'
    assert [len(g) for g in groups] == [1, 2]
    assert groups[1].get("data-name") == 'a "b" & <c>'


def test_bytes_do_not_depend_on_the_number_of_threads():
    drawing = drawing_of(shaped(20_000, 2))
    drawing.dots.roughness[::3] = 0
    drawing.dots.elongation[::6] = 1
    both = []
    for n_threads in (1, 2):
        pool.set_threads(n_threads)
        both.append(b"".join(svg.svg_chunks(drawing)))
    pool.set_threads(0)
    assert both[0] == both[1]


def test_a_round_dot_takes_few_bytes():
    rng = np.random.default_rng(0)
    drawing = drawing_of(Dots.round(rng.uniform(0, 99, (1000, 2)), rng.uniform(0.1, 0.3, 1000)))
    assert len(b"".join(svg.svg_chunks(drawing))) < 44 * 1000 + 1000


@pytest.mark.parametrize("decimals", [-1, 7, 100])
def test_decimals_out_of_range_are_refused(decimals):
    with pytest.raises(ParameterError, match="decimals"):
        list(svg.svg_chunks(drawing_of(Dots.none()), decimals=decimals))


def test_shapes_out_of_range_are_refused():
    dots = shaped(3, 0)
    dots.elongation[1] = 9
    with pytest.raises(ParameterError, match="elongation"):
        list(svg.svg_chunks(drawing_of(dots)))


def test_segment_counts_cover_the_range():
    limits = [limit for limit, _ in svg.SEGMENTS]
    assert limits == sorted(limits)
    assert limits[-1] == 1.0
    assert all(a < b for a, b in itertools.pairwise(n for _, n in svg.SEGMENTS))
