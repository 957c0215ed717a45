"""Level of detail of single areas: all else stays to the bit, and it is one step to undo."""

import numpy as np
import pytest
import shapely

from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.pattern import Pattern
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import GeometryError, ParameterError
from stippler.jobs.processing import process_now
from stippler.stippling.patterns import builtin
from stippler.stippling.scale import Scaling, scaled_drawing
from stippler.stippling.scale_areas import scale_areas, scaled_areas


def box(x0, y0, x1, y1):
    return Path.polyline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], closed=True)


@pytest.fixture(scope="module")
def finished() -> Drawing:
    """A page of a grey ramp with an area in its middle, both stippled."""
    drawing = Drawing.blank(Page(60, 40), Style(n_dots=2500, iterations=6))
    ramp = np.tile(np.linspace(0.15, 0.6, 300, dtype=np.float32), (200, 1))
    drawing.reference = Reference(ramp, 60.0)
    document = Document(drawing)
    edit_areas(document, "Draw area", lambda m: edits.add(m, box(20, 10, 40, 30)))
    process_now(document, sorted(document.drawing.areas))
    return document.drawing


@pytest.fixture
def document(finished) -> Document:
    return Document(finished.snapshot())


def the_area(document) -> int:
    return max(document.drawing.areas)


def others(document, area):
    dots = document.dots.by_id()
    rest = dots.take(np.flatnonzero(dots.area != area))
    return [getattr(rest, name).tobytes() for name in Dots.__slots__]


def state(document):
    dots, drawing = document.dots.by_id(), document.drawing
    arrays = [getattr(dots, name).tobytes() for name in Dots.__slots__]
    areas = {k: (a.name, a.outline_mm.wkb) for k, a in drawing.areas.items()}
    return arrays, areas, dict(drawing.borders), dict(drawing.patterns)


def own(document, area) -> Dots:
    return document.dots.take(np.flatnonzero(document.dots.area == area))


def ink(dots) -> float:
    return float((dots.radius_mm.astype(float) ** 2).sum() * np.pi)


@pytest.mark.parametrize(
    "how", [Scaling(0.5), Scaling(1.0, 150), Scaling(0.7, None, 0.25), Scaling(1.0, 900)], ids=str
)
def test_all_else_stays_and_undo_brings_it_back(document, how):
    area = the_area(document)
    rest, before, n_steps = others(document, area), state(document), len(document.history.steps)
    scale_areas(document, [area], how)
    if how.factor <= 1.0:
        assert others(document, area) == rest
    assert len(document.history.steps) == n_steps + 1
    outline = document.drawing.areas[area].outline_mm
    assert outline.area == pytest.approx(400 * how.factor**2, rel=1e-3)
    dots = own(document, area)
    assert shapely.intersects_xy(outline, *dots.position_mm.T).all()
    if how.n_dots:
        assert len(dots) == pytest.approx(how.n_dots, abs=3)
    if how.least_radius_mm:
        assert dots.radius_mm.min() >= how.least_radius_mm - 1e-6
    document.undo()
    assert state(document) == before


def test_half_the_size_is_the_same_ink_for_its_area(document):
    area = the_area(document)
    before = own(document, area)
    scale_areas(document, [area], Scaling(0.5))
    after = own(document, area)
    assert np.array_equal(np.sort(after.id), np.sort(before.id))
    assert ink(after) == pytest.approx(ink(before) / 4, rel=1e-4)
    a, b = before.by_id(), after.by_id()
    assert np.allclose(b.position_mm, (a.position_mm - (30, 20)) * 0.5 + (30, 20), atol=1e-3)


def test_another_number_keeps_the_tone_of_the_picture(document):
    area = the_area(document)
    asked = ink(own(document, area))
    for n in (200, 800):
        scale_areas(document, [area], Scaling(n_dots=n))
        assert ink(own(document, area)) == pytest.approx(asked, rel=0.03)


def test_what_an_area_grows_over_gives_way_but_for_fixed_dots(document):
    area = the_area(document)
    ring = np.flatnonzero(
        shapely.contains_xy(shapely.box(15, 5, 45, 35), *document.dots.position_mm.T)
        & (document.dots.area != area)
    )
    document.begin("Fix")
    document.change("constraint", ring[:5], np.full(5, FIXED, document.dots.constraint.dtype))
    document.commit()
    kept, gone = document.dots.id[ring[:5]].copy(), document.dots.id[ring[5:]].copy()
    scale_areas(document, [area], Scaling(1.5))
    assert document.drawing.areas[area].outline_mm.area == pytest.approx(900, rel=1e-3)
    assert (document.rows(kept) >= 0).all()
    assert (document.rows(gone) < 0).all()


def test_its_pattern_comes_with_it(document):
    area = the_area(document)
    laid = Pattern.over(area, builtin("bricks"), (20, 10, 40, 30), 6.0)
    document.begin("Pattern")
    k = document.add("pattern", laid)
    document.commit()
    scale_areas(document, [area], Scaling(0.5))
    small, _ = document.drawing.patterns[k].rings_mm()
    large, _ = laid.rings_mm()
    assert np.allclose(small, (large - (30, 20)) * 0.5 + (30, 20), atol=1e-9)


def test_dots_on_lines_stay(document):
    area = the_area(document)
    document.begin("Line")
    line = document.add("line", Line("axis", Path.polyline([(22, 20), (38, 20)])))
    rows = np.flatnonzero(document.dots.area == area)[:4]
    document.change("constraint", rows, np.full(4, ON_CURVE, document.dots.constraint.dtype))
    document.change("curve", rows, np.full(4, line, document.dots.curve.dtype))
    document.commit()
    ids = document.dots.id[rows].copy()
    at = document.dots.position_mm[rows].copy()
    scale_areas(document, [area], Scaling(0.8))
    assert np.array_equal(document.dots.position_mm[document.rows(ids)], at)


def test_what_cannot_be_is_refused_and_changes_nothing(document):
    area, before = the_area(document), state(document)
    with pytest.raises(ParameterError, match="there is no area 77"):
        scale_areas(document, [77], Scaling(0.5))
    with pytest.raises(GeometryError, match="would reach the page's edge"):
        scale_areas(document, [area], Scaling(2.1))
    with pytest.raises(GeometryError, match="would reach the page's edge"):
        scale_areas(document, [0], Scaling(0.9))
    assert state(document) == before
    assert not document.in_stroke


def test_sizes_set_by_hand_stay_larger_when_the_number_changes(finished):
    """They were solved for the tone like all others: what a person had done was lost."""
    document = Document(finished.snapshot())
    rows = np.flatnonzero(document.dots.position_mm[:, 0] < 12.0)
    document.begin("Size")
    document.change("radius_mm", rows, document.dots.radius_mm[rows] * np.float32(1.5))
    document.commit()
    by_hand, plain = document.drawing.snapshot(), finished.snapshot()
    half = len(plain.dots) // 2
    inks = []
    for drawing in (by_hand, plain):
        dots = scaled_drawing(drawing, Scaling(n_dots=half)).dots
        left = dots.position_mm[:, 0]
        inks.append([ink(dots.take(np.flatnonzero(m))) for m in (left < 11.0, left > 14.0)])
    assert inks[0][0] / inks[1][0] == pytest.approx(1.5**2, rel=0.06)
    assert inks[0][1] / inks[1][1] == pytest.approx(1.0, rel=0.01)


def test_the_command_line_scales_an_area_by_its_name(document, tmp_path):
    from typer.testing import CliRunner

    from stippler.api import open as open_drawing
    from stippler.cli import app
    from stippler.files.native.drawing_file import save_drawing

    area, path, out = the_area(document), tmp_path / "a.stipple", tmp_path / "b.stipple"
    save_drawing(document.drawing, path)
    name = document.drawing.areas[area].name
    asked = ["scale", str(path), "-o", str(out), "--area", name, "--by", "50"]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    found = open_drawing(out)
    assert found.areas[area].outline_mm.area == pytest.approx(100, rel=1e-3)
    same = scaled_areas(document.drawing.snapshot(), [area], Scaling(0.5))
    assert np.array_equal(found.dots.by_id().position_mm, same.dots.by_id().position_mm)
