"""Dark parts: what the dots fall short of, by the same rule that stippling reports it by."""

import numpy as np
import pytest
import shapely

from stippler.drawing.drawing import Drawing
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.editor.dark_parts import dark_outlines
from stippler.stippling.tone import rule_for, shortfall


def drawing_of(style):
    y, x = np.mgrid[0:150, 0:200]
    darkness = np.where(np.hypot(x - 100, y - 75) < 40, 0.95, 0.3).astype(np.float32)
    darkness[:10, :10] = 0.95  # 1 mm2
    reference = Reference(darkness, 20.0)
    nothing = np.empty((0, 2)), np.empty(0, np.float32)
    return Drawing.from_reference(reference, *nothing, style), reference


def test_what_is_reported_as_too_dark_becomes_an_outline():
    style = Style(n_dots=60, size_range_mm=(0.1, 0.2))
    drawing, reference = drawing_of(style)
    darkness = reference.darkness
    rim = np.concatenate([darkness[0], darkness[-1], darkness[:, 0], darkness[:, -1]])
    rule = rule_for(darkness, 60, (1.0, 2.0), rim)
    assert shortfall(darkness, rule, 0.1, 60, 60).share > 0.1
    (rings,) = dark_outlines(drawing, reference) or [[]]
    assert shapely.Polygon(rings[0].points_mm).area >= np.pi * 16 * 0.95


def test_dots_that_are_dark_enough_leave_only_what_a_level_says():
    drawing, reference = drawing_of(Style(n_dots=5000))
    assert dark_outlines(drawing, reference) == []
    (rings,) = dark_outlines(drawing, reference, 0.9)
    assert shapely.Polygon(rings[0].points_mm).area == pytest.approx(np.pi * 16, rel=0.03)
