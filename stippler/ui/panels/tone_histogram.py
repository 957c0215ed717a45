"""The picture's tones as a histogram, and the curve by which they become ink, to be dragged."""

from __future__ import annotations

from typing import Any

import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from stippler.drawing.adjustment import Adjustment
from stippler.drawing.levels import Levels
from stippler.drawing.reference import Reference
from stippler.editor.tone_handles import (
    Handle,
    Place,
    ink_at,
    let_go,
    moved,
    nearest,
    place_of,
)
from stippler.ui.number_control import DRAG_PX, look_for
from stippler.ui.widgets import Widgets

_BARS = 64
_HEIGHT = 96.0
_GRIP, _KNOB = 18.0, 4.5  # the side of what takes the pointer; the radius of what is drawn
_MOST_PIXELS = 200_000
_NUMBERS = {Handle.WHITE: "White from", Handle.BLACK: "Black from", Handle.MIDDLE: "Gamma"}
_TIPS = {
    Handle.WHITE: "Drag to the lightest tone that is to get dots; lighter ones become bare paper.",
    Handle.BLACK: "Drag to the tone from which on all is black.",
    Handle.MIDDLE: "Drag up for darker middle tones, down for lighter ones.",
}
_MORE = " A double click puts it back; arrows move it, digits go to the number below."


class ToneHistogram:
    """A histogram of the picture last shown, counted once, and the curve over it.

    Every handle is another hand on one of the numbers below: arrows, digits and Enter go there.
    """

    def __init__(self) -> None:
        self._counted: object = None
        self._share = np.zeros(_BARS)
        self._held: Handle | None = None
        self._from: tuple[Place, Place] = ((0.0, 0.0), (0.0, 0.0))  # what was taken, the pointer
        self._at, self._size = imgui.ImVec2(0.0, 0.0), (1.0, 1.0)

    def draw(self, widgets: Widgets, reference: Reference, now: Adjustment) -> Adjustment:
        """Draw bars from white to black, and the ink for each tone as a line; return the line."""
        levels = reference.source.levels
        if self._counted is not levels:
            self._counted, self._share = levels, _shares(levels)
        knob = _KNOB * widgets.scale
        across = imgui.get_content_region_avail().x
        at = imgui.get_cursor_screen_pos()
        self._at = imgui.ImVec2(at.x + knob, at.y + knob)  # knobs at the ends have room
        self._size = (across - 2 * knob, _HEIGHT * widgets.scale)
        after = self._take(widgets, now, (across, self._size[1] + 2 * knob))
        self._draw_bars(widgets)
        self._draw_curve(widgets, after)
        return after

    # --- hands ------------------------------------------------------------------------------

    def _take(self, widgets: Widgets, now: Adjustment, size: tuple[float, float]) -> Adjustment:
        """Put controls on the whole and on each handle; return what a hand makes of the curve."""
        first = imgui.get_cursor_screen_pos()
        imgui.push_item_flag(imgui.ItemFlags_.no_nav, True)
        imgui.set_next_item_allow_overlap()
        imgui.invisible_button("##tones", size)
        imgui.pop_item_flag()
        widgets.note("Tones")
        over = self._place(imgui.get_io().mouse_pos)
        after = self._held_by(widgets, nearest(over, now), now, on_curve=True)
        below = imgui.get_cursor_screen_pos()
        side = _GRIP * widgets.scale
        for handle in Handle:
            x, y = self._px(place_of(handle, now))
            top = min(max(y - side / 2, first.y), first.y + size[1] - side)
            imgui.set_cursor_screen_pos((x - side / 2, top))
            imgui.invisible_button(f"##{handle.value}", (side, side))
            widgets.note(handle.value)
            after = self._held_by(widgets, handle, after, on_curve=False)
        imgui.set_cursor_screen_pos(below)
        imgui.dummy((0.0, 0.0))
        if not imgui.is_mouse_down(imgui.MouseButton_.left):
            self._held = None
        return after

    def _held_by(
        self, widgets: Widgets, handle: Handle, now: Adjustment, *, on_curve: bool
    ) -> Adjustment:
        """Let the last control move a handle: by how far the pointer has gone since the press."""
        if imgui.is_item_hovered():
            shape = imgui.MouseCursor_
            is_middle = handle is Handle.MIDDLE
            imgui.set_mouse_cursor(shape.resize_ns if is_middle else shape.resize_ew)
            if imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
                return let_go(handle, now)
        pointer = self._place(imgui.get_io().mouse_pos)
        if imgui.is_item_activated():
            start = place_of(handle, now)
            if on_curve and handle is Handle.MIDDLE:
                start = (pointer[0], ink_at(pointer[0], now))
            self._held, self._from = handle, (start, pointer)
        look_for(widgets.numbers, imgui.get_id(f"##{_NUMBERS[self._held or handle]}"))
        widgets.tip(_TIPS[handle] + _MORE)
        far = imgui.is_mouse_dragging(imgui.MouseButton_.left, DRAG_PX * widgets.scale)
        if not (imgui.is_item_active() and far) or self._held is None:
            return now
        (tone, ink), (x, y) = self._from
        return moved(self._held, (tone + pointer[0] - x, ink + pointer[1] - y), now)

    def _place(self, at: imgui.ImVec2Like) -> Place:
        """Return the tone and ink at a point of the screen."""
        x, y = at[0], at[1]
        return (x - self._at.x) / self._size[0], 1.0 - (y - self._at.y) / self._size[1]

    def _px(self, place: Place) -> tuple[float, float]:
        """Return where on the screen a tone and its ink are."""
        return (
            self._at.x + self._size[0] * place[0],
            self._at.y + self._size[1] * (1.0 - place[1]),
        )

    # --- looks ------------------------------------------------------------------------------

    def _draw_bars(self, widgets: Widgets) -> None:
        draw = imgui.get_window_draw_list()
        bar = imgui.get_color_u32((*widgets.theme.faint, 0.45))
        for k, share in enumerate(self._share):
            high = self._px((k / _BARS, float(share)))
            draw.add_rect_filled(high, self._px(((k + 1) / _BARS, 0.0)), bar)

    def _draw_curve(self, widgets: Widgets, now: Adjustment) -> None:
        """Draw the line, and a knob for each handle; the one in use in the accent's colour."""
        draw, theme = imgui.get_window_draw_list(), widgets.theme
        tone = np.linspace(0.0, 1.0, 4 * _BARS + 1, dtype=np.float32)
        ink = now.apply(tone[None, :])[0]
        points: list[Any] = [
            imgui.ImVec2(*self._px((float(t), float(i)))) for t, i in zip(tone, ink, strict=True)
        ]
        line = imgui.get_color_u32(imgui.Col_.text)
        draw.add_polyline(points, line, 1.5 * widgets.scale, 0)
        accent = imgui.get_color_u32((*theme.accent, 1.0))
        knob, numbers = _KNOB * widgets.scale, widgets.numbers
        for handle in Handle:
            at = self._px(place_of(handle, now))
            control = imgui.get_id(f"##{_NUMBERS[handle]}")
            in_use = control in (numbers.hovered, numbers.focused, numbers.used)
            fill = imgui.get_color_u32((*theme.panel, 1.0))
            draw.add_circle_filled(at, knob, accent if in_use else fill)
            draw.add_circle(at, knob, accent if in_use else line, 0, 1.5 * widgets.scale)


def _shares(levels: Levels) -> NDArray[np.float64]:
    """Return how often each tone but paper occurs, the root of it, the highest bar 1."""
    every = slice(None, None, max(int(np.sqrt(levels.size / _MOST_PIXELS)), 1))
    some = levels.darkness(every, every)
    counts = np.histogram(some[some > 0.0], _BARS, (0.0, 1.0))[0]
    shares: NDArray[np.float64] = np.sqrt(counts / max(int(counts.max()), 1))
    return shares
