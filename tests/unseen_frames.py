"""Frames that nobody looks at: software GL takes three quarters of a window's time to fill them in.

All is handed to GL as ever; its last step is left out, until the pixels are asked for. The page,
which is drawn apart, is whole in every frame.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from stippler.ui.window.gui import Gui
from stippler.ui.window.window import Window

_RASTERIZER_DISCARD = 0x8C89


def filled_when_seen() -> tuple[Callable[[Gui], None], Callable[[Window], Any]]:
    """Return what to take for `Gui.draw` and for `Window.pixels`."""
    draw, pixels = Gui.draw, Window.pixels
    unseen: dict[Window, Gui] = {}

    def draw_unseen(gui: Gui) -> None:
        context = gui._window.ctx
        context.enable_direct(_RASTERIZER_DISCARD)
        try:
            draw(gui)
        finally:
            context.disable_direct(_RASTERIZER_DISCARD)
        unseen[gui._window] = gui

    def look(window: Window) -> Any:
        if (gui := unseen.pop(window, None)) is not None:
            window.ctx.screen.use()
            draw(gui)
        return pixels(window)

    return draw_unseen, look
