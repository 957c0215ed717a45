"""G-code, HPGL, DXF and SVG as plotters' own programs read them."""

import re
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import svgelements
import vpype
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).parent))
from sheets_tried import SHEETS, SIZE, dots

from stippler.files.write.formats import format_of
from stippler.files.write.options import checked
from stippler.files.write.raster import bit_strips
from stippler.files.write.sheet import Layer, Line, Sheet

PX_PER_MM = 96 / 25.4
ODD_NAMES = ['a "b" & <c>', "Übergang\nzwei", "ear\x0b\x00", "骨", "", "x" * 90, "ear\x0b\x00"]


def text_of(sheet, ending, **options):
    one = format_of(f"a{ending}")
    return b"".join(one.write(sheet, checked(one.options, options)))


def gcode_strokes(code):
    """Simulate the machine: return what is drawn, and fail where the pen drags."""
    at, down, strokes, feeds = np.zeros(2), None, [], None
    for line in code.splitlines():
        line = line.split(";")[0].strip()
        if line in ("", "G21", "G90"):
            continue
        if line == "M5":
            down = False
        elif line == "M3S1000":
            assert down is False, "lowered twice"
            down = True
            strokes.append([at])
        elif match := re.fullmatch(r"G1F(\d+)", line):
            feeds = float(match[1])
        else:
            match = re.fullmatch(r"G([01])X(-?[\d.]+)Y(-?[\d.]+)(?:F\d+)?", line)
            assert match, line
            at = np.array([float(match[2]), float(match[3])])
            assert (match[1] == "1") == bool(down), "drags, or draws in the air"
            if down:
                assert feeds
                strokes[-1].append(at)
    assert down is False
    return [np.array(stroke) for stroke in strokes]


def hpgl_strokes(code):
    at, down, strokes = None, False, []
    for part in code.replace("\n", "").split(";"):
        if part in ("IN", "PA", "") or part[:2] in ("SP", "VS"):
            continue
        down = {"PU": False, "PD": True}.get(part[:2], down)
        if part == "PD":
            strokes.append([at])
        elif len(part) > 2:
            at = np.array([float(v) for v in part[2:].split(",")]) / 40
            if down:
                strokes[-1].append(at)
    return [np.array(stroke) for stroke in strokes]


def drawn(strokes, pen_mm):
    """Return the ink that a pen leaves, at 20 pixels a mm."""
    flipped = [Line(s * (1, -1) + (0, SIZE[1]), pen_mm) for s in strokes]
    layer = Layer("pen", lines=tuple(flipped))
    return np.unpackbits(np.concatenate(list(bit_strips(Sheet(*SIZE, (layer,)), 508))), axis=1)


@pytest.mark.parametrize(
    ("ending", "strokes_of"), [(".gcode", gcode_strokes), (".hpgl", hpgl_strokes)]
)
def test_the_pen_leaves_the_drawing(sheet, ending, strokes_of):
    """Spirals, hatching and passes fill what is to be filled: the ink is the sheet's."""
    pen = 0.15
    alone = [Sheet(*SIZE, (layer,)) for layer in sheet.layers]
    for one in alone:
        strokes = strokes_of(text_of(one, ending, pen_width=pen).decode())
        ours = np.unpackbits(np.concatenate(list(bit_strips(one, 508))), axis=1)
        theirs = drawn(strokes, pen)
        assert int(theirs.sum()) == pytest.approx(int(ours.sum()), rel=0.06)
        assert (ours != theirs).mean() < 0.02 + 0.1 * ours.mean()


def test_dots_of_the_pen_are_taps_in_a_short_order():
    layer = SHEETS["round"][0]
    sheet = Sheet(*SIZE, (layer,))
    taps = {}
    for sort in (True, False):
        code = text_of(sheet, ".gcode", pen_width=2.0, sort=sort).decode()
        strokes = gcode_strokes(code)
        assert all(len(stroke) == 1 for stroke in strokes)
        taps[sort] = np.array([stroke[0] for stroke in strokes])
    truth = layer.dots.position_mm * (1, -1) + (0, SIZE[1])
    np.testing.assert_allclose(taps[False], truth, atol=6e-4)
    away, which = cKDTree(taps[True]).query(truth)
    assert away.max() < 1e-3
    assert len(set(which)) == len(truth)
    lengths = [np.hypot(*np.diff(t, axis=0).T).sum() for t in (taps[True], taps[False])]
    assert lengths[0] < 0.1 * lengths[1]


def test_dxf_by_ezdxf(sheet, tmp_path):
    path = tmp_path / "a.dxf"
    path.write_bytes(text_of(sheet, ".dxf"))
    document = ezdxf.readfile(path)
    assert not document.audit().errors
    assert document.units == ezdxf.units.MM
    circles = list(document.modelspace().query("CIRCLE"))
    rounds = [layer.dots.take(layer.dots.elongation == 1) for layer in sheet.layers]
    assert len(circles) == sum(map(len, rounds))
    seen = np.array([(c.dxf.center.x, c.dxf.center.y, c.dxf.radius) for c in circles]).reshape(
        -1, 3
    )
    truth = np.concatenate(
        [np.column_stack([d.position_mm * (1, -1) + (0, SIZE[1]), d.radius_mm]) for d in rounds]
    )
    np.testing.assert_allclose(seen, truth, atol=1e-4)
    outlines = [p for p in document.modelspace().query("POLYLINE") if p.is_closed]
    n_rings = sum(len(s.rings_mm) for one in sheet.layers for s in (*one.ground, *one.shapes))
    n_closed = sum(line.closed for one in sheet.layers for line in one.lines)
    n_shaped = sum(int((one.dots.elongation > 1).sum()) for one in sheet.layers)
    assert len(outlines) == n_rings + n_closed + n_shaped


@pytest.mark.parametrize("round_dots", ["circles", "taps"])
def test_vpype_plots_the_dots_and_not_the_paper(tmp_path, round_dots):
    """The white page was a path like any other, so that plotters drew the paper's edge."""
    layers = SHEETS["round"], dots(40, seed=9)
    sheet = Sheet(*SIZE, (*layers[0], Layer("second", layers[1])))
    path = tmp_path / "a.svg"
    path.write_bytes(text_of(sheet, ".svg", round_dots=round_dots))
    document = vpype.read_multilayer_svg(str(path), quantization=0.05, crop=False)
    assert [len(lines) for lines in document.layers.values()] == [300, 40]
    assert document.page_size == pytest.approx([side * PX_PER_MM for side in SIZE], rel=1e-5)
    first = document.layers[1]
    middles = np.array([line.mean() for line in first]) / PX_PER_MM
    found = np.column_stack([middles.real, middles.imag])
    away, _ = cKDTree(found).query(layers[0][0].dots.position_mm)
    assert away.max() < 0.02


@pytest.mark.parametrize("name", ODD_NAMES)
def test_odd_names(tmp_path, name):
    sheet = Sheet(*SIZE, (Layer(name, dots(3)), Layer(name, dots(2, seed=4))))
    for ending in (".svg", ".dxf", ".pdf", ".eps", ".gcode", ".hpgl"):
        (tmp_path / f"a{ending}").write_bytes(text_of(sheet, ending))
    read = svgelements.SVG.parse(str(tmp_path / "a.svg"), ppi=25.4)
    assert sum(isinstance(e, svgelements.Circle) for e in read.elements()) == 5
    assert (read.width, read.height) == pytest.approx(SIZE)
    layers = {e.dxf.layer for e in ezdxf.readfile(tmp_path / "a.dxf").modelspace()}
    assert len(layers) == 2
    assert "\n" not in name or len(gcode_strokes((tmp_path / "a.gcode").read_text())) == 5


def test_numbers_do_not_ask_the_locale():
    import locale

    sheet = Sheet(*SIZE, SHEETS["round"])
    before = text_of(sheet, ".svg")
    for name in ("de_DE.UTF-8", "fr_FR.UTF-8"):
        try:
            locale.setlocale(locale.LC_ALL, name)
        except locale.Error:
            continue
        try:
            assert text_of(sheet, ".svg") == before
        finally:
            locale.setlocale(locale.LC_ALL, "C")
