"""Every picture is read by a program that no one here wrote, and shows what ours shows."""

import itertools
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
import consumers
from sheets_tried import SHEETS, SIZE

from stippler.files.write.formats import format_of
from stippler.files.write.options import checked
from stippler.files.write.raster import grey_strips
from stippler.files.write.sheet import Layer, Sheet

INK = 0.005  # agreement in ink, of all of it
TILE, WORST_TILE = 16, 0.02  # and in the worst tile, of full black
READERS = {
    ".svg": consumers.resvg,
    ".pdf": consumers.poppler,
    ".eps": consumers.ghostscript,
    ".png": consumers.pillow,
    ".tif": consumers.pillow,
}


def written(sheet, path, **options):
    one = format_of(path)
    path.write_bytes(b"".join(one.write(sheet, checked(one.options, options))))
    return path


def shown(sheet, dpi):
    return 1 - np.concatenate(list(grey_strips(sheet, dpi))).astype(np.float32) / 255


def assert_same(ours, theirs):
    h, w = (min(a, b) for a, b in zip(ours.shape, theirs.shape, strict=True))
    assert max(ours.shape[0] - h, ours.shape[1] - w) <= 1  # programs round the size up or down
    ours, theirs = ours[:h, :w], theirs[:h, :w]
    assert theirs.sum() == pytest.approx(ours.sum(), rel=INK)
    tiles = consumers.averaged(np.abs(consumers.averaged(ours - theirs, TILE)), 1)
    assert tiles.max() < WORST_TILE


@pytest.mark.parametrize("dpi", [100, 300, 508])
@pytest.mark.parametrize("ending", [".svg", ".pdf", ".eps"])
def test_vectors_show_what_we_show(sheet, tmp_path, ending, dpi):
    path = written(sheet, tmp_path / f"a{ending}")
    by = max(round(1200 / dpi), 2)
    assert_same(shown(sheet, dpi), READERS[ending](path, dpi, by))


@pytest.mark.parametrize("round_dots", ["compound", "taps"])
def test_dots_as_strokes_are_the_same_picture(sheet, tmp_path, round_dots):
    path = written(sheet, tmp_path / "a.svg", round_dots=round_dots)
    assert_same(shown(sheet, 300), consumers.resvg(path, 300))


def test_pdf_by_ghostscript(sheet, tmp_path):
    path = written(sheet, tmp_path / "a.pdf")
    assert_same(shown(sheet, 300), consumers.ghostscript(path, 300))


@pytest.mark.parametrize("dpi", [100, 300, 508])
def test_pixels_are_ours(sheet, tmp_path, dpi):
    ours = shown(sheet, dpi)
    for ending, options in ((".png", {}), (".png", {"transparent": True}), (".tif", {"bits": "8"})):
        path = written(sheet, tmp_path / f"a{ending}", dpi=dpi, **options)
        np.testing.assert_allclose(consumers.pillow(path, dpi), ours, atol=1e-6)
    fine = written(sheet, tmp_path / "b.tif", dpi=dpi * 8)
    assert_same(ours, consumers.pillow(fine, dpi, 8))


def test_one_missing_dot_is_seen(tmp_path):
    """Else these tests would prove nothing."""
    layer = SHEETS["round"][0]
    fewer = Layer("page", layer.dots.take(np.arange(len(layer.dots)) != 0))
    path = written(Sheet(*SIZE, (fewer,)), tmp_path / "a.svg")
    with pytest.raises(AssertionError):
        assert_same(shown(Sheet(*SIZE, (layer,)), 300), consumers.resvg(path, 300))


def test_sizes_in_mm(sheet, tmp_path):
    pdf = subprocess.run(
        ["pdfinfo", written(sheet, tmp_path / "a.pdf")], capture_output=True, text=True, check=True
    ).stdout
    line = next(row for row in pdf.splitlines() if row.startswith("Page size"))
    assert [float(v) * 25.4 / 72 for v in line.split()[2:5:2]] == pytest.approx(SIZE, abs=1e-3)
    eps = written(sheet, tmp_path / "a.eps").read_text("latin-1")
    box = eps.split("%%HiResBoundingBox:")[1].split("\n")[0].split()
    assert [float(v) * 25.4 / 72 for v in box[2:]] == pytest.approx(SIZE, abs=1e-3)
    tif = written(sheet, tmp_path / "a.tif", dpi=1200)
    told = subprocess.run(["tiffinfo", tif], capture_output=True, text=True, check=True).stdout
    assert "Compression Scheme: CCITT Group 4" in told
    assert "Resolution: 1200, 1200 pixels/inch" in told
    assert f"Image Width: {round(SIZE[0] * 1200 / 25.4)}" in told


def test_pdf_has_a_layer_a_name_and_no_fonts(sheet, tmp_path):
    path = written(sheet, tmp_path / "a.pdf")
    fonts = subprocess.run(["pdffonts", path], capture_output=True, text=True, check=True).stdout
    assert len(fonts.splitlines()) == 2  # a head and nothing below
    names = [layer.name.encode("utf-16-be").hex().upper() for layer in sheet.layers]
    assert all(name.encode() in path.read_bytes() for name in names)


@pytest.mark.parametrize("ending", READERS)
def test_no_dots_and_one(tmp_path, ending):
    layer = SHEETS["round"][0]
    for n in (0, 1):
        one = Sheet(*SIZE, (Layer("page", layer.dots.take(np.arange(n))),))
        options = {"dpi": 300} if ending in (".png", ".tif") else {}
        found = READERS[ending](written(one, tmp_path / f"a{ending}", **options), 300)
        assert found.sum() == pytest.approx(shown(one, 300).sum(), rel=0.03, abs=1e-3)


def test_bytes_are_the_same_twice(sheet, tmp_path):
    for ending, k in itertools.product((*READERS, ".svgz", ".dxf", ".gcode", ".hpgl"), (1, 2)):
        written(sheet, tmp_path / f"{k}{ending}")
    for ending in READERS:
        assert (tmp_path / f"1{ending}").read_bytes() == (tmp_path / f"2{ending}").read_bytes()
