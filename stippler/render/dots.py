"""Dots: buffers of instances, the ink they add up to, and its laying on the page."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.camera import Camera, Size
from stippler.drawing.dots import Dots
from stippler.kernels.dot_shape import pack_dots, pack_positions
from stippler.render.paper import Color, page_matrix
from stippler.render.shaders import Program

_DOT = 12  # bytes: x, y, radius
_SHAPE = 12  # bytes: elongation, angle, roughness, flags, seed


class DotBuffers:
    """The dots as the GPU holds them, with room to grow."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._room = 0
        self.n = 0
        self.dot = ctx.buffer(reserve=_DOT)
        self.shape = ctx.buffer(reserve=_SHAPE)
        self.is_rough = False

    def set(self, dots: Dots, origin_mm: tuple[float, float]) -> bool:
        """Upload all; return whether the buffers are new ones."""
        n = len(dots)
        grown = self._grow(n)
        place, shape = pack_dots(dots, origin_mm)
        self.dot.orphan()
        self.shape.orphan()
        if n:
            self.dot.write(place)
            self.shape.write(shape)
        self.n, self.is_rough = n, bool((dots.roughness > 0).any())
        return grown

    def set_positions(
        self, position_mm: NDArray[np.float64], radius_mm: NDArray[np.float32], origin_mm: tuple
    ) -> bool:
        """Upload round dots."""
        n = len(position_mm)
        grown = self._grow(n)
        place = pack_positions(position_mm, radius_mm, origin_mm)
        self.dot.orphan()
        self.shape.orphan()
        if n:
            self.dot.write(place)
            self.shape.write(np.zeros((n, 3), np.uint32))
        self.n, self.is_rough = n, False
        return grown

    def _grow(self, n: int) -> bool:
        if n <= self._room:
            return False
        self._room = max(1024, 2 ** (n - 1).bit_length())
        self.release()
        self.dot = self._ctx.buffer(reserve=self._room * _DOT)
        self.shape = self._ctx.buffer(reserve=self._room * _SHAPE)
        return True

    def release(self) -> None:
        """Free the GL objects."""
        self.dot.release()
        self.shape.release()


class DotsPass:
    """Adds up the coverage of all dots off screen, then inks the page with it."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self.buffers = DotBuffers(ctx)
        self._programs = {
            rough: Program(ctx, "dots.vert", "dots.frag", ["ROUGH"] if rough else [])
            for rough in (False, True)
        }
        self._resolve = Program(ctx, "page.vert", "resolve.frag")
        self._page = ctx.vertex_array(self._resolve.gl, [])
        self._vertices: dict[bool, moderngl.VertexArray] = {}
        self._ink: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None
        self._bind()

    def _bind(self) -> None:
        for array in self._vertices.values():
            array.release()
        place, shape = self.buffers.dot, self.buffers.shape
        self._vertices = {
            rough: self._ctx.vertex_array(
                program.gl, [(place, "3f4/i", "a_dot"), (shape, "3u4/i", "a_shape")]
            )
            for rough, program in self._programs.items()
        }

    def set(self, dots: Dots, origin_mm: tuple[float, float]) -> None:
        """Upload all dots."""
        if self.buffers.set(dots, origin_mm):
            self._bind()

    def set_positions(self, position_mm, radius_mm, origin_mm) -> None:
        """Upload round dots."""
        if self.buffers.set_positions(position_mm, radius_mm, origin_mm):
            self._bind()

    def gather(self, camera: Camera, size_px: Size, origin_mm: tuple[float, float]) -> None:
        """Add up the coverage of all dots in the pass's own target."""
        target = self._sized(size_px)
        target.use()
        target.clear()
        if not self.buffers.n:
            return
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_equation = moderngl.FUNC_ADD
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE
        program = self._programs[self.buffers.is_rough]
        center = [camera.center_mm[i] - origin_mm[i] for i in (0, 1)]
        program.set(
            {
                "u_page_to_px": np.ascontiguousarray(camera.linear().T.astype(np.float32)),
                "u_center_mm": tuple(center),
                "u_px_to_clip": (2 / size_px[0], -2 / size_px[1]),
                "u_px_per_mm": camera.px_per_mm,
            }
        )
        self._vertices[self.buffers.is_rough].render(
            moderngl.TRIANGLE_STRIP, vertices=4, instances=self.buffers.n
        )

    def lay(self, camera: Camera, size_px: Size, page_mm: tuple[float, float], ink: Color) -> None:
        """Ink the page in the framebuffer in use with what was gathered."""
        assert self._ink is not None
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_equation = moderngl.FUNC_ADD
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        self._ctx.clear_samplers(0, 1)
        self._ink.use(0)
        self._resolve.set(
            {
                "u_page_to_clip": page_matrix(camera, size_px),
                "u_rect_mm": (0.0, 0.0, *page_mm),
                "u_ink": 0,
                "u_ink_color": ink,
            }
        )
        self._page.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _sized(self, size_px: Size) -> moderngl.Framebuffer:
        if self._target is None or self._target.size != tuple(size_px):
            self._release_target()
            self._ink = self._ctx.texture(size_px, 2, dtype="f4")
            self._ink.filter = moderngl.NEAREST, moderngl.NEAREST
            self._target = self._ctx.framebuffer([self._ink])
        return self._target

    def _release_target(self) -> None:
        if self._target is not None and self._ink is not None:
            self._target.release()
            self._ink.release()
        self._target = self._ink = None

    def release(self) -> None:
        """Free the GL objects."""
        self._release_target()
        for array in self._vertices.values():
            array.release()
        self._page.release()
        for program in (*self._programs.values(), self._resolve):
            program.release()
        self.buffers.release()
