"""Where things are: tools at the left edge, then panels as tabs of a dock, then the canvas."""

from __future__ import annotations

from collections.abc import Sequence

from imgui_bundle import imgui

from stippler.ui.panels.room import hold_inside, keep_canvas, tab_scale
from stippler.ui.theme import PANEL_WIDTH, STATUS_HEIGHT, TEXT_PX
from stippler.ui.widgets import Rect

DRAWING, TOOL, SHAPE, VIEW, HISTORY = "Drawing", "Tool", "Shape", "View", "History"
AREAS = "Areas"
_TAB_PADDING = 7.0
_HOST = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_background
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_bring_to_front_on_focus
    | imgui.WindowFlags_.no_nav_focus
)


class Layout:
    """Docks the panels where they have no place yet; what is left in the middle is the canvas.

    Parameters
    ----------
    names : sequence of str
        The panels, in the order of their tabs.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self._names = tuple(names)
        self._reset = False
        self._wanted: dict[int, float] = {}  # how wide docks are where there is room
        self._seen: tuple[float, float] = (0.0, 0.0)

    def reset(self) -> None:
        """Dock the panels in the next frame as at first."""
        self._reset = True

    def draw(self, scale: float, strip: float) -> Rect:
        """Draw the dock space beside the strip; return the canvas, in ImGui's coordinates."""
        viewport = imgui.get_main_viewport()
        height = max(viewport.work_size.y - STATUS_HEIGHT * scale, 1.0)
        size = (max(viewport.work_size.x - strip, 1.0), height)
        imgui.set_next_window_pos((viewport.work_pos.x + strip, viewport.work_pos.y))
        imgui.set_next_window_size(size)
        imgui.push_style_var(imgui.StyleVar_.window_padding, (0.0, 0.0))
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
        imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
        imgui.begin("##host", None, _HOST)
        imgui.pop_style_var(3)
        space = imgui.get_id("space")
        if self._reset or imgui.internal.dock_builder_get_node(space) is None:
            self._dock(space, size, scale)
            self._reset = False
        self._draw_space(space, scale)
        imgui.end()
        middle = imgui.internal.dock_builder_get_central_node(space)
        grows = self._seen != (size[0], scale)
        for place in self._wanted:
            self._wanted[place] *= scale / self._seen[1]
        self._seen = (size[0], scale)
        keep_canvas(self._names, middle, size[0], scale, self._wanted, grows=grows)
        hold_inside(self._names, (viewport.work_pos.x + strip, viewport.work_pos.y), size)
        left, top = round(middle.pos.x), round(middle.pos.y)
        right, bottom = round(middle.pos.x + middle.size.x), round(middle.pos.y + middle.size.y)
        return left, top, max(right, left + 1), max(bottom, top + 1)

    def _draw_space(self, space: int, scale: float) -> None:
        """Draw the docks, with tabs whose names can be read."""
        share = tab_scale(self._names, _TAB_PADDING * scale, scale)
        imgui.push_font(None, TEXT_PX * share)
        imgui.push_style_var(
            imgui.StyleVar_.frame_padding, (_TAB_PADDING * share**3 * scale, 5.0 * scale)
        )
        imgui.push_style_var(imgui.StyleVar_.item_inner_spacing, (2.0 * scale, 4.0 * scale))
        imgui.dock_space(space, (0.0, 0.0), imgui.DockNodeFlags_.passthru_central_node)
        imgui.pop_style_var(2)
        imgui.pop_font()

    def _dock(self, space: int, size: tuple[float, float], scale: float) -> None:
        build = imgui.internal
        build.dock_builder_remove_node(space)
        build.dock_builder_add_node(space, build.DockNodeFlagsPrivate_.dock_space)
        build.dock_builder_set_node_size(space, size)
        share = min(PANEL_WIDTH * scale / max(size[0], 1.0), 0.6)
        split = build.dock_builder_split_node(space, imgui.Dir.left, share)
        for name in self._names:
            build.dock_builder_dock_window(name, split.id_at_dir)
        build.dock_builder_get_node(split.id_at_dir).set_local_flags(
            build.DockNodeFlagsPrivate_.no_close_button
        )
        build.dock_builder_finish(space)
        self._wanted = {}
        self._seen = (0.0, 0.0)
