"""The editor's commands, each with its keys."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stippler.ui.commands import CTRL, Command, Commands, Key
from stippler.ui.session import Session
from stippler.ui.window import Window

if TYPE_CHECKING:
    from stippler.ui.editor import Editor

EXPORT_DPI = 600.0


def commands_for(editor: Editor, session: Session, window: Window) -> Commands:
    """Make the commands of an editor."""

    def export() -> None:
        if not session.n_dots:
            session.export(Path("drawing.svg"), EXPORT_DPI)  # says why there is nothing to write
            return
        from stippler.export import ENDINGS

        source = session.source.path if session.source else Path("drawing")
        editor.dialogs.ask_export(
            _writable(source.parent) / f"{source.stem}.svg",
            ENDINGS,
            lambda path: session.export(path, EXPORT_DPI),
        )

    def open_picture() -> None:
        folder = session.source.path.resolve().parent if session.source else Path.cwd()
        editor.dialogs.ask_picture(folder, session.open)

    def hold() -> None:
        if session.phase == "paused":
            session.resume()
        else:
            session.pause()

    def show_reference() -> None:
        editor.look.reference_shown = not editor.look.reference_shown

    def print_size() -> None:
        editor.view.print_size(window.px_per_mm)

    return Commands(
        [
            Command("file.open", "Open a picture", open_picture, (Key("o", CTRL),)),
            Command("file.export", "Export the drawing", export, (Key("s", CTRL), Key("e", CTRL))),
            Command("file.quit", "Quit", window.ask_to_close, (Key("q", CTRL),)),
            Command("work.start", "Start", session.start, (Key("enter", CTRL),)),
            Command("work.pause", "Pause or go on", hold, (Key("p"),)),
            Command("view.fit", "Fit", editor.view.fit, (Key("f"), Key("home"))),
            Command("view.print_size", "Print size", print_size, (Key("1"),)),
            Command("view.reference", "Show or hide the picture", show_reference, (Key("r"),)),
            Command("view.theme", "Light or dark", editor.look.turn_theme, (Key("t"),)),
        ]
    )


def _writable(folder: Path) -> Path:
    """Return the folder, or the current one where it is a bundled sample's."""
    from stippler.resources import assets

    return Path.cwd() if folder.resolve().is_relative_to(assets().resolve()) else folder.resolve()
