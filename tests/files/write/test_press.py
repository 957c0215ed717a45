"""What a press prints, simulated by shapely, is the picture that was drawn."""

import json
import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import stippler
from stippler.cli import app
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import ParameterError
from stippler.files import presses
from stippler.files.write.press import grown_radius, solved, solved_dots
from stippler.files.write.sheet import Layer, Line, Sheet, shape_of


def some(n=400, low=0.1, high=0.4, seed=1) -> Dots:
    rng = np.random.default_rng(seed)
    return Dots.round(rng.uniform(1, 19, (n, 2)), rng.uniform(low, high, n))


def printed(dots: Dots, gain: float):
    """Return the ink that round dots leave, every edge grown by shapely."""
    discs = shapely.buffer(shapely.points(dots.position_mm), dots.radius_mm, quad_segs=20)
    return shapely.union_all(discs).buffer(gain, quad_segs=20)


def tiles(ink, side=5.0):
    boxes = [
        shapely.box(x, y, x + side, y + side) for x in range(0, 20, 5) for y in range(0, 20, 5)
    ]
    return np.array([ink.intersection(b).area for b in boxes]) / side**2


@pytest.mark.parametrize("gain", [-0.02, 0.02, 0.05])
def test_overlapping_dots_print_as_they_were_drawn(gain):
    dots = some(low=0.16)
    made = solved_dots(dots, gain)
    assert len(made) == len(dots)
    drawn, seen = printed(dots, 0.0), printed(made, gain)
    assert seen.symmetric_difference(drawn).area < 0.004 * drawn.area
    careless = printed(dots, gain)
    assert abs(careless.area - drawn.area) > 0.03 * drawn.area  # else this would prove nothing


def test_dots_that_the_press_loses_become_fewer_and_print_the_same_tone():
    dots = some(3000, 0.05, 0.09)
    gain, least = 0.03, 0.16
    made = solved_dots(dots, gain, least)
    assert made.radius_mm.min() >= least / 2 * (1 - 1e-6)
    assert len(made) < 0.6 * len(dots)
    grown = made.radius_mm.astype(float) + gain
    asked = float((dots.radius_mm.astype(float) ** 2).sum())
    assert float((grown**2).sum()) == pytest.approx(asked, rel=0.005)
    away = tiles(printed(made, gain)) - tiles(printed(dots, 0.0))
    assert np.abs(away).max() < 0.03
    assert abs(away.mean()) < 0.01


def test_no_ink_is_lost_where_the_gain_is_larger_than_the_dots():
    dots = some(2000, 0.03, 0.05)
    made = solved_dots(dots, 0.06)
    ink = float(((made.radius_mm.astype(float) + 0.06) ** 2).sum())
    assert ink == pytest.approx(float((dots.radius_mm.astype(float) ** 2).sum()), rel=0.01)


@given(st.floats(0.05, 2), st.floats(1, 4), st.floats(0.001, 0.2))
def test_growth_is_taken_back_exactly(radius, elongation, gain):
    dots = Dots.round([(0, 0)], radius)
    dots.elongation[:] = elongation
    grown = Dots.round([(0, 0)], grown_radius(dots, gain))
    grown.elongation[:] = elongation
    a, b = radius * math.sqrt(elongation), radius / math.sqrt(elongation)
    assert grown.radius_mm[0] == pytest.approx(math.sqrt((a + gain) * (b + gain)), rel=1e-6)
    made = Dots.round([(0, 0)], max(grown_radius(dots, -gain)[0], 1e-9))
    root = math.sqrt(elongation)
    if made.radius_mm[0] > 1e-6:
        a, b = made.radius_mm[0] * root + gain, made.radius_mm[0] / root + gain
        assert a * b == pytest.approx(radius**2, rel=1e-4)


def test_white_dots_grow_and_the_ground_recedes():
    ground = shapely.box(2, 2, 18, 18)
    layer = Layer(
        "night", some(50), True, (shape_of(ground),), (Line(np.array([(3.0, 3.0), (9, 9)]), 0.4),)
    )
    (made,) = solved(Sheet(20, 20, (layer,)), 0.05).layers
    np.testing.assert_allclose(made.dots.radius_mm, layer.dots.radius_mm + 0.05, rtol=1e-5)
    assert made.lines[0].width_mm == pytest.approx(0.5)
    (shape,) = made.ground
    ring = shapely.Polygon(shape.rings_mm[0])
    assert ring.buffer(0.05, join_style="mitre").area == pytest.approx(ground.area, rel=1e-6)


def test_a_press_is_kept_and_found(tmp_path):
    presses.keep_press(presses.Press("laser, plain", 0.021, 0.08), tmp_path)
    presses.keep_press(presses.Press("riso", -0.004), tmp_path)
    assert list(presses.presses(tmp_path)) == ["laser, plain", "riso"]
    assert presses.press_named("laser, plain", tmp_path).gain_mm == 0.021
    with pytest.raises(ParameterError, match="one of laser, plain, riso"):
        presses.press_named("offset", tmp_path)
    path = tmp_path / presses.FILE
    path.write_text(json.dumps({"bad": {"gain_mm": "x"}, "worse": 3, "riso": {"gain_mm": 0.01}}))
    assert list(presses.presses(tmp_path)) == ["riso"]


@pytest.mark.parametrize(("name", "gain"), [("", 0.1), ("a\nb", 0.1), ("a", 3.0), ("a", math.nan)])
def test_presses_that_are_none(name, gain):
    with pytest.raises(ParameterError):
        presses.Press(name, gain)


def test_measured_once_used_by_command_line_and_python(tmp_path, monkeypatch):
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    told = CliRunner().invoke(
        app,
        ["calibrate", "--measured", "0.118,0.232,0.343,0.452,0.56,0.668,0.773", "--name", "riso"],
    )
    assert told.exit_code == 0, told.output
    gain = presses.press_named("riso").gain_mm
    assert 0.005 < gain < 0.05
    drawing = Drawing.blank(Page(20, 20))
    drawing.dots = some(30, 0.2, 0.3)
    stippler.Drawing(**{name: getattr(drawing, name) for name in ("page", "areas", "dots")}).save(
        tmp_path / "a.stipple"
    )
    one = stippler.open(tmp_path / "a.stipple")
    one.save(tmp_path / "python.svg", press="riso")
    told = CliRunner().invoke(
        app,
        ["render", str(tmp_path / "a.stipple"), "-o", str(tmp_path / "cli.svg"), "--press", "riso"],
    )
    assert told.exit_code == 0, told.output
    assert (tmp_path / "cli.svg").read_bytes() == (tmp_path / "python.svg").read_bytes()
    one.save(tmp_path / "plain.svg")
    one.save(tmp_path / "gain.svg", gain=gain)
    assert (tmp_path / "gain.svg").read_bytes() == (tmp_path / "cli.svg").read_bytes()
    assert (tmp_path / "plain.svg").read_bytes() != (tmp_path / "cli.svg").read_bytes()
    with pytest.raises(ParameterError, match="one of riso"):
        one.save(tmp_path / "x.svg", press="offset")
