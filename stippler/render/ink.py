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

    def use(self, unit: int) -> None:
        """Let a texture unit read it."""
        assert self._texture is not None
        self._ctx.clear_samplers(unit, unit + 1)
        self._texture.use(unit)

    def _release_target(self) -> None:
        if self._framebuffer is not None:
            release_target(self._ctx, self._framebuffer)
        self._framebuffer = self._texture = None

    def release(self) -> None:
        """Free the GL objects."""
        self._release_target()


class InkPass:
    """Lays what was gathered on the page.

    Attributes
    ----------
    ink : InkTarget
        Of black dots and of lines.
    black, white : InkTarget
        Of grounds, and of the white dots on them; only where there are any.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self.ink, self.black, self.white = InkTarget(ctx), InkTarget(ctx), InkTarget(ctx)
        self._programs: dict[bool, tuple[Program, moderngl.VertexArray]] = {}

    def lay(
        self,
        camera: Camera,
        size_px: Size,
        page_mm: tuple[float, float],
        ink: Color,
        under: Color | None,
        *,
        inverse: bool,
    ) -> None:
        """Ink the page in the framebuffer in use, over a colour or over what is there.

        `inverse`: grounds and white dots were gathered too.
        """
        program, vertices = self._program(inverse)
        set_state(self._ctx, "none" if under else "over")
        gathered = {"u_ink": self.ink}
        if inverse:
            gathered |= {"u_black": self.black, "u_white": self.white}
        for unit, target in enumerate(gathered.values()):
            target.use(unit)
        program.set(
            {
                "u_page_to_clip": page_matrix(camera, size_px),
                "u_rect_mm": (0.0, 0.0, *page_mm),
                "u_margin_px": MARGIN_PX,
                "u_ink_color": ink,
                "u_ground": (*under, 1.0) if under else (0.0, 0.0, 0.0, 0.0),
            }
            | {name: unit for unit, name in enumerate(gathered)}
        )
        vertices.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _program(self, inverse: bool) -> tuple[Program, moderngl.VertexArray]:
        if inverse not in self._programs:
            program = Program(self._ctx, "page.vert", "resolve.frag", ["INVERSE"] * inverse)
            self._programs[inverse] = program, self._ctx.vertex_array(program.gl, [])
        return self._programs[inverse]

    def release(self) -> None:
        """Free the GL objects."""
        for target in (self.ink, self.black, self.white):
            target.release()
        for program, vertices in self._programs.values():
            vertices.release()
            program.release()
