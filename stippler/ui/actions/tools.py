"""Commands on tools, brushes and the selection."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from stippler.editor.commands import CTRL, CTRL_SHIFT, SHIFT, Command, Key
from stippler.editor.events import NO_MODS
from stippler.ui.actions.parts import Parts
from stippler.ui.panels.layout import TOOL

_RESIZE_PERCENT = 10.0
_NUDGE_MM = 0.1


def selection_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on the chosen dots."""
    painting, selecting, pointer = parts.painting, parts.selecting, parts.pointer

    def has_some() -> bool:
        return painting.n_selected > 0

    yield Command("selection.all", "Select all", painting.select_all, (Key("a", CTRL),))
    yield Command("selection.none", "Select nothing", painting.select_none,
                  (Key("a", CTRL_SHIFT),), can=has_some)  # fmt: skip
    yield Command("selection.again", "Select again", selecting.again, (Key("d", CTRL_SHIFT),),
                  can=lambda: painting.toolbox.selection.has_last)  # fmt: skip
    yield Command("selection.invert", "Invert the selection", selecting.invert,
                  (Key("i", CTRL_SHIFT),), short="Invert",
                  tip="selects all other dots.")  # fmt: skip
    for name, label, short, tip, run, keys in (
        ("grow", "Grow the selection", "Grow", "selects the neighbours, too.", selecting.grow,
         (Key("g", CTRL),)),
        ("copy", "Copy the selection", "Copy", "keeps it for Paste.", selecting.copy,
         (Key("c", CTRL),)),
        ("cut", "Cut the selection", "Cut", "copies and deletes it.", selecting.cut,
         (Key("x", CTRL),)),
        ("delete", "Delete the selection", "Delete", "", painting.delete,
         (Key("delete"), Key("backspace"))),
        ("duplicate", "Duplicate the selection", "Duplicate", "the copies are selected then.",
         painting.duplicate, (Key("d", CTRL),)),
        ("fix", "Fix the selection", "Fix dots", "they stay where they are from now on.",
         lambda: painting.fix(True), ()),
        ("free", "Free the selection", "Free dots", "they may move again.",
         lambda: painting.fix(False), ()),
        ("relax", "Relax the selection", "Relax dots", "evens out their spacing by one step.",
         painting.relax, ()),
        ("jitter", "Jitter the selection", "Jitter dots",
         "by up to a fifth of their mean distance.", painting.jitter, ()),
        ("enlarge", "Enlarge the selection's dots", "Larger", "by 10 %.",
         lambda: painting.resize(_RESIZE_PERCENT), ()),
        ("reduce", "Reduce the selection's dots", "Smaller", "by 10 %.",
         lambda: painting.resize(-_RESIZE_PERCENT), ()),
    ):  # fmt: skip
        yield Command(f"selection.{name}", label, run, keys, can=has_some, short=short, tip=tip)
    yield Command("selection.paste", "Paste", lambda: selecting.paste(pointer.at_mm),
                  (Key("v", CTRL),), can=lambda: selecting.has_copy, short="Paste",
                  tip="adds what was copied, at the pointer; it is selected then.")  # fmt: skip
    yield from _nudge_commands(parts)


def _nudge_commands(parts: Parts) -> Iterator[Command]:
    for name, dx, dy in (("left", -1, 0), ("right", 1, 0), ("up", 0, -1), ("down", 0, 1)):
        for suffix, step_mm, mods in (("", _NUDGE_MM, NO_MODS), ("_far", 10 * _NUDGE_MM, SHIFT)):
            yield Command(
                f"selection.{name}{suffix}",
                f"Nudge {name} by {step_mm:g} mm",
                lambda x=dx * step_mm, y=dy * step_mm: parts.selecting.nudge(x, y),  # type: ignore[misc]
                (Key(name, mods),),
                can=lambda: parts.painting.n_selected > 0,
                repeats=True,
            )


def tool_commands(parts: Parts) -> Iterator[Command]:
    """Yield a command for each tool, and for brushes."""
    toolbox = parts.painting.toolbox

    def chooser(name: str) -> Callable[[], None]:
        def choose() -> None:
            toolbox.choose(name)
            commands = parts.popups.commands
            if commands is None or not commands.by_key:  # a letter hides no panel
                parts.show_panel(TOOL)

        return choose

    def used(name: str) -> Callable[[], bool]:
        return lambda: toolbox.name == name

    yield Command("tool.none", "No tool", lambda: toolbox.choose(""), (Key("v"),),
                  is_on=lambda: toolbox.tool is None)  # fmt: skip
    for tool in toolbox.cards:
        keys = (Key.read(tool.key),) if tool.key else ()
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
