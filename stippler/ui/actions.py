"""The editor's commands, each with its keys."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.brushes.kinds import KINDS
from stippler.ui.commands import CTRL, CTRL_SHIFT, Command, Commands, Key
from stippler.ui.events import Mods
from stippler.ui.layout import BRUSH
from stippler.ui.session import Session
from stippler.ui.window import Window

if TYPE_CHECKING:
    from stippler.ui.editor import Editor

EXPORT_DPI = 600.0
TURN_RAD = math.radians(15.0)
SHIFT = Mods(shift=True)


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

    def show_dots() -> None:
        editor.look.dots_shown = not editor.look.dots_shown

    def print_size() -> None:
        editor.view.print_size(window.px_per_mm)

    painting = editor.painting

    def relax_all() -> None:
        session.relax(session.plan.iterations or 20, weighted=session.plan.weighted)

    def tool(name: str) -> Callable[[], None]:
        def choose() -> None:
            painting.toolbox.choose_kind(name)
            editor.show_panel(BRUSH)

        return choose

    tools = [
        Command(f"tool.{kind.name}", kind.label, tool(kind.name), (Key(kind.key),))
        for kind in KINDS
    ]
    return Commands(
        [
            *tools,
            Command("tool.none", "No brush", lambda: painting.toolbox.choose(-1), (Key("v"),)),
            Command(
                "tool.larger",
                "Larger tip",
                lambda: painting.toolbox.resize(1.15),
                (Key("]"), Key("right_bracket")),
            ),
            Command(
                "tool.smaller",
                "Smaller tip",
                lambda: painting.toolbox.resize(1 / 1.15),
                (Key("["), Key("left_bracket")),
            ),
            Command("edit.undo", "Undo", painting.undo, (Key("z", CTRL),)),
            Command("edit.redo", "Redo", painting.redo, (Key("z", CTRL_SHIFT), Key("y", CTRL))),
            Command(
                "selection.delete",
                "Delete the selection",
                painting.delete,
                (Key("delete"), Key("backspace")),
            ),
            Command(
                "selection.duplicate",
                "Duplicate the selection",
                painting.duplicate,
                (Key("d", CTRL),),
            ),
            Command("selection.all", "Select all", painting.select_all, (Key("a", CTRL),)),
            Command(
                "selection.none", "Select nothing", painting.select_none, (Key("a", CTRL_SHIFT),)
            ),
            Command("work.relax", "Relax all dots", relax_all, (Key("l", CTRL),)),
            Command("file.new", "New page", editor.new_page.ask, (Key("n", CTRL),)),
            Command("file.open", "Open a picture", open_picture, (Key("o", CTRL),)),
            Command("file.export", "Export the drawing", export, (Key("s", CTRL), Key("e", CTRL))),
            Command("file.quit", "Quit", window.ask_to_close, (Key("q", CTRL),)),
            Command("work.start", "Start", session.start, (Key("enter", CTRL),)),
            Command("work.pause", "Pause or go on", hold, (Key("p"),)),
            Command("view.fit", "Fit", editor.view.fit, (Key("f"), Key("home"))),
            Command("view.print_size", "Print size", print_size, (Key("1"),)),
            Command(
                "view.selection",
                "Zoom to the selection",
                editor.show_selection,
                (Key("f", SHIFT),),
            ),
            Command(
                "view.turn_left",
                "Turn left",
                lambda: editor.view.turn(-TURN_RAD),
                (Key(","), Key("comma")),
            ),
            Command(
                "view.turn_right",
                "Turn right",
                lambda: editor.view.turn(TURN_RAD),
                (Key("."), Key("period")),
            ),
            Command("view.flip", "Flip", editor.view.flip, (Key("y"), Key("\\"), Key("backslash"))),
            Command("view.upright", "Upright", editor.view.upright, (Key("0"),)),
            Command(
                "view.reduce",
                "Reduction lens",
                lambda: editor.lens_key.switch("reduce"),
                (Key("z"),),
            ),
            Command(
                "view.magnify",
                "Magnifying lens",
                lambda: editor.lens_key.switch("magnify"),
                (Key("q"),),
            ),
            Command("view.reference", "Show or hide the picture", show_reference, (Key("r"),)),
            Command("view.dots", "Show or hide the dots", show_dots, (Key("d"),)),
            Command("view.theme", "Light or dark", editor.look.turn_theme, (Key("t"),)),
        ]
    )


def _writable(folder: Path) -> Path:
    """Return the folder, or the current one where it is a bundled sample's."""
    from stippler.resources import assets

    return Path.cwd() if folder.resolve().is_relative_to(assets().resolve()) else folder.resolve()
