"""The renderer: exact pixels, nothing leaks in or out, partial uploads equal full ones."""

import itertools
import math
from dataclasses import replace

import moderngl
import numpy as np
import pytest

from stippler import headless
from stippler.camera import Camera
from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.drawing import Page
from stippler.drawing.pens import pen_named
from stippler.drawing.preview import Preview
from stippler.drawing.reference import Reference
from stippler.errors import ParameterError
from stippler.render.frame import Frame
from stippler.render.renderer import Renderer
from stippler.render.state import release_target

PAGE = Page(40, 30)
SIZE = (320, 240)
FIT = Camera((20, 15), 8.0)
WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)


@pytest.fixture
def page(renderer):
    renderer.scene.set_page(PAGE.width_mm, PAGE.height_mm)
    return renderer


def test_a_dot_is_black_inside_white_outside_and_in_its_place(page, ink, shaped):
    page.scene.set_dots(shaped([(10.0, 5.0)], 2.0))
    seen = ink(FIT, SIZE)
    y, x = np.mgrid[:240, :320] + 0.5
    away = np.hypot(x - 80, y - 40)
    assert (seen[away < 15.4] == 1).all()
    assert (seen[away > 16.6] == 0).all()
    assert math.isclose(seen.sum(), math.pi * 16**2, rel_tol=1e-3)


def test_ink_is_the_part_of_the_pixel_within_the_dot(page, ink, shaped):
    page.scene.set_dots(shaped([(20.0, 15.0)], 10.0))
    seen = ink(Camera((20, 15), 8.05), SIZE)[120]
    edge = 160 + 10.0 * 8.05
    assert seen[int(edge)] == pytest.approx(edge % 1, abs=0.03)


@pytest.mark.parametrize("turn", [0.0, 0.7, math.pi / 2])
@pytest.mark.parametrize("flip", [False, True])
def test_dots_lie_where_the_camera_says(page, ink, shaped, turn, flip):
    place = [(12.0, 9.0), (30.0, 20.0), (25.0, 7.0)]
    page.scene.set_dots(shaped(place, [0.5, 0.7, 0.6], elongation=[1.0, 3.0, 2.0], angle=0.4))
    camera = Camera((22, 14), 9.0, turn, flip)
    seen = ink(camera, SIZE)
    y, x = np.mgrid[:240, :320] + 0.5
    for (cx, cy), radius in zip(camera.page_to_screen(place, SIZE), (0.5, 0.7, 0.6), strict=True):
        near = np.hypot(x - cx, y - cy) < 20
        mass = seen[near].sum()
        assert mass == pytest.approx(math.pi * (radius * 9) ** 2, rel=0.02)
        assert (x[near] * seen[near]).sum() / mass == pytest.approx(cx, abs=0.05)
        assert (y[near] * seen[near]).sum() / mass == pytest.approx(cy, abs=0.05)


def test_an_elongated_dot_points_along_its_angle(page, ink, shaped):
    page.scene.set_dots(shaped([(20.0, 15.0)], 2.0, elongation=4.0, angle=math.radians(30)))
    seen = ink(FIT, SIZE)
    y, x = np.mgrid[:240, :320] + 0.5
    dx, dy = x - 160, y - 120
    xx, yy, xy = ((seen * v).sum() for v in (dx * dx, dy * dy, dx * dy))
    assert 0.5 * math.atan2(2 * xy, xx - yy) == pytest.approx(math.radians(30), abs=1e-3)
    spread = np.sqrt(np.linalg.eigvalsh([[xx, xy], [xy, yy]]))
    assert spread[1] / spread[0] == pytest.approx(4.0, rel=0.02)


def test_a_dot_may_fill_the_window(page, ink, shaped):
    page.scene.set_dots(shaped([(20.0001, 15.0)], 0.15))
    camera = Camera((20.0001 + 0.15, 15.0), 60_000.0)
    seen = ink(camera, SIZE)
    assert (seen[:, :158] == 1).all(axis=1).sum() > 200  # the edge runs down the middle
    assert (seen[120, 162:] == 0).all()
    inside = ink(Camera((20.0001, 15.0), 60_000.0), SIZE)
    assert (inside == 1).all()


@pytest.mark.parametrize("kind", ["round", "smooth", "rough"])
def test_small_and_large_dots_meet_without_a_seam(page, ink, many, kind):
    """At the zoom where sprites give way to quads, ink grows with the square of the scale."""
    page.scene.set_dots(many(10, 8, kind))
    measured = []
    for scale in np.linspace(12, 60, 8):
        size = (round(40 * scale), round(30 * scale))
        seen = ink(Camera((20, 15), size[0] / 40), size)
        measured.append(seen.sum() / size[0] ** 2)
    np.testing.assert_allclose(measured, measured[-1], rtol=2e-3)


def test_hidden_dots_are_not_drawn_and_nothing_seen_is_missing(page, ink, many):
    """Every window into the page shows the same pixels as the page drawn whole."""
    page.scene.set_dots(many())
    whole = ink(Camera((20, 15), 40.0), (1600, 1200))
    for x, y in itertools.product((0, 650, 1280), (0, 500, 960)):
        part = ink(Camera((20, 15), 40.0).tile((x, y), (320, 240), (1600, 1200)), (320, 240))
        np.testing.assert_allclose(part, whole[y : y + 240, x : x + 320], atol=1.5 / 255)


def test_the_order_of_dots_does_not_matter(page, ink, many):
    dots = many()
    page.scene.set_dots(dots)
    seen = ink(FIT, SIZE)
    page.scene.set_dots(dots.take(np.random.default_rng(0).permutation(len(dots))))
    np.testing.assert_allclose(ink(FIT, SIZE), seen, atol=1.5 / 255)


def test_partial_uploads_equal_a_full_one(page, ink, many):
    rng = np.random.default_rng(8)
    dots = many()
    page.scene.set_dots(dots)
    camera = Camera((20, 15), 60.0).tile((300, 300), SIZE, (2400, 1800))
    for _ in range(5):
        rows = rng.choice(len(dots), 12, replace=False)
        dots.position_mm[rows] += rng.normal(0, 0.3, (12, 2))
        dots.radius_mm[rows] *= 1.3
        dots.roughness[rows] = rng.uniform(0, 1, 12)
        dots.angle_rad[rows] += 1
        page.scene.update_dots(dots, rows)
        seen = {c: ink(c, SIZE) for c in (FIT, camera)}
        page.scene.set_dots(dots)
        for c, expected in seen.items():
            np.testing.assert_allclose(ink(c, SIZE), expected, atol=1.5 / 255)


def test_round_dots_that_become_rough_in_part_are_drawn_rough(page, ink, many):
    dots = many(kind="round")
    page.scene.set_dots(dots)
    before = ink(FIT, SIZE)
    dots.elongation[7], dots.roughness[7] = 3.0, 1.0
    page.scene.update_dots(dots, np.array([7]))
    seen = ink(FIT, SIZE)
    assert np.abs(seen - before).max() > 0.3
    page.scene.set_dots(dots)
    np.testing.assert_allclose(ink(FIT, SIZE), seen, atol=1.5 / 255)


def test_dots_too_small_to_look_rough_are_drawn_smooth_and_look_the_same(
    page, ink, many, monkeypatch
):
    """The same pixels as if all went through the shader for rough dots."""
    dots = many()
    dots.roughness[::4] = 0
    page.scene.set_dots(dots)
    camera, size = Camera((20, 15), 12.0), (480, 360)
    seen = ink(camera, size)
    assert page.n_draw_calls == 2
    parts = page._dots._parts
    assert 0 < parts.rough.n < len(dots)
    assert parts.rough.n + parts.smooth.n == len(dots)
    monkeypatch.setattr(
        page._dots,
        "_run_parts",
        lambda buffer, _, names, uniforms: page._dots._run_chosen(buffer, names, uniforms),
    )
    np.testing.assert_allclose(ink(camera, size), seen, atol=1.5 / 255)
    assert page.n_draw_calls == 1


@pytest.mark.parametrize("n_new", [1, 30, 900])
def test_new_dots_are_appended(page, ink, many, n_new):
    dots = many(40, 40)
    old = dots.take(slice(0, len(dots) - n_new))
    page.scene.set_dots(old)
    page.scene.update_dots(dots, np.arange(len(old), len(dots)))
    assert page.scene.n_dots == len(dots)
    seen = ink(FIT, SIZE)
    page.scene.set_dots(dots)
    np.testing.assert_allclose(ink(FIT, SIZE), seen, atol=1.5 / 255)


@pytest.mark.parametrize(
    ("name", "value"), [("elongation", 4.5), ("roughness", -0.1), ("angle_rad", math.nan)]
)
def test_shapes_outside_the_range_are_refused_with_a_message(page, ink, many, name, value):
    dots = many()
    page.scene.set_dots(dots)
    seen = ink(FIT, SIZE)
    getattr(dots, name)[3] = value
    for upload in (
        lambda: page.scene.set_dots(dots),
        lambda: page.scene.update_dots(dots, np.array([3])),
    ):
        with pytest.raises(ParameterError, match=name.removesuffix("_rad")):
            upload()
    assert (ink(FIT, SIZE) == seen).all()


def test_removed_dots_are_gone(page, ink, many):
    dots = many()
    page.scene.set_dots(dots)
    page.scene.update_dots(dots.take(slice(0, 5)), np.array([0]))
    assert page.scene.n_dots == 5
    assert ink(FIT, SIZE).sum() > 0
    page.scene.set_dots(Dots.none())
    assert (ink(FIT, SIZE) == 0).all()


def test_positions_from_a_worker_keep_shapes(page, ink, many):
    dots = many()
    page.scene.set_dots(dots)
    dots.position_mm += (0.3, -0.2)
    page.scene.set_positions(dots.position_mm, dots.radius_mm)
    seen = ink(FIT, SIZE)
    page.scene.set_dots(dots)
    np.testing.assert_allclose(ink(FIT, SIZE), seen, atol=1.5 / 255)


def test_positions_of_another_number_are_round_dots(page, ink, many):
    page.scene.set_dots(many())
    others = many(7, 5, "round")
    page.scene.set_positions(others.position_mm, others.radius_mm)
    seen = ink(FIT, SIZE)
    page.scene.set_dots(others)
    np.testing.assert_allclose(ink(FIT, SIZE), seen, atol=1.5 / 255)


def test_what_a_worker_makes_is_seen_as_its_pen_will_draw_it(page, ink, many):
    made = many(7, 5, "round")
    pen = pen_named("stick")
    page.scene.set_positions(made.position_mm, made.radius_mm)
    seen = ink(FIT, SIZE, preview=Preview(pen.change))
    page.scene.set_dots(pen.drawn(Dots.round(made.position_mm, made.radius_mm)))
    np.testing.assert_allclose(ink(FIT, SIZE), seen, atol=0.03)


def test_drawing_twice_gives_the_same_bits(page, canvas, many):
    page.scene.set_dots(many())
    target = canvas(SIZE)
    page.draw(Frame(FIT, SIZE), target.framebuffer)
    first = target.pixels()
    page.draw(Frame(FIT, SIZE), target.framebuffer)
    assert (target.pixels() == first).all()


def test_a_new_context_gives_the_same_bits(ctx, page, canvas, many):
    dots = many()
    page.scene.set_dots(dots)
    target = canvas(SIZE)
    page.draw(Frame(FIT, SIZE), target.framebuffer)
    with headless.open_context() as other:
        again = Renderer(other)
        again.scene.set_page(PAGE.width_mm, PAGE.height_mm)
        again.scene.set_dots(dots)
        framebuffer = other.framebuffer([other.renderbuffer(SIZE, 3)])
        again.draw(Frame(FIT, SIZE), framebuffer)
        data = framebuffer.read(components=3, alignment=1)
        release_target(other, framebuffer)
        again.release()
    ctx.__enter__()  # make it current again
    seen = np.frombuffer(data, np.uint8).reshape(240, 320, 3)[::-1]
    assert (seen == target.pixels()).all()


def test_foreign_state_does_no_harm(page, ctx, canvas, many):
    """Draw after someone has left every switch the wrong way round."""
    page.scene.set_dots(many())
    page.scene.set_reference(Reference(np.linspace(0, 1, 1200, dtype="f4").reshape(30, 40), 40.0))
    target = canvas(SIZE)
    page.draw(Frame(FIT, SIZE, opacity=0.5), target.framebuffer)
    expected = target.pixels()
    wrong = ctx.texture((2, 2), 4)
    sampler = ctx.sampler(filter=(moderngl.LINEAR, moderngl.LINEAR))
    for unit in range(3):
        wrong.use(unit)
        sampler.use(unit)
    ctx.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE | moderngl.RASTERIZER_DISCARD)
    ctx.blend_func = moderngl.ZERO, moderngl.ZERO
    ctx.blend_equation = moderngl.FUNC_REVERSE_SUBTRACT
    ctx.wireframe = True
    target.framebuffer.use()
    target.framebuffer.viewport = (3, 4, 5, 6)
    target.framebuffer.scissor = (1, 1, 9, 9)
    target.framebuffer.color_mask = False, True, False, True
    page.draw(Frame(FIT, SIZE, opacity=0.5), target.framebuffer)
    seen = target.pixels()
    sampler.release()
    wrong.release()
    assert (seen == expected).all()


def test_paper_desk_and_edge(page, canvas):
    target = canvas((400, 300))
    page.draw(
        Frame(Camera((20, 15), 8.0), (400, 300), paper=(1, 0, 0), desk=(0, 0, 1)),
        target.framebuffer,
    )
    seen = target.pixels()
    assert (seen[150, 200] == (255, 0, 0)).all()
    assert (seen[5, 5] == (0, 0, 255)).all()
    assert (seen[150, 41] == (255, 0, 0)).all()
    assert seen[150, 37, 2] < 255  # the shadow
    assert seen[150, 37, 0] == 0


def test_a_turned_page_has_a_smooth_edge(page, canvas):
    target = canvas((400, 300))
    camera = Camera((20, 15), 6.0, 0.3)
    page.draw(Frame(camera, (400, 300), paper=WHITE, desk=BLACK), target.framebuffer)
    levels = np.unique(target.pixels()[:, :, 0])
    assert len(levels) > 20


def test_the_reference_shows_at_its_opacity(page, canvas):
    field = np.zeros((30, 40), np.float32)
    field[:, 20:] = 1.0
    page.scene.set_reference(Reference(field, 40.0))
    target = canvas(SIZE)
    page.draw(Frame(FIT, SIZE, paper=WHITE, ink=BLACK, opacity=0.5), target.framebuffer)
    seen = target.pixels()[:, :, 0]
    assert seen[120, 80] == 255
    assert abs(int(seen[120, 240]) - 128) <= 1
    page.scene.set_reference(None)
    page.draw(Frame(FIT, SIZE, paper=WHITE, ink=BLACK, opacity=0.5), target.framebuffer)
    assert (target.pixels() == 255).all()


def test_polarity_is_a_matter_of_colours(page, canvas, many):
    page.scene.set_dots(many())
    black, white = canvas(SIZE), canvas(SIZE)
    page.draw(Frame(FIT, SIZE, paper=WHITE, desk=WHITE, ink=BLACK), black.framebuffer)
    page.draw(Frame(FIT, SIZE, paper=BLACK, desk=BLACK, ink=WHITE), white.framebuffer)
    assert np.abs(255 - black.pixels().astype(int) - white.pixels()).max() <= 1


def test_fixed_and_selected_dots_are_marked(page, canvas, shaped):
    dots = shaped([(10.0, 15.0), (20.0, 15.0), (30.0, 15.0)], 2.0)
    dots.constraint[0] = FIXED
    page.scene.set_dots(dots, np.array([False, False, True]))
    target = canvas(SIZE)
    page.draw(Frame(FIT, SIZE, ink=BLACK, marks=((1, 0, 0), (0, 0, 1))), target.framebuffer)
    row = target.pixels()[120]
    assert row[[80, 160, 240]].tolist() == [[255, 0, 0], [0, 0, 0], [0, 0, 255]]
    page.draw(Frame(FIT, SIZE, ink=BLACK, marks=None), target.framebuffer)
    assert (target.pixels()[120][[80, 160, 240]] == 0).all()


def test_an_empty_drawing_and_a_tiny_window_draw(page, canvas):
    target = canvas((1, 1))
    page.draw(Frame(FIT, (1, 1), paper=(0, 1, 0)), target.framebuffer)
    assert target.pixels().ravel().tolist() == [0, 255, 0]


def test_a_window_may_change_its_size(page, ink, many):
    page.scene.set_dots(many())
    first = ink(FIT, SIZE)
    ink(FIT, (333, 111))
    assert (ink(FIT, SIZE) == first).all()


@pytest.mark.parametrize("kind", ["round", "rough"])
def test_a_flipped_or_turned_page_is_the_picture_flipped_or_turned(page, ink, many, kind):
    page.scene.set_dots(many(kind=kind))
    upright = ink(Camera((20, 15), 9.0), (200, 200))
    flipped = ink(Camera((20, 15), 9.0, flip=True), (200, 200))
    np.testing.assert_allclose(flipped, upright[:, ::-1], atol=2 / 255)
    turned = ink(Camera((20, 15), 9.0, math.pi / 2), (200, 200))
    np.testing.assert_allclose(turned, np.rot90(upright, -1), atol=2 / 255)


def test_dots_can_be_left_out(page, canvas, many):
    dots = many()
    dots.constraint[:] = FIXED
    page.scene.set_dots(dots)
    page.scene.set_reference(Reference(np.full((3, 4), 0.4, np.float32), 40.0))
    target = canvas(SIZE)
    frame = Frame(FIT, SIZE, paper=WHITE, desk=BLACK, ink=BLACK, opacity=1.0)
    page.draw(frame, target.framebuffer)
    assert np.ptp(target.pixels()[5:-5, 5:-5]) > 100
    page.draw(replace(frame, dots=False), target.framebuffer)
    assert (target.pixels()[5:-5, 5:-5] == 153).all()
