"""The part of the page that a hovering brush would change, as it would be then.

It lies over the page's picture, so that a hovering brush costs what is under its tip, however many
dots there are.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import moderngl
from imgui_bundle import imgui

from stippler.camera import Camera, Size
from stippler.drawing.preview import Footprint, Preview
from stippler.ui.widgets import Rect

if TYPE_CHECKING:
    from stippler.render.frame import Frame
    from stippler.render.renderer import Renderer

_STEP_PX = 64  # a tip that grows needs another texture only now and then

Box = tuple[int, int, int, int]


class Patch:
    """A small texture of the canvas's pixels.

    Attributes
    ----------
    box : (left, top, right, bottom) or None
        Where it lies on the canvas, in its pixels; None while there is nothing to show.
    n_drawn : int
        How often it has been drawn.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._texture: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None
        self._drawn: object = None
        self.box: Box | None = None
        self.n_drawn = 0

    def place(
        self, preview: Preview | None, renderer: Renderer | None, camera: Camera, size_px: Size
    ) -> None:
        """Find where it lies."""
        self.box = None
        if preview is not None and preview.footprint and renderer is not None:
            tip = preview.footprint
            self.box = _box(tip, renderer.reach_mm(preview), camera, size_px)

    def show(self, canvas: Rect, ratio: float) -> None:
        """Put it over the page's picture; `ratio` is its pixels for each of ImGui's."""
        if self.box is None:
            return
        left, top, right, bottom = self.box
        w, h = right - left, bottom - top
        texture = self._sized((w, h))
        low = canvas[0] + left / ratio, canvas[1] + top / ratio
        high = canvas[0] + right / ratio, canvas[1] + bottom / ratio
        uv = (0.0, h / texture.height), (w / texture.width, 0.0)
        imgui.get_background_draw_list().add_image(imgui.ImTextureRef(texture.glo), low, high, *uv)

    def draw(self, renderer: Renderer, frame: Frame, page: object) -> None:
        """Draw its part of a frame if it would look different; `page` tells all the rest apart."""
        if self.box is None or self._target is None:
            return
        key = (frame, self.box, page)
        if key == self._drawn:
            return
        left, top, right, bottom = self.box
        part_px = (right - left, bottom - top)
        tile = frame.camera.tile((left, top), part_px, frame.size_px)
        renderer.draw(replace(frame, camera=tile, size_px=part_px), self._target)
        self._drawn = key
        self.n_drawn += 1

    def _sized(self, size_px: Size) -> moderngl.Texture:
        now = self._texture
        if now is not None and now.width >= size_px[0] and now.height >= size_px[1]:
            return now
        size = (_rounded_up(size_px[0]), _rounded_up(size_px[1]))
        self.close()
        self._texture = self._ctx.texture(size, 4)
        self._texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._target = self._ctx.framebuffer([self._texture])
        self._drawn = None
        return self._texture

    def close(self) -> None:
        """Free every GL object."""
        for one in (self._target, self._texture):
            if one is not None:
                one.release()
        self._target = self._texture = None


def _rounded_up(side_px: int) -> int:
    return -(-side_px // _STEP_PX) * _STEP_PX


def _box(tip: Footprint, reach_mm: float, camera: Camera, size_px: Size) -> Box | None:
    """Return the part of the canvas that holds all the ink of the dots under a tip."""
    x, y = camera.page_to_screen(tip.center_mm, size_px)
    reach = (tip.reach_mm + reach_mm) * camera.px_per_mm + 1.0
    left, top = max(math.floor(x - reach), 0), max(math.floor(y - reach), 0)
    right, bottom = min(math.ceil(x + reach), size_px[0]), min(math.ceil(y + reach), size_px[1])
    return (left, top, right, bottom) if left < right and top < bottom else None
