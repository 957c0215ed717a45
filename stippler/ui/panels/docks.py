"""The panels: which are shown, and drawing those."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from imgui_bundle import imgui

from stippler.ui.fields import Fields
from stippler.ui.widgets import Rect, Widgets

Guarded = Callable[[str, Callable[[], None]], None]
_AWAY = 20_000.0
_UNSEEN = (
    imgui.WindowFlags_.no_inputs
    | imgui.WindowFlags_.no_nav
    | imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_focus_on_appearing
    | imgui.WindowFlags_.no_bring_to_front_on_focus
)


class Panels:
    """Windows that are docked, moved, closed and opened again by the person.

    Parameters
    ----------
    parts : mapping of name to callable
        What each draws into its window.
    closed : list of str
        Names of those that are not shown; kept up to date.
    """

    def __init__(self, parts: Mapping[str, Callable[[], None]], closed: list[str]) -> None:
        self._parts, self._closed = parts, closed
        self._to_show = ""
        self._in_front: set[str] = set()
        self._turns_focus = False
        self._fields = Fields()
        self._tabs: dict[str, Rect] = {}
        self.are_hidden = False
        self._home = 0  # where the first panel is docked
        self._has_begun = False

    def turn_hidden(self) -> None:
        """Hide all panels, or show those again that were there."""
        self.are_hidden = not self.are_hidden
        self._in_front.clear()

    def turn_focus(self) -> None:
        """Give the panel in front the keyboard in the next frame, or take it back to the canvas."""
        self._turns_focus = True

    @property
    def names(self) -> list[str]:
        """All panels."""
        return list(self._parts)

    def is_open(self, name: str) -> bool:
        """Return whether a panel is shown."""
        return name not in self._closed

    def show(self, name: str) -> None:
        """Open a panel, and bring it to the front."""
        if name in self._closed:
            self._closed.remove(name)
        self._to_show, self.are_hidden = name, False

    def is_in_front(self, name: str) -> bool:
        """Return whether a panel's controls were drawn in the last frame."""
        return name in self._in_front

    def toggle(self, name: str) -> None:
        """Bring a panel to the front; close it if it is there."""
        if self.is_in_front(name):
            self._close(name)
        else:
            self.show(name)

    def show_all(self) -> None:
        """Open every panel."""
        self._closed.clear()
        self.are_hidden = False

    def draw(self, guarded: Guarded, widgets: Widgets, *, survey: bool = False) -> None:
        """Draw the panels that are shown; a faulty one leaves the others alone.

        Parameters
        ----------
        survey : bool
            Whether the others are drawn, too, out of sight, so that the palette knows all controls.
        """
        self._fields, self._tabs = widgets.fields, {}
        if survey:
            widgets.fields.forget()
        for name, draw in self._parts.items():
            if self.is_open(name) and not self.are_hidden:
                guarded(f"the panel {name}", lambda name=name, draw=draw: self._draw(name, draw))  # type: ignore[misc]
        self._has_begun = True
        widgets.marks |= {f"panel {name}": tab for name, tab in self._tabs.items()}
        if survey:
            self._survey(guarded, widgets)
        if self._to_show:
            imgui.set_window_focus(self._to_show)
            self._to_show = ""
        if self._turns_focus:
            self._turns_focus = False
            self._turn_focus()

    def _survey(self, guarded: Guarded, widgets: Widgets) -> None:
        """Draw all panels where nobody sees them, with all that is folded away."""
        fields, scale = widgets.fields, widgets.scale
        fields.is_survey = True
        for name, draw in self._parts.items():
            imgui.set_next_window_pos((-_AWAY, -_AWAY))
            imgui.set_next_window_size((320.0 * scale, _AWAY / 2))
            imgui.begin(f"##survey {name}", None, _UNSEEN)
            fields.panel = name
            guarded(f"the panel {name}", draw)
            fields.panel = ""
            imgui.end()
        fields.is_survey = False

    def _turn_focus(self) -> None:
        context = imgui.get_current_context()
        assert context is not None
        if context.nav_cursor_visible and context.nav_window is not None:
            imgui.set_nav_cursor_visible(False)
        elif front := next((name for name in self._parts if name in self._in_front), ""):
            imgui.set_window_focus(front)
            imgui.set_nav_cursor_visible(True)

    def _draw(self, name: str, draw: Callable[[], None]) -> None:
        if self._home:  # a panel that has never had a place
            imgui.set_next_window_dock_id(self._home, imgui.Cond_.first_use_ever)
        # only a tab in front has a cross: with one on each, they would not fit in a row
        cross = True if name in self._in_front else None
        shown, stays = imgui.begin(name, cross, imgui.WindowFlags_.no_collapse)
        self._home = self._home or imgui.get_window_dock_id()
        tab = imgui.internal.get_current_window().dc.dock_tab_item_rect
        self._tabs[name] = (tab.min.x, tab.min.y, tab.max.x, tab.max.y)
        if shown and (self._has_begun or not self._in_front):
            # in the very first frame all tabs are shown, and one in front of the others is enough
            self._in_front.add(name)
            self._fields.panel = name
            try:
                draw()
            finally:
                self._fields.panel = ""
        else:
            self._in_front.discard(name)
        imgui.end()
        if stays is False:
            self._close(name)

    def _close(self, name: str) -> None:
        self._closed.append(name)
        self._in_front.discard(name)
