"""The tools, the one at hand, what it holds, and the selection."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.brushes.brush import Brush
from stippler.editor.area_choice import AreaChoice
from stippler.editor.events import (
    LEFT,
    NO_MODS,
    Event,
    FocusLost,
    KeyDown,
    KeyUp,
    Mods,
    Moved,
    Pressed,
    Released,
)
from stippler.editor.messages import WARNING
from stippler.editor.tools.brush_shelf import BrushShelf, Say
from stippler.editor.tools.brush_tool import BrushTool
from stippler.editor.tools.cards import all_cards
from stippler.editor.tools.line_choice import ChosenLines
from stippler.editor.tools.selection import Selection
from stippler.editor.tools.tool import RESTING, Desk, Overlay, Point, Sight, Tool, ToolState
from stippler.errors import StipplerError
from stippler.settings import read_document, write_document

if TYPE_CHECKING:
    from stippler.brushes.kinds import Value
    from stippler.drawing.document import Document
    from stippler.drawing.preview import Preview
    from stippler.drawing.reference import Reference

_HEADING_PX = 6.0  # shorter ways are shaking
_VALUES_FILE = "tools.json"


class Toolbox:
    """Takes input for the tool at hand and brings it to the document that is edited.

    Parameters
    ----------
    path : Path
        Where the brushes are kept; values of other tools are kept beside it.
    say : callable
        Tells the person a line, with how grave it is.

    Attributes
    ----------
    cards : tuple of Card
        What there is, in the order of the strip.
    prepare : dict of callables by name
        Given a tool when it is made.
    tool : Tool or None
        The one at hand; without one the pointer only looks around.
    shelf : BrushShelf
    selection : Selection
    lines : ChosenLines
    areas : AreaChoice
    state : ToolState
    """

    def __init__(self, path: Path, say: Say, seed: int = 0) -> None:
        self._say, self._values_path = say, path.with_name(_VALUES_FILE)
        self.shelf = BrushShelf(path, say)
        self.cards = all_cards(self.shelf)
        self._cards = {card.name: card for card in self.cards}
        self._made: dict[str, Tool] = {}
        self.prepare: dict[str, Callable[[Tool], None]] = {}
        self.tool: Tool | None = None
        self.selection = Selection()
        self.lines = ChosenLines()
        self.areas = AreaChoice()
        self.state: ToolState = RESTING
        self._desk: Desk | None = None  # of the last event
        self.mods = NO_MODS
        self._n_strokes = seed
        self._from: Point | None = None  # where the pointer was when its heading was last looked at
        self._heading_rad = math.nan
        self._kept_values = self._load_values()

    # --- which tool -------------------------------------------------------------------------

    def choose(self, name: str) -> None:
        """Take a tool by its name, or the next brush of its type; an empty name puts it away.

        With the old one goes what it holds open; a stroke in progress ends as it is.
        """
        tool = self.made(name) if name else None
        if tool is not self.tool:
            self._end_stroke()
            self.state = RESTING
            if self.tool is not None:
                self.tool.put_away()
        elif isinstance(tool, BrushTool):
            self.shelf.use_next(tool.kind.name)
        self.tool = tool

    def _end_stroke(self) -> None:
        """End the stroke in progress, if there is one, as if its button had come up."""
        desk = self._desk
        if desk is None or not self.is_busy or not desk.document.in_stroke:
            return
        try:
            self.state.take(FocusLost(), desk)
        finally:
            if desk.document.in_stroke:  # not one that can end early
                desk.document.cancel()

    def made(self, name: str) -> Tool:
        """Return a tool by its name; it is made when it is first asked for."""
        if name not in self._made:
            tool = self._made[name] = self._cards[name].made()
            tool.use(self._kept_values.get(name, {}))
            if name in self.prepare:
                self.prepare[name](tool)
        return self._made[name]

    def has(self, name: str) -> bool:
        """Return whether there is a tool of a name; an empty one is none at hand."""
        return not name or name in self._cards

    @property
    def name(self) -> str:
        """Of the tool at hand; empty without one."""
        return self.tool.name if self.tool else ""

    @property
    def brush(self) -> Brush | None:
        """The brush in use; None where the tool at hand is none."""
        return self.tool.brush if isinstance(self.tool, BrushTool) else None

    def set_brush(self, brush: Brush) -> None:
        """Change the brush in use."""
        if isinstance(self.tool, BrushTool):
            self.tool.brush = brush

    def resize(self, factor: float) -> None:
        """Enlarge or reduce the tip of the tool at hand."""
        if self.tool is not None:
            self.tool.resize(factor)

    # --- what is kept -----------------------------------------------------------------------

    def save(self) -> None:
        """Keep brushes and the values of other tools, if they have changed."""
        self.shelf.save()
        values = self._own_values()
        if values != self._kept_values:
            self._kept_values = values
            try:
                write_document(self._values_path, {"version": 1, "tools": values})
            except StipplerError as error:
                self._say(str(error), WARNING)

    def save_soon(self, now_s: float) -> float | None:
        """Keep what has changed some seconds ago; return when to ask again, None is not at all."""
        return self.shelf.save_soon(now_s)

    def _own_values(self) -> dict[str, dict[str, Value]]:
        own = {tool.name: dict(tool.values) for tool in self._made.values() if tool.values}
        return self._kept_values | own

    def _load_values(self) -> dict[str, dict[str, Value]]:
        document, problem = read_document(self._values_path)
        if problem:
            self._say(problem, WARNING)
        kept = document.get("tools", {})
        kept = kept if isinstance(kept, dict) else {}
        return {k: v for k, v in kept.items() if k in self._cards and isinstance(v, dict)}

    # --- input ------------------------------------------------------------------------------

    @property
    def is_busy(self) -> bool:
        """Whether something is held, so that it gets events over panels, too."""
        return self.state is not RESTING

    @property
    def is_timed(self) -> bool:
        """Whether what is held goes on while the pointer rests."""
        return bool(getattr(self.state, "is_timed", False))

    def overlay(self, document: Document | None, at_mm: Point | None, px_per_mm: float) -> Overlay:
        """Return what lies over the page: the tool's own, and what it holds."""
        if self.tool is None:
            return self.state.overlay
        sight = Sight(
            document,
            self.selection,
            self.areas,
            at_mm,
            1.0 / px_per_mm,
            self.mods,
            is_held=self.is_busy,
            lines=self.lines,
        )
        own, held = self.tool.overlay(sight), self.state.overlay
        return Overlay(
            own.paths + held.paths,
            own.handles + held.handles,
            held.tip or own.tip,
            has_borders=held.has_borders,
        )

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
        self._note_mods(event)
        if self.tool is None:
            return False
        desk = self._desk = self.desk(document, page, px_per_mm)
        if isinstance(event, Moved):
            self._head(page(event.x_px, event.y_px), px_per_mm)
        before = self.state
        try:
            if before is RESTING:
                begun = self.tool.begin(event, desk)
                self.state = RESTING if begun is None else begun
                return begun is not None
            self.state = before.take(event, desk)
        except BaseException:
            before.cancel(desk)
            if document.in_stroke:  # that it has begun, or left open
                document.cancel()
            self.state = RESTING
            raise
        match event:
            case Pressed(button=button) | Released(button=button):
                return button == LEFT
            case KeyDown():
                return True
        return False

    def wants(self, event: KeyDown, document: Document) -> bool:
        """Return whether a key is for the tool at hand, before any command has it."""
        if self.tool is None or self.is_busy:
            return False
        return self.tool.wants(event, self.desk(document, lambda x, y: (x, y), 1.0))

    def rest(self, t_s: float) -> None:
        """Let time go on."""
        if self.is_timed:
            try:
                self.state.rest(t_s)  # type: ignore[attr-defined]
            except BaseException:
                self.state = RESTING
                raise

    def drop(self, document: Document | None) -> None:
        """Give up what is held, and the selection: another drawing is open now."""
        if document is not None and self.is_busy:
            self.state.cancel(self.desk(document, lambda x, y: (x, y), 1.0))
        self.state, self._desk = RESTING, None
        for tool in self._made.values():
            tool.forget()
        self.selection.forget()
        self.lines.choose(None)
        self.areas.forget()

    def preview(self, at_mm: Point, reference: Reference | None) -> Preview | None:
        """Return what a press would do to the dots, where that can be shown."""
        if self.tool is None or self.is_busy:
            return None
        return self.tool.preview(at_mm, self.mods, self._heading_rad, reference)

    def desk(
        self, document: Document, page: Callable[[float, float], Point], px_per_mm: float
    ) -> Desk:
        """Return what a tool works with now."""
        return Desk(
            document,
            self.selection,
            page,
            px_per_mm,
            self._next_seed,
            self._say,
            self.areas,
            self.mods,
            self._heading_rad,
            self.lines,
        )

    def _note_mods(self, event: Event) -> None:
        """Note which modifier keys are held."""
        match event:
            case KeyDown() | KeyUp():
                held, down = self.mods, isinstance(event, KeyDown)
                name = event.key.removeprefix("left_").removeprefix("right_")
                self.mods = Mods(
                    down if name == "control" else held.ctrl,
                    down if name == "shift" else held.shift,
                    down if name == "alt" else held.alt,
                )
            case Pressed() | Released():
                held = event.mods
                self.mods = Mods(held.ctrl, held.shift, held.alt or self.mods.alt)
            case FocusLost():
                self.mods = NO_MODS

    def _head(self, at: Point, px_per_mm: float) -> None:
        """Note where the pointer is going."""
        if self._from is None:
            self._from = at
        dx, dy = at[0] - self._from[0], at[1] - self._from[1]
        if math.hypot(dx, dy) * px_per_mm >= _HEADING_PX:
            self._from, self._heading_rad = at, math.atan2(dy, dx)

    def _next_seed(self) -> int:
        self._n_strokes += 1
        return self._n_strokes
