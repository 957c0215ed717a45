"""Commands on lines and rows of dots."""

from __future__ import annotations

from collections.abc import Iterator

from stippler.editor.commands import Command
from stippler.ui.actions.parts import Parts


def line_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on lines."""
    lines = parts.lines

    def has_chosen() -> bool:
        return lines.document is not None and bool(lines.chosen)

    yield Command("line.row", "Lay the row", lines.lay_row, can=lambda: lines.can_row, short="Row",
                  tip="lays a row of dots by the values of the tool Line.")  # fmt: skip
    for name, label, short, tip, run in (
        ("line_up", "Line up dots", "Line up", "dots within reach come to lie on the line.",
         lines.line_up),
        ("spread", "Spread dots on lines", "Spread", "evenly by arc length, by the picture's tone.",
         lines.spread),
        ("release", "Free dots of lines", "Free dots", "lines hold them no longer.", lines.release),
        ("delete", "Delete lines", "Delete line", "their dots are free then.", lines.delete),
    ):  # fmt: skip
        yield Command(f"line.{name}", label, run, can=has_chosen, short=short, tip=tip)
