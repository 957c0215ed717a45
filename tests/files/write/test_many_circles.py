"""Many round dots: circles in whole units under one scale, read by others as they are in mm."""

import sys
from pathlib import Path

import numpy as np
import pytest
import svgelements
import vpype
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).parent))
import consumers
from sheets_tried import SIZE

from stippler.drawing.dots import Dots
from stippler.files.write.formats import format_of
from stippler.files.write.options import checked
from stippler.files.write.raster import grey_strips
from stippler.files.write.sheet import Layer, Sheet

PX_PER_MM = 96 / 25.4


def sheet_of(n, low=0.12, high=0.24):
    rng = np.random.default_rng(5)
    place = rng.uniform((1, 1), (49, 24), (n, 2))
    return Sheet(*SIZE, (Layer("page", Dots.round(place, rng.uniform(low, high, n))),))


def written(sheet, path, **options):
    one = format_of(path)
    path.write_bytes(b"".join(one.write(sheet, checked(one.options, options))))
    return path


@pytest.mark.parametrize(("low", "high"), [(0.12, 0.24), (0.04, 0.06), (0.15025, 0.15025)])
def test_svgelements_finds_every_dot_in_its_place(tmp_path, low, high):
    sheet = sheet_of(2500, low, high)
    read = svgelements.SVG.parse(str(written(sheet, tmp_path / "a.svg")), ppi=25.4)
    circles = [e for e in read.elements() if isinstance(e, svgelements.Circle)]
    seen = np.array([(c.implicit_center.x, c.implicit_center.y, c.implicit_rx) for c in circles])
    (layer,) = sheet.layers
    np.testing.assert_allclose(seen[:, :2], layer.dots.position_mm, atol=0.01 * low)
    np.testing.assert_allclose(seen[:, 2], layer.dots.radius_mm, atol=0.0101 * low)
    ink = float((seen[:, 2] ** 2).sum())
    assert ink == pytest.approx(float((layer.dots.radius_mm.astype(float) ** 2).sum()), rel=5e-4)


def test_vpype_plots_them_in_mm(tmp_path):
    sheet = sheet_of(2200)
    path = written(sheet, tmp_path / "a.svg")
    document = vpype.read_multilayer_svg(str(path), quantization=0.05, crop=False)
    middles = np.array([line.mean() for line in document.layers[1]]) / PX_PER_MM
    away, _ = cKDTree(np.column_stack([middles.real, middles.imag])).query(
        sheet.layers[0].dots.position_mm
    )
    assert len(middles) == 2200
    assert away.max() < 0.005


def test_resvg_shows_the_same_ink(tmp_path):
    sheet = sheet_of(2500)
    ours = 1 - np.concatenate(list(grey_strips(sheet, 150))).astype(np.float32) / 255
    theirs = consumers.resvg(written(sheet, tmp_path / "a.svg"), 150, 16)
    assert theirs.sum() == pytest.approx(ours.sum(), rel=0.005)
    assert np.abs(consumers.averaged(ours - theirs, 16)).max() < 0.02


def test_their_files_are_smaller(tmp_path):
    rng = np.random.default_rng(0)
    some = Dots.round(rng.uniform(0, 150, (20_000, 2)), rng.uniform(0.13, 0.26, 20_000))
    sheet = Sheet(150, 150, (Layer("page", some),))
    assert written(sheet, tmp_path / "a.svg").stat().st_size < 40 * 20_000
    assert written(sheet, tmp_path / "a.svgz").stat().st_size < 10 * 20_000


@pytest.mark.parametrize("kind", ["round", "smooth", "rough"])
def test_more_dots_than_readers_take_share_paths(tmp_path, monkeypatch, kind):
    """resvg and librsvg refuse a million elements; the picture is the same."""
    from stippler.files.write import svg

    sheet = sheet_of(2500, 0.2, 0.3)
    dots = sheet.layers[0].dots
    if kind != "round":
        dots.elongation[:] = 1.5
    if kind == "rough":
        dots.roughness[:] = np.linspace(0.01, 1, len(dots))
    usual = written(sheet, tmp_path / "a.svg")
    monkeypatch.setattr(svg, "MOST_ELEMENTS", 2000)
    shared = written(sheet, tmp_path / "b.svg")
    n_elements = shared.read_bytes().count(b"<path") + shared.read_bytes().count(b"<circle")
    assert n_elements < 500
    by = 16 if kind == "round" else 4  # resvg draws strokes of few pixels lighter than circles
    both = [consumers.resvg(path, 150, by) for path in (usual, shared)]
    assert both[1].sum() == pytest.approx(both[0].sum(), rel=0.003)
    assert np.abs(consumers.averaged(both[0] - both[1], 16)).max() < 0.02
