"""A small field in which a person draws the polygon of a tip."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.ui.widgets import Widgets

Corners = tuple[tuple[float, float], ...]

FIRST: Corners = ((0.0, -0.9), (0.8, 0.5), (-0.8, 0.5))
_SIDE = 150.0
_NEAR = 0.12


def draw_tip_editor(widgets: Widgets, corners: Corners) -> Corners:
    """Show the polygon; a click adds a corner to the nearest side, a right click takes one away.

    Returns the corners as they are now; three at least.
    """
    corners = corners if len(corners) >= 3 else FIRST
    side = _SIDE * widgets.scale
    corner = imgui.get_cursor_screen_pos()
    imgui.invisible_button(
        "##tip", (side, side),
        imgui.ButtonFlags_.mouse_button_left | imgui.ButtonFlags_.mouse_button_right,
    )  # fmt: skip
    widgets.note("Tip polygon")
    widgets.tip("Click to add a corner, drag one to move it, right click to take it away.")
    mouse = imgui.get_mouse_pos()
    at = (
        min(max(2.0 * (mouse.x - corner.x) / side - 1.0, -1.0), 1.0),
        min(max(2.0 * (mouse.y - corner.y) / side - 1.0, -1.0), 1.0),
    )
    if imgui.is_item_hovered() and imgui.is_mouse_clicked(imgui.MouseButton_.right):
        corners = without_nearest(corners, at)
    elif imgui.is_item_active() and imgui.is_mouse_down(imgui.MouseButton_.left):
        corners = dragged(corners, at)
    _draw(widgets, (corner.x, corner.y), side, corners)
    return corners


def without_nearest(corners: Corners, at: tuple[float, float]) -> Corners:
    """Take the corner under the pointer away, if three are left."""
    k, near = _nearest(corners, at)
    return corners[:k] + corners[k + 1 :] if near and len(corners) > 3 else corners


def dragged(corners: Corners, at: tuple[float, float]) -> Corners:
    """Bring the corner under the pointer to it, or a new one on the nearest side."""
    k, near = _nearest(corners, at)
    if near:
        return (*corners[:k], at, *corners[k + 1 :])
    n = len(corners)

    def detour(k: int) -> float:
        (ax, ay), (bx, by) = corners[k], corners[(k + 1) % n]
        to, on = _length(ax - at[0], ay - at[1]), _length(bx - at[0], by - at[1])
        return to + on - _length(ax - bx, ay - by)

    k = min(range(n), key=detour) + 1
    return (*corners[:k], at, *corners[k:])


def _nearest(corners: Corners, at: tuple[float, float]) -> tuple[int, bool]:
    distances = [_length(x - at[0], y - at[1]) for x, y in corners]
    k = min(range(len(corners)), key=distances.__getitem__)
    return k, distances[k] < _NEAR


def _length(x: float, y: float) -> float:
    return float((x * x + y * y) ** 0.5)


def _draw(widgets: Widgets, at: tuple[float, float], side: float, corners: Corners) -> None:
    draw, theme = imgui.get_window_draw_list(), widgets.theme
    field = int(imgui.color_convert_float4_to_u32((*theme.raised, 1.0)))
    ink = int(imgui.color_convert_float4_to_u32((*theme.accent, 1.0)))
    draw.add_rect_filled(at, (at[0] + side, at[1] + side), field, 5.0 * widgets.scale)
    points = [(at[0] + side * (x + 1.0) / 2.0, at[1] + side * (y + 1.0) / 2.0) for x, y in corners]
    draw.add_polyline(list(points), ink, 1.6 * widgets.scale, imgui.ImDrawFlags_.closed)
    for point in points:
        draw.add_circle_filled(point, 3.5 * widgets.scale, ink, 12)
