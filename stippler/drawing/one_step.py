"""An edit that is a step of the history by itself, whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.edit import Edit


def as_one_step(document: Document, label: str, act: Callable[[Document], Any]) -> Edit:
    """Let a function change a document, as one step of its history.

    What it raises is raised on, once all that it has changed is taken back: a stroke that stays
    open would refuse every edit after it.
    """
    document.begin(label)
    try:
        act(document)
    except BaseException:
        document.cancel()
        raise
    return document.commit()
