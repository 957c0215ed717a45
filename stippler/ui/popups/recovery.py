"""What crashes have left: offered at the start, with a small picture of each drawing."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import moderngl
from imgui_bundle import imgui

from stippler.editor.session import Session
from stippler.errors import StipplerError
from stippler.names import shown
from stippler.ui.popups.file_dialogs import center
from stippler.ui.widgets import Widgets

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from stippler.files.native.recovery import Lost

_TITLE = "Drawings that were not closed"
_WIDTH, _PICTURE = 520.0, 96.0


class _Entry:
    """One drawing, and its picture once a thread has made it."""

    def __init__(self, lost: Lost, wake: Callable[[], None]) -> None:
        self.lost = lost
        self.text = "looking at it …"
        self.picture: NDArray[np.uint8] | None = None
        self.texture: moderngl.Texture | None = None
        self._wake = wake
        threading.Thread(target=self._look, name="recovery preview", daemon=True).start()

    def _look(self) -> None:
        from stippler.files.native.thumbnail import thumbnail
        from stippler.jobs.reading import recovered

        try:
            document = recovered(self.lost)
            self.picture = thumbnail(document.drawing, int(2 * _PICTURE))
            steps = document.history.n_done
            self.text = f"{len(document.dots):,} dots, {steps} step{'s' * (steps != 1)} not saved"
        except StipplerError as error:
            self.text = str(error)
        self._wake()


class RecoveryWindow:
    """Asks what is to become of drawings that a crash has left.

    Parameters
    ----------
    root : Path or None
        Where they are kept; None offers nothing.
    open : callable
        Guards what is open now, then opens another drawing.
    """

    def __init__(
        self,
        root: Path | None,
        session: Session,
        ctx: moderngl.Context,
        wake: Callable[[], None],
        guard: Callable[[str, Callable[[], None]], None],
    ) -> None:
        self._root, self._session, self._ctx = root, session, ctx
        self._wake, self._guard = wake, guard
        self._entries: list[_Entry] = []
        self._wanted = False
        self.is_open = False

    def renew(self, ctx: moderngl.Context) -> None:
        """Make pictures again in another context; those of the one before are gone with it."""
        self._ctx = ctx
        for entry in self._entries:
            entry.texture = None

    def ask(self, *, quietly: bool = False) -> None:
        """Offer what there is; without anything say so, unless that is not to be said."""
        if self._root is None:
            return
        from stippler.files.native.recovery import lost_drawings

        self._let_go()
        self._entries = [_Entry(lost, self._wake) for lost in lost_drawings(self._root)]
        self._wanted = bool(self._entries)
        if not self._entries and not quietly:
            self._session.messages.say("no drawing was lost")

    def draw(self, widgets: Widgets) -> None:
        """Draw the window, if it is open."""
        if self._wanted:
            imgui.open_popup(_TITLE)
            self._wanted = False
        center(_WIDTH * widgets.scale)
        self.is_open = imgui.begin_popup_modal(_TITLE, None, imgui.WindowFlags_.no_resize)[0]
        if not self.is_open:
            return
        widgets.caption("The program ended before they were closed. Nothing you did is lost.")
        for k, entry in enumerate(list(self._entries)):
            self._draw_entry(widgets, k, entry)
        later = widgets.button("Later", "Keeps them; File offers them again (Esc).")
        if later or widgets.escaped() or not self._entries:
            imgui.close_current_popup()
            self._let_go()
        imgui.end_popup()

    def _draw_entry(self, widgets: Widgets, k: int, entry: _Entry) -> None:
        side, left = _PICTURE * widgets.scale, imgui.get_cursor_pos_x()
        top = imgui.get_cursor_pos_y()
        texture = self._texture(entry)
        if texture is not None:
            fit = side / max(texture.size)
            size = (texture.width * fit, texture.height * fit)
            imgui.image(imgui.ImTextureRef(texture.glo), size)
        imgui.set_cursor_pos((left + side + widgets.gap * 2, top))
        imgui.begin_group()
        imgui.text_unformatted(shown(entry.lost.name))
        when = time.strftime("%d %b %H:%M", time.localtime(entry.lost.left_s))
        widgets.caption(f"{entry.text}; last change {when}")
        recover = widgets.button(
            "Recover", "Opens it as it was.", name=f"recover {k}", width=104.0 * widgets.scale,
            primary=True,
        )  # fmt: skip
        imgui.same_line(0.0, widgets.gap)
        discard = widgets.button(
            "Discard", "Removes it for good.", name=f"discard {k}", width=104.0 * widgets.scale
        )
        imgui.end_group()
        imgui.set_cursor_pos_y(max(imgui.get_cursor_pos_y(), top + side + widgets.gap))
        if discard:
            entry.lost.discard()
            self._entries.remove(entry)
        if recover:
            imgui.close_current_popup()
            lost = entry.lost
            self._let_go()
            self._guard(f"Recovering {shown(lost.name)}", lambda: self._session.recover(lost))

    def _texture(self, entry: _Entry) -> moderngl.Texture | None:
        if entry.texture is None and entry.picture is not None:
            height, width = entry.picture.shape
            pixels = entry.picture.repeat(3).tobytes()
            entry.texture = self._ctx.texture((width, height), 3, pixels, alignment=1)
        return entry.texture

    def _let_go(self) -> None:
        for entry in self._entries:
            if entry.texture is not None:
                entry.texture.release()
        self._entries = []

    def close(self) -> None:
        """Free every GL object."""
        self._let_go()
