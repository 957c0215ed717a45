"""Where a window is on the screen, to be put there again."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import imgui_bundle  # noqa: F401  # isort: skip - first: glfw then uses its library
import glfw

SMALLEST, LARGEST = 320, 32_000
_SEEN = 80  # screen coordinates of the title bar that a monitor has to show


@dataclass(frozen=True, slots=True)
class Place:
    """Size and upper left corner, in screen coordinates; of the window when not maximised.

    Attributes
    ----------
    at : (x, y) or None
        None leaves the corner to the window system.
    """

    size: tuple[int, int] = (1280, 800)
    at: tuple[int, int] | None = None
    maximised: bool = False

    def as_dict(self) -> dict[str, Any]:
        """Return plain values."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Place:
        """Return the place that `as_dict` has written.

        Raises
        ------
        ValueError
            If there is none.
        """
        width, height = _pair(data.get("size"))
        if not (1 <= width <= LARGEST and 1 <= height <= LARGEST):
            raise ValueError(f"{width} by {height} is no size of a window")
        at = data.get("at")
        size = (max(width, SMALLEST), max(height, SMALLEST))  # what was too small to work in grows
        return cls(size, _pair(at) if at is not None else None, bool(data["maximised"]))


def _pair(value: Any) -> tuple[int, int]:
    x, y = value
    return int(x), int(y)


def place_of(handle: Any, last: Place) -> Place:
    """Return where a window is; maximised, it keeps the place that it had before."""
    if glfw.get_window_attrib(handle, glfw.MAXIMIZED):
        return Place(last.size, last.at, maximised=True)
    width, height = glfw.get_window_size(handle)
    x, y = glfw.get_window_pos(handle)
    return Place((width, height), (x, y))


def put(handle: Any, place: Place) -> None:
    """Put a window where it was, if a monitor shows that place."""
    if place.at is not None and _is_seen(place.at, place.size[0]):
        glfw.set_window_pos(handle, *place.at)
    if place.maximised:
        glfw.maximize_window(handle)


def _is_seen(at: tuple[int, int], width: int) -> bool:
    x, y = at
    for monitor in glfw.get_monitors():
        left, top, wide, high = glfw.get_monitor_workarea(monitor)
        across = min(x + width, left + wide) - max(x, left)
        if across >= _SEEN and top <= y <= top + high - _SEEN:
            return True
    return False
