"""The shader's outline is the kernel's, to 1 % of the radius; a preview is what is left behind."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stippler.brushes.tip import Tip
from stippler.camera import Camera
from stippler.drawing.dots import Dots
from stippler.drawing.pens import PENS
from stippler.drawing.preview import Preview
from stippler.drawing.reference import Reference
from stippler.drawing.shape_change import Edges, LinearChange, ShapeChange, to
from stippler.kernels.shapes.dot_shape import outlines
from stippler.render.frame import Frame

RADIUS_PX = 100.0
SIZE = (640, 640)

in_one_context = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def bilinear(image: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return an image's values between pixel centres."""
    x, y = (points - 0.5).T
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    u, v = x - i, y - j
    top = image[j, i] * (1 - u) + image[j, i + 1] * u
    return top * (1 - v) + (image[j + 1, i] * (1 - u) + image[j + 1, i + 1] * u) * v


def normals(ring: np.ndarray) -> np.ndarray:
    along = np.roll(ring, -1, axis=0) - np.roll(ring, 1, axis=0)
    outwards = np.column_stack([along[:, 1], -along[:, 0]])
    return outwards / np.linalg.norm(outwards, axis=1, keepdims=True)


@in_one_context
@given(
    elongation=st.floats(1, 4, width=32),
    angle=st.floats(-7, 7, width=32),
    roughness=st.floats(0, 1, width=32),
    seed=st.integers(0, 2**32 - 1),
)
def test_the_edge_on_screen_is_the_outline(
    renderer, canvas, shaped, elongation, angle, roughness, seed
):
    """A hundredth of the radius inside the outline is inked, a hundredth outside is not."""
    renderer.scene.set_page(6.4, 6.4)
    dots = shaped(
        [(3.2, 3.2)], 1.0, elongation=elongation, angle=angle, roughness=roughness, seed=seed
    )
    renderer.scene.set_dots(dots)
    target = canvas(SIZE)
    camera = Camera((3.2, 3.2), RADIUS_PX)
    renderer.draw(Frame(camera, SIZE, paper=(1, 1, 1), ink=(0, 0, 0)), target.framebuffer)
    seen = 1.0 - target.pixels()[:, :, 0] / 255.0
    ring = outlines(dots, 400)[0] * RADIUS_PX
    step = normals(ring) * 0.01 * RADIUS_PX
    # Where the outline turns within a few pixels a step along the normal may leave by the far side.
    inside = bilinear(seen, ring - step)
    outside = bilinear(seen, ring + step)
    assert (inside > 0.5).mean() > 0.995
    assert (outside < 0.5).mean() > 0.995
    on = bilinear(seen, ring)
    assert np.abs(on - 0.5).mean() < 0.06


def hill() -> Reference:
    y, x = np.mgrid[0:90, 0:120] / 90.0
    return Reference(np.exp(-8 * ((x - 0.6) ** 2 + (y - 0.5) ** 2)).astype(np.float32), 40.0)


ANY = math.pi / 2
CHANGES = {
    "enlarge": ShapeChange(radius=LinearChange(1.4)),
    "set size": ShapeChange(radius=to(0.5)),
    "reduce": ShapeChange(radius=LinearChange(0.5, -0.01)),
    "deform": ShapeChange(elongation=LinearChange(addend=1.2), roughness=LinearChange(addend=0.5)),
    "round": ShapeChange(elongation=to(1.0), roughness=to(0.0)),
    "direct": ShapeChange(elongation=to(3.0), angle_rad=0.7),
    "upright": ShapeChange(elongation=to(2.0), angle_rad=math.pi / 2),
    "scatter": ShapeChange(elongation=LinearChange(1.3), scatter_rad=ANY),
    "along edges": ShapeChange(elongation=to(3.0), edges=Edges(hill(), 1.0)),
    "stretch": ShapeChange(stretch=0.8, angle_rad=math.pi / 2),
    "stretch at random": ShapeChange(stretch=0.8, angle_rad=0.0, scatter_rad=ANY),
    "stretch along edges": ShapeChange(stretch=0.8, edges=Edges(hill(), 1.0)),
    "pen": PENS[-1].change,
}
CORNERS = ((-1.0, -0.8), (0.9, -0.9), (0.2, 0.0), (0.7, 1.0), (-0.6, 0.6))
TIPS = {
    "hard": (Tip(hardness=1.0), 9.0),
    "soft": (Tip(hardness=0.2), 12.0),
    "ellipse": (Tip("ellipse", 0.4, 0.3, 0.5), 14.0),
    "square": (Tip("square", 0.5, angle_rad=0.3), 9.0),
    "polygon": (Tip("polygon", 0.3, corners=CORNERS), 11.0),
}
AT, STRENGTH = (22.0, 13.0), 0.7


def weights(where: str, dots: Dots, selected: np.ndarray) -> np.ndarray | float:
    """Return how far each dot follows: what a brush's tip says, or the selection."""
    if where in TIPS:
        tip, radius = TIPS[where]
        return STRENGTH * tip.weight(dots.position_mm - AT, radius)
    return selected.astype(float) if where == "selected" else 1.0


def preview_of(change: ShapeChange, where: str) -> Preview:
    if where in TIPS:
        tip, radius = TIPS[where]
        return Preview(change, tip.footprint(AT, radius, STRENGTH))
    return Preview(change, where)


CASES = [("deform", where) for where in (*TIPS, "selected")]
CASES += [(change, where) for change in CHANGES for where in ("all", "soft")]


@pytest.mark.parametrize(("change", "where"), CASES)
def test_letting_go_leaves_what_the_preview_showed(renderer, ink, many, change, where):
    dots = many()
    selected = np.arange(len(dots)) % 3 == 0
    renderer.scene.set_page(40, 30)
    renderer.scene.set_dots(dots, selected)
    camera, size = Camera((20, 15), 24.0), (960, 720)
    plain = ink(camera, size)
    shown = ink(camera, size, preview=preview_of(CHANGES[change], where))
    new = CHANGES[change].of(dots, weights(where, dots, selected))
    made = dataclasses.replace(dots, **new)
    assert (ink(camera, size) == plain).all()
    renderer.scene.set_dots(made, selected)
    left = ink(camera, size)
    assert np.abs(left - plain).max() > 0.5
    assert np.abs(shown - left).max() < 0.05
    assert np.abs(shown - left).mean() < 2e-4


def test_a_preview_uploads_nothing(renderer, ink, many, monkeypatch):
    renderer.scene.set_page(40, 30)
    renderer.scene.set_dots(many())
    ink(Camera((20, 15), 8.0), (320, 240))
    revision = renderer.scene.dots.revision
    before = renderer.scene.dots.gl.read()
    preview = Preview(ShapeChange(radius=LinearChange(2.0)))
    ink(Camera((20, 15), 8.0), (320, 240), preview=preview)
    assert renderer.scene.dots.revision == revision
    assert renderer.scene.dots.gl.read() == before


def test_an_enlarged_preview_reaches_into_the_view(renderer, ink, shaped):
    """A dot that is hidden as it is must be seen where the preview makes it reach the window."""
    renderer.scene.set_page(40, 30)
    renderer.scene.set_dots(shaped([(20.0, 15.0), (1.0, 1.0)], 0.5))
    camera = Camera((24.0, 15.0), 100.0)
    assert ink(camera, (320, 240)).sum() == 0
    preview = Preview(ShapeChange(radius=to(3.0)))
    assert ink(camera, (320, 240), preview=preview).sum() > 1000


@pytest.mark.parametrize("pen", PENS, ids=lambda pen: pen.name)
def test_a_pen_keeps_areas_and_ranges(pen, many):
    new = pen.change.of(many(kind="round"))
    assert "radius_mm" not in new
    for name, (low, high) in (("elongation", pen.elongation), ("roughness", pen.roughness)):
        assert new[name].min() >= np.float32(low) - 1e-6
        assert new[name].max() <= np.float32(high) + 1e-6
        assert np.ptp(new[name]) >= 0.9 * (high - low)
    away = new["angle_rad"] - pen.angle_rad
    away -= math.pi * np.round(away / math.pi)  # the same axis
    assert np.abs(away).max() <= pen.spread_rad + 1e-6
    assert np.ptp(away) >= 1.8 * pen.spread_rad


def test_pens_and_changes_refuse_nonsense():
    from stippler.drawing.pens import Pen
    from stippler.errors import ParameterError

    for wrong in (
        {"elongation": (0.5, 1.0)},
        {"elongation": (2.0, 1.0)},
        {"roughness": (0.0, 1.5)},
        {"spread_rad": -1.0},
        {"angle_rad": math.nan},
    ):
        with pytest.raises(ParameterError):
            Pen("x", **wrong)
    with pytest.raises(ParameterError):
        ShapeChange(radius=LinearChange(math.inf))


def test_a_change_turns_the_shorter_way():
    dots = Dots.round([(0, 0)], 1.0)
    dots.angle_rad[:] = math.radians(170)
    turned = ShapeChange(angle_rad=0.0).of(dots)["angle_rad"][0]
    assert turned == pytest.approx(math.radians(180), abs=1e-5)  # the same axis as 0
