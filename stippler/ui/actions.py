"""The editor's commands, each with its keys."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from stippler.editor.commands import CTRL, CTRL_SHIFT, SHIFT, Command, Commands, Key
from stippler.editor.session import Session
from stippler.stippling.plan import Plan
from stippler.ui.panels.layout import TOOL
from stippler.ui.preferences import SCALES, TONES
from stippler.ui.window.window import Window
from stippler.units import DEFAULT_WIDTH_MM

if TYPE_CHECKING:
    from stippler.ui.editor_window import Editor

_TEXT_STEP = 1.1
_RESIZE_PERCENT = 10.0
_TURN_RAD = math.radians(15.0)


def commands_for(editor: Editor, session: Session, window: Window) -> Commands:
    """Make the commands of an editor."""
    return Commands(
        [
            *_file(editor, session),
            *_edit(editor, session),
            *_selection(editor),
            *_work(editor, session),
            *_tools(editor),
            *_view(editor, session, window),
            *_panels(editor),
            *_help(editor),
        ]
    )


def _file(editor: Editor, session: Session) -> Iterator[Command]:
    popups, filing = editor.popups, editor.popups.filing

    def has_dots() -> bool:
        return session.n_dots > 0

    yield Command("file.new", "New page", popups.new_page.ask, (Key("n", CTRL),))
    yield Command("file.open", "Open a picture", filing.ask_picture, (Key("o", CTRL),))
    yield Command("file.forget", "Forget recent pictures", filing.forget_recent,
                  can=lambda: bool(filing.recent()))  # fmt: skip
    yield Command("file.export", "Export the drawing", filing.export, (Key("s", CTRL),),
                  can=has_dots)  # fmt: skip
    yield Command("file.export_as", "Export to another file", filing.export_as,
                  (Key("s", CTRL_SHIFT), Key("e", CTRL)), can=has_dots)  # fmt: skip
    yield Command("file.quit", "Quit", filing.quit, (Key("q", CTRL),))


def _edit(editor: Editor, session: Session) -> Iterator[Command]:
    painting, popups = editor.painting, editor.popups

    def can_undo() -> bool:
        return session.document is not None and session.document.history.undone is not None

    def can_redo() -> bool:
        return session.document is not None and session.document.history.redone is not None

    yield Command("edit.undo", "Undo", painting.undo, (Key("z", CTRL),), can=can_undo)
    yield Command("edit.redo", "Redo", painting.redo, (Key("z", CTRL_SHIFT), Key("y", CTRL)),
                  can=can_redo)  # fmt: skip
    yield Command("edit.preferences", "Preferences", popups.preferences.ask, (Key(",", CTRL),))


def _selection(editor: Editor) -> Iterator[Command]:
    painting = editor.painting

    def has_some() -> bool:
        return painting.n_selected > 0

    yield Command("selection.all", "Select all", painting.select_all, (Key("a", CTRL),))
    yield Command("selection.none", "Select nothing", painting.select_none,
                  (Key("a", CTRL_SHIFT),), can=has_some)  # fmt: skip
    for name, label, short, tip, run, keys in (
        ("delete", "Delete the selection", "Delete", "", painting.delete,
         (Key("delete"), Key("backspace"))),
        ("duplicate", "Duplicate the selection", "Duplicate", "the copies are selected then.",
         painting.duplicate, (Key("d", CTRL),)),
        ("fix", "Fix the selection", "Fix dots", "they stay where they are from now on.",
         lambda: painting.fix(True), ()),
        ("free", "Free the selection", "Free dots", "they may move again.",
         lambda: painting.fix(False), ()),
        ("relax", "Relax the selection", "Relax dots", "one step of relaxation.",
         painting.relax, ()),
        ("jitter", "Jitter the selection", "Jitter dots",
         "by up to a fifth of their mean distance.", painting.jitter, ()),
        ("enlarge", "Enlarge the selection's dots", "Larger", "by 10 percent.",
         lambda: painting.resize(_RESIZE_PERCENT), ()),
        ("reduce", "Reduce the selection's dots", "Smaller", "by 10 percent.",
         lambda: painting.resize(-_RESIZE_PERCENT), ()),
    ):  # fmt: skip
        yield Command(f"selection.{name}", label, run, keys, can=has_some, short=short, tip=tip)


def _work(editor: Editor, session: Session) -> Iterator[Command]:
    def relax_all() -> None:
        session.relax(session.plan.iterations or 20, weighted=session.plan.weighted)

    def hold() -> None:
        if session.phase == "paused":
            session.resume()
        else:
            session.pause()

    def reset() -> None:
        session.plan = Plan()
        session.tone, session.width_mm = TONES[0], DEFAULT_WIDTH_MM

    def is_busy() -> bool:
        return session.busy

    yield Command("work.start", "Start", editor.popups.filing.start, (Key("enter", CTRL),))
    yield Command("work.pause", "Pause or go on", hold, (Key("p"),), can=is_busy)
    yield Command("work.stop", "Stop", session.stop, can=is_busy)
    yield Command("work.relax", "Relax all dots", relax_all, (Key("l", CTRL),),
                  can=lambda: session.paintable and session.n_dots > 0)  # fmt: skip
    yield Command("work.reset", "Values as at first", reset)


def _tools(editor: Editor) -> Iterator[Command]:
    toolbox = editor.painting.toolbox

    def chooser(name: str) -> Callable[[], None]:
        def choose() -> None:
            toolbox.choose(name)
            editor.show_panel(TOOL)

        return choose

    def used(name: str) -> Callable[[], bool]:
        return lambda: toolbox.name == name

    yield Command("tool.none", "No tool", lambda: toolbox.choose(""), (Key("v"),),
                  is_on=lambda: toolbox.tool is None)  # fmt: skip
    for tool in toolbox.tools:
        keys = (Key(tool.key),) if tool.key else ()
        yield Command(f"tool.{tool.name}", tool.label, chooser(tool.name), keys,
                      is_on=used(tool.name))  # fmt: skip
    shelf = toolbox.shelf

    def restore() -> None:
        if kind := shelf.restore():
            toolbox.choose(kind if toolbox.name != kind else "")
            toolbox.choose(kind)

    yield Command("tool.restore", "Restore deleted brush", restore,
                  can=lambda: shelf.can_restore)  # fmt: skip
    for name, label, factor, key in (
        ("larger", "Larger tip", 1.15, Key("]")),
        ("smaller", "Smaller tip", 1 / 1.15, Key("[")),
    ):
        yield Command(f"tool.{name}", label, lambda f=factor: toolbox.resize(f), (key,))  # type: ignore[misc]


def _view(editor: Editor, session: Session, window: Window) -> Iterator[Command]:
    look, view = editor.look, editor.view

    def show_reference() -> None:
        look.reference_shown = not look.reference_shown

    def show_dots() -> None:
        look.dots_shown = not look.dots_shown

    def print_size() -> None:
        view.print_size(window.px_per_mm)

    def scale_text(factor: float) -> None:
        scale = (look.scale or window.scale) * factor
        look.scale = round(min(max(scale, SCALES[0]), SCALES[1]), 2)
        session.messages.say(f"text and controls at {look.scale:.0%}")

    yield Command("view.fit", "Fit", view.fit, (Key("f"), Key("home")))
    yield Command("view.print_size", "Print size", print_size, (Key("1"),))
    yield Command("view.selection", "Zoom to the selection", editor.show_selection,
                  (Key("f", SHIFT),))  # fmt: skip
    yield Command("view.reference", "Show or hide the picture", show_reference, (Key("r"),),
                  is_on=lambda: look.reference_shown)  # fmt: skip
    yield Command("view.dots", "Show or hide the dots", show_dots, (Key("d"),),
                  is_on=lambda: look.dots_shown)  # fmt: skip
    yield from _turning(editor)
    yield from _lenses(editor)
    yield Command("view.theme", "Light or dark", look.turn_theme, (Key("t"),))
    yield Command("view.larger", "Larger text and controls", lambda: scale_text(_TEXT_STEP))
    yield Command("view.smaller", "Smaller text and controls", lambda: scale_text(1 / _TEXT_STEP))


def _turning(editor: Editor) -> Iterator[Command]:
    view = editor.view
    yield Command("view.turn_left", "Turn left", lambda: view.turn(-_TURN_RAD), (Key(","),))
    yield Command("view.turn_right", "Turn right", lambda: view.turn(_TURN_RAD), (Key("."),))
    yield Command("view.flip", "Flip", view.flip, (Key("y"), Key("\\")))
    yield Command("view.upright", "Upright", view.upright, (Key("0"),))


def _lenses(editor: Editor) -> Iterator[Command]:
    look, lens = editor.look, editor.lens_key
    for name, label, key in (
        ("reduce", "Reduction lens", Key("z")),
        ("magnify", "Magnifying lens", Key("q")),
    ):
        yield Command(
            f"view.{name}",
            label,
            lambda name=name: lens.switch(name),  # type: ignore[misc]
            (key,),
            is_on=lambda name=name: look.lens == name,  # type: ignore[misc]
        )


def _panels(editor: Editor) -> Iterator[Command]:
    panels = editor.panels
    for name in panels.names:
        yield Command(
            f"panel.{name.lower().replace(' ', '_')}",
            name,
            lambda name=name: panels.toggle(name),  # type: ignore[misc]
            is_on=lambda name=name: panels.is_open(name),  # type: ignore[misc]
        )
    yield Command("panel.reset", "Reset the panels", editor.reset_panels)


def _help(editor: Editor) -> Iterator[Command]:
    popups = editor.popups
    yield Command("help.palette", "Find a command", popups.palette.ask, (Key("p", CTRL_SHIFT),))
    yield Command("help.keys", "Shortcuts", popups.sheet.ask, (Key("f1"),))
