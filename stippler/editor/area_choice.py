"""The chosen areas, by id, and the one that is shown alone."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from stippler.drawing.area import PAGE_AREA
from stippler.editor.events import NO_MODS, Mods

if TYPE_CHECKING:
    from stippler.drawing.document import Document

Point = tuple[float, float]


class AreaChoice:
    """Which areas are chosen; they are told from chosen dots.

    Attributes
    ----------
    ids : tuple of int
        In the order they were chosen; some may be gone.
    solo : int or None
        The one area that is shown.
    revision : int
        Grows with every change.
    """

    def __init__(self) -> None:
        self.ids: tuple[int, ...] = ()
        self.solo: int | None = None
        self.revision = 0

    def choose(self, ids: Iterable[int], mods: Mods = NO_MODS) -> None:
        """Choose areas; Shift adds them or takes them away again, Alt takes them away."""
        new = tuple(dict.fromkeys(ids))
        if mods.shift:
            kept = tuple(k for k in self.ids if k not in new)
            new = kept if len(kept) < len(self.ids) else self.ids + new
        elif mods.alt:
            new = tuple(k for k in self.ids if k not in new)
        if new != self.ids:
            self.ids = new
            self.revision += 1

    def click(self, document: Document, at: Point, mods: Mods = NO_MODS) -> None:
        """Choose the area at a point; a click off the page chooses none."""
        found = area_at(document, at)
        self.choose(() if found is None else (found,), mods)

    def show_alone(self, area: int | None) -> None:
        """Show one area alone, or all again."""
        self.solo = area
        self.revision += 1

    def alive(self, document: Document) -> list[int]:
        """Return the chosen areas that are there."""
        areas = document.drawing.areas
        return [k for k in self.ids if k in areas]

    def drawn(self, document: Document) -> list[int]:
        """Return the chosen areas that are there and not the page's own."""
        return [k for k in self.alive(document) if k != PAGE_AREA]

    def forget(self) -> None:
        """Choose nothing, and show all."""
        self.choose(())
        self.show_alone(None)


def area_at(document: Document, at: Point) -> int | None:
    """Return the area at a point; None off the page."""
    import numpy as np

    found = int(document.partition.area_at(np.array([at], np.float64))[0])
    return found if found >= 0 else None
