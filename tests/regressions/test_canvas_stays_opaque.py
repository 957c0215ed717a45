"""A page drawn with its picture and shadow was see-through, and the desk shone into the window."""

import numpy as np

from stippler import headless
from stippler.camera import Camera
from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.reference import Reference
from stippler.render.frame import Frame
from stippler.render.renderer import Renderer
from stippler.render.state import release_target

SIZE = (160, 120)


def test_all_pixels_are_opaque() -> None:
    ctx = headless.open_context()
    renderer = Renderer(ctx)
    target = ctx.framebuffer([ctx.texture(SIZE, 4)])
    renderer.scene.set_page(40, 30)
    dots = Dots.round([(10, 10), (30, 20)], 4.0)
    dots.constraint[0] = FIXED
    renderer.scene.set_dots(dots)
    renderer.scene.set_reference(Reference(np.full((30, 40), 0.7, np.float32), 40.0))
    renderer.draw(Frame(Camera((20, 15), 3.0), SIZE, opacity=0.5), target)
    alpha = np.frombuffer(target.read(components=4), np.uint8)[3::4]
    release_target(ctx, target)
    renderer.release()
    ctx.release()
    assert (alpha == 255).all()
