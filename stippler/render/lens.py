"""A round lens over the page: the same drawing at another scale, mixed as light."""

from __future__ import annotations

from dataclasses import replace

import moderngl

from stippler.render.frame import Frame
from stippler.render.paper import Color
from stippler.render.renderer import Renderer
from stippler.render.shaders import Program
from stippler.render.state import release_target, set_state, set_target


class LensPass:
    """Draws what a lens shows into a picture of its own, with rim and shadow.

    A lens of glass mixes ink and paper as light, not as the numbers of a display: a grey of fine
    dots looks through it as it does from afar. So the page is drawn in light, into floats, and
    encoded at the end.

    Attributes
    ----------
    size : (int, int, float)
        Diameter; margin for rim and shadow; width of each of the rim's two lines. Pixels.
    texture : moderngl.Texture
        The picture, with alpha; the diameter and a margin on each side.
    """

    def __init__(
        self, ctx: moderngl.Context, diameter_px: int, margin_px: int, rim_px: float
    ) -> None:
        self._ctx = ctx
        self.size = (diameter_px, margin_px, rim_px)
        self._program = Program(ctx, "lens.vert", "lens.frag")
        self._vertices = ctx.vertex_array(self._program.gl, [])
        size_px = (diameter_px, diameter_px)
        self._seen = ctx.texture(size_px, 4, dtype="f2")
        self._seen.filter = moderngl.NEAREST, moderngl.NEAREST
        self._glass = ctx.framebuffer([self._seen])
        whole = (diameter_px + 2 * margin_px, diameter_px + 2 * margin_px)
        self.texture = ctx.texture(whole, 4)
        self.texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self._target = ctx.framebuffer([self.texture])

    @property
    def margin_px(self) -> int:
        """Around the lens in the picture."""
        return self.size[1]

    def draw(self, renderer: Renderer, frame: Frame) -> None:
        """Draw a frame of a screen of the diameter; its colours are encoded, as on any other."""
        d, margin, rim_px = self.size
        marks = frame.marks and (_light(frame.marks[0]), _light(frame.marks[1]))
        in_light = replace(
            frame,
            size_px=(d, d),
            paper=_light(frame.paper),
            desk=_light(frame.desk),
            ink=_light(frame.ink),
            marks=marks,
        )
        renderer.draw(in_light, self._glass)
        set_target(self._ctx, self._target, self.texture.size)
        set_state(self._ctx, "none")
        self._ctx.clear_samplers(0, 1)
        self._seen.use(0)
        self._program.set(
            {
                "u_seen": 0,
                "u_radius_px": d / 2,
                "u_margin_px": float(margin),
                "u_rim_px": rim_px,
            }
        )
        self._vertices.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Free the GL objects."""
        for framebuffer in (self._glass, self._target):
            release_target(self._ctx, framebuffer)
        self._vertices.release()
        self._program.release()


def _light(color: Color) -> Color:
    """Return how much light an encoded colour is."""
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color)
    return red, green, blue
