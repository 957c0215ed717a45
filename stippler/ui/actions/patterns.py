"""Commands on the pattern of an area."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from stippler.editor.commands import Command
from stippler.ui.actions.parts import Parts

_ENDINGS = (".svg", ".svgz", ".geojson")


def pattern_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on patterns."""
    patterns = parts.patterns

    def is_laid() -> bool:
        return patterns.document is not None and patterns.laid is not None

    def add() -> None:
        parts.popups.dialogs.ask_open("Add a pattern", Path.cwd(), _ENDINGS, patterns.add_file)

    yield Command("pattern.add", "Add pattern", add,
                  tip="reads closed paths from an SVG; open ones are closed.")  # fmt: skip
    for name, label, short, tip, run in (
        ("fill", "Fill the pattern", "Fill", "dots fill its polygons and relax in all at once.",
         patterns.fill),
        ("relax", "Relax in the pattern", "Relax", "each dot within its polygon.", patterns.relax),
        ("straighten", "Straighten the pattern", "Straighten", "takes cage and pins away.",
         patterns.straighten),
        ("between", "Area of what lies between", "Part between",
         "makes an area with a style of its own of what lies between the polygons.",
         patterns.part_between),
        ("remove", "Remove the pattern", "Remove", "its dots stay.", patterns.remove),
    ):  # fmt: skip
        yield Command(f"pattern.{name}", label, run, can=is_laid, short=short, tip=tip)
