"""What lies over the drawing and is no part of it: the outline of a brush."""

from __future__ import annotations

import moderngl

from stippler.camera import Camera, Point, Size
from stippler.render.shaders import Program
from stippler.render.state import set_state

LINE_PX = 1.25


class OverlayPass:
    """Draws rings on the page, seen on black and on white."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = Program(ctx, "ring.vert", "ring.frag")
        self._vertices = ctx.vertex_array(self._program.gl, [])

    def draw(self, camera: Camera, size_px: Size, center_mm: Point, radius_mm: float) -> None:
        """Draw a ring into the framebuffer in use."""
        set_state(self._ctx, "over")
        x, y = camera.page_to_screen(center_mm, size_px)
        self._program.set(
            {
                "u_ring": (x, size_px[1] - y, radius_mm * camera.px_per_mm, LINE_PX),
                "u_px_to_clip": (2 / size_px[0], 2 / size_px[1]),
            }
        )
        self._vertices.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Free the GL objects."""
        self._vertices.release()
        self._program.release()
