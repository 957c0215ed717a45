"""The sheet in the export dialog: as it will be printed, near or far, or as pens draw it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import moderngl
from imgui_bundle import imgui

from stippler.jobs.export_look import Look, Sight
from stippler.ui.theme import ICON_PAUSE, ICON_PLAY
from stippler.ui.widgets import Widgets

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from stippler.files.write.proof import Window

PENS = ((26, 26, 32), (196, 62, 40), (34, 92, 170), (30, 128, 74), (150, 84, 160), (190, 130, 20))
"""Colours that pens have, one after another."""

_PAPER, _TRAVEL = (255, 255, 255), (236, 120, 96)
_TO_COME = 0.16  # of its colour, that ink has before it is drawn
_PLAYED_S = 20.0  # all of a drawing, however long it takes
_WHEEL, _MOST_PX_PER_MM = 1.25, 800.0
_EDGE = 0x60000000


@dataclass(slots=True)
class Playing:
    """How far the pens are shown.

    Attributes
    ----------
    at_s : float
        Of the plotter's time.
    """

    shown: bool = False
    runs: bool = False
    travel: bool = True
    at_s: float = 0.0


class ExportPreview:
    """Keeps where the person looks, and the texture of it.

    Attributes
    ----------
    playing : Playing
        The pens.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._texture: moderngl.Texture | None = None
        self._shown: object = None
        self._window: Window | None = None
        self._px_per_mm: float | None = None
        self._middle: tuple[float, float] | None = None
        self.playing = Playing()

    def fit(self) -> None:
        """Show the whole sheet."""
        self._px_per_mm = self._middle = None

    def show_at(self, px_per_mm: float) -> None:
        """Show so many pixels a mm, about what is in the middle."""
        self._px_per_mm = px_per_mm

    @property
    def is_fitted(self) -> bool:
        """Whether the whole sheet is shown."""
        return self._px_per_mm is None

    def sight(self, size: tuple[float, float], ratio: float) -> Sight:
        """Return what is to be looked at, in a box of ImGui's size."""
        columns, rows = max(round(size[0] * ratio), 1), max(round(size[1] * ratio), 1)
        return Sight(columns, rows, self._px_per_mm, self._middle)

    def draw(self, widgets: Widgets, look: Look, size: tuple[float, float], ratio: float) -> None:
        """Draw the box, and take what the pointer does in it."""
        low = imgui.get_cursor_screen_pos()
        high = (low.x + size[0], low.y + size[1])
        imgui.invisible_button("##proof", size)
        widgets.note("proof")
        draw = imgui.get_window_draw_list()
        draw.push_clip_rect((low.x, low.y), high, True)
        draw.add_rect_filled((low.x, low.y), high, widgets.packed(widgets.theme.desk))
        if look.sheet is not None:
            sheet = look.sheet.width_mm, look.sheet.height_mm
            self._take_pointer(sheet, size, ratio)
            sight = self.sight(size, ratio)
            scale, corner = sight.scale(*sheet) / ratio, sight.corner(*sheet)

            def placed(x: float, y: float) -> tuple[float, float]:
                return low.x + (x - corner[0]) * scale, low.y + (y - corner[1]) * scale

            draw.add_rect_filled(placed(0.0, 0.0), placed(*sheet), 0xFFFFFFFF)
            self._upload(look)
            if self._texture is not None and self._window is not None:
                w = self._window
                ends = placed(w.left, w.top), placed(w.left + w.width_mm, w.top + w.height_mm)
                draw.add_image(imgui.ImTextureRef(self._texture.glo), *ends)
            self._draw_pen(draw, look, placed, widgets.scale)
            draw.add_rect(placed(0.0, 0.0), placed(*sheet), _EDGE)
        draw.pop_clip_rect()

    # --- pointer ------------------------------------------------------------------------------

    def _take_pointer(
        self, sheet: tuple[float, float], size: tuple[float, float], ratio: float
    ) -> None:
        io = imgui.get_io()
        if imgui.is_item_active() and (io.mouse_delta.x or io.mouse_delta.y):
            self._hold(sheet, size, ratio)
            assert self._px_per_mm is not None
            assert self._middle is not None
            scale = self._px_per_mm / ratio
            x, y = self._middle
            self._middle = x - io.mouse_delta.x / scale, y - io.mouse_delta.y / scale
            self._stay(sheet)
        # while the path has the keyboard, too
        blocked = (
            imgui.HoveredFlags_.allow_when_blocked_by_active_item
            | imgui.HoveredFlags_.no_nav_override
        )
        if imgui.is_item_hovered(blocked) and io.mouse_wheel:
            self._hold(sheet, size, ratio)
            low = imgui.get_item_rect_min()
            at = io.mouse_pos.x - low.x, io.mouse_pos.y - low.y
            self._zoom(_WHEEL**io.mouse_wheel, at, sheet, size, ratio)

    def _hold(self, sheet: tuple[float, float], size: tuple[float, float], ratio: float) -> None:
        """Make what is seen of a fitted sheet a place of its own."""
        sight = self.sight(size, ratio)
        self._px_per_mm = sight.scale(*sheet)
        self._middle = self._middle or (sheet[0] / 2, sheet[1] / 2)

    def _zoom(
        self,
        factor: float,
        at: tuple[float, float],
        sheet: tuple[float, float],
        size: tuple[float, float],
        ratio: float,
    ) -> None:
        assert self._px_per_mm is not None
        assert self._middle is not None
        least = Sight(round(size[0] * ratio), round(size[1] * ratio)).scale(*sheet)
        target = min(self._px_per_mm * factor, _MOST_PX_PER_MM)
        if target <= least:
            self.fit()
            return
        # what is under the pointer stays there
        dx, dy = at[0] - size[0] / 2, at[1] - size[1] / 2
        before, after = ratio / self._px_per_mm, ratio / target
        x, y = self._middle
        self._middle = x + dx * (before - after), y + dy * (before - after)
        self._px_per_mm = target
        self._stay(sheet)

    def _stay(self, sheet: tuple[float, float]) -> None:
        assert self._middle is not None
        x, y = self._middle
        self._middle = min(max(x, 0.0), sheet[0]), min(max(y, 0.0), sheet[1])

    # --- the picture --------------------------------------------------------------------------

    def _upload(self, look: Look) -> None:
        """Bring the picture to the GPU, if it is another."""
        pens = self.playing.shown and look.moments is not None
        shown = (look.proof_key, self.playing.at_s, self.playing.travel) if pens else look.proof_key
        if shown == self._shown or look.picture is None:
            return
        pixels = composed(look, self.playing) if pens else look.picture.repeat(3)
        height, width = look.picture.shape
        if self._texture is None or self._texture.size != (width, height):
            self.close()
            self._texture = self._ctx.texture((width, height), 3, alignment=1)
            self._texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._texture.write(pixels.tobytes(), alignment=1)
        self._shown, self._window = shown, look.window

    def _draw_pen(self, draw: imgui.ImDrawList, look: Look, placed: object, scale: float) -> None:
        """Mark where the pen is."""
        course = look.course
        if not (self.playing.shown and course is not None and len(course.points_mm)):
            return
        if self.playing.at_s >= course.total_s:
            return
        k = course.at(self.playing.at_s)
        x, y = course.points_mm[k]
        at = placed(float(x), float(y))  # type: ignore[operator]
        r, g, b = PENS[int(course.pen[k]) % len(PENS)]
        draw.add_circle_filled(at, 4.0 * scale, 0xFFFFFFFF)
        draw.add_circle(at, 4.0 * scale, 0xFF000000 | b << 16 | g << 8 | r, 0, 2.0 * scale)

    def close(self) -> None:
        """Free the texture."""
        if self._texture is not None:
            self._texture.release()
        self._texture, self._shown, self._window = None, None, None


def composed(look: Look, playing: Playing) -> NDArray[np.uint8]:
    """Return (rows, columns, 3) of a moment: what is drawn, what travelled over, what to come."""
    import numpy as np

    moments = look.moments
    assert moments is not None
    colours = np.array([PENS[k % len(PENS)] for k in range(256)], np.uint8)[moments.pen]
    faint = (255 - (255 - colours.astype(np.float32)) * _TO_COME).astype(np.uint8)
    out = np.full((*moments.pen.shape, 3), _PAPER, np.uint8)
    drawn = moments.drawn_s <= playing.at_s
    later = np.isfinite(moments.drawn_s) & ~drawn
    out[later] = faint[later]
    if playing.travel:
        out[(moments.travelled_s <= playing.at_s) & ~drawn] = _TRAVEL
    out[drawn] = colours[drawn]
    return out


def draw_playing(widgets: Widgets, playing: Playing, look: Look, width: float, dt_s: float) -> None:
    """Draw what plays and scrubs the pens' course."""
    total = look.course.total_s if look.course is not None else 0.0
    if playing.runs and total > 0:
        playing.at_s = min(playing.at_s + dt_s * total / _PLAYED_S, total)
        playing.runs = playing.at_s < total
    icon = ICON_PAUSE if playing.runs else ICON_PLAY
    if widgets.icon_button("play", icon, "Plays the order in which pens draw."):
        playing.runs = not playing.runs
        if playing.runs and playing.at_s >= total:
            playing.at_s = 0.0
    imgui.same_line(0.0, widgets.gap)
    imgui.set_next_item_width(width - 3 * imgui.get_frame_height() - 190.0 * widgets.scale)
    moved, share = imgui.slider_float(
        "##moment", playing.at_s / total if total else 0.0, 0.0, 1.0, "",
        imgui.SliderFlags_.always_clamp,
    )  # fmt: skip
    widgets.note("moment")
    if moved:
        playing.at_s, playing.runs = share * total, False
    imgui.same_line(0.0, widgets.gap)
    imgui.align_text_to_frame_padding()
    told = f"{clock_text(playing.at_s)} of {clock_text(total)}"
    imgui.text_colored((*widgets.theme.faint, 1.0), told)
    imgui.same_line(0.0, widgets.gap)
    playing.travel = widgets.check("Travel", playing.travel, "Ways above the paper, too.")


def clock_text(seconds: float) -> str:
    """Return a time as clocks show it."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def duration_text(seconds: float) -> str:
    """Return a time as people say it."""
    if seconds < 1:
        return "less than a second"
    if seconds < 90:
        return f"{seconds:.0f} s" if seconds >= 9.95 else f"{seconds:.1f} s"
    minutes = round(seconds / 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min"
