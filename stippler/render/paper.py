"""The page on the desk."""

from __future__ import annotations

import moderngl
import numpy as np

from stippler.camera import Camera, Size
from stippler.render.shaders import Program

Color = tuple[float, float, float]


def page_matrix(camera: Camera, size_px: Size) -> np.ndarray:
    """Return the camera's matrix as GL stores it, column after column."""
    return np.ascontiguousarray(camera.matrix(size_px).T)


class PaperPass:
    """Clears to the desk and lays the paper on it."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = Program(ctx, "page.vert", "paper.frag")
        self._vertices = ctx.vertex_array(self._program.gl, [])

    def draw(
        self, camera: Camera, size_px: Size, page_mm: tuple[float, float], paper: Color, desk: Color
    ) -> None:
        """Draw into the framebuffer in use, which is already cleared to the desk."""
        ctx = self._ctx
        ctx.enable_only(moderngl.BLEND)
        ctx.blend_equation = moderngl.FUNC_ADD
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        margin = SHADOW_PX / camera.px_per_mm
        shade = tuple(0.82 * c for c in desk)
        self._program.set(
            {
                "u_page_to_clip": page_matrix(camera, size_px),
                "u_rect_mm": (-margin, -margin, page_mm[0] + margin, page_mm[1] + margin),
                "u_page_mm": page_mm,
                "u_px_per_mm": camera.px_per_mm,
                "u_paper_color": paper,
                "u_shadow": (*shade, SHADOW_PX),
            }
        )
        self._vertices.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Free the GL objects."""
        self._vertices.release()
        self._program.release()


SHADOW_PX = 12.0
