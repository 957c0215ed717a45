"""What a tool is: it begins states from events, and says what lies over the page.

A state takes an event and a `Desk` and returns the state that comes next. Changes of the drawing
are made within a stroke of its document, so every state can be cancelled without trace.
`docs/editor.md` tells how to add a tool.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Protocol

from stippler.brushes.kinds import Value
from stippler.drawing.parameter import Parameter
from stippler.editor.events import NO_MODS, Event, KeyDown, Mods, Moved, Pressed, Released, Scrolled
from stippler.editor.tools.line_choice import ChosenLines

if TYPE_CHECKING:
    from stippler.brushes.brush import Brush
    from stippler.drawing.document import Document
    from stippler.drawing.preview import Preview
    from stippler.drawing.reference import Reference
    from stippler.editor.area_choice import AreaChoice
    from stippler.editor.tools.selection import Selection

Point = tuple[float, float]
Grip = Literal["node", "control", "scale", "turn"]


@dataclass(slots=True)
class Desk:
    """What a tool works with; made anew for each event.

    Attributes
    ----------
    document : Document
        The only way to change the drawing: `begin`, change, `commit` or `cancel`.
    selection : Selection
        The chosen dots.
    page : callable
        From pixels of the canvas to mm on the page.
    px_per_mm : float
        Scale of the view.
    mods : Mods
        The modifier keys that are held.
    heading_rad : float
        Direction in which the pointer came; NaN if it is not known.
    next_seed : callable
        Another seed for each stroke.
    say : callable
        Tells the person a line, with how grave it is (`editor.messages`).
    lines : ChosenLines
        The chosen lines.
    """

    document: Document
    selection: Selection
    page: Callable[[float, float], Point]
    px_per_mm: float
    next_seed: Callable[[], int]
    say: Callable[[str, str], None]
    areas: AreaChoice
    mods: Mods = NO_MODS
    heading_rad: float = float("nan")
    lines: ChosenLines = field(default_factory=ChosenLines)

    def at(self, event: Moved | Pressed | Released | Scrolled) -> Point:
        """Return where on the page an event was."""
        return self.page(event.x_px, event.y_px)

    def mm(self, px: float) -> float:
        """Return how long so many pixels are on the page."""
        return px / self.px_per_mm


@dataclass(frozen=True, slots=True)
class Sight:
    """What there is to be seen while nothing happens.

    Attributes
    ----------
    document : Document or None
    at_mm : (x, y) or None
        The pointer on the page; None while it is elsewhere.
    mm : float
        How long a pixel is on the page.
    mods : Mods
        The modifier keys that are held.
    is_held : bool
        Whether the tool's state holds something; its overlay is shown besides.
    """

    document: Document | None
    selection: Selection
    areas: AreaChoice
    at_mm: Point | None
    mm: float
    mods: Mods = NO_MODS
    is_held: bool = False
    lines: ChosenLines = field(default_factory=ChosenLines)


@dataclass(frozen=True, slots=True)
class Path:
    """A line to be drawn over the page, light and dark, so that it shows on ink and on paper.

    Attributes
    ----------
    refused : bool
        What it stands for cannot be done; it is red.
    """

    points_mm: Sequence[Sequence[float]]
    closed: bool = False
    dashed: bool = False
    refused: bool = False


@dataclass(frozen=True, slots=True)
class Handle:
    """A grip of a size in pixels, whatever the zoom."""

    at_mm: Point
    grip: Grip = "node"
    chosen: bool = False


@dataclass(frozen=True, slots=True)
class Tip:
    """The outline of a brush, about the pointer."""

    brush: Brush
    at_mm: Point


@dataclass(frozen=True, slots=True)
class Overlay:
    """What lies over the page and is no part of it.

    Attributes
    ----------
    has_borders : bool
        Its paths show all borders of areas; those of the drawing are not drawn besides.
    """

    paths: tuple[Path, ...] = ()
    handles: tuple[Handle, ...] = ()
    tip: Tip | None = None
    has_borders: bool = False


NOTHING = Overlay()


class ToolState(Protocol):
    """One way of taking input: something is held."""

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Take an event; return the state that comes next, `RESTING` if nothing is held then."""
        ...

    def cancel(self, desk: Desk) -> None:
        """Take back what this state has begun."""
        ...

    @property
    def overlay(self) -> Overlay:
        """What lies over the page meanwhile, besides the tool's own."""
        ...


class Resting:
    """Nothing is held: the tool at hand begins the next state."""

    overlay = NOTHING

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Stay."""
        return self

    def cancel(self, desk: Desk) -> None:
        """Nothing has begun."""


RESTING = Resting()


class Tool:
    """One tool; a subclass in a file of its own overrides what it needs.

    Attributes
    ----------
    name : str
        Unique; "select". Its command is "tool.select", and its icon is found by it.
    label, tip : str
        As the strip, menus and its panel show it, and what it does.
    key : str
        One letter, at first.
    parameters : tuple of Parameter
        Its panel, the palette and what is kept for the next start are made of them.
    commands : tuple of str
        Names of commands that its panel offers as buttons.
    groups : tuple of (str, tuple of str)
        More of them, each under a heading of its own.
    shows_areas : bool
        Whether borders of areas are to be seen while it is at hand.
    """

    name = ""
    label = ""
    key = ""
    tip = ""
    commands: tuple[str, ...] = ()
    groups: tuple[tuple[str, tuple[str, ...]], ...] = ()
    shows_areas = False

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return ()

    @property
    def chosen_text(self) -> str:
        """Say how much is chosen, above its commands; empty: chosen dots are counted."""
        return ""

    def __init__(self) -> None:
        self.values: dict[str, Value] = {}

    def value(self, name: str) -> Any:
        """Return a parameter's value."""
        default = next(p.default for p in self.parameters if p.name == name)
        return self.values.get(name, default)

    def set(self, name: str, value: Value) -> None:
        """Set a parameter."""
        self.values = {**self.values, name: value}

    def use(self, values: Mapping[str, Value]) -> None:
        """Take values that were kept; those that do not fit are as at first."""
        for parameter in self.parameters:
            if (value := values.get(parameter.name)) is not None and parameter.allows(value):
                self.set(parameter.name, value)

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Take an event while nothing is held; return what it begins, None if it is not for it.

        `RESTING` says that the event was taken and nothing is held.
        """
        return None

    def overlay(self, sight: Sight) -> Overlay:
        """Return what lies over the page."""
        return NOTHING

    def wants(self, event: KeyDown, desk: Desk) -> bool:
        """Return whether a key is for this tool now, before any command has it."""
        return False

    def preview(
        self, at_mm: Point, mods: Mods, heading_rad: float, reference: Reference | None
    ) -> Preview | None:
        """Return what a press would do to the dots, where that can be shown."""
        return None

    def resize(self, factor: float) -> bool:
        """Enlarge or reduce its tip; return whether it has one."""
        return False

    def put_away(self) -> None:
        """Another tool is at hand."""

    def forget(self) -> None:
        """Another drawing is open."""
