"""The small palette at the pointer: tools, the size of the tip, undo and redo."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from stippler.editor.border_labels import BORDER_COMMANDS
from stippler.editor.commands import Commands
from stippler.editor.tools.toolbox import Toolbox
from stippler.ui.panels.brush_radius import draw_radius
from stippler.ui.panels.strip import draw_tool
from stippler.ui.widgets import Widgets

_TITLE = "##context"
_COLUMNS = 4
_BORDER = tuple(f"nodes.{name}" for name in BORDER_COMMANDS)
_SELECTION = ("selection.copy", "selection.paste", "selection.delete", "selection.invert")


class ContextPalette:
    """Opens where the right button is pressed on the canvas."""

    def __init__(self, toolbox: Toolbox, px_per_mm: Callable[[], float]) -> None:
        self._toolbox, self._px_per_mm = toolbox, px_per_mm
        self._wanted = False
        self.is_open = False

    def ask(self) -> None:
        """Open it at the pointer in the next frame."""
        self._wanted = True

    def draw(self, widgets: Widgets, commands: Commands) -> None:
        """Draw it, if it is open."""
        if self._wanted:
            self._wanted = False
            imgui.open_popup(_TITLE)
        scale = widgets.scale
        imgui.push_style_var(imgui.StyleVar_.window_padding, (8.0 * scale, 8.0 * scale))
        self.is_open = imgui.begin_popup(_TITLE)
        imgui.pop_style_var()
        if not self.is_open:
            return
        chosen = self._draw_tools(widgets, commands)
        self._draw_size(widgets)
        width = (4 * 34.0 + 3 * 3.0) * scale
        half = (width - widgets.gap) / 2
        names = ["edit.undo", "edit.redo"]
        if len(self._toolbox.selection.ids) or self._toolbox.name == "select":
            names += _SELECTION
        if self._toolbox.name == "nodes" and commands[_BORDER[0]].enabled:
            names += _BORDER
        for k, name in enumerate(names):
            command = commands[name]
            if k % 2:
                imgui.same_line(0.0, widgets.gap)
            if widgets.button(
                command.short,
                command.explained,
                name=f"context {command.short}",
                width=half,
                enabled=command.enabled,
            ):
                command.run()
                chosen = chosen or name.startswith(("selection.", "nodes."))
        if chosen:
            imgui.close_current_popup()
        imgui.end_popup()

    def _draw_tools(self, widgets: Widgets, commands: Commands) -> bool:
        """Draw the tools in rows; return whether one was chosen."""
        chosen, used = False, self._toolbox.name
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (3.0 * widgets.scale,) * 2)
        for k, tool in enumerate(self._toolbox.cards):
            if k % _COLUMNS:
                imgui.same_line()
            command = commands[f"tool.{tool.name}"]
            if draw_tool(
                widgets, command, tool.name, tool.tip, used=used == tool.name, mark="context "
            ):
                self._toolbox.choose(tool.name if used != tool.name else "")
                chosen = True
        imgui.pop_style_var()
        return chosen

    def _draw_size(self, widgets: Widgets) -> None:
        brush = self._toolbox.brush
        if brush is None or not brush.about.has_tip:
            return
        width = (_COLUMNS * 34.0 + (_COLUMNS - 1) * 3.0) * widgets.scale
        radius_mm = draw_radius(
            widgets, brush.radius_mm, self._px_per_mm(), label="", name="context radius",
            width=width,
        )  # fmt: skip
        if radius_mm != brush.radius_mm:
            self._toolbox.resize(radius_mm / brush.radius_mm)
