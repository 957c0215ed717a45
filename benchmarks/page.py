"""Writes what topics measure into `docs/performance.md`.

``python -m benchmarks.page TOPIC...`` runs them and replaces the table under each one's mark,
``<!-- bench TOPIC -->``; without a name, all topics that have one.
"""

from __future__ import annotations

import importlib
import re
import sys
from pathlib import Path

from benchmarks.figures import Figure

PAGE = Path(__file__).parents[1] / "docs" / "performance.md"
_HEAD = "| | measured | reach | stretch | |\n|---|---|---|---|---|\n"


def main(topics: list[str]) -> None:
    """Measure topics, all that are marked by default, and write each down as it ends."""
    for topic in topics or marked(PAGE.read_text(encoding="utf-8")):
        figures = importlib.import_module(f"benchmarks.{topic}").figures()
        text = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(filled(text, topic, figures), encoding="utf-8")


def marked(text: str) -> list[str]:
    """Return the topics that have a table."""
    return re.findall(r"<!-- bench (\w+) -->", text)


def filled(text: str, topic: str, figures: list[Figure]) -> str:
    """Return a page with the table of a topic made anew; all else stays.

    Raises
    ------
    KeyError
        If the topic has no mark.
    """
    mark = f"<!-- bench {topic} -->\n"
    if mark not in text:
        raise KeyError(topic)
    before, _, rest = text.partition(mark)
    after = re.sub(r"\A(?:\|.*\n)*", "", rest)
    return f"{before}{mark}{_HEAD}{''.join(map(_row, figures))}{after}"


def _row(figure: Figure) -> str:
    reach, stretch = (
        "" if promised is None else f"{promised:g} {figure.unit}"
        for promised in (figure.reach, figure.stretch)
    )
    note = ", ".join(filter(None, ("missed" * (figure.verdict == "missed"), figure.note)))
    cells = (figure.name, f"{figure.value:.3g} {figure.unit}", reach, stretch, note)
    return f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |\n"


if __name__ == "__main__":
    main(sys.argv[1:])
