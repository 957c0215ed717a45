"""The reference picture, shown on the page under the dots."""

from __future__ import annotations

import moderngl

from stippler.camera import Camera, Size
from stippler.drawing.adjustment import Adjustment
from stippler.drawing.reference import Reference
from stippler.render.paper import Color, page_matrix
from stippler.render.shaders import Program
from stippler.render.state import set_state

MAX_SIDE_PX = 4096


class ReferencePass:
    """Holds the reference as a texture and lays it on the paper."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = Program(ctx, "page.vert", "reference.frag")
        self._vertices = ctx.vertex_array(self._program.gl, [])
        self._texture: moderngl.Texture | None = None
        self._shown: Reference | None = None
        self._size_mm = (1.0, 1.0)

    @property
    def is_set(self) -> bool:
        """Whether there is one to show."""
        return self._texture is not None

    def set(self, reference: Reference | None) -> None:
        """Show another reference; uploads only if it is another one."""
        if reference is self._shown:
            return
        if self._texture is not None:
            self._texture.release()
            self._texture = None
        self._shown = reference
        if reference is None:
            return
        step = -(-max(reference.darkness.shape) // MAX_SIDE_PX)
        seen = (reference.darkness[::step, ::step] * 255 + 0.5).astype("u1")
        texture = self._ctx.texture(seen.shape[::-1], 1, seen.tobytes(), alignment=1)
        texture.build_mipmaps()
        texture.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
        texture.repeat_x = texture.repeat_y = False
        self._texture = texture
        self._size_mm = (reference.width_mm, reference.height_mm)

    def draw(
        self, camera: Camera, size_px: Size, opacity: float, ink: Color, adjustment: Adjustment
    ) -> None:
        """Draw into the framebuffer in use, as it looks when it is adjusted."""
        assert self._texture is not None
        set_state(self._ctx, "over")
        self._ctx.clear_samplers(0, 1)
        self._texture.use(0)
        *curve, exponent = adjustment.curve
        self._program.set(
            {
                "u_page_to_clip": page_matrix(camera, size_px),
                "u_rect_mm": (0.0, 0.0, *self._size_mm),
                "u_size_mm": self._size_mm,
                "u_darkness": 0,
                "u_px_per_mm": camera.px_per_mm,
                "u_opacity": min(opacity, 1.0),
                "u_ink_color": ink,
                "u_curve": tuple(curve),
                "u_exponent": exponent,
            }
        )
        self._vertices.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Free the GL objects."""
        self.set(None)
        self._vertices.release()
        self._program.release()
