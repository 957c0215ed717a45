"""Commands on areas."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from stippler.editor.area_files import READ, WRITTEN
from stippler.editor.commands import CTRL, CTRL_SHIFT, Command, Key
from stippler.editor.tools.tool import Desk
from stippler.ui.actions.parts import Parts


def area_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on the chosen areas."""
    acts = parts.area_acts

    def has_some() -> bool:
        return acts.n_chosen > 0

    def has_two() -> bool:
        return acts.n_chosen > 1

    for name, label, short, tip, run, keys, can in (
        ("unite", "Unite areas", "Unite", "the first chosen takes the places of the others.",
         acts.unite, (Key("u", CTRL),), has_two),
        ("remove", "Remove areas", "Remove", "their places and dots are the page's then.",
         acts.remove, (Key("delete", CTRL), Key("backspace", CTRL)), has_some),
        ("smooth", "Smooth borders", "Smooth", "turns the chosen areas' borders into curves.",
         acts.smooth, (), has_some),
        ("simplify", "Simplify borders", "Simplify",
         "leaves out nodes of the chosen areas' borders, as the panel Areas says.",
         acts.simplify, (), has_some),
        ("lock", "Lock or unlock areas", "Lock",
         "brushes and work leave the dots of locked areas alone.",
         lambda: acts.toggle("locked"), (Key("l", CTRL_SHIFT),), has_some),
        ("hide", "Hide or show areas", "Hide",
         "the dots of hidden areas are neither drawn nor exported.",
         lambda: acts.toggle("hidden"), (Key("h", CTRL_SHIFT),), has_some),
        ("up", "Area up in the list", "Up", "", lambda: acts.move_up(1), (), has_some),
        ("down", "Area down in the list", "Down", "", lambda: acts.move_up(-1), (), has_some),
    ):  # fmt: skip
        yield Command(f"area.{name}", label, run, keys, can=can, short=short, tip=tip)
    yield from _work_commands(parts)
    yield from _picture_commands(parts)
    yield from _file_commands(parts)


def _work_commands(parts: Parts) -> Iterator[Command]:
    acts, session = parts.area_acts, parts.session

    def can_work() -> bool:
        return bool(acts.choice.ids) and session.paintable

    def can_stipple() -> bool:
        return can_work() and session.reference is not None

    for name, label, short, tip, run, keys, can in (
        ("stipple", "Stipple areas", "Stipple",
         "makes the dots of the chosen areas anew, one area after the other, each in its style; "
         "all others stay as they are.",
         acts.process, (Key("enter", CTRL_SHIFT),), can_stipple),
        ("relax", "Relax areas", "Relax", "evens out the dots of the chosen areas alone.",
         acts.relax, (Key("r", CTRL_SHIFT),), can_work),
        ("fill", "Fill areas", "Fill", "adds dots to each chosen area.", acts.fill, (), can_work),
        ("clear", "Clear areas", "Clear", "removes the dots of the chosen areas, but fixed ones.",
         acts.clear, (), can_work),
        ("enlarge", "Enlarge the dots of areas", "Larger", "by 10 %.",
         lambda: acts.resize(110.0), (), can_work),
        ("reduce", "Reduce the dots of areas", "Smaller", "by 10 %.",
         lambda: acts.resize(100.0 / 1.1), (), can_work),
    ):  # fmt: skip
        yield Command(f"area.{name}", label, run, keys, can=can, short=short, tip=tip)


def _picture_commands(parts: Parts) -> Iterator[Command]:
    acts, painting, session = parts.area_acts, parts.painting, parts.session
    toolbox = painting.toolbox

    def make(name: str) -> Callable[[], None]:
        def act(desk: Desk) -> None:
            toolbox.made(name).make(desk)  # type: ignore[attr-defined]

        return lambda: painting.at_desk(act, parts.view.camera.px_per_mm)

    yield Command("area.grown", "Make an area of what has grown", make("grow"),
                  can=lambda: toolbox.name == "grow", short="Make area",
                  tip="the outline that is shown becomes an area.")  # fmt: skip
    yield Command("area.proposed", "Make areas of all proposals", make("proposals"),
                  can=lambda: toolbox.name == "proposals", short="Make areas",
                  tip="all regions but the ground become areas.")  # fmt: skip
    yield Command("area.dark", "Dark parts as inverse areas", acts.dark_parts,
                  can=lambda: session.paintable and session.reference is not None,
                  short="Dark parts", tip="what is too dark for dots of the page's sizes becomes "
                  "areas of white dots on black.")  # fmt: skip


def _file_commands(parts: Parts) -> Iterator[Command]:
    acts, dialogs, session = parts.area_acts, parts.popups.dialogs, parts.session

    def ask_import() -> None:
        dialogs.ask_file("Import areas", "Outlines", Path.cwd(), READ, acts.import_outlines)

    def ask_export() -> None:
        first = session.exports.file or Path("areas")
        dialogs.ask_outlines(first.with_suffix(".svg"), WRITTEN, acts.export_outlines)

    for name, short, tip, run, can in (
        ("import", "Import", "outlines of an SVG or GeoJSON file become areas.",
         ask_import, lambda: acts.document is not None),
        ("export", "Export", "outlines of all areas, as SVG paths or GeoJSON.",
         ask_export, lambda: acts.n_listed > 0),
    ):  # fmt: skip
        yield Command(f"area.{name}", f"{short} areas", run, can=can, short=short, tip=tip)
