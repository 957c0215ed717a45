"""Named brushes that survive a restart, as JSON in the person's settings folder."""

from __future__ import annotations

import json
from pathlib import Path

from stippler.brushes.brush import Brush, first_brushes
from stippler.brushes.kinds import KINDS
from stippler.errors import ParameterError
from stippler.settings import settings_folder, write_document

_VERSION = 1


def presets_path() -> Path:
    """Return where the brushes are kept; ``STIPPLER_CONFIG_DIR`` moves it."""
    return settings_folder() / "brushes.json"


def load_brushes(path: Path) -> tuple[list[Brush], str]:
    """Return the brushes kept in a file, and what was wrong with it, if anything.

    Every type is there at least once, whatever the file holds.
    """
    problem = ""
    brushes: list[Brush] = []
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        for data in document["brushes"]:
            try:
                brushes.append(Brush.from_dict(data))
            except ParameterError as error:
                problem = str(error)
    except FileNotFoundError:
        pass
    except (OSError, ValueError, KeyError, TypeError) as error:
        problem = f"{path.name} cannot be read ({error})"
    there = {brush.kind for brush in brushes}
    brushes += [brush for brush in first_brushes() if brush.kind not in there]
    order = {kind.name: k for k, kind in enumerate(KINDS)}
    brushes.sort(key=lambda brush: order[brush.kind])
    return brushes, problem


def save_brushes(path: Path, brushes: list[Brush]) -> None:
    """Keep brushes in a file, whole or not at all.

    Raises
    ------
    StipplerError
        If it cannot be written.
    """
    document = {"version": _VERSION, "brushes": [brush.as_dict() for brush in brushes]}
    write_document(path, document)
