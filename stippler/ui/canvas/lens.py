"""The lens that follows the pointer: when it is there, where it lies, what it shows."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from stippler.camera import Camera, Point
from stippler.editor.events import Event, FocusLost, KeyDown, KeyUp
from stippler.editor.view import View
from stippler.ui.look import STRENGTHS, Look

MARGIN = 16.0  # the theme's pixels around the lens, for rim and shadow
_TAP_S = 0.3  # a key that is held longer, once the lens is seen, shows it only for so long
_SIDES = ((1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))  # of a brush; upper right first


@dataclass(frozen=True, slots=True)
class Glass:
    """A lens in its place.

    Attributes
    ----------
    camera : Camera
        What it shows, on a screen of its diameter.
    corner_px : (x, y)
        Of the square around it, on the canvas; whole, so that its pixels are the canvas's.
    """

    camera: Camera
    diameter_px: int
    corner_px: tuple[int, int]


def place_lens(
    view: View, at_px: Point, factor: float, diameter_px: float, reach_px: float | None
) -> Glass:
    """Lay a lens over the pointer, or beside it where a brush of a radius has to be seen."""
    room = view.size_px
    d = max(2 * round(min(diameter_px, *room) / 2), 2)
    x, y = at_px[0] - d / 2, at_px[1] - d / 2
    if reach_px is not None:
        away = (reach_px + d / 2 + MARGIN) * math.sqrt(0.5)
        places = [(x + away * i, y + away * j) for i, j in _SIDES]
        x, y = min(places, key=lambda place: _outside(place, d, room))
        x, y = (min(max(v, 0.0), room[k] - d) for k, v in enumerate((x, y)))
    camera = _steady(view.camera.zoomed(factor, at_px, room), view.at(*at_px), d)
    return Glass(camera, d, (round(x), round(y)))


def _steady(camera: Camera, center_mm: Point, d: int) -> Camera:
    """Centre a camera on a point, to the nearest whole pixel from the page's corner.

    Small dots then do not flicker as the lens moves, and where it moves by less than one of its
    pixels, nothing is to be drawn.
    """
    at_corner = replace(camera, center_mm=(0.0, 0.0))
    x, y = at_corner.page_to_screen(center_mm, (d, d))
    near_x, near_y = at_corner.screen_to_page((round(float(x)), round(float(y))), (d, d))
    return replace(camera, center_mm=(float(near_x), float(near_y)))


def _outside(corner: Point, d: int, room: tuple[int, int]) -> float:
    """Return how far a square reaches beyond the canvas."""
    return sum(max(-corner[k], 0.0) + max(corner[k] + d - room[k], 0.0) for k in (0, 1))


class LensKey:
    """Shows a lens while its key is held; a tap leaves it there until the next."""

    def __init__(self, look: Look) -> None:
        self._look = look
        self._down: KeyDown | None = None  # the event that is being taken
        self._held, self._since_s = "", math.inf
        self._before = look.lens

    @property
    def is_held(self) -> bool:
        """Whether the key of a lens is down."""
        return bool(self._held)

    def switch(self, lens: str) -> None:
        """Show a lens, or take it away if it is there."""
        self._before, self._held = self._look.lens, ""
        self._look.lens = "none" if self._before == lens else lens
        if self._down is not None and self._look.lens == lens:
            self._held, self._since_s = self._down.key, math.inf

    def take(self, event: Event) -> None:
        """Look at an event before the commands have it."""
        self._down = event if isinstance(event, KeyDown) and not event.repeated else None
        match event:
            case KeyUp(key=key) if key == self._held:
                self._held = ""
                if event.t_s - self._since_s > _TAP_S:
                    self._look.lens = self._before
            case FocusLost() if self._held:
                self._look.lens, self._held = self._before, ""

    def let_pass(self) -> None:
        """Take note that the event has been taken: what is switched from now on, no key holds."""
        self._down = None

    def note_frame(self, now_s: float) -> None:
        """Take note that a frame was drawn: a tap is as short as that, however long it took."""
        self._since_s = min(self._since_s, now_s)

    def strengthen(self, notches: float) -> None:
        """Take the next strength, as the wheel is turned while the key is held."""
        name = "reduction" if self._look.lens == "reduce" else "magnification"
        at = STRENGTHS.index(getattr(self._look, name)) + (notches > 0) - (notches < 0)
        setattr(self._look, name, STRENGTHS[min(max(at, 0), len(STRENGTHS) - 1)])
