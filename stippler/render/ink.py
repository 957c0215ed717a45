"""The ink that all dots add up to: where it is gathered, and its laying on the page."""

from __future__ import annotations

import moderngl

from stippler.camera import Camera, Size
from stippler.render.paper import Color, page_matrix
from stippler.render.shaders import Program
from stippler.render.state import release_target, set_state, set_target

MARGIN_PX = 40
"""Around the picture, so that sprites whose centre lies outside are drawn too."""


class InkTarget:
    """A picture of coverage, added up in floats; a little larger than the frame."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = Program(ctx, "page.vert", "resolve.frag")
        self._vertices = ctx.vertex_array(self._program.gl, [])
        self._texture: moderngl.Texture | None = None
        self._framebuffer: moderngl.Framebuffer | None = None

    def begin(self, size_px: Size) -> Size:
        """Clear what a frame of this size needs, put it in use, and return its size."""
        whole = (size_px[0] + 2 * MARGIN_PX, size_px[1] + 2 * MARGIN_PX)
        framebuffer = self._sized(whole)
        set_target(self._ctx, framebuffer, whole)
        framebuffer.clear(viewport=(0, 0, *whole))
        return whole

    def _sized(self, whole: Size) -> moderngl.Framebuffer:
        """Return a framebuffer at least this large: a part of the page needs no other one."""
        now = self._framebuffer
        if now is not None and now.width >= whole[0] and now.height >= whole[1]:
            return now
        size = whole if now is None else (max(now.width, whole[0]), max(now.height, whole[1]))
        self._release_target()
        self._texture = self._ctx.texture(size, 1, dtype="f4")
        self._texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self._framebuffer = self._ctx.framebuffer([self._texture])
        return self._framebuffer

    def lay(
        self,
        camera: Camera,
        size_px: Size,
        page_mm: tuple[float, float],
        ink: Color,
        ground: Color | None,
    ) -> None:
        """Ink the page in the framebuffer in use, over a ground or over what is there."""
        assert self._texture is not None
        set_state(self._ctx, "none" if ground else "over")
        self._ctx.clear_samplers(0, 1)
        self._texture.use(0)
        self._program.set(
            {
                "u_page_to_clip": page_matrix(camera, size_px),
                "u_rect_mm": (0.0, 0.0, *page_mm),
                "u_ink": 0,
                "u_margin_px": MARGIN_PX,
                "u_ink_color": ink,
                "u_ground": (*ground, 1.0) if ground else (0.0, 0.0, 0.0, 0.0),
            }
        )
        self._vertices.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _release_target(self) -> None:
        if self._framebuffer is not None:
            release_target(self._ctx, self._framebuffer)
        self._framebuffer = self._texture = None

    def release(self) -> None:
        """Free the GL objects."""
        self._release_target()
        self._vertices.release()
        self._program.release()
