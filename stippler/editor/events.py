"""Input events as plain data: what the window saw, without a window, GL or ImGui."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

LEFT, RIGHT, MIDDLE = "left", "right", "middle"


@dataclass(frozen=True, slots=True)
class Mods:
    """Which modifier keys are held; `ctrl` is Command on a Mac."""

    ctrl: bool = False
    shift: bool = False
    alt: bool = False


NO_MODS = Mods()


@dataclass(frozen=True, slots=True)
class Moved:
    """The pointer is at (x, y); pixels of the framebuffer, origin top left."""

    x_px: float
    y_px: float
    t_s: float = 0.0
    mods: Mods = NO_MODS


@dataclass(frozen=True, slots=True)
class Pressed:
    """A mouse button went down."""

    button: str
    x_px: float
    y_px: float
    t_s: float = 0.0
    mods: Mods = NO_MODS


@dataclass(frozen=True, slots=True)
class Released:
    """A mouse button came up."""

    button: str
    x_px: float
    y_px: float
    t_s: float = 0.0
    mods: Mods = NO_MODS


@dataclass(frozen=True, slots=True)
class Scrolled:
    """The wheel turned; up and right are positive, one notch is 1."""

    dx: float
    dy: float
    x_px: float
    y_px: float
    t_s: float = 0.0
    mods: Mods = NO_MODS


@dataclass(frozen=True, slots=True)
class KeyDown:
    """A key went down (or repeats), by its name on the keyboard: "f", "space", "home"."""

    key: str
    mods: Mods = NO_MODS
    repeated: bool = False
    t_s: float = 0.0


@dataclass(frozen=True, slots=True)
class KeyUp:
    """A key came up."""

    key: str
    mods: Mods = NO_MODS
    t_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Typed:
    """Text was typed; what the keyboard's layout, dead keys and input methods make of the keys."""

    text: str


@dataclass(frozen=True, slots=True)
class FocusLost:
    """The window lost the keyboard: keys and buttons held before are to be forgotten."""


@dataclass(frozen=True, slots=True)
class FocusGained:
    """The window has the keyboard."""


@dataclass(frozen=True, slots=True)
class Gone:
    """The pointer left the window."""


@dataclass(frozen=True, slots=True)
class Dropped:
    """Files were dropped on the window."""

    paths: tuple[Path, ...]


@dataclass(frozen=True, slots=True)
class Exposed:
    """The window has to be drawn anew: uncovered, resized, or on another screen."""


@dataclass(frozen=True, slots=True)
class CloseAsked:
    """The window's close button was pressed; the window stays until it is told to close."""


Event = (
    Moved
    | Pressed
    | Released
    | Scrolled
    | KeyDown
    | KeyUp
    | Typed
    | FocusLost
    | FocusGained
    | Gone
    | Dropped
    | Exposed
    | CloseAsked
)
