"""The windows over the canvas that take the keyboard: dialogs, palette, sheet, preferences."""

from __future__ import annotations

from collections.abc import Callable

from stippler.editor.commands import Command, Commands, Key
from stippler.editor.events import KeyDown
from stippler.editor.keymap import save_keys
from stippler.editor.messages import WARNING
from stippler.editor.session import Session
from stippler.editor.tools.toolbox import Toolbox
from stippler.errors import StipplerError
from stippler.ui.field_commands import FieldCommands
from stippler.ui.popups.context import ContextPalette
from stippler.ui.popups.export_dialog import ExportDialog
from stippler.ui.popups.file_dialogs import Dialogs
from stippler.ui.popups.filing import Filing
from stippler.ui.popups.new_page import NewPage
from stippler.ui.popups.palette import Palette
from stippler.ui.popups.preferences_window import PreferencesWindow
from stippler.ui.popups.recovery import RecoveryWindow
from stippler.ui.popups.save_failed import SaveFailed
from stippler.ui.popups.scale import ScaleDrawing
from stippler.ui.popups.shelf import Shelf
from stippler.ui.popups.shortcut_sheet import Sheet
from stippler.ui.popups.styles import style_items
from stippler.ui.preferences import Preferences
from stippler.ui.widgets import Widgets
from stippler.ui.window.window import Window

Guarded = Callable[[str, Callable[[], None]], None]


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
        self._session, self._kept = session, kept
        self.dialogs = Dialogs(use_native=use_native)
        self.filing = Filing(session, self.dialogs, kept, window.end)
        self.exporting = ExportDialog(
            window, session, self.dialogs, self.filing.write, self.filing.show_calibration_sheet
        )
        self.filing.ask_export = self.exporting.ask
        self.recovery = RecoveryWindow(
            session.keeping.root, session, window.ctx, window.wake, self.filing.guard.then
        )
        self.recent = Shelf(
            "Recent files", self.filing.recent_items,
            lambda: session.messages.say("no file was opened yet"), window.ctx, window.wake,
        )  # fmt: skip
        self.earlier = Shelf(
            "Earlier versions", self.filing.earlier_items,
            lambda: session.messages.say("there is no earlier version of this drawing yet"),
            window.ctx, window.wake,
        )  # fmt: skip
        self.styles = Shelf(
            "Styles", lambda: style_items(session),
            lambda: session.messages.say("there are no styles"), window.ctx, window.wake,
        )  # fmt: skip
        self.save_failed = SaveFailed(session, lambda is_copy: self.filing.save_as(is_copy=is_copy))
        self.new_page = NewPage(self.filing.begin)
        self.field_commands: FieldCommands | None = None
        self.palette = Palette(kept, self._more_commands, self._valued_commands)
        self.scale = ScaleDrawing(session)
        self.sheet = Sheet()
        self.preferences = PreferencesWindow(kept, self._keep_keys, lambda: window.scale)
        self.context = ContextPalette(toolbox, px_per_mm)
        self.commands: Commands | None = None

    @property
    def is_open(self) -> bool:
        """Whether one has the keyboard that lets nothing else have it."""
        return (
            self.dialogs.is_open
            or self.exporting.is_open
            or self.filing.guard.is_open
            or self.new_page.is_open
            or self.scale.is_open
            or self.recovery.is_open
            or self.recent.is_open
            or self.earlier.is_open
            or self.styles.is_open
            or self.save_failed.is_open
            or self.palette.is_open
            or self.sheet.is_open
        )

    def take(self, event: KeyDown) -> bool:
        """Take a key; return whether it is for one of the windows, and for no command."""
        assert self.commands is not None
        if self.sheet.is_open:
            owner = self.commands.owner(Key(event.key, event.mods))
            if owner is not None and owner.name == "help.keys":
                self.sheet.ask()
        return self.is_open or self.preferences.take(event, self.commands)

    def draw(self, widgets: Widgets, guarded: Guarded) -> None:
        """Draw what is open; a faulty one leaves the others alone."""
        commands = self.commands
        assert commands is not None
        guarded("the preferences", lambda: self.preferences.draw(widgets, commands))
        guarded("the dialog", lambda: self.dialogs.draw(widgets))
        guarded("the export", lambda: self.exporting.draw(widgets))
        guarded("the new page", lambda: self.new_page.draw(widgets))
        guarded("scaling", lambda: self.scale.draw(widgets))
        guarded("what was lost", lambda: self.recovery.draw(widgets))
        guarded("the recent files", lambda: self.recent.draw(widgets))
        guarded("the earlier versions", lambda: self.earlier.draw(widgets))
        guarded("the styles", lambda: self.styles.draw(widgets))
        guarded("the failed save", lambda: self.save_failed.draw(widgets))
        guarded("the question", lambda: self.filing.guard.draw(widgets))
        guarded("the palette at the pointer", lambda: self.context.draw(widgets, commands))
        guarded("the palette", lambda: self.palette.draw(widgets, commands))
        guarded("the shortcuts", lambda: self.sheet.draw(widgets, commands))

    def _more_commands(self) -> list[Command]:
        fields = self.field_commands.all() if self.field_commands is not None else []
        return [*self.filing.recent(), *fields]

    def _valued_commands(self, typed: str) -> list[Command]:
        return self.field_commands.values(typed) if self.field_commands is not None else []

    def close(self) -> None:
        """Free every GL object."""
        for popup in (self.recovery, self.recent, self.earlier, self.styles, self.exporting):
            popup.close()

    def _keep_keys(self) -> None:
        if self._kept.folder is None or self.commands is None:
            return
        try:
            save_keys(self._kept.folder, self.commands)
        except StipplerError as error:
            self._session.messages.say(str(error), WARNING)
