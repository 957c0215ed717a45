"""Dots: small ones as point sprites, large ones as quads, none that the view does not show."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.camera import Camera, Size
from stippler.drawing.preview import Preview
from stippler.drawing.shape_change import MAX_RADIUS_MM, ShapeChange
from stippler.kernels.shapes import gpu_dots
from stippler.kernels.shapes.dot_shape import MAX_ELONGATION, MAX_ROUGH
from stippler.render.dot_buffer import DotBuffer
from stippler.render.frame import Frame
from stippler.render.ink import MARGIN_PX
from stippler.render.paper import Color, Origin, page_uniforms
from stippler.render.preview import PreviewUniforms, defines
from stippler.render.shaders import Program
from stippler.render.state import set_state

_ROUGH_FROM_PX = 1.0  # as in shaders/lib/ink.glsl
_ALONE_PX = 4.0  # dots of this radius need not know of one another
_PAD_STEP = 1.25  # pads of previews are rounded up by this, or each would choose dots anew


@dataclass(frozen=True, slots=True)
class _View:
    """What decides which dots are drawn, and how."""

    camera: Camera
    size_px: Size
    pad: float  # a dot reaches at most so many of its radii
    largest_mm: float  # radius of the largest point sprite
    revision: int


class DotsPass:
    """Adds up the coverage of all dots in an ink target.

    Blending is additive, so the order of dots does not matter: neither that of the drawing, nor
    that small ones come before large ones.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._bound: moderngl.Buffer | None = None  # what the vertex arrays read
        self._preview = PreviewUniforms(ctx)
        self.n_draw_calls = 0
        self._programs: dict[tuple[str, ...], Program] = {}
        self._arrays: dict[tuple[str | int, ...], moderngl.VertexArray] = {}
        self._chosen = [_Chosen(ctx), _Chosen(ctx)]  # small, large
        self._parts = _Parts(ctx)
        self._seen: _View | None = None
        self._all_small = True
        span = ctx.info["GL_POINT_SIZE_RANGE"]
        self._reach_px = min(MARGIN_PX - 2.0, float(span[1]) / 2 - 1.0)

    def draw(
        self,
        buffer: DotBuffer,
        frame: Frame,
        origin_mm: Origin,
        whole: Size,
        *,
        in_white: bool = False,
    ) -> None:
        """Add dots seen by a frame's camera to the ink target in use, of a size.

        All black dots, or all white ones.
        """
        camera, preview = frame.camera, frame.preview
        if not in_white:
            self.n_draw_calls = 0
        if buffer.n == 0:
            return
        if buffer.gl is not self._bound:
            self._forget_buffer()
            self._bound = buffer.gl
        if buffer.max_radius_mm * camera.px_per_mm < _ALONE_PX:
            buffer.find_shares()
        self._choose(buffer, frame, origin_mm)
        set_state(self._ctx, "add", sprites=True)
        kind = _kind(buffer, camera, preview)
        uniforms = self._uniforms(frame, whole, kind, origin_mm)
        names = (kind, *defines(preview, kind))
        if not buffer.polarity.is_plain:
            names = (*names, "POLARITY")
            uniforms["u_paint"] = gpu_dots.IN_WHITE * in_white
        if kind == "ROUGH" and preview is None and self._all_small:
            self._run_parts(buffer, camera, names, uniforms)
        else:
            self._run_chosen(buffer, names, uniforms)

    def draw_marks(
        self, buffer: DotBuffer, frame: Frame, origin_mm: Origin, colors: tuple[Color, Color]
    ) -> None:
        """Colour the fixed and the selected dots in the framebuffer in use, after `draw`."""
        if not buffer.has_flags or buffer.n == 0:
            return
        camera, preview = frame.camera, frame.preview
        set_state(self._ctx, "over", sprites=True)
        kind = _kind(buffer, camera, preview)
        uniforms = self._uniforms(frame, frame.size_px, kind, origin_mm)
        uniforms |= {"u_fixed_color": colors[0], "u_selected_color": colors[1]}
        self._run_chosen(buffer, (kind, *defines(preview, kind), "MARKS"), uniforms)

    def _uniforms(
        self, frame: Frame, size_px: Size, kind: str, origin_mm: Origin
    ) -> dict[str, Any]:
        uniforms = page_uniforms(frame.camera, size_px, origin_mm)
        uniforms["u_px_per_mm"] = frame.camera.px_per_mm
        return uniforms | self._preview.of(frame.preview, kind, origin_mm)

    def _run_parts(
        self, buffer: DotBuffer, camera: Camera, names: tuple[str, ...], uniforms: dict[str, Any]
    ) -> None:
        """Draw by the shader for rough dots only those that are large enough to look rough."""
        parts = self._parts
        parts.find(buffer, _ROUGH_FROM_PX / camera.px_per_mm)
        for kind, part in (("SMOOTH", parts.smooth), ("ROUGH", parts.rough)):
            self._run((kind, *names[1:], "POINTS"), buffer.gl, part.n, uniforms, part.gl)

    def _run_chosen(
        self, buffer: DotBuffer, names: tuple[str, ...], uniforms: dict[str, Any]
    ) -> None:
        if self._all_small:
            self._run((*names, "POINTS"), buffer.gl, buffer.n, uniforms)
            return
        small, large = self._chosen
        self._run((*names, "POINTS"), small.gl, small.n, uniforms)
        self._run((*names, "QUADS"), large.gl, large.n, uniforms)

    def _choose(self, buffer: DotBuffer, frame: Frame, origin_mm: Origin) -> None:
        """Decide what to draw, unless the view is the one it was decided for."""
        camera, size_px, preview = frame.camera, frame.size_px, frame.preview
        pad = _pad(buffer, preview.change if preview else None)
        small_mm = self._reach_px / (camera.px_per_mm * pad)
        view = _View(camera, size_px, pad, small_mm, buffer.revision)
        if view == self._seen:
            return
        self._seen = view
        inside = _inside_mm(camera, size_px, origin_mm)
        shown = _share_shown(inside, origin_mm)
        self._all_small = buffer.max_radius_mm <= small_mm and shown > 0.5
        if not self._all_small:
            for chosen, limits in zip(
                self._chosen, ((0.0, small_mm), (small_mm, math.inf)), strict=True
            ):
                chosen.set(gpu_dots.choose(buffer.rows, inside, pad, limits))

    def reach_mm(self, buffer: DotBuffer, change: ShapeChange) -> float:
        """Return how far from its centre a dot may be seen when it is changed."""
        return _pad(buffer, change) * buffer.max_radius_mm if buffer.n else 0.0

    def _run(
        self,
        names: tuple[str, ...],
        data: moderngl.Buffer,
        n: int,
        uniforms: dict[str, Any],
        index: moderngl.Buffer | None = None,
    ) -> None:
        if n == 0:
            return
        program = self._programs.get(names)
        if program is None:
            asked = [d for d in names if d not in ("SMOOTH", "QUADS")]
            program = Program(self._ctx, "dots.vert", "dots.frag", asked)
            self._programs[names] = program
        as_points = "POINTS" in names
        key: tuple[str | int, ...] = (*names, data.glo, index.glo if index else 0)
        array = self._arrays.get(key)
        if array is None:
            rate = "" if as_points else "/i"
            content = [(data, f"3f4 3u4{rate}", "a_dot", "a_shape")]
            array = self._ctx.vertex_array(program.gl, content, index_buffer=index)
            self._arrays[key] = array
        if as_points:
            assert self._seen is not None
            uniforms = uniforms | {"u_largest_mm": self._seen.largest_mm}
        program.set(uniforms)
        if as_points:
            array.render(moderngl.POINTS, vertices=n)
        else:
            array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=n)
        self.n_draw_calls += 1

    def _forget_buffer(self) -> None:
        """Let go of everything bound to a GL buffer that is no more."""
        for array in self._arrays.values():
            array.release()
        self._arrays.clear()

    def release(self) -> None:
        """Free the GL objects."""
        self._forget_buffer()
        for program in self._programs.values():
            program.release()
        self._programs.clear()
        for chosen in self._chosen:
            chosen.gl.release()
        self._parts.release()
        self._preview.release()


def _pad(buffer: DotBuffer, change: ShapeChange | None) -> float:
    """Return how many of its radii a dot reaches at most."""
    if change is None:
        return math.sqrt(buffer.max_elongation * (1.0 + MAX_ROUGH * buffer.is_rough))
    long = MAX_ELONGATION if change.elongates else buffer.max_elongation
    pad = math.sqrt(long * (1.0 + MAX_ROUGH * (buffer.is_rough or change.roughens)))
    pad *= _largest_mm(buffer, change) / buffer.max_radius_mm
    return float(_PAD_STEP ** math.ceil(math.log(pad, _PAD_STEP)))


def _largest_mm(buffer: DotBuffer, change: ShapeChange | None) -> float:
    """Return what no dot's radius is above."""
    largest = buffer.max_radius_mm
    if change is None:
        return largest
    changed = largest * change.radius.factor + change.radius.addend
    return max(largest, min(changed, MAX_RADIUS_MM))


def _kind(buffer: DotBuffer, camera: Camera, preview: Preview | None) -> str:
    """Return the cheapest shader that draws all dots right."""
    change = preview.change if preview else None
    is_rough = buffer.is_rough or (change is not None and change.roughens)
    if buffer.is_round and not (is_rough or (change is not None and change.elongates)):
        return "ROUND"
    largest_px = _largest_mm(buffer, change) * camera.px_per_mm
    return "ROUGH" if is_rough and largest_px > _ROUGH_FROM_PX else "SMOOTH"


class _Chosen:
    """A GL buffer with some of the dots, or with the numbers of some."""

    def __init__(self, ctx: moderngl.Context, bytes_each: int = 24) -> None:
        self._each = bytes_each
        self._room = 256
        self.gl = ctx.buffer(reserve=self._room * bytes_each)
        self.n = 0

    def set(self, rows: NDArray[np.uint32]) -> None:
        self.n = len(rows)
        if self.n > self._room:
            self._room = 1 << (self.n - 1).bit_length()
            self.gl.orphan(self._room * self._each)
        if self.n:
            self.gl.write(rows)


class _Parts:
    """Which dots look rough at a scale, and which do not, though their outlines are."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.rough, self.smooth = _Chosen(ctx, 4), _Chosen(ctx, 4)
        self._found: object = None

    def find(self, buffer: DotBuffer, from_mm: float) -> None:
        """Part the dots of a buffer, unless they are parted so."""
        key = (buffer.revision, from_mm)
        if key != self._found:
            rough, smooth = gpu_dots.part_by_roughness(buffer.rows, from_mm)
            self.rough.set(rough)
            self.smooth.set(smooth)
            self._found = key

    def release(self) -> None:
        """Free the GL objects."""
        self.rough.gl.release()
        self.smooth.gl.release()


def _inside_mm(
    camera: Camera, size_px: Size, origin_mm: Origin
) -> tuple[float, float, float, float]:
    """Return left, top, right and bottom of what the screen shows, from the origin."""
    w, h = size_px
    corners = camera.screen_to_page([(-1, -1), (w + 1, -1), (-1, h + 1), (w + 1, h + 1)], size_px)
    low, high = corners.min(axis=0) - origin_mm, corners.max(axis=0) - origin_mm
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _share_shown(inside: tuple[float, float, float, float], origin_mm: Origin) -> float:
    """Return how much of the page the rectangle covers."""
    share = 1.0
    for low, high, half in zip(inside[:2], inside[2:], origin_mm, strict=True):
        share *= max(min(high, half) - max(low, -half), 0.0) / (2 * half)
    return share
