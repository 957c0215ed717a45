"""Lines: printed ones as ink, guides as marks; each segment a quad."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.camera import Camera, Size
from stippler.drawing.line import Line
from stippler.drawing.pattern import Pattern
from stippler.errors import GeometryError
from stippler.render.paper import Color, Origin, page_uniforms
from stippler.render.shaders import Program
from stippler.render.state import set_state

Rows = NDArray[np.float32]

_N_FLOATS = 8
_GUIDE_PX = 1.2
_NONE: Rows = np.empty((0, _N_FLOATS), np.float32)


class LineBuffer:
    """Segments of lines on the GPU: those drawn in ink, guides, and outlines of patterns.

    Attributes
    ----------
    revision : int
        Counts changes.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._rows: dict[int, tuple[Line, Origin, Rows]] = {}
        self.ink, self.guides, self.patterns = (Segments(ctx) for _ in range(3))
        self.revision = 0

    def set(self, lines: Mapping[int, Line], origin_mm: Origin) -> None:
        """Take lines by their ids; those that are the same values as before are not looked at."""
        kept = {}
        for k, line in lines.items():
            known = self._rows.get(k)
            if known is None or known[0] is not line or known[1] != origin_mm:
                known = (line, origin_mm, _rows_of(line, origin_mm))
            kept[k] = known
        self._rows = kept
        shown = [(line, rows) for line, _, rows in kept.values() if not line.hidden]
        self.ink.set([rows for line, rows in shown if line.is_inked])
        self.guides.set([rows for line, rows in shown if not line.is_inked])
        self.revision += 1

    def set_patterns(self, patterns: Iterable[Pattern], origin_mm: Origin) -> None:
        """Take the outlines of patterns, as far as they meet the page."""
        self.patterns.set([_outlines_of(pattern, origin_mm) for pattern in patterns])
        self.revision += 1

    @property
    def is_empty(self) -> bool:
        """Whether there is no ink."""
        return self.ink.n == 0

    def release(self) -> None:
        """Free the GL buffers."""
        for one in (self.ink, self.guides, self.patterns):
            if one.gl is not None:
                one.gl.release()


class Segments:
    """A GL buffer of segments, with what is in it."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self.gl: moderngl.Buffer | None = None  # with the first line
        self.rows = _NONE

    @property
    def n(self) -> int:
        """How many."""
        return len(self.rows)

    def set(self, parts: list[Rows]) -> None:
        """Upload others."""
        self.rows = np.concatenate(parts) if parts else _NONE
        if not self.n:
            return
        if self.gl is None or self.gl.size < self.rows.nbytes:
            if self.gl is not None:
                self.gl.release()
            self.gl = self._ctx.buffer(reserve=1 << (self.rows.nbytes - 1).bit_length())
        self.gl.write(self.rows)


def _rows_of(line: Line, origin_mm: Origin) -> Rows:
    """Return x0, y0, x1, y1, half widths, and which ends are the line's, of each segment."""
    segments = line.segments()
    rows = np.zeros((len(segments), _N_FLOATS), np.float32)
    rows[:, :4] = segments[:, :4] - (*origin_mm, *origin_mm)
    rows[:, 4:6] = segments[:, 4:6]
    if not line.is_closed:
        rows[0, 6] = rows[-1, 7] = 1.0
    return rows


def _outlines_of(pattern: Pattern, origin_mm: Origin) -> Rows:
    """Return the edges of a pattern's polygons that have a corner on the page.

    None where a file has one beyond its horizon: the page is drawn all the same.
    """
    try:
        corners, start = pattern.rings_mm()
    except GeometryError:
        return _NONE
    at = corners - origin_mm
    on = (np.abs(at) <= origin_mm).all(axis=1)
    shown = np.repeat(np.add.reduceat(on, start[:-1]) > 0, np.diff(start))
    following = np.arange(1, len(at) + 1)
    following[start[1:] - 1] = start[:-1]
    rows = np.zeros((int(shown.sum()), _N_FLOATS), np.float32)
    rows[:, :2], rows[:, 2:4] = at[shown], at[following[shown]]
    return rows


class LinesPass:
    """Lays lines into an ink target, before dots are added; draws guides as marks."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._programs: dict[str, Program] = {}
        self._arrays: dict[tuple[str, int], tuple[moderngl.Buffer, moderngl.VertexArray]] = {}

    def draw(self, buffer: LineBuffer, camera: Camera, whole_px: Size, origin_mm: Origin) -> None:
        """Ink lines into the target in use; where they overlap the larger coverage counts."""
        if buffer.is_empty:
            return
        set_state(self._ctx, "most")
        self._run("", buffer.ink, _scaled(camera, whole_px, origin_mm))

    def draw_marks(
        self, segments: Segments, camera: Camera, size_px: Size, origin_mm: Origin, color: Color
    ) -> None:
        """Draw fine lines in a colour, whatever the zoom, into the framebuffer in use."""
        if not segments.n:
            return
        set_state(self._ctx, "over")
        values = page_uniforms(camera, size_px, origin_mm)
        self._run("MARKS", segments, values | {"u_color": color, "u_half_px": _GUIDE_PX / 2})

    def _run(self, kind: str, segments: Segments, uniforms: dict[str, Any]) -> None:
        program = self._programs.get(kind)
        if program is None:
            defines = [kind] if kind else []
            program = self._programs[kind] = Program(self._ctx, "lines.vert", "lines.frag", defines)
        assert segments.gl is not None
        key = (kind, id(segments))
        buffer, array = self._arrays.get(key, (None, None))
        if array is None or buffer is not segments.gl:
            if array is not None:
                array.release()
            form = "4f4 8x 2f4/i" if kind else "4f4 2f4 2f4/i"
            names = ("a_ends", "a_loose") if kind else ("a_ends", "a_half", "a_loose")
            array = self._ctx.vertex_array(program.gl, [(segments.gl, form, *names)])
            self._arrays[key] = segments.gl, array
        program.set(uniforms)
        array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=segments.n)

    def release(self) -> None:
        """Free the GL objects."""
        for _, array in self._arrays.values():
            array.release()
        self._arrays.clear()
        for program in self._programs.values():
            program.release()
        self._programs.clear()


def _scaled(camera: Camera, whole_px: Size, origin_mm: Origin) -> dict[str, Any]:
    return page_uniforms(camera, whole_px, origin_mm) | {"u_px_per_mm": camera.px_per_mm}
