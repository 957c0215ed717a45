"""The picture's tones as a histogram, and the curve by which they become ink, over it."""

from __future__ import annotations

from typing import Any

import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from stippler.drawing.adjustment import Adjustment
from stippler.drawing.reference import Reference
from stippler.ui.widgets import Widgets

_BARS = 64
_HEIGHT = 72.0
_MOST_PIXELS = 200_000


class ToneHistogram:
    """A histogram of the picture last shown, counted once."""

    def __init__(self) -> None:
        self._counted: object = None
        self._share = np.zeros(_BARS)

    def draw(self, widgets: Widgets, reference: Reference, adjustment: Adjustment) -> None:
        """Draw bars from white to black, and the ink for each tone as a line."""
        plain = reference.picture.darkness
        if self._counted is not plain:
            self._counted, self._share = plain, _shares(plain)
        draw, theme = imgui.get_window_draw_list(), widgets.theme
        at = imgui.get_cursor_screen_pos()
        width, height = imgui.get_content_region_avail().x, _HEIGHT * widgets.scale
        bar = imgui.get_color_u32((*theme.faint, 0.45))
        for k, share in enumerate(self._share):
            x0, x1 = at.x + width * k / _BARS, at.x + width * (k + 1) / _BARS
            draw.add_rect_filled((x0, at.y + height * (1.0 - share)), (x1, at.y + height), bar)
        tone = np.linspace(0.0, 1.0, 4 * _BARS + 1, dtype=np.float32)
        ink = adjustment.apply(tone[None, :])[0]
        line = imgui.get_color_u32(imgui.Col_.text)
        points: list[Any] = [
            imgui.ImVec2(at.x + width * float(t), at.y + height * (1.0 - float(i)))
            for t, i in zip(tone, ink, strict=True)
        ]
        draw.add_polyline(points, line, 1.5 * widgets.scale, 0)
        imgui.invisible_button("##tones", (width, height))
        widgets.tip("The picture's tones, white at the left; the line is the ink for each.")


def _shares(darkness: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return how often each tone but paper occurs, the root of it, the highest bar 1."""
    step = max(int(np.sqrt(darkness.size / _MOST_PIXELS)), 1)
    some = darkness[::step, ::step]
    counts = np.histogram(some[some > 0.0], _BARS, (0.0, 1.0))[0]
    shares: NDArray[np.float64] = np.sqrt(counts / max(int(counts.max()), 1))
    return shares
