"""Strokes of many dots, written by blocks, are a path for each size, each from the corner on."""

import re

import numpy as np

from stippler.drawing.dots import Dots
from stippler.files.write import svg
from stippler.files.write.sheet import Layer, Sheet
from stippler.files.write.sizes import by_size


def text_of(dots, monkeypatch, block):
    monkeypatch.setattr(svg, "_STROKES_BLOCK", block)
    sheet = Sheet(90.0, 60.0, (Layer("dots", dots),))
    return b"".join(svg.chunks(sheet, {"round_dots": "compound", "decimals": 3})).decode()


def test_each_path_leads_to_its_dots_whatever_the_blocks(monkeypatch):
    rng = np.random.default_rng(4)
    at, radius = rng.random((3000, 2)) * (90, 60), rng.uniform(0.1, 0.2, 3000)
    dots = Dots.round(at, radius.astype(np.float32))
    whole = text_of(dots, monkeypatch, 10**6)
    assert text_of(dots, monkeypatch, 7) == whole
    paths = re.findall(r'<path stroke-width="([\d.]+)" d="([^"]*)"/>', whole)
    sizes = list(by_size(dots.radius_mm))
    assert len(paths) == len(sizes) > 100
    for (width, d), (diameter, rows) in zip(paths, sizes, strict=True):
        assert abs(float(width) - diameter) < 1e-6
        steps = re.findall(r"m(-?[\d.]+) ?(-?[\d.]+)h0", d)
        place = np.cumsum(np.array(steps, np.float64), axis=0)
        assert np.abs(place - at[rows]).max() < 0.5001e-3


def test_one_size_is_one_path(monkeypatch):
    dots = Dots.round(np.array([[1.0, 2.0], [3.0, 4.0]]), np.float32(0.25))
    found = text_of(dots, monkeypatch, 100)
    assert '<path stroke-width="0.5" d="m1 2h0m2 2h0"/>' in found
