"""How a person looked at a drawing and what they held, as a part of its file."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from stippler.brushes.brush import Brush
from stippler.editor.tools.toolbox import Toolbox
from stippler.editor.view import View
from stippler.errors import ParameterError

if TYPE_CHECKING:
    from stippler.editor.session import Session

MEMBER = "editor.json"
_LARGEST = 1 << 20


def state_of(view: View, toolbox: Toolbox) -> dict[str, Any]:
    """Return view, tool and the brushes in use as plain values."""
    camera = view.camera
    return {
        "view": {
            "center_mm": [float(v) for v in camera.center_mm],
            "px_per_mm": float(camera.px_per_mm),
            "rotation_rad": float(camera.rotation_rad),
            "flip": bool(camera.flip),
            "whole_page": view.following,
        },
        "tool": toolbox.name,
        "brushes": [brush.as_dict() for brush in toolbox.shelf.in_use()],
    }


def to_bytes(state: Mapping[str, Any], before: bytes | None = None) -> bytes:
    """Return a state as a member; what a later program has put there before stays in it."""
    return json.dumps({**_document(before), **state}).encode()


def use_state(data: bytes, view: View, toolbox: Toolbox) -> None:
    """Look at a drawing and hold what its file tells; whatever makes no sense is left aside."""
    document = _document(data)
    kept = document.get("view")
    if isinstance(kept, dict):
        _use_view(kept, view)
    brushes = document.get("brushes")
    toolbox.shelf.lend(_brushes(brushes if isinstance(brushes, list) else []))
    name = document.get("tool")
    if isinstance(name, str) and name != toolbox.name and toolbox.has(name):
        toolbox.choose(name)


def _document(data: bytes | None) -> dict[str, Any]:
    if data is None or len(data) > _LARGEST:
        return {}
    try:
        document = json.loads(data)
    except (ValueError, RecursionError):
        return {}
    return document if isinstance(document, dict) else {}


def _use_view(kept: Mapping[str, Any], view: View) -> None:
    try:
        x, y = (float(v) for v in kept["center_mm"])
        scale, turn = float(kept["px_per_mm"]), float(kept["rotation_rad"])
        flip, whole = kept["flip"], kept["whole_page"]
    except (KeyError, TypeError, ValueError, OverflowError):
        return
    if not all(math.isfinite(v) and abs(v) < 1e6 for v in (x, y, scale, turn)) or scale <= 0:
        return
    view.look(
        replace(
            view.camera,
            center_mm=(x, y),
            px_per_mm=scale,
            rotation_rad=turn,
            flip=flip is True,
        ),
        whole_page=whole is True,
    )


def _brushes(values: list[Any]) -> list[Brush]:
    found = []
    for value in values[:100]:
        try:
            found.append(Brush.from_dict(value))
        except ParameterError:
            continue
    return found


class DeskState:
    """Takes over what the file of a drawing just opened tells, and tells what to put into it.

    Parameters
    ----------
    session : Session
        Whose `saving` is told what to put into files.
    """

    def __init__(self, session: Session, view: View, toolbox: Toolbox) -> None:
        self._session, self._view, self._toolbox = session, view, toolbox
        self._seen = session.revision
        session.saving.tell_desk = self._told

    def follow(self) -> None:
        """Use what came with another drawing, once it is open."""
        session = self._session
        if session.revision == self._seen or session.drawing is None:
            return
        self._seen = session.revision
        data = session.drawing.foreign.members.get(MEMBER, b"")
        use_state(data, self._view, self._toolbox)

    def _told(self, before: bytes | None) -> dict[str, bytes]:
        return {MEMBER: to_bytes(state_of(self._view, self._toolbox), before)}
