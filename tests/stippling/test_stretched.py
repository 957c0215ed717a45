"""Long dots lay down the tone that is asked for, by exact unions of their drawn outlines."""

import numpy as np
import pytest
import shapely
from shapely import affinity
from shapely.geometry import Polygon, box

from stippler.drawing.dots import Dots
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.drawing.style_shape import shaped
from stippler.kernels.shapes.dot_shape import outlines
from stippler.kernels.tone.ellipses import mark_covered
from stippler.stippling.pipeline import run
from stippler.stippling.stretched import _one_in_each_square
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
    shapes = shapely.make_valid(shapely.polygons(outlines(dots, 64)))
    drawn = shapely.disjoint_subset_union_all(shapes)
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


def test_places_are_covered_where_ellipses_contain_them():
    rng = np.random.default_rng(7)
    w, h = 90, 50
    at, columns, rows = _one_in_each_square(w, h, 400, 3)
    points, radii = rng.uniform(-4, 94, (60, 2)), rng.uniform(0.01, 8.0, 60)
    dots = Dots.round(points, radii.astype(np.float32))
    dots.elongation[:] = rng.uniform(1, 6, 60)
    dots.angle_rad[:] = rng.uniform(0, 3.2, 60)
    found, angle = np.zeros(len(at), np.uint8), dots.angle_rad.astype(float)
    mark_covered(
        at, columns, rows, np.array([w / columns, h / rows]), points, radii,
        dots.elongation.astype(float), np.cos(angle), np.sin(angle), found,
    )  # fmt: skip
    stretch = np.sqrt(dots.elongation.astype(float))
    expected = np.zeros(len(at), np.bool_)
    for i in range(60):
        ellipse = shapely.transform(
            shapely.buffer(shapely.Point(0, 0), 1.0, quad_segs=256),
            lambda xy, i=i: xy * radii[i] * (stretch[i], 1 / stretch[i]),
        )
        turned = affinity.rotate(ellipse, angle[i], (0, 0), use_radians=True)
        moved = affinity.translate(turned, *points[i])
        expected |= shapely.contains_xy(moved, *at.T)
    assert expected.any()
    assert np.count_nonzero(expected != found) <= len(at) * 1e-4  # the outline has corners
