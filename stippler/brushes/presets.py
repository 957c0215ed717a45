"""Named brushes that survive a restart, as JSON in the person's settings folder."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path

from platformdirs import user_config_path

from stippler.brushes.brush import Brush, first_brushes
from stippler.brushes.kinds import KINDS
from stippler.errors import ParameterError, StipplerError

_VERSION = 1


def presets_path() -> Path:
    """Return where the brushes are kept; ``STIPPLER_CONFIG_DIR`` moves it."""
    base = os.environ.get("STIPPLER_CONFIG_DIR")
    return (Path(base) if base else user_config_path("stippler")) / "brushes.json"


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
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=path.parent, delete=False
        ) as file:
            json.dump(document, file, indent=1)
        os.replace(file.name, path)
    except OSError as error:
        raise StipplerError(
            f"the brushes cannot be kept ({error.strerror})", path, "check the folder"
        ) from error
