"""DXF, G-code and HPGL as pictures: what their readers find, filled or drawn, is what we show."""

import io
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from PIL import Image, ImageDraw

sys.path.insert(0, str(Path(__file__).parent))
import consumers
from sheets_tried import SHEETS, SIZE
from test_plotters import gcode_strokes, hpgl_strokes, text_of

from stippler.files.write.pen_paths import paths_of
from stippler.files.write.raster import grey_strips
from stippler.files.write.sheet import Layer, Line, Sheet

INK, TILE = 0.005, 16
HPGL_INK = 0.01  # its steps are 0.025 mm: lines of hatching are not quite even
PEN_MM = 0.2
WORST = {".dxf": 0.02, ".gcode": 0.01, ".hpgl": 0.06}  # HPGL's steps are 0.025 mm
FINER = 8


def shown(sheet, dpi):
    return 1 - np.concatenate(list(grey_strips(sheet, dpi))).astype(np.float32) / 255


def assert_same(ours, theirs, worst, ink=INK):
    assert theirs.sum() == pytest.approx(ours.sum(), rel=ink)
    assert np.abs(consumers.averaged(ours - theirs, TILE)).max() < worst


@pytest.mark.parametrize("dpi", [100, 300, 508])
@pytest.mark.parametrize(
    ("ending", "strokes_of"), [(".gcode", gcode_strokes), (".hpgl", hpgl_strokes)]
)
def test_a_pen_draws_what_is_planned(sheet, ending, strokes_of, dpi):
    for layer in sheet.layers:
        one = Sheet(*SIZE, (layer,))
        paths = paths_of(layer, one, PEN_MM)
        planned = [
            Line(paths.points_mm[a:b], PEN_MM)
            for a, b in zip(paths.starts[:-1], paths.starts[1:], strict=True)
        ]
        read = strokes_of(text_of(one, ending, pen_width=PEN_MM).decode())
        drawn = [Line(s * (1, -1) + (0, SIZE[1]), PEN_MM) for s in read]
        ours = shown(Sheet(*SIZE, (Layer("pen", lines=tuple(planned)),)), dpi)
        theirs = shown(Sheet(*SIZE, (Layer("pen", lines=tuple(drawn)),)), dpi)
        assert_same(ours, theirs, WORST[ending], HPGL_INK if ending == ".hpgl" else INK)


def rings_of(sheet, tmp_path):
    """Return the closed outlines of a DXF by layer, flattened by ezdxf, in mm with y down."""
    path = tmp_path / "a.dxf"
    path.write_bytes(text_of(sheet, ".dxf"))
    found = {}
    for entity in ezdxf.readfile(path).modelspace():
        closed = entity.dxftype() == "CIRCLE" or entity.is_closed
        made = ezdxf.path.make_path(entity)
        points = np.array([(p.x, SIZE[1] - p.y) for p in made.flattening(1e-4)])
        found.setdefault(entity.dxf.layer, []).append((closed, points))
    return found


@pytest.mark.parametrize("dpi", [100, 300, 508])
@pytest.mark.parametrize("name", ["round", "deformed"])
def test_outlines_of_a_dxf_enclose_the_ink(tmp_path, name, dpi):
    sheet = Sheet(*SIZE, SHEETS[name])
    by = max(round(FINER * 300 / dpi), 4)
    size = tuple(round(side / 25.4 * dpi * by) for side in SIZE)
    image = Image.new("1", size)
    draw = ImageDraw.Draw(image)
    for rings in rings_of(sheet, tmp_path).values():
        for closed, points in rings:
            assert closed
            # Pillow fills the pixels of the edge, too: half a pixel inwards on every side
            draw.polygon([tuple(p) for p in points * dpi * by / 25.4 - 0.5], fill=1)
    theirs = consumers.averaged(np.asarray(image, np.float32), by)
    ours = shown(sheet, dpi)
    grown = theirs.sum() / ours.sum() - 1
    assert 0 < grown < 0.08  # by half a pixel of the edge
    assert np.abs(consumers.averaged(ours - theirs, TILE)).max() < 0.08


def test_areas_that_a_dxf_encloses_are_those_of_the_ink(sheet, tmp_path):
    """By shapely, exactly: dots, holes and what is inverse, in painting order."""
    import shapely
    from shapely.geometry import Polygon

    found = rings_of(sheet, tmp_path)
    grounds = {name: found.pop(name) for name in list(found) if name.endswith("-ground")}
    names = list(found)
    assert len(names) == sum(not layer.is_empty for layer in sheet.layers)
    for layer, name in zip((one for one in sheet.layers if not one.is_empty), names, strict=True):
        both = found[name] + grounds.get(f"{name[:24]}-ground", [])
        rings = [Polygon(points) for closed, points in both if closed and len(points) > 3]
        theirs = sum(ring.area for ring in rings)
        dots = float((np.pi * layer.dots.radius_mm.astype(float) ** 2).sum())
        shapes = sum(
            Polygon(ring).area for one in (*layer.ground, *layer.shapes) for ring in one.rings_mm
        )
        lines = sum(Polygon(one.points_mm).area for one in layer.lines if one.closed)
        assert theirs == pytest.approx(dots + shapes + lines, rel=INK)
        assert all(shapely.is_valid(ring) for ring in rings)


def test_a_page_of_no_dots_and_of_one(tmp_path):
    layer = SHEETS["round"][0]
    for n in (0, 1):
        one = Sheet(*SIZE, (Layer("page", layer.dots.take(np.arange(n))),))
        assert len(gcode_strokes(text_of(one, ".gcode", pen_width=2.0).decode())) == n
        assert len(hpgl_strokes(text_of(one, ".hpgl", pen_width=2.0).decode())) == n
        drawing = ezdxf.read(io.StringIO(text_of(one, ".dxf").decode()))
        assert len(drawing.modelspace()) == n
