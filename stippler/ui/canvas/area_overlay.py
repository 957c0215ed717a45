"""Draws the borders of areas over the page, and marks the chosen ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from stippler.drawing.area import PAGE_AREA, Area
from stippler.drawing.style import BLEED, THROUGH, WALL
from stippler.editor.area_choice import AreaChoice
from stippler.editor.view import View
from stippler.ui.widgets import Rect

if TYPE_CHECKING:
    from stippler.drawing.document import Document

Points = NDArray[np.float64]
Line = list[imgui.ImVec2 | tuple[float, float] | list[float]]
_LIGHT, _DARK = 0xC0FFFFFF, 0xC0302820
_APART_PX = 0.75  # vertices nearer to the last one are left out
_TINT, _STRONG = 0x30, 0xFF
_MOST_TRIANGLES = 20_000
_BROAD_PX = 2.2
_DASHES_PX = {THROUGH: (7.0, 5.0), BLEED: (2.0, 4.0)}  # a stroke, and what is left out after it


class AreaOverlay:
    """Borders of all areas, and the chosen areas tinted in their colours."""

    def __init__(self) -> None:
        self._key: object = None
        self._borders: list[Line] = []
        self._pieces: list[tuple[Line, float]] = []
        self._rings: list[tuple[Line, int]] = []
        self._tints: list[tuple[NDArray[np.float64], int]] = []
        self._triangles: dict[int, tuple[Area, NDArray[np.float64]]] = {}

    def draw(
        self, document: Document, choice: AreaChoice, view: View, canvas: Rect, ratio: float
    ) -> None:
        """Draw into the canvas; nothing where the page was never divided."""
        if len(document.drawing.areas) < 2:
            return
        seen = (choice.revision, view.camera, view.size_px, canvas, ratio)
        # what is the same object is found equal at once
        key = (id(document), seen, dict(document.drawing.areas), dict(document.drawing.borders))
        if key != self._key:
            self._make(document, choice, view, canvas, ratio)
            self._key = key
        draw = imgui.get_background_draw_list()
        draw.push_clip_rect(canvas[:2], canvas[2:], True)
        self._fill(draw)
        for points in self._borders:
            draw.add_polyline(points, _LIGHT, 2.6, imgui.ImDrawFlags_.none)
            draw.add_polyline(points, _DARK, 1.0, imgui.ImDrawFlags_.none)
        for points, width in self._pieces:
            draw.add_polyline(points, _LIGHT, width + 1.6, imgui.ImDrawFlags_.none)
            draw.add_polyline(points, _DARK, width, imgui.ImDrawFlags_.none)
        for points, colour in self._rings:
            draw.add_polyline(points, _LIGHT, 4.2, imgui.ImDrawFlags_.closed)
            draw.add_polyline(points, colour, 2.4, imgui.ImDrawFlags_.closed)
        draw.pop_clip_rect()

    def _fill(self, draw: imgui.ImDrawList) -> None:
        draw.push_draw_flag(imgui.ImDrawFlags_.aa_fill, False)  # no seams in between
        for corners, colour in self._tints:
            for a, b, c in corners.tolist():
                draw.add_triangle_filled(a, b, c, colour)
        draw.pop_draw_flag()

    def _make(
        self, document: Document, choice: AreaChoice, view: View, canvas: Rect, ratio: float
    ) -> None:
        def placed(points_mm: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.asarray(
                view.camera.page_to_screen(points_mm, view.size_px) / ratio + canvas[:2]
            )

        low, high = np.array(canvas[:2]), np.array(canvas[2:])
        lines, pieces = _border_lines(document)
        self._borders = [thinned(p) for p in map(placed, lines) if _is_seen(p, low, high)]
        self._pieces = [
            one for policy, line in pieces
            for one in _drawn(placed(line), policy, low, high)
        ]  # fmt: skip
        self._rings, self._tints = [], []
        chosen = [k for k in choice.alive(document) if k != PAGE_AREA]
        for k in chosen:
            area = document.drawing.areas[k]
            for ring in _rings(area):
                p = placed(ring)
                if _is_seen(p, low, high):
                    self._rings.append((thinned(p)[:-1], packed(area.colour, _STRONG)))
            corners = self._triangles_of(k, area)
            if len(corners) <= _MOST_TRIANGLES:
                where = placed(corners.reshape(-1, 2)).reshape(-1, 3, 2)
                self._tints.append((where, packed(area.colour, _TINT)))
        self._triangles = {k: v for k, v in self._triangles.items() if k in chosen}

    def _triangles_of(self, k: int, area: Area) -> NDArray[np.float64]:
        import shapely

        known = self._triangles.get(k)
        if known is not None and known[0].outline_mm is area.outline_mm:
            return known[1]
        made = shapely.get_parts(shapely.constrained_delaunay_triangles(area.outline_mm))
        corners = shapely.get_coordinates(made).reshape(-1, 4, 2)[:, :3]
        self._triangles[k] = (area, corners)
        return np.asarray(corners)


def _border_lines(
    document: Document,
) -> tuple[list[NDArray[np.float64]], list[tuple[str, NDArray[np.float64]]]]:
    """Return the borders, each once, and pieces that are to dots what they say themselves.

    Of areas that have no borders yet their outlines are returned.
    """
    from stippler.drawing.planar.planar_map import OUTSIDE, Arc
    from stippler.drawing.planar.policies import pieces_of

    lines, pieces = [], []
    if not document.drawing.borders:
        areas = [a for k, a in document.drawing.areas.items() if k != PAGE_AREA]
        return [ring for area in areas for ring in _rings(area)], []
    for arc in document.drawing.borders.values():
        if not isinstance(arc, Arc) or not (arc.policies or OUTSIDE not in (arc.left, arc.right)):
            continue
        at = arc.path.points_mm
        for first, last, policy in pieces_of(arc):
            if policy:
                pieces.append((policy, at[first : last + 1]))
            elif OUTSIDE not in (arc.left, arc.right):
                lines.append(at[first : last + 1])
    return lines, pieces


def _drawn(
    points: NDArray[np.float64], policy: str, low: NDArray[np.float64], high: NDArray[np.float64]
) -> list[tuple[Line, float]]:
    """Return the strokes that a piece is drawn in: through dashed, bleed dotted, a wall broad."""
    if not _is_seen(points, low, high):
        return []
    if policy == WALL:
        return [(thinned(points), _BROAD_PX)]
    if policy not in _DASHES_PX:
        return [(thinned(points), 1.0)]
    return [(line, 1.4) for line in dashes(points, *_DASHES_PX[policy], low, high)]


def dashes(
    points: NDArray[np.float64],
    on: float,
    off: float,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> list[Line]:
    """Return the dashes of a line that may be seen in a box."""
    way = np.r_[0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T))]
    begin = np.arange(0.0, way[-1], on + off)
    end = np.minimum(begin + on, way[-1])
    a, b = (np.column_stack([np.interp(s, way, c) for c in points.T]) for s in (begin, end))
    seen = ((np.maximum(a, b) >= low) & (np.minimum(a, b) <= high)).all(axis=1)
    inner = np.searchsorted(way, [begin[seen], end[seen]], side="right")
    return [
        [tuple(p), *map(tuple, points[i:j].tolist()), tuple(q)]
        for p, q, i, j in zip(a[seen].tolist(), b[seen].tolist(), *inner.tolist(), strict=True)
    ]


def _rings(area: Area) -> list[NDArray[np.float64]]:
    import shapely

    rings = shapely.get_rings(shapely.get_parts(area.outline_mm))
    return [shapely.get_coordinates(ring) for ring in rings]


def _is_seen(
    points: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> bool:
    return bool((points.max(axis=0) >= low).all() and (points.min(axis=0) <= high).all())


def thinned(points: NDArray[np.float64]) -> Line:
    """Return a line without vertices that the screen could not tell apart."""
    way = np.hypot(*np.diff(points, axis=0).T)
    step = np.floor(np.cumsum(way) / _APART_PX)
    kept = np.r_[True, np.diff(np.r_[-1.0, step]) > 0]
    kept[-1] = True
    return [(x, y) for x, y in points[kept].tolist()]


def packed(colour: str, alpha: int) -> int:
    """Return a colour such as #c65d57 in ImGui's order."""
    r, g, b = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return alpha << 24 | b << 16 | g << 8 | r
