"""The windows over the canvas that take the keyboard: dialogs, palette, sheet, preferences.

Most are made, and their modules imported, when they are first asked for: a start needs none.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

from stippler.editor.commands import Command, Commands, Key
from stippler.editor.events import KeyDown
from stippler.editor.keymap import save_keys
from stippler.editor.messages import WARNING
from stippler.editor.session import Session
from stippler.editor.tools.toolbox import Toolbox
from stippler.errors import StipplerError
from stippler.ui.field_commands import FieldCommands
from stippler.ui.popups.file_dialogs import Dialogs
from stippler.ui.popups.filing import Filing
from stippler.ui.popups.save_failed import SaveFailed
from stippler.ui.preferences import Preferences
from stippler.ui.widgets import Widgets
from stippler.ui.window.window import Window

if TYPE_CHECKING:
    from stippler.editor.print_check import PrintCheck
    from stippler.ui.popups.context import ContextPalette
    from stippler.ui.popups.export_dialog import ExportDialog
    from stippler.ui.popups.new_page import NewPage
    from stippler.ui.popups.palette import Palette
    from stippler.ui.popups.preferences_window import PreferencesWindow
    from stippler.ui.popups.recovery import RecoveryWindow
    from stippler.ui.popups.scale import ScaleDrawing
    from stippler.ui.popups.shelf import Item, Shelf
    from stippler.ui.popups.shortcut_sheet import Sheet

Guarded = Callable[[str, Callable[[], None]], None]

_DIALOGS = {  # the attribute of each, in the order of drawing, and what a fault in it is called
    "exporting": "the export",
    "new_page": "the new page",
    "scale": "scaling",
    "recovery": "what was lost",
    "recent": "the recent files",
    "earlier": "the earlier versions",
    "styles": "the styles",
}
_LISTS = {  # likewise, of those that show commands
    "preferences": "the preferences",
    "context": "the palette at the pointer",
    "palette": "the palette",
    "sheet": "the shortcuts",
}


class Popups:
    """All of them; `draw` is called in every frame."""

    def __init__(
        self,
        window: Window,
        session: Session,
        kept: Preferences,
        toolbox: Toolbox,
        px_per_mm: Callable[[], float],
        *,
        use_native: bool,
    ) -> None:
        self._window, self._session, self._kept, self._toolbox = window, session, kept, toolbox
        self._px_per_mm = px_per_mm
        self.dialogs = Dialogs(use_native=use_native)
        self.filing = Filing(session, self.dialogs, kept, window.end)
        self.filing.ask_export = lambda path: self.exporting.ask(path)
        self.save_failed = SaveFailed(session, lambda is_copy: self.filing.save_as(is_copy=is_copy))
        self.field_commands: FieldCommands | None = None
        self.commands: Commands | None = None
        self.print_check: PrintCheck | None = None

    # --- made when they are first asked for --------------------------------------------------

    @cached_property
    def exporting(self) -> ExportDialog:
        """Exports the drawing."""
        from stippler.ui.popups.export_dialog import ExportDialog

        filing = self.filing
        made = ExportDialog(
            self._window, self._session, self.dialogs, filing.write, filing.show_calibration_sheet
        )
        made.print_check = self.print_check
        return made

    @cached_property
    def recovery(self) -> RecoveryWindow:
        """Offers what crashes have left."""
        from stippler.ui.popups.recovery import RecoveryWindow

        root, window = self._session.keeping.root, self._window
        return RecoveryWindow(root, self._session, window.ctx, window.wake, self.filing.guard.then)

    @cached_property
    def recent(self) -> Shelf:
        """Shows the files of late."""
        return self._shelf("Recent files", self.filing.recent_items, "no file was opened yet")

    @cached_property
    def earlier(self) -> Shelf:
        """Shows earlier versions of the file."""
        nothing = "there is no earlier version of this drawing yet"
        return self._shelf("Earlier versions", self.filing.earlier_items, nothing)

    @cached_property
    def styles(self) -> Shelf:
        """Shows the styles."""
        from stippler.ui.popups.styles import style_items

        return self._shelf("Styles", lambda: style_items(self._session), "there are no styles")

    def _shelf(self, title: str, items: Callable[[], list[Item]], nothing: str) -> Shelf:
        from stippler.ui.popups.shelf import Shelf

        say, window = self._session.messages.say, self._window
        return Shelf(title, items, lambda: say(nothing), window.ctx, window.wake)

    @cached_property
    def new_page(self) -> NewPage:
        """Asks for the size of an empty page."""
        from stippler.ui.popups.new_page import NewPage

        return NewPage(self.filing.begin)

    @cached_property
    def scale(self) -> ScaleDrawing:
        """Scales the drawing."""
        from stippler.ui.popups.scale import ScaleDrawing

        return ScaleDrawing(self._session, self._toolbox.areas)

    @cached_property
    def palette(self) -> Palette:
        """Finds a command by a few letters."""
        from stippler.ui.popups.palette import Palette

        return Palette(self._kept, self._more_commands, self._valued_commands)

    @cached_property
    def sheet(self) -> Sheet:
        """Lists the keys."""
        from stippler.ui.popups.shortcut_sheet import Sheet

        return Sheet()

    @cached_property
    def preferences(self) -> PreferencesWindow:
        """Changes look, values, panels and keys."""
        from stippler.ui.popups.preferences_window import PreferencesWindow

        return PreferencesWindow(self._kept, self._keep_keys, lambda: self._window.scale)

    @cached_property
    def context(self) -> ContextPalette:
        """Offers tools at the pointer."""
        from stippler.ui.popups.context import ContextPalette

        return ContextPalette(self._toolbox, self._px_per_mm)

    def _made(self, names: dict[str, str]) -> dict[str, Any]:
        """Return those that were asked for, by what a fault in each is called."""
        there = vars(self)
        return {fault: there[name] for name, fault in names.items() if name in there}

    # --- all of them --------------------------------------------------------------------------

    @property
    def is_open(self) -> bool:
        """Whether one has the keyboard that lets nothing else have it."""
        if self.dialogs.is_open or self.filing.guard.is_open or self.save_failed.is_open:
            return True
        there = vars(self)
        modal = (*_DIALOGS, "palette", "sheet")
        return any(name in there and there[name].is_open for name in modal)

    @property
    def searches(self) -> bool:
        """Whether the palette opens in this frame, and wants to know every control."""
        return "palette" in vars(self) and self.palette.is_asked

    @property
    def moves(self) -> bool:
        """Whether one looks different in the next frame."""
        return "exporting" in vars(self) and self.exporting.moves

    def poll(self) -> bool:
        """Take what their workers have found; return whether there is something new to show."""
        return "exporting" in vars(self) and self.exporting.poll()

    def renew(self) -> None:
        """Make pictures again in the window's new context."""
        if "recovery" in vars(self):
            self.recovery.renew(self._window.ctx)

    def take(self, event: KeyDown) -> bool:
        """Take a key; return whether it is for one of the windows, and for no command."""
        assert self.commands is not None
        there = vars(self)
        if "sheet" in there and self.sheet.is_open:
            owner = self.commands.owner(Key(event.key, event.mods))
            if owner is not None and owner.name == "help.keys":
                self.sheet.ask()
        if self.is_open:
            return True
        return "preferences" in there and self.preferences.take(event, self.commands)

    def draw(self, widgets: Widgets, guarded: Guarded) -> None:
        """Draw what is open; a faulty one leaves the others alone."""
        commands = self.commands
        assert commands is not None
        guarded("the dialog", lambda: self.dialogs.draw(widgets))
        for fault, dialog in self._made(_DIALOGS).items():
            guarded(fault, partial(dialog.draw, widgets))
        guarded("the failed save", lambda: self.save_failed.draw(widgets))
        guarded("the question", lambda: self.filing.guard.draw(widgets))
        for fault, listed in self._made(_LISTS).items():
            guarded(fault, partial(listed.draw, widgets, commands))

    def _more_commands(self) -> list[Command]:
        fields = self.field_commands.all() if self.field_commands is not None else []
        return [*self.filing.recent(), *fields]

    def _valued_commands(self, typed: str) -> list[Command]:
        return self.field_commands.values(typed) if self.field_commands is not None else []

    def close(self) -> None:
        """Free every GL object."""
        there = vars(self)
        for name in ("recovery", "recent", "earlier", "styles", "exporting"):
            if name in there:
                there[name].close()

    def _keep_keys(self) -> None:
        if self._kept.folder is None or self.commands is None:
            return
        try:
            save_keys(self._kept.folder, self.commands)
        except StipplerError as error:
            self._session.messages.say(str(error), WARNING)
