"""A change of shape under way, as uniforms of the dots' shaders; no dot is uploaded for it."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np

from stippler.drawing.preview import MOST_CORNERS, Footprint, Preview
from stippler.drawing.reference import Reference
from stippler.drawing.shape_change import Edges

_UNIT = 1  # of the darkness; 0 is used by other passes
_OUTLINES = {"round": 0, "square": 1, "polygon": 2}


class PreviewUniforms:
    """Makes uniforms of previews; holds the darkness of a reference whose edges one goes by."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._held: Reference | None = None
        self._darkness: moderngl.Texture | None = None

    def of(
        self, preview: Preview | None, kind: str, origin_mm: tuple[float, float]
    ) -> dict[str, Any]:
        """Return the uniforms of the program for these defines, and bind what they need."""
        if preview is None:
            return {}
        change, tip = preview.change, preview.footprint
        values: dict[str, Any] = {"u_radius": change.radius[:2]}
        if kind != "ROUND":
            turns = float(change.angle_rad is not None or change.edges is not None)
            values["u_elongation"] = change.elongation
            values["u_turn"] = turns, change.angle_rad or 0.0, change.scatter_rad, change.stretch
        if kind == "ROUGH":
            values["u_roughness"] = change.roughness
        if "EDGES" in defines(preview, kind) and change.edges:
            values |= _of_edges(change.edges, origin_mm, self._bind(change.edges.reference))
        return values | (
            _of_tip(tip, origin_mm) if tip else {"u_selected_only": preview.where == "selected"}
        )

    def _bind(self, reference: Reference) -> int:
        """Bind the darkness; return how many pixels of the reference each of its pixels is."""
        most = int(self._ctx.info["GL_MAX_TEXTURE_SIZE"])
        levels = reference.levels
        step: int = -(-max(levels.shape) // most)
        if reference is not self._held:
            self.release()
            every = slice(None, None, step)
            field = levels.darkness(every, every)
            self._darkness = self._ctx.texture(field.shape[::-1], 1, field, dtype="f4")
            self._darkness.filter = moderngl.NEAREST, moderngl.NEAREST
            self._held = reference
        assert self._darkness is not None
        self._ctx.clear_samplers(_UNIT, _UNIT + 1)
        self._darkness.use(_UNIT)
        return step

    def release(self) -> None:
        """Free the GL objects."""
        if self._darkness is not None:
            self._darkness.release()
        self._darkness = self._held = None


def defines(preview: Preview | None, kind: str) -> tuple[str, ...]:
    """Return what a program that shows a preview on dots of a kind is compiled with."""
    if preview is None:
        return ()
    tip = ("TIP",) if preview.footprint else ()
    edges = ("EDGES",) if preview.change.edges and kind != "ROUND" else ()
    return ("PREVIEW", *tip, *edges)


def _of_edges(edges: Edges, origin_mm: tuple[float, float], step: int) -> dict[str, Any]:
    pixel_mm = edges.reference.pixel_mm * step
    return {
        "u_edges": (edges.reach_mm, pixel_mm, -origin_mm[0], -origin_mm[1]),
        "u_darkness": _UNIT,
    }


def _of_tip(tip: Footprint, origin_mm: tuple[float, float]) -> dict[str, Any]:
    x, y = (tip.center_mm[i] - origin_mm[i] for i in (0, 1))
    corners = np.zeros((MOST_CORNERS, 2), np.float32)
    corners[: len(tip.corners)] = np.reshape(tip.corners, (-1, 2))
    return {
        "u_tip": (x, y, tip.reach_mm),
        "u_tip_to_unit": tip.to_unit,
        "u_tip_effect": (tip.hardness, tip.strength, tip.depth),
        "u_tip_outline": (_OUTLINES[tip.outline], len(tip.corners)),
        "u_corners": corners,
    }
