"""Ink along borders of any direction, on both sides, by the exact union of the discs."""

import numpy as np
import pytest
import shapely
from shapely.geometry import box

from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.planar import edits
from stippler.drawing.planar.edits import Outcome
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.policies import with_policy
from stippler.drawing.style import Style
from stippler.jobs.processing import process_now
from tests.stippling.test_tone_of_each_area import H, W, asked, laid, pictured

SPACING = np.sqrt(W * H / 3000)
BAND = 2.0 * SPACING


def across(seed: int) -> np.ndarray:
    """Return a line over the page, straight or in waves, in any direction."""
    rng = np.random.default_rng(seed)
    turn, middle = rng.uniform(0.0, np.pi), np.array([30.0, 20.0]) + rng.uniform(-4.0, 4.0, 2)
    way = np.array([np.cos(turn), np.sin(turn)])
    t = np.linspace(-80.0, 80.0, 81)[:, None]
    waves = (seed % 2) * 1.5 * np.sin(t / rng.uniform(2.0, 5.0))
    return middle + t * way + waves * np.array([-way[1], way[0]])


def halved(seed: int, policy: str) -> Document:
    """Return a page in two areas; the border between them has a policy."""
    nothing = np.empty((0, 2)), np.empty(0, np.float32)
    style = Style(n_dots=3000, iterations=12)
    document = Document(Drawing.from_reference(pictured("middle"), *nothing, style))
    edit_areas(document, "Cut", lambda m: edits.split(m, Path.polyline(across(seed)), 0))
    runs = {
        k: [(0, len(a.path.points_mm) - 1, policy)]
        for k, a in document.drawing.borders.items() if -1 not in (a.left, a.right)
    }  # fmt: skip
    edit_areas(document, "Border", lambda m: Outcome(with_policy(m, runs)))
    return document


def off_in_bands(document: Document) -> np.ndarray:
    """Return by how much ink is off beside the border, on both sides, and in both areas."""
    dots, reference = document.dots, document.drawing.reference
    parts = [document.partition.part_of(k) for k in sorted(document.drawing.areas)]
    line = shapely.intersection(*parts).intersection(box(2, 2, W - 2, H - 2))
    bands = [line.buffer(BAND, cap_style="flat").intersection(part) for part in parts]
    radius = dots.radius_mm.astype(float)
    return np.array([
        laid(dots.position_mm, radius, part) / asked(reference, part) - 1.0
        for part in (*bands, *parts)
    ])  # fmt: skip


@pytest.mark.parametrize(("policy", "most"), [("wall", 0.02), ("through", 0.03), ("bleed", 0.05)])
def test_two_spacings_along_any_border_meet_the_tone(policy, most):
    """Where a border bled on both sides, ink was laid twice: 4 % too much of it, up to 6.5."""
    off = []
    for seed in range(5):
        document = halved(seed, policy)
        process_now(document, sorted(document.drawing.areas))
        off.append(off_in_bands(document))
        assert np.abs(off[-1][2:]).max() < 0.005
    bands = np.array(off)[:, :2]
    assert np.abs(bands).max() < most
    assert abs(bands.mean()) < 0.012


def test_an_area_that_bleeds_onto_dots_lays_no_ink_twice():
    for seed in range(2):
        document = halved(seed, "bleed")
        both = sorted(document.drawing.areas)
        process_now(document, both)
        for k in both:
            process_now(document, [k])
            off = off_in_bands(document)[2:]
            assert abs(off[both.index(k)]) < 0.005
