"""The brushes at hand, the one in use, the selection, and the state of the tool."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.brushes.brush import Brush
from stippler.brushes.presets import load_brushes, save_brushes
from stippler.brushes.stroke_path import PointerSample
from stippler.editor.events import LEFT, Event, KeyDown, KeyUp, Mods, Moved, Pressed, Released
from stippler.editor.messages import WARNING
from stippler.editor.tools.states import (
    Cornering,
    Desk,
    Outlining,
    Point,
    Rest,
    Stroking,
    ToolState,
)
from stippler.errors import StipplerError

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.preview import Preview
    from stippler.drawing.reference import Reference

LIGHT_PRESSURE = 0.3
_FAST_RADII_PER_S = 30.0  # a stroke this fast has the least pressure
_HEADING_PX = 6.0  # shorter ways are shaking
_CALM_S = 0.08  # over which the speed is averaged

Say = Callable[[str, str], None]


class Chosen:
    """The selected dots, by id.

    Attributes
    ----------
    revision : int
        Grows with every change.
    """

    def __init__(self) -> None:
        self.ids: NDArray[np.int64] = np.empty(0, np.int64)
        self.revision = 0

    def choose(self, ids: NDArray[np.int64], mods: Mods) -> None:
        """Choose dots; Shift adds them, Alt takes them away."""
        if mods.shift:
            ids = np.union1d(self.ids, ids)
        elif mods.alt:
            ids = np.setdiff1d(self.ids, ids)
        self.ids = np.sort(ids)
        self.revision += 1

    def mask(self, document: Document) -> NDArray[np.bool_]:
        """Return which rows are chosen."""
        out = np.zeros(len(document.dots), np.bool_)
        rows = document.rows(self.ids)
        out[rows[rows >= 0]] = True
        return out


class Toolbox:
    """Takes input for the chosen brush and brings it to the drawing that is edited.

    Parameters
    ----------
    path : Path
        Where the brushes are kept.
    say : callable
        Tells the person a line, with how grave it is.

    Attributes
    ----------
    brushes : list of Brush
        Each type at least once.
    chosen : int
        Which of them is in use; -1 is none, and the pointer only pans.
    selection : Chosen
    state : ToolState
    """

    def __init__(self, path: Path, say: Say, seed: int = 0) -> None:
        self._path, self._say = path, say
        self.brushes, problem = load_brushes(path)
        if problem:
            say(f"some brushes could not be loaded: {problem}", WARNING)
        self.chosen = -1
        self.selection = Chosen()
        self.state: ToolState = Rest()
        self._n_strokes = seed
        self._last_end: PointerSample | None = None
        self._alt = False
        self._speed: tuple[Point, float, float] | None = None  # where, when, mm/s
        self._unsaved = bool(problem)  # what could be read is written anew
        self._from: Point | None = None  # where the pointer was when its heading was last looked at
        self._heading_rad = math.nan

    # --- brushes ----------------------------------------------------------------------------

    @property
    def brush(self) -> Brush | None:
        """The brush in use."""
        return self.brushes[self.chosen] if self.chosen >= 0 else None

    def choose(self, index: int) -> None:
        """Take a brush; -1 puts it away, and with the old one goes a polygon not closed yet."""
        if isinstance(self.state, Cornering):
            self.state = Rest()
        self.chosen = index

    def choose_kind(self, name: str) -> None:
        """Take the first brush of a type, or the next if one of that type is in use."""
        same = [k for k, brush in enumerate(self.brushes) if brush.kind == name]
        at = same.index(self.chosen) + 1 if self.chosen in same else 0
        self.choose(same[at % len(same)])

    def set_brush(self, brush: Brush) -> None:
        """Change the brush in use."""
        if self.chosen >= 0 and brush != self.brushes[self.chosen]:
            self.brushes[self.chosen] = brush
            self._unsaved = True

    def resize(self, factor: float) -> None:
        """Enlarge or reduce the tip of the brush in use."""
        if self.brush is not None:
            self.set_brush(self.brush.resized(factor))

    def copy_brush(self) -> None:
        """Add a copy of the brush in use, and use that."""
        if self.brush is None:
            return
        names = {brush.name for brush in self.brushes}
        n = next(n for n in range(2, len(names) + 3) if f"{self.brush.name} {n}" not in names)
        self.brushes.insert(self.chosen + 1, replace(self.brush, name=f"{self.brush.name} {n}"))
        self.chosen += 1
        self._unsaved = True

    def delete_brush(self) -> None:
        """Remove the brush in use, if its type has another."""
        brush = self.brush
        if brush is None or sum(b.kind == brush.kind for b in self.brushes) < 2:
            return
        del self.brushes[self.chosen]
        self.choose(next(k for k, b in enumerate(self.brushes) if b.kind == brush.kind))
        self._unsaved = True

    def save(self) -> None:
        """Keep the brushes, if they have changed."""
        if self._unsaved:
            self._unsaved = False
            try:
                save_brushes(self._path, self.brushes)
            except StipplerError as error:
                self._say(str(error), WARNING)

    # --- input ------------------------------------------------------------------------------

    @property
    def is_busy(self) -> bool:
        """Whether something is held, so that it gets events over panels, too."""
        return not isinstance(self.state, Rest)

    @property
    def is_timed(self) -> bool:
        """Whether the stroke goes on while the pointer rests."""
        return isinstance(self.state, Stroking) and self.state.stroke.is_timed

    @property
    def outline(self) -> list[Point]:
        """The outline being drawn for a selection, in mm."""
        return self.state.outline if isinstance(self.state, Outlining | Cornering) else []

    def take(
        self,
        event: Event,
        document: Document,
        page: Callable[[float, float], Point],
        px_per_mm: float,
    ) -> bool:
        """Take an event; return whether it was for the tool.

        What fails takes the stroke back before it is raised.
        """
        if isinstance(event, KeyDown | KeyUp) and event.key in ("left_alt", "right_alt"):
            self._alt = isinstance(event, KeyDown)
        brush = self.brush
        if brush is None:
            return False
        desk = self._desk(document, brush, page, px_per_mm)
        before = self.state
        if isinstance(event, Moved):
            self._head(page(event.x_px, event.y_px), px_per_mm)
        try:
            self.state = before.take(event, desk)
        except BaseException:
            before.cancel(desk)
            self.state = Rest()
            raise
        if isinstance(self.state, Rest):
            self._last_end = self.state.ended or self._last_end
            self._speed = None
        was_busy = not isinstance(before, Rest)
        match event:
            case Pressed(button=button) | Released(button=button):
                return button == LEFT and (was_busy or self.is_busy)
            case KeyDown():
                return was_busy
        return self.brush is not brush and not isinstance(event, Moved)

    def rest(self, t_s: float) -> None:
        """Let time go on within a stroke."""
        if isinstance(self.state, Stroking):
            try:
                self.state.rest(t_s)
            except BaseException:
                self.state = Rest()
                raise

    def drop(self, document: Document | None) -> None:
        """Give up what is held, and the selection: another drawing is open now."""
        if document is not None and self.brush is not None and self.is_busy:
            self.state.cancel(self._desk(document, self.brush, lambda x, y: (x, y), 1.0))
        self.state, self._last_end = Rest(), None
        self.selection.choose(np.empty(0, np.int64), Mods())

    def _desk(
        self,
        document: Document,
        brush: Brush,
        page: Callable[[float, float], Point],
        px_per_mm: float,
    ) -> Desk:
        return Desk(
            document,
            brush,
            self.selection,
            page,
            px_per_mm,
            self._pressure,
            self._next_seed,
            self.set_brush,
            self._last_end,
            self._heading_rad,
        )

    def _head(self, at: Point, px_per_mm: float) -> None:
        """Note where the pointer is going."""
        if self._from is None:
            self._from = at
        dx, dy = at[0] - self._from[0], at[1] - self._from[1]
        if math.hypot(dx, dy) * px_per_mm >= _HEADING_PX:
            self._from, self._heading_rad = at, math.atan2(dy, dx)

    def preview(self, at_mm: Point, reference: Reference | None) -> Preview | None:
        """Return what a press would do to the dots under the tip, where that can be shown."""
        brush = self.brush
        if brush is None or self.is_busy or brush.kind not in ("size", "shape"):
            return None
        from stippler.brushes.shape import preview_of

        light = brush.pressure == "key" and self._alt
        strength = LIGHT_PRESSURE if light else 1.0
        return preview_of(brush, at_mm, self._heading_rad, strength, reference)

    def _next_seed(self) -> int:
        self._n_strokes += 1
        return self._n_strokes

    def _pressure(self, at: Point, t_s: float) -> float:
        """Return what stands in for a pen's pressure: 1 is full."""
        brush = self.brush
        if brush is None or brush.pressure == "none":
            return 1.0
        if brush.pressure == "key":
            return LIGHT_PRESSURE if self._alt else 1.0
        speed = 0.0
        if self._speed is not None:
            (x, y), t, before = self._speed
            dt = t_s - t
            share = 1.0 - math.exp(-dt / _CALM_S) if dt > 0.0 else 0.0
            now = math.hypot(at[0] - x, at[1] - y) / dt if dt > 0.0 else before
            speed = before + share * (now - before)
        self._speed = (at, t_s, speed)
        fast = _FAST_RADII_PER_S * brush.radius_mm
        return 1.0 - (1.0 - LIGHT_PRESSURE) * min(speed / fast, 1.0)
