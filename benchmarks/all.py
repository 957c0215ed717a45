"""All figures, topic by topic, as a table or as JSON."""

from __future__ import annotations

import importlib
import json
import platform
import sys
from dataclasses import asdict
from typing import Any

from rich.console import Console
from rich.table import Table

from benchmarks.figures import Figure
from stippler.errors import ParameterError
from stippler.kernels.machine.pool import n_threads

TOPICS = (
    "programs",
    "kernels",
    "relaxation",
    "areas",
    "lines",
    "first_dots",
    "quality",
    "grain",
    "tone",
    "rendering",
    "exports",
    "editor",
    "brushes",
    "view",
    "live",
    "files",
    "soak",
)


def main(*, as_json: bool = False, quick: bool = False, only: str = "") -> int:
    """Run the topics named, or all, and print every figure beside what was promised."""
    topics = [name.strip() for name in only.split(",") if name.strip()] or list(TOPICS)
    for name in topics:
        if name not in TOPICS:
            raise ParameterError(f"{name!r} is no topic", "only", f"of {', '.join(TOPICS)}")
    console = Console(stderr=True)
    results: dict[str, list[Figure]] = {}
    for name in topics:
        console.print(f"measuring {name} ...")
        results[name] = importlib.import_module(f"benchmarks.{name}").figures(quick=quick)
        if not as_json:
            Console(width=120).print(table(name, results[name]))
    if as_json:
        sys.stdout.write(json.dumps(_document(results), indent=1) + "\n")
    return 0


def table(title: str, figures: list[Figure]) -> Table:
    """Lay figures out beside what was promised."""
    shown = Table(title=title, title_justify="left", highlight=False)
    shown.add_column("figure")
    for name in ("measured", "reach", "stretch"):
        shown.add_column(name, justify="right")
    shown.add_column("")
    shown.add_column("note")
    for figure in figures:
        shown.add_row(
            figure.name,
            f"{figure.value:.4g} {figure.unit}",
            "" if figure.reach is None else f"{figure.reach:g}",
            "" if figure.stretch is None else f"{figure.stretch:g}",
            figure.verdict,
            figure.note,
        )
    return shown


def _document(results: dict[str, list[Figure]]) -> dict[str, Any]:
    return {
        "python": platform.python_version(),
        "machine": platform.machine(),
        "threads": n_threads(),
        "topics": {name: [asdict(f) for f in figures] for name, figures in results.items()},
    }
