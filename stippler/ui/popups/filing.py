"""What a person does with files: open, save, export, begin anew, leave."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.editor.commands import Command
from stippler.editor.exports import SAVED
from stippler.editor.messages import WARNING
from stippler.editor.session import Session
from stippler.names import shown
from stippler.resources import assets
from stippler.ui.popups.file_dialogs import Dialogs
from stippler.ui.popups.shelf import Item, when
from stippler.ui.popups.unsaved_guard import Guard
from stippler.ui.preferences import Preferences

if TYPE_CHECKING:
    from stippler.drawing.drawing import Page
    from stippler.jobs.work import Source

EXPORT_DPI = 600.0
_NAMED = 4  # of several files that were dropped


class Filing:
    """Opens and exports for a session; what would lose a person's changes asks first.

    Parameters
    ----------
    end : callable
        Closes the window.
    """

    def __init__(
        self, session: Session, dialogs: Dialogs, kept: Preferences, end: Callable[[], None]
    ) -> None:
        self._session, self._dialogs, self._kept, self._end = session, dialogs, kept, end
        self.guard = Guard(session, self.save, lambda: dialogs.is_open)
        self.ask_export: Callable[[Path], None] = lambda path: None
        self._last: tuple[Path, dict[str, Any]] | None = None
        self._noted: Path | None = None

    # --- opening ------------------------------------------------------------------------------

    def ask_picture(self) -> None:
        """Ask for a picture, and open it."""
        source = self._session.source
        folder = source.path.resolve().parent if source else Path.cwd()
        self._dialogs.ask_picture(folder, self.open)

    def ask_reference(self) -> None:
        """Ask for a picture to draw after by hand, and open it."""
        source = self._session.source
        folder = source.path.resolve().parent if source else Path.cwd()
        self._dialogs.ask_picture(folder, self.open_reference)

    def open_reference(self, path: Path) -> None:
        """Open a picture to draw after by hand."""

        def open_it() -> None:
            self._session.open_reference(path)
            self._kept.look.reference_shown = True

        self.guard.then(f"Opening {shown(path.name)}", open_it)

    def open(self, path: Path) -> None:
        """Open a picture or a drawing."""
        from stippler.opening import is_drawing

        opener = self._session.open_drawing if is_drawing(path) else self._session.open
        self.guard.then(f"Opening {shown(path.name)}", lambda: opener(path))

    def open_recent(self, path: Path) -> None:
        """Open a picture of the list; one that is gone is taken off it."""
        if path.is_file():
            self.open(path)
            return
        self._kept.recent.remove(path)
        self._session.messages.say(
            f"{path}: is not there any more; it is taken off the list", WARNING
        )

    def recent(self) -> list[Command]:
        """Return a command for each picture of the list, the last one first."""
        return [
            Command(
                f"file.recent {path}",
                f"Open {shown(path.name)}",
                self._opener(path),
                detail=_short(path),
            )
            for path in self._kept.recent
        ]

    def recent_items(self) -> list[Item]:
        """Return the files of the list for a shelf."""
        return [
            Item(path, path.name, shown(str(path)), self._opener(path))
            for path in self._kept.recent
        ]

    def earlier_items(self) -> list[Item]:
        """Return the earlier versions of the open drawing, the newest first."""
        backups = self._session.saving.earlier()
        if backups is None or self._session.document is None:
            return []
        return [
            Item(
                backup.path,
                when(backup.saved_s),
                "saved by itself" if backup.is_auto else "as it was before a later save",
                self._earlier_opener(backup.path),
            )
            for backup in backups.listed()
        ]

    def _earlier_opener(self, path: Path) -> Callable[[], None]:
        def act() -> None:
            self._session.open_earlier(path)

        return lambda: self.guard.then("Opening an earlier version", act)

    def _opener(self, path: Path) -> Callable[[], None]:
        return lambda: self.open_recent(path)

    def forget_recent(self) -> None:
        """Empty the list of recent pictures."""
        self._kept.recent.clear()

    def drop(self, paths: tuple[Path, ...]) -> None:
        """Open what was dropped on the window; a file dialog has its answer by that."""
        if paths and not self.guard.is_open:
            self._dialogs.dismiss()
        if len(paths) > 1:
            self._session.messages.say(_told_of(paths), WARNING)
        if paths:
            self.open(paths[0])

    def note_opened(self) -> bool:
        """Put the open picture on the list of recent ones; return whether the list is new."""
        source, file = self._session.source, self._session.exports.file
        path = file or (source.path if source else None)
        if path == self._noted:
            return False
        self._noted = path
        if path is None or path.resolve().is_relative_to(assets().resolve()):
            return False
        self._kept.note_opened(path)
        return True

    # --- beginning anew -----------------------------------------------------------------------

    def begin(self, page: Page) -> None:
        """Begin a drawing on an empty page."""
        self.guard.then("A new page", lambda: self._session.new(page))

    def start(self) -> None:
        """Stipple the open picture; another tone or width begins another drawing."""
        if self._session.starts_afresh:
            self.guard.then("Starting with another tone or width", self._session.start)
        else:
            self._session.start()

    def quit(self) -> None:
        """Close the window."""
        if not self.guard.is_open:
            self._dialogs.dismiss()
        self.guard.then("Quitting", self._end, leaving=True)

    # --- saving -------------------------------------------------------------------------------

    def save(self) -> None:
        """Save the drawing in its file, or ask for one.

        A file that another program has changed meanwhile is replaced only if asked for again.
        """
        session, exports = self._session, self._session.exports
        if exports.file is None:
            self.save_as()
        elif exports.is_changed_on_disk:
            exports.allow_replacing()
            name = shown(exports.file.name)
            text = (
                f"{name} was changed by another program; save again to replace it, or save under "
                "another name"
                if os.path.exists(exports.file)
                else f"{name} is no longer there: it was moved or deleted, or its drive is gone; "
                "save again to write it anew, or save under another name"
            )
            session.messages.say(text, WARNING)
        else:
            session.save(exports.file)

    def save_as(self, *, is_copy: bool = False) -> None:
        """Ask where to save the drawing, and save it."""
        session = self._session
        if session.document is None:
            session.save(Path())  # says why there is nothing to save
            return
        first = session.exports.file or _first_path(session.source).with_suffix(SAVED)
        if is_copy:
            first = first.with_stem(f"{first.stem} copy")
        self._dialogs.ask_save(first, (SAVED,), lambda path: session.save(path, is_copy=is_copy))

    def revert(self) -> None:
        """Open the drawing as it was last saved."""
        file = self._session.exports.file
        if file is not None:
            self.guard.then("Going back to the file", lambda: self._session.open_drawing(file))

    # --- exporting ----------------------------------------------------------------------------

    def export(self) -> None:
        """Write to the file that the drawing was last written to, or ask for one."""
        path = self._session.exports.path
        if path is None or not self._session.n_dots:
            self.export_as()
        else:
            options = self._last[1] if self._last is not None and self._last[0] == path else None
            self._session.export(path, EXPORT_DPI, options)

    def export_as(self) -> None:
        """Ask where to write the drawing, and write it."""
        session = self._session
        if session.drawing is None or not session.n_dots:
            session.export(Path("drawing.svg"), EXPORT_DPI)  # says why there is nothing to write
            return
        self.ask_export(session.exports.path or _first_path(session.source))

    def write(self, path: Path, options: dict[str, Any], expected_bytes: int = 0) -> None:
        """Write to a file by options of its format; the next time they are used again."""
        self._last = (path, options)
        self._session.export(path, EXPORT_DPI, options, expected_bytes=expected_bytes)

    def show_calibration_sheet(self) -> None:
        """Open the sheet that presses are calibrated by."""
        from stippler.files.checks import calibration_sheet

        self.guard.then("The calibration sheet", lambda: self._session.show(calibration_sheet()))


def _told_of(paths: tuple[Path, ...]) -> str:
    """Say which of several files is opened, and which are not."""
    others = [shown(path.name) for path in paths[1:]]
    named = ", ".join(others[:_NAMED])
    more = f" and {len(others) - _NAMED} more" if len(others) > _NAMED else ""
    return (
        f"one drawing is open at a time: {shown(paths[0].name)} is opened; {named}{more} "
        f"{'is' if len(others) == 1 else 'are'} not"
    )


def _first_path(source: Source | None) -> Path:
    """Offer a place beside the picture, or in the current folder if that is a bundled sample's."""
    path = source.path if source else Path("drawing")
    bundled = path.resolve().is_relative_to(assets().resolve())
    return (Path.cwd() if bundled else path.resolve().parent) / f"{path.stem}.svg"


def _short(path: Path) -> str:
    """Return a picture's folder, from the person's home on."""
    folder, home = path.parent, Path.home()
    return shown(f"~/{folder.relative_to(home)}" if folder.is_relative_to(home) else folder)
