"""Small drawings with every kind of content: for the corpus of released files, and for fuzzing."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stippler.drawing import records
from stippler.drawing.adjustment import Adjustment
from stippler.drawing.area_edits import edit_areas
from stippler.drawing.deformation import Cage, Deformation
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.foreign import Foreign
from stippler.drawing.line import ADHERE, Line
from stippler.drawing.pattern import TONED, Pattern, PolygonSet
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path, path_of_cubics
from stippler.drawing.reference import Picture, Reference
from stippler.drawing.style import Style


def dots() -> Drawing:
    """Dots of all shapes on a page of one area."""
    rng = np.random.default_rng(3)
    drawing = Drawing.blank(Page(40.0, 30.0), Style(n_dots=24, seed=7))
    made = Dots.round(1.0 + rng.random((24, 2)) * (38, 28), 0.1 + 0.3 * rng.random(24))
    made.elongation[:] = 1.0 + rng.random(24)
    made.angle_rad[:] = rng.random(24)
    made.roughness[:] = rng.random(24)
    made.constraint[::5] = FIXED
    made.id[:] = rng.permutation(99)[:24]
    drawing.dots = made
    drawing.next_id = {"dot": 120}
    return drawing


def areas() -> Drawing:
    """Areas with shared borders, straight and curved, and styles of their own."""
    drawing = dots()
    document = Document(drawing)
    box = Path.polyline([(4, 4), (20, 4), (20, 20), (4, 20)], closed=True)
    leaf = path_of_cubics(
        [np.array([(15.0, 10.0), (22.0, 2.0), (34.0, 6.0), (36.0, 15.0)]),
         np.array([(36.0, 15.0), (30.0, 26.0), (20.0, 24.0), (15.0, 10.0)])], closed=True,
    )  # fmt: skip
    edit_areas(document, "Draw area", lambda m: edits.add(m, box))
    edit_areas(document, "Draw area", lambda m: edits.add(m, leaf))
    return document.drawing.snapshot()


def lines() -> Drawing:
    """Lines, and dots that hold on to one."""
    drawing = dots()
    path = Path.polyline([(5.0, 5.0), (20.0, 12.0), (30.0, 25.0)], closed=False)
    drawing.lines[2] = Line("vein", path, (0.1, 0.4), True, ADHERE, 0.2, 1.5)
    drawing.dots.constraint[:3] = ON_CURVE
    drawing.dots.curve[:3] = 2
    drawing.dots.parameter[:3] = (0.5, 1.5, 2.5)
    return drawing


def patterns() -> Drawing:
    """A pattern of polygons over an area, bent by a cage and a pin."""
    drawing = areas()
    rings = [np.array([(0.1, 0.1), (0.9, 0.1), (0.5, 0.8)])]
    cage = Cage.over((0.0, 0.0, 40.0, 30.0)).moved({5: (12.0, 9.0)})
    bent = Deformation((8.0, 0.0, 0.0, 0.0, 8.0, 0.0, 0.0, 0.0, 1.0), cage, (((9, 9), (10, 10)),))
    polygons = PolygonSet.of("thorns", rings, finest=0.5)
    drawing.patterns[1] = Pattern(1, polygons, 3, 2, bent, TONED, 0)
    return drawing


def styles() -> Drawing:
    """Styles with every field set."""
    drawing = dots()
    drawing.styles[0] = Style(
        n_dots=500, size_range_mm=(0.1, 0.3), iterations=3, seed=11, growth="triangular",
        start="border", sizes="regions", weighted=False, spacing="lloyd", pen="quill", name="ear",
    )  # fmt: skip
    drawing.styles[4] = Style(name="spare")
    return drawing


def adjusted() -> Drawing:
    """A reference that came from no file, adjusted."""
    drawing = dots()
    darkness = np.linspace(0, 1, 16, dtype=np.float32).reshape(4, 4)
    adjustment = Adjustment(0.1, -0.2, 1.5, True, 0.05, 0.9)
    drawing.reference = Reference.of(Picture.of(darkness), 40.0, adjustment)
    return drawing


def unknown() -> Drawing:
    """Parts that no program knows yet: members, fields of the document, fields of values."""
    drawing = areas()
    drawing.foreign = Foreign(
        {"weather": {"rain": [1, 2.5, None]}},
        {(records.AREA, 1): {"scent": "moss"}, (records.STYLE, 0): {"tempo": 3}},
        {"strange/part.bin": bytes(range(40))},
    )
    return drawing


CONTENTS: dict[str, Callable[[], Drawing]] = {
    make.__name__: make for make in (dots, areas, lines, patterns, styles, adjusted, unknown)
}
