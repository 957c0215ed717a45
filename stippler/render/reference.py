"""The reference picture, shown on the page under the dots."""

from __future__ import annotations

import moderngl

from stippler.drawing.reference import Reference
from stippler.render.frame import Frame
from stippler.render.paper import page_matrix
from stippler.render.shaders import Program
from stippler.render.state import set_state

MAX_SIDE_PX = 4096


class ReferenceTexture:
    """The darkness of a reference, as a texture.

    Attributes
    ----------
    size_mm : (width, height)
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._texture: moderngl.Texture | None = None
        self._shown: Reference | None = None
        self.size_mm = (1.0, 1.0)

    @property
    def is_set(self) -> bool:
        """Whether there is one to show."""
        return self._texture is not None

    def set(self, reference: Reference | None) -> None:
        """Hold another reference; uploads only if it is another one."""
        if reference is self._shown:
            return
        if self._texture is not None:
            self._texture.release()
            self._texture = None
        self._shown = reference
        if reference is None:
            return
        most = min(MAX_SIDE_PX, int(self._ctx.info["GL_MAX_TEXTURE_SIZE"]))
        levels = reference.levels
        every = slice(None, None, -(-max(levels.shape) // most))
        seen = (levels.darkness(every, every) * 255 + 0.5).astype("u1")
        texture = self._ctx.texture(seen.shape[::-1], 1, seen.tobytes(), alignment=1)
        texture.build_mipmaps()
        texture.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
        texture.repeat_x = texture.repeat_y = False
        self._texture = texture
        self.size_mm = (reference.width_mm, reference.height_mm)

    def use(self, unit: int) -> None:
        """Bind it to a texture unit."""
        assert self._texture is not None
        self._ctx.clear_samplers(unit, unit + 1)
        self._texture.use(unit)

    def release(self) -> None:
        """Free the GL objects."""
        self.set(None)


class ReferencePass:
    """Lays a reference on the paper."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = Program(ctx, "page.vert", "reference.frag")
        self._vertices = ctx.vertex_array(self._program.gl, [])

    def draw(self, reference: ReferenceTexture, frame: Frame) -> None:
        """Draw into the framebuffer in use, as it looks when it is adjusted."""
        set_state(self._ctx, "over")
        reference.use(0)
        *curve, exponent = frame.adjustment.curve
        self._program.set(
            {
                "u_page_to_clip": page_matrix(frame.camera, frame.size_px),
                "u_rect_mm": (0.0, 0.0, *reference.size_mm),
                "u_size_mm": reference.size_mm,
                "u_darkness": 0,
                "u_px_per_mm": frame.camera.px_per_mm,
                "u_opacity": min(frame.opacity, 1.0),
                "u_ink_color": frame.ink,
                "u_curve": tuple(curve),
                "u_exponent": exponent,
            }
        )
        self._vertices.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Free the GL objects."""
        self._vertices.release()
        self._program.release()
