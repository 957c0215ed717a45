"""Named brushes that survive a restart, as JSON in the person's settings folder."""

from __future__ import annotations

from pathlib import Path

from stippler.brushes.brush import Brush, first_brushes
from stippler.brushes.kinds import KINDS
from stippler.errors import ParameterError
from stippler.settings import put_aside, read_document, settings_folder, write_document

_VERSION = 1
_FORMER = ("select",)  # kinds of earlier versions that are tools of their own now


def presets_path() -> Path:
    """Return where the brushes are kept; ``STIPPLER_CONFIG_DIR`` moves it."""
    return settings_folder() / "brushes.json"


def load_brushes(path: Path) -> tuple[list[Brush], str]:
    """Return the brushes kept in a file, and what was wrong with it, if anything.

    Every type is there at least once, whatever the file holds. A file that holds something else
    is put aside, so that it is not written over.
    """
    document, problem = read_document(path)
    kept = document.get("brushes", [])
    brushes: list[Brush] = []
    unusable = "" if isinstance(kept, list) else "'brushes' is no list"
    for data in kept if isinstance(kept, list) else ():
        if isinstance(data, dict) and data.get("kind") in _FORMER:
            continue
        try:
            brushes.append(Brush.from_dict(data))
        except ParameterError as error:
            unusable = str(error)
    if unusable:
        problem = f"{unusable}; the file is kept as {put_aside(path)}"
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
