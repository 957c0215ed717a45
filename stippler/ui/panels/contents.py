"""What each panel shows; one that is not in front at first is imported when it is first seen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from stippler.ui.panels.dots import draw_dots
from stippler.ui.panels.layout import AREAS, DRAWING, HISTORY, SHAPE, TOOL, VIEW
from stippler.ui.panels.picture import draw_picture
from stippler.ui.panels.progress import HEIGHT as WORK_HEIGHT
from stippler.ui.panels.progress import LOW as WORK_LOW
from stippler.ui.panels.progress import draw_work
from stippler.ui.panels.reference import draw_reference, draw_tones
from stippler.ui.panels.tool import draw_tool

if TYPE_CHECKING:
    import moderngl

    from stippler.editor.area_acts import AreaActs
    from stippler.editor.commands import Commands
    from stippler.editor.lines import Lines
    from stippler.editor.painting import Painting
    from stippler.editor.patterns import Patterns
    from stippler.editor.session import Session
    from stippler.editor.shaping import Shaping
    from stippler.editor.view import View
    from stippler.ui.canvas.pattern_samples import PatternSamples
    from stippler.ui.canvas.pen_samples import PenSamples
    from stippler.ui.look import Look
    from stippler.ui.panels.areas import AreasPanel
    from stippler.ui.widgets import Widgets

_LEAST_SETTINGS = 60.0  # the theme's pixels; a lower panel scrolls as a whole
_LOW = 300.0  # likewise; in a lower panel the work is one line


@dataclass(slots=True)
class Subjects:
    """What the panels show and change."""

    session: Session
    look: Look
    view: View
    painting: Painting
    shaping: Shaping
    lines: Lines
    patterns: Patterns
    area_acts: AreaActs


class Contents:
    """Draws what is within the panels; `draw` has a function for each.

    Parameters
    ----------
    frame : callable
        Returns the widgets of this frame, and the commands.
    """

    def __init__(
        self,
        subjects: Subjects,
        ctx: moderngl.Context,
        frame: Callable[[], tuple[Widgets, Commands]],
    ) -> None:
        self._of, self._ctx, self._frame = subjects, ctx, frame
        self.draw = {
            DRAWING: self._draw_drawing,
            TOOL: self._draw_tool,
            AREAS: self._draw_areas,
            SHAPE: self._draw_shape,
            VIEW: self._draw_view,
            HISTORY: self._draw_history,
        }
        self._of_tools = {"line": self._draw_lines, "pattern": self._draw_patterns}

    def _draw_drawing(self) -> None:
        (widgets, commands), of = self._frame(), self._of
        height = imgui.get_content_region_avail().y
        is_low = height < _LOW * widgets.scale
        room = height - (WORK_LOW if is_low else WORK_HEIGHT) * widgets.scale
        imgui.begin_child("##settings", (0.0, max(room, _LEAST_SETTINGS * widgets.scale)))
        draw_picture(widgets, of.session, commands)
        draw_tones(widgets, of.session, of.look, commands)
        widgets.rule()
        draw_dots(widgets, of.session, commands)
        imgui.end_child()
        draw_work(widgets, of.session, commands, is_low=is_low)

    def _draw_tool(self) -> None:
        (widgets, commands), toolbox = self._frame(), self._of.painting.toolbox
        px_per_mm = self._of.view.camera.px_per_mm
        draw_tool(widgets, toolbox, commands, self._of.painting.n_selected, px_per_mm)
        if toolbox.name in self._of_tools:
            widgets.rule()
            self._of_tools[toolbox.name]()

    def _draw_lines(self) -> None:
        from stippler.ui.panels.lines import draw_lines

        widgets, commands = self._frame()
        draw_lines(widgets, self._of.lines, commands)

    def _draw_patterns(self) -> None:
        from stippler.ui.panels.patterns import draw_patterns

        widgets, commands = self._frame()
        draw_patterns(widgets, self._of.patterns, commands, self._pattern_samples)

    def _draw_areas(self) -> None:
        self._areas_panel.draw(*self._frame())

    def _draw_shape(self) -> None:
        from stippler.ui.panels.shape import draw_shape

        draw_shape(self._frame()[0], self._of.shaping, self._pen_samples)

    def _draw_view(self) -> None:
        from stippler.ui.panels.view import draw_view

        (widgets, commands), of = self._frame(), self._of
        draw_view(widgets, of.look, of.view, commands)
        if of.session.reference is not None:
            widgets.rule()
            draw_reference(widgets, of.session, of.look, commands)

    def _draw_history(self) -> None:
        from stippler.ui.panels.history import draw_history

        widgets, commands = self._frame()
        draw_history(widgets, self._of.session, self._of.painting, commands)

    @cached_property
    def _areas_panel(self) -> AreasPanel:
        from stippler.ui.panels.areas import AreasPanel

        return AreasPanel(self._of.area_acts)

    @cached_property
    def _pattern_samples(self) -> PatternSamples:
        from stippler.ui.canvas.pattern_samples import PatternSamples

        return PatternSamples(self._ctx)

    @cached_property
    def _pen_samples(self) -> PenSamples:
        from stippler.ui.canvas.pen_samples import PenSamples

        return PenSamples(self._ctx)

    def close(self) -> None:
        """Free every GL object; what was drawn with them is made again when it is next seen."""
        for name in ("_pattern_samples", "_pen_samples"):
            if (samples := vars(self).pop(name, None)) is not None:
                samples.close()

    def renew(self, ctx: moderngl.Context) -> None:
        """Draw in another context from now on; the one before is gone."""
        for name in ("_pattern_samples", "_pen_samples"):
            vars(self).pop(name, None)
        self._ctx = ctx
