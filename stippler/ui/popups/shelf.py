"""Files to choose from by their small pictures: recent ones, and earlier versions of a drawing."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import moderngl
import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from stippler.names import shown
from stippler.ui.widgets import Widgets

_COLUMNS, _PICTURE = 4, 132.0
_ROWS_SHOWN = 2.5


@dataclass(frozen=True, slots=True)
class Item:
    """A file on offer.

    Attributes
    ----------
    name, detail : str
        Under its picture, and when the pointer rests on it.
    choose : callable
        Opens it.
    """

    path: Path
    name: str
    detail: str
    choose: Callable[[], None]


class _Picture:
    """A small picture, made by a thread when it is first wanted."""

    def __init__(self) -> None:
        self.pixels: NDArray[np.uint8] | None = None
        self.texture: moderngl.Texture | None = None


class Shelf:
    """A window of small pictures; a click opens one.

    Parameters
    ----------
    title : str
    items : callable
        Returns what there is when the window is opened.
    nothing : callable
        Called in place of that where there is nothing.
    """

    def __init__(
        self,
        title: str,
        items: Callable[[], list[Item]],
        nothing: Callable[[], None],
        ctx: moderngl.Context,
        wake: Callable[[], None],
    ) -> None:
        self._title, self._find, self._nothing = title, items, nothing
        self._ctx, self._wake = ctx, wake
        self._items: list[Item] = []
        self._pictures: dict[Path, _Picture] = {}
        self._wanted = False
        self.is_open = False

    @property
    def is_ready(self) -> bool:
        """Whether all pictures that there are have been made."""
        return not any(thread.name == "small pictures" for thread in threading.enumerate())

    def ask(self) -> None:
        """Open the window."""
        self._items = self._find()
        self._wanted = bool(self._items)
        if not self._items:
            self._nothing()
            return
        self._let_go()
        self._pictures = {item.path: _Picture() for item in self._items}
        pictures = dict(self._pictures)
        threading.Thread(
            target=self._look, args=(pictures,), name="small pictures", daemon=True
        ).start()

    def _look(self, pictures: dict[Path, _Picture]) -> None:
        for path, picture in pictures.items():
            picture.pixels = small_picture(path, int(2 * _PICTURE))
            self._wake()

    def draw(self, widgets: Widgets) -> None:
        """Draw the window, if it is open."""
        if self._wanted:
            imgui.open_popup(self._title)
            self._wanted = False
        side, gap = _PICTURE * widgets.scale, widgets.gap
        viewport = imgui.get_main_viewport()
        room = viewport.work_size.x - 60 * widgets.scale
        columns = int(min(max(room // (side + gap), 1), _COLUMNS, max(len(self._items), 2)))
        imgui.set_next_window_pos(viewport.get_center(), imgui.Cond_.appearing, (0.5, 0.5))
        imgui.set_next_window_size((columns * (side + gap) + 40.0 * widgets.scale, 0.0))
        was_open = self.is_open
        self.is_open = imgui.begin_popup_modal(self._title, None, imgui.WindowFlags_.no_resize)[0]
        if not self.is_open:
            if was_open:
                self._let_go()
            return
        chosen = self._draw_items(widgets, columns, side)
        if widgets.button("Close", "Leaves everything as it is (Esc).") or widgets.escaped():
            imgui.close_current_popup()
        if chosen is not None:
            imgui.close_current_popup()
        imgui.end_popup()
        if chosen is not None:
            chosen.choose()

    def _draw_items(self, widgets: Widgets, columns: int, side: float) -> Item | None:
        chosen = None
        line = imgui.get_text_line_height_with_spacing()
        rows = (len(self._items) + columns - 1) // columns
        height = min(rows, _ROWS_SHOWN) * (side + line + 2 * widgets.gap)
        imgui.begin_child("##shelf", (0.0, height))
        for k, item in enumerate(self._items):
            if k % columns:
                imgui.same_line(0.0, widgets.gap)
            imgui.begin_group()
            at = imgui.get_cursor_screen_pos()
            if imgui.invisible_button(f"##{k}", (side, side + line)):
                chosen = item
            widgets.note(f"shelf {k}")
            hovered = imgui.is_item_hovered() or imgui.is_item_focused()
            widgets.tip(item.detail)
            self._draw_item(widgets, item, (at.x, at.y), side, hovered=hovered)
            imgui.end_group()
        imgui.end_child()
        return chosen

    def _draw_item(
        self, widgets: Widgets, item: Item, at: tuple[float, float], side: float, *, hovered: bool
    ) -> None:
        lines, theme = imgui.get_window_draw_list(), widgets.theme
        frame = widgets.packed(theme.accent if hovered else theme.line)
        low, high = at, (at[0] + side, at[1] + side)
        texture = self._texture(item.path)
        if texture is not None:
            fit = (side - 4.0) / max(texture.size)
            w, h = texture.width * fit, texture.height * fit
            x, y = at[0] + (side - w) / 2, at[1] + (side - h) / 2
            lines.add_image(imgui.ImTextureRef(texture.glo), (x, y), (x + w, y + h))
        lines.add_rect(low, high, frame, 3.0 * widgets.scale)
        name = _fitted(item.name, side)
        lines.add_text((at[0], high[1] + 2.0 * widgets.scale), widgets.packed(theme.text), name)

    def _texture(self, path: Path) -> moderngl.Texture | None:
        picture = self._pictures.get(path)
        if picture is None:
            return None
        if picture.texture is None and picture.pixels is not None:
            height, width = picture.pixels.shape
            data = picture.pixels.repeat(3).tobytes()
            picture.texture = self._ctx.texture((width, height), 3, data, alignment=1)
        return picture.texture

    def _let_go(self) -> None:
        for picture in self._pictures.values():
            if picture.texture is not None:
                picture.texture.release()
        self._pictures = {}

    def close(self) -> None:
        """Free every GL object."""
        self._let_go()


def small_picture(path: Path, side_px: int) -> NDArray[np.uint8] | None:
    """Return a drawing's or a picture's small picture in grey; None where there is none."""
    from stippler.files.native.signature import is_container
    from stippler.files.native.thumbnail import read_thumbnail
    from stippler.files.read.picture import small_grey

    return read_thumbnail(path) if is_container(path) else small_grey(path, side_px)


def when(at_s: float) -> str:
    """Return a time as people write it."""
    day = time.strftime("%d %b", time.localtime(at_s))
    today = time.strftime("%d %b", time.localtime())
    return time.strftime("%H:%M" if day == today else "%d %b %H:%M", time.localtime(at_s))


def _fitted(text: str, room: float) -> str:
    text = shown(text)
    while len(text) > 4 and imgui.calc_text_size(text).x > room:
        text = f"{text[: len(text) - 3]}…" if text.endswith("…") else f"{text[:-2]}…"
    return text
