"""Pictures without a window: any size in strips, and a clear word where there is no GL."""

import math

import moderngl
import numpy as np
import pytest

from stippler import headless
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import DisplayError, ParameterError


@pytest.fixture(scope="module")
def context():
    ctx = headless.open_context()
    yield ctx
    ctx.release()


@pytest.fixture
def drawing():
    rng = np.random.default_rng(4)
    one = Drawing.blank(Page(50, 37))
    one.dots = Dots.round(rng.uniform(0, (50, 37), (400, 2)), rng.uniform(0.2, 1.0, 400))
    one.dots.elongation[::2] = 2.5
    one.dots.roughness[::3] = 0.8
    return one


def test_size_type_and_colours(drawing, context):
    image = headless.render_image(
        drawing, px_per_mm=4.0, paper=(1, 0.5, 0), ink=(0, 0, 1), context=context
    )
    assert image.shape == (148, 200, 3)
    assert image.dtype == np.uint8
    colors = {tuple(c) for c in image.reshape(-1, 3).tolist()}
    assert (255, 128, 0) in colors or (255, 127, 0) in colors
    assert (0, 0, 255) in colors


def test_grey_is_the_first_channel(drawing, context):
    grey = headless.render_image(drawing, px_per_mm=4.0, grey=True, context=context)
    color = headless.render_image(drawing, px_per_mm=4.0, context=context)
    assert grey.shape == (148, 200)
    assert (grey == color[:, :, 0]).all()


@pytest.mark.parametrize("strip_px", [1, 5_000, 20_000])
def test_strips_are_cut_out_of_the_whole(drawing, context, monkeypatch, strip_px):
    whole = headless.render_image(drawing, px_per_mm=7.0, grey=True, context=context)
    monkeypatch.setattr(headless, "_STRIP_PX", strip_px)
    strips = list(headless.render_strips(drawing, px_per_mm=7.0, grey=True, context=context))
    assert len(strips) > 3
    assert all(strip.shape[1] == 350 for strip in strips)
    np.testing.assert_allclose(np.concatenate(strips).astype(int), whole.astype(int), atol=1)


def test_strips_are_rendered_as_they_are_asked_for(drawing, context, monkeypatch):
    monkeypatch.setattr(headless, "_STRIP_PX", 5_000)
    strips = headless.render_strips(drawing, px_per_mm=7.0, context=context)
    assert next(strips).shape == (16, 350, 3)
    strips.close()  # gives everything back
    assert headless.render_image(drawing, px_per_mm=1.0, context=context).shape == (37, 50, 3)


def test_a_page_wider_than_the_driver_draws_at_once_is_tiled(drawing, context, monkeypatch):
    whole = headless.render_image(drawing, px_per_mm=7.0, context=context)
    grey = headless.render_image(drawing, px_per_mm=7.0, grey=True, context=context)
    monkeypatch.setattr(headless, "_most_columns", lambda _: 97)
    tiled = headless.render_image(drawing, px_per_mm=7.0, context=context)
    assert np.abs(tiled.astype(int) - whole).max() <= 1
    assert np.array_equal(
        headless.render_image(drawing, px_per_mm=7.0, grey=True, context=context).shape, grey.shape
    )


def test_a_picture_wider_than_16384_pixels_is_made():
    one = Drawing.blank(Page(170, 1))
    one.dots = Dots.round([(169.5, 0.5), (0.5, 0.5)], 0.3)
    strip = headless.render_image(one, px_per_mm=100.0, grey=True)
    assert strip.shape == (100, 17_000)
    assert strip[50, [50, 16_950]].tolist() == [0, 0]
    assert (strip[:, 200:16_800] == 255).all()


def test_what_fails_half_way_gives_everything_back(drawing, context, monkeypatch):
    made = []
    for name in ("framebuffer", "buffer", "program"):
        make = getattr(moderngl.Context, name)

        def noted(self, *args, make=make, **kwargs):
            made.append(make(self, *args, **kwargs))
            return made[-1]

        monkeypatch.setattr(moderngl.Context, name, noted)

    def fail(*_):
        raise RuntimeError("out of memory")

    monkeypatch.setattr(headless.Renderer, "draw", fail)
    with pytest.raises(RuntimeError):
        headless.render_image(drawing, px_per_mm=7.0, context=context)
    assert made
    assert all(type(one.mglo).__name__ == "InvalidObject" for one in made)


def test_without_a_context_one_is_opened(drawing):
    image = headless.render_image(drawing, px_per_mm=2.0)
    assert image.shape == (74, 100, 3)


def test_an_image_that_rounds_is_paper_to_its_edges():
    """10.4 px become 10: no row at the edge shows the desk."""
    blank = Drawing.blank(Page(10.4, 99.7))
    image = headless.render_image(blank, px_per_mm=1.0, paper=(0, 0, 0), ink=(1, 1, 1))
    assert image.shape == (100, 10, 3)
    assert (image == 0).all()


def test_ink_is_the_area_of_the_dots(context):
    one = Drawing.blank(Page(30, 20))
    one.dots = Dots.round([(8, 8), (20, 12)], [3.0, 2.0])
    image = headless.render_image(one, px_per_mm=10.0, grey=True, context=context)
    assert (255 - image).sum() / 255 == pytest.approx(math.pi * 13 * 100, rel=1e-3)


@pytest.mark.parametrize("scale", [0.0, -1.0, math.nan, math.inf, 1e-9, 1e9])
def test_sizes_that_make_no_picture_are_refused(drawing, scale):
    with pytest.raises(ParameterError, match="resolution"):
        headless.image_size(drawing, scale)


@pytest.mark.parametrize(
    ("drivers", "chosen"),
    [
        (["llvmpipe (LLVM 19)", None, "NVIDIA H100"], "NVIDIA H100"),
        (["NVIDIA H100", "llvmpipe"], "NVIDIA H100"),
        (["llvmpipe"], "llvmpipe"),
    ],
)
def test_a_gpu_is_preferred_to_software_wherever_it_stands(monkeypatch, drivers, chosen):
    class Context:
        def __init__(self, name):
            self.info, self.released = {"GL_RENDERER": name}, False

        def release(self):
            self.released = True

    made = []

    def create(*, require, backend, device_index=0):
        if device_index >= len(drivers) or drivers[device_index] is None:
            raise Exception("no such device")
        made.append(Context(drivers[device_index]))
        return made[-1]

    monkeypatch.setattr(moderngl, "create_standalone_context", create)
    ctx = headless.open_gpu_context()
    assert ctx.info["GL_RENDERER"] == chosen
    assert [one for one in made if not one.released] == [ctx]


def test_no_gl_is_said_with_what_to_install(monkeypatch):
    def fails(**options):
        raise Exception("cannot open libEGL.so")

    monkeypatch.setattr(moderngl, "create_standalone_context", fails)
    with pytest.raises(DisplayError, match=r"libEGL\.so.*apt install libegl1"):
        headless.open_context()
