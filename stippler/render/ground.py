"""Grounds of ink under white dots: how much of each pixel areas cover, to the last digit."""

from __future__ import annotations

from collections.abc import Collection

import moderngl
import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.camera import Camera, Size
from stippler.render.paper import Origin, page_uniforms
from stippler.render.shaders import Program
from stippler.render.state import set_state

_N_FLOATS = 8


class GroundBuffer:
    """The edges of areas on the GPU.

    Attributes
    ----------
    n : int
        How many there are.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self.gl: moderngl.Buffer | None = None  # with the first area
        self.n = 0
        self._known: tuple[tuple[Polygon | MultiPolygon, ...], Origin] = ((), (0.0, 0.0))

    def set(self, areas: Collection[Polygon | MultiPolygon], origin_mm: Origin) -> None:
        """Take areas that do not overlap; cheap for those that are there already."""
        known = (tuple(areas), origin_mm)
        if known == self._known:
            return
        self._known = known
        parts = [_edges(part, origin_mm) for area in areas for part in shapely.get_parts(area)]
        rows = np.concatenate(parts) if parts else np.empty((0, _N_FLOATS), np.float32)
        self.n = len(rows)
        if not self.n:
            return
        if self.gl is None or self.gl.size < rows.nbytes:
            self._drop()
            self.gl = self._ctx.buffer(reserve=1 << (rows.nbytes - 1).bit_length())
        self.gl.write(rows)

    def _drop(self) -> None:
        if self.gl is not None:
            self.gl.release()
        self.gl = None

    def release(self) -> None:
        """Free the GL buffer."""
        self._drop()


def _edges(part: Polygon, origin_mm: Origin) -> NDArray[np.float32]:
    """Return both ends of each edge of a polygon, its holes' too, and the box around it."""
    turned = shapely.orient_polygons(part)
    ends = []
    for ring in (turned.exterior, *turned.interiors):
        points = shapely.get_coordinates(ring) - origin_mm
        ends.append(np.hstack([points[:-1], points[1:]]))
    edges = np.concatenate(ends)
    low, high = edges.reshape(-1, 2).min(axis=0), edges.reshape(-1, 2).max(axis=0)
    box = np.broadcast_to((*low, *high), edges.shape)
    return np.hstack([edges, box]).astype(np.float32)


class GroundPass:
    """Adds up the coverage of areas in an ink target."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program: Program | None = None  # with the first area
        self._bound: tuple[moderngl.Buffer, moderngl.VertexArray] | None = None

    def draw(self, buffer: GroundBuffer, camera: Camera, whole_px: Size, origin_mm: Origin) -> None:
        """Add areas to the target in use, of a size."""
        if buffer.gl is None or not buffer.n:
            return
        set_state(self._ctx, "add")
        if self._program is None:
            self._program = Program(self._ctx, "ground.vert", "ground.frag", [])
        if self._bound is None or self._bound[0] is not buffer.gl:
            self._forget()
            content = [(buffer.gl, "4f4 4f4/i", "a_edge", "a_box")]
            self._bound = buffer.gl, self._ctx.vertex_array(self._program.gl, content)
        self._program.set(page_uniforms(camera, whole_px, origin_mm))
        self._bound[1].render(moderngl.TRIANGLE_STRIP, vertices=4, instances=buffer.n)

    def _forget(self) -> None:
        if self._bound is not None:
            self._bound[1].release()
        self._bound = None

    def release(self) -> None:
        """Free the GL objects."""
        self._forget()
        if self._program is not None:
            self._program.release()
