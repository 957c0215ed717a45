"""A change of shape under way, as uniforms of the dots' shaders; no dot is uploaded for it."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np

from stippler.drawing.preview import MOST_CORNERS, Footprint, Preview
from stippler.drawing.reference import Reference
from stippler.drawing.shape_change import ShapeChange

_SHAPES_ONLY = {"u_elongation", "u_roughness", "u_turn", "u_edges", "u_darkness"}
UNKNOWN = {"ROUND": _SHAPES_ONLY, "SMOOTH": {"u_roughness"}, "ROUGH": set[str]()}
"""What programs for each kind of dots do not have."""

_UNIT = 1  # of the darkness; 0 is used by other passes
_MODES = {"all": 1, "selected": 2}
_TIP = 3
_OUTLINES = {"round": 0, "square": 1, "polygon": 2}


class PreviewUniforms:
    """Makes uniforms of previews; holds the darkness of a reference whose edges one goes by."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._held: Reference | None = None
        self._darkness: moderngl.Texture | None = None

    def of(self, preview: Preview | None, origin_mm: tuple[float, float]) -> dict[str, Any]:
        """Return the uniforms for a preview or for none, and bind what they need."""
        if preview is None:
            return {"u_preview": 0}
        change, tip = preview.change, preview.footprint
        mode = _TIP if tip else _MODES[str(preview.where)]
        values = {"u_preview": mode, "u_radius": change.radius[:2]}
        values |= _of_shapes(change, origin_mm)
        if tip:
            values |= _of_tip(tip, origin_mm)
        if change.edges:
            self._bind(change.edges.reference)
        return values

    def _bind(self, reference: Reference) -> None:
        if reference is not self._held:
            self.release()
            field = reference.darkness
            self._darkness = self._ctx.texture(field.shape[::-1], 1, field, dtype="f4")
            self._darkness.filter = moderngl.NEAREST, moderngl.NEAREST
            self._held = reference
        assert self._darkness is not None
        self._ctx.clear_samplers(_UNIT, _UNIT + 1)
        self._darkness.use(_UNIT)

    def release(self) -> None:
        """Free the GL objects."""
        if self._darkness is not None:
            self._darkness.release()
        self._darkness = self._held = None


def _of_shapes(change: ShapeChange, origin_mm: tuple[float, float]) -> dict[str, Any]:
    edges = change.edges
    turns = 2.0 if edges else float(change.angle_rad is not None)
    reach, pixel = (edges.reach_mm, edges.reference.pixel_mm) if edges else (0.0, 1.0)
    return {
        "u_elongation": change.elongation,
        "u_roughness": change.roughness,
        "u_turn": (turns, change.angle_rad or 0.0, change.scatter_rad, change.stretch),
        "u_edges": (reach, pixel, -origin_mm[0], -origin_mm[1]),
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
