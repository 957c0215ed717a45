"""Long dots lay down the tone that is asked for, by exact unions of their drawn outlines."""

import numpy as np
import pytest
import shapely
from shapely.geometry import Polygon, box

from stippler.drawing.dots import Dots
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.drawing.style_shape import shaped
from stippler.kernels.shapes.dot_shape import outlines
from stippler.stippling.pipeline import run
from stippler.stippling.task import Task

TRIANGLE = Polygon([(0, 0), (60, 4), (20, 40)])


def tone_error(
    style: Style, part: Polygon | None, low: float, high: float, first_id: int = 0
) -> float:
    """Return by what share the ink of a drawing is off the picture's, which gets darker evenly."""
    x = np.linspace(low, high, 480, dtype=np.float32)
    reference = Reference(np.tile(x, (320, 1)), 60.0)
    parts = () if part is None else (part,)
    *_, made = run(Task(style, reference, parts_mm=parts), snapshots=False)
    within = box(0, 0, 60, 40) if part is None else part
    plain = Dots.round(made.position_mm, made.radius_mm, first_id=first_id)
    dots = shaped(plain, style, reference)
    drawn = shapely.union_all(shapely.make_valid(shapely.polygons(outlines(dots, 64))))
    ink = shapely.intersection(drawn, within).area * 1.0008  # corners lie on the outline
    return float(ink / within.area / (low + (high - low) * within.centroid.x / 60.0) - 1.0)


@pytest.mark.parametrize("part", [None, TRIANGLE], ids=["page", "triangle"])
@pytest.mark.parametrize(
    ("style", "low", "high"),
    [
        ({"elongation": 2.0}, 0.3, 0.5),
        ({"elongation": 3.0, "direction_by": "set", "direction_deg": 30.0}, 0.2, 0.6),
        ({"pen": "quill"}, 0.3, 0.6),
        ({"pen": "brush"}, 0.2, 0.7),
        ({"elongation": 2.0}, 0.7, 0.86),
    ],
)  # fmt: skip
def test_long_dots_meet_the_tone(style, low, high, part):
    asked = Style(n_dots=3000, iterations=12, **style)
    assert abs(tone_error(asked, part, low, high)) < 0.005


def test_they_do_whatever_shapes_chance_gives_them():
    """Dots of an area get ids, and so shapes, that are not known while sizes are solved."""
    style = Style(n_dots=3000, iterations=12, pen="brush")
    assert abs(tone_error(style, TRIANGLE, 0.3, 0.6, first_id=77_000)) < 0.005
