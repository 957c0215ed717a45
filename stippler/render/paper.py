"""The page on the desk."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.camera import Camera, Size
from stippler.render.shaders import Program
from stippler.render.state import set_state

Color = tuple[float, float, float]
Origin = tuple[float, float]

SHADOW_PX = 14.0
SHADE = 0.80  # of the desk's colour, where the shadow is deepest


def page_matrix(camera: Camera, size_px: Size) -> NDArray[np.float32]:
    """Return the camera's matrix as GL stores it, column after column."""
    return np.ascontiguousarray(camera.matrix(size_px).T)


def page_uniforms(camera: Camera, size_px: Size, origin_mm: Origin) -> dict[str, Any]:
    """Return what turns mm from an origin into pixels, y up, and those into GL's clip space."""
    upwards = np.array([[1.0], [-1.0]])
    matrix = (upwards * camera.linear()).T.astype(np.float32)
    return {
        "u_page_to_px": np.ascontiguousarray(matrix),
        "u_center_mm": tuple(camera.center_mm[i] - origin_mm[i] for i in (0, 1)),
        "u_middle_px": (size_px[0] / 2, size_px[1] / 2),
        "u_px_to_clip": (2 / size_px[0], 2 / size_px[1]),
    }


class PaperPass:
    """Lays the paper on the desk, with a soft shadow."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = Program(ctx, "paper.vert", "paper.frag")
        self._vertices = ctx.vertex_array(self._program.gl, [])

    def draw(
        self,
        camera: Camera,
        size_px: Size,
        page_mm: tuple[float, float],
        colors: tuple[Color, Color],
        *,
        edge_only: bool,
    ) -> None:
        """Draw into the framebuffer in use, which is already cleared to the desk.

        Parameters
        ----------
        colors : (paper, desk)
        edge_only : bool
            Leave out the middle, which another pass is going to cover.
        """
        paper, desk = colors
        set_state(self._ctx, "over")
        w, h = page_mm
        out, inset = SHADOW_PX / camera.px_per_mm, 2.0 / camera.px_per_mm
        has_middle = not edge_only or min(w, h) <= 2 * inset
        inner = (w / 2, h / 2, w / 2, h / 2) if has_middle else (inset, inset, w - inset, h - inset)
        self._program.set(
            {
                "u_page_to_clip": page_matrix(camera, size_px),
                "u_outer_mm": (-out, -out, w + out, h + out),
                "u_inner_mm": inner,
                "u_page_mm": page_mm,
                "u_px_per_mm": camera.px_per_mm,
                "u_paper_color": paper,
                "u_shadow": (*(SHADE * c for c in desk), SHADOW_PX),
            }
        )
        self._vertices.render(moderngl.TRIANGLE_STRIP, vertices=10)

    def release(self) -> None:
        """Free the GL objects."""
        self._vertices.release()
        self._program.release()
