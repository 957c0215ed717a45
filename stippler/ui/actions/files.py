"""Commands on files, the history, the work, and help."""

from __future__ import annotations

from collections.abc import Iterator

from stippler.drawing.picture_values import TONES
from stippler.drawing.style import Style
from stippler.editor.commands import CTRL, CTRL_SHIFT, SHIFT, Command, Key
from stippler.editor.print_check import PrintCheck
from stippler.ui.actions.parts import Parts
from stippler.units import DEFAULT_WIDTH_MM


def file_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on files."""
    popups, filing, session = parts.popups, parts.popups.filing, parts.session

    def has_dots() -> bool:
        return session.n_dots > 0 or bool(session.drawing and session.drawing.lines)

    def is_open() -> bool:
        return session.document is not None

    yield Command("file.new", "New page", lambda: popups.new_page.ask(), (Key("n", CTRL),))
    yield Command("file.open", "Open", filing.ask_picture, (Key("o", CTRL),))
    yield Command("file.open_reference", "Open as reference only", filing.ask_reference,
                  tip="a picture to draw after by hand; no dots are made of it.")  # fmt: skip
    yield Command(
        "file.recent_files", "Recent files", lambda: popups.recent.ask(), (Key("o", CTRL_SHIFT),)
    )
    yield Command("file.forget", "Forget recent pictures", filing.forget_recent,
                  can=lambda: bool(filing.recent()))  # fmt: skip
    yield Command("file.save", "Save", filing.save, (Key("s", CTRL),), can=is_open)
    yield Command("file.save_as", "Save as", filing.save_as, (Key("s", CTRL_SHIFT),), can=is_open)
    yield Command(
        "file.save_copy", "Save a copy", lambda: filing.save_as(is_copy=True), can=is_open
    )
    yield Command("file.revert", "Revert to the file", filing.revert,
                  can=lambda: session.exports.file is not None)  # fmt: skip
    yield Command("file.earlier", "Earlier versions", lambda: popups.earlier.ask(), can=is_open)
    yield Command("file.recover", "Recover lost drawings", lambda: popups.recovery.ask())
    yield Command("file.export_as", "Export", filing.export_as, (Key("e", CTRL),), can=has_dots)
    yield Command("file.export", "Export again", filing.export, (Key("e", CTRL_SHIFT),),
                  can=has_dots)  # fmt: skip
    yield Command("file.quit", "Quit", filing.quit, (Key("q", CTRL),))


def edit_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on the history, and preferences."""
    painting, popups, session = parts.painting, parts.popups, parts.session

    def can_undo() -> bool:
        return session.document is not None and session.document.history.undone is not None

    def can_redo() -> bool:
        return session.document is not None and session.document.history.redone is not None

    yield Command("edit.undo", "Undo", painting.undo, (Key("z", CTRL),), can=can_undo)
    yield Command("edit.redo", "Redo", painting.redo, (Key("z", CTRL_SHIFT), Key("y", CTRL)),
                  can=can_redo)  # fmt: skip
    yield Command(
        "edit.preferences", "Preferences", lambda: popups.preferences.ask(), (Key(",", CTRL),)
    )


def work_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on the work."""
    session = parts.session

    def relax_all() -> None:
        session.relax(session.style.iterations or 20, weighted=session.style.weighted)

    def hold() -> None:
        if session.phase == "paused":
            session.resume()
        else:
            session.pause()

    def reset() -> None:
        session.style = Style()
        session.tone, session.width_mm = TONES[0], DEFAULT_WIDTH_MM

    def is_busy() -> bool:
        return session.busy

    yield Command("work.start", "Start", parts.popups.filing.start, (Key("enter", CTRL),))
    yield Command("work.pause", "Pause or go on", hold, (Key("p"),), can=is_busy)
    yield Command("work.stop", "Stop", session.stop, (Key("p", SHIFT),), can=is_busy)
    yield Command("work.relax", "Relax all dots", relax_all, (Key("l", CTRL),),
                  can=lambda: session.paintable and session.n_dots > 0)  # fmt: skip
    yield Command("work.fill", "Fill the page", session.fill, can=lambda: session.paintable,
                  tip="adds dots by the values under Drawing; one step to undo.")  # fmt: skip
    yield Command("work.style", "Choose a style", lambda: parts.popups.styles.ask())
    yield Command("work.reset", "Default values", reset,
                  tip="in the panel Drawing; dots change with the next Start.")  # fmt: skip
    yield Command("work.scale", "Scale the drawing", lambda: parts.popups.scale.ask(),
                  can=lambda: session.paintable,
                  tip="or chosen areas, to another size or number of dots.")  # fmt: skip
    yield from _print_commands(parts)


def _print_commands(parts: Parts) -> Iterator[Command]:
    session = parts.session
    check = PrintCheck(session, parts.painting, parts.view)
    parts.popups.print_check = check

    def has_dots() -> bool:
        return session.paintable and session.n_dots > 0

    yield Command("work.check_print", "Next fault that print would spoil", check.show_next,
                  can=has_dots)  # fmt: skip
    yield Command("work.repair_print", "Repair for print", check.repair, can=has_dots)


def help_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands that tell of others."""
    popups = parts.popups
    yield Command(
        "help.palette", "Find a command", lambda: popups.palette.ask(), (Key("p", CTRL_SHIFT),)
    )
    yield Command("help.keys", "Shortcuts", lambda: popups.sheet.ask(), (Key("f1"),))
