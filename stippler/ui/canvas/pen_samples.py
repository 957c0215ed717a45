"""A strip of dots for each pen, as it makes them, to choose from; drawn once by the renderer."""

from __future__ import annotations

from dataclasses import fields

import moderngl
import numpy as np
from imgui_bundle import imgui

from stippler.camera import Camera, Size
from stippler.drawing.dots import Dots
from stippler.drawing.pens import PENS, Pen
from stippler.ui.theme import Theme

_STEP = 10.0  # between dots, in the theme's pixels, which stand for mm here
_RADII = (1.2, 4.4)
_JITTER = 0.9
_MARGIN = 4.0


class PenSamples:
    """One texture with a row for each of `PENS`, in order."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._texture: moderngl.Texture | None = None
        self._drawn: object = None

    def show(self, k: int, size: tuple[float, float], theme: Theme, scale: float) -> None:
        """Draw the sample of a pen as an ImGui item of a size in ImGui's pixels."""
        texture = self._made((max(round(size[0]), 1), max(round(size[1]), 1)), theme, scale)
        n = len(PENS)
        imgui.image(imgui.ImTextureRef(texture.glo), size, (0.0, 1 - k / n), (1.0, 1 - (k + 1) / n))

    def _made(self, row_px: Size, theme: Theme, scale: float) -> moderngl.Texture:
        key = (row_px, theme, scale)
        if self._texture is not None and key == self._drawn:
            return self._texture
        from stippler.render.frame import Frame  # late, for the first frame's sake
        from stippler.render.renderer import Renderer

        self.close()
        size_px = (row_px[0], row_px[1] * len(PENS))
        page = (size_px[0] / scale, size_px[1] / scale)
        self._texture = self._ctx.texture(size_px, 4)
        target = self._ctx.framebuffer([self._texture])
        renderer = Renderer(self._ctx)
        renderer.scene.set_page(*page)
        rows = [_strip(pen, k, page) for k, pen in enumerate(PENS)]
        renderer.scene.set_dots(
            Dots(
                **{f.name: np.concatenate([getattr(r, f.name) for r in rows]) for f in fields(Dots)}
            )
        )
        camera = Camera((page[0] / 2, page[1] / 2), scale)
        paper = theme.paper
        frame = Frame(camera, size_px, paper=paper, desk=paper, ink=theme.ink, marks=None)
        renderer.draw(frame, target)
        renderer.release()
        self._ctx.screen.use()
        target.release()
        self._drawn = key
        return self._texture

    def close(self) -> None:
        """Free the GL objects."""
        if self._texture is not None:
            self._texture.release()
        self._texture = None


def _strip(pen: Pen, k: int, page: tuple[float, float]) -> Dots:
    """Return dots over a row of the page that grow from left to right."""
    width, height = page[0] - 2 * _MARGIN, page[1] / len(PENS)
    n_x, n_y = int(width / _STEP), int(height / _STEP)
    x, y = (side.ravel() for side in np.meshgrid(np.arange(n_x) + 0.5, np.arange(n_y) + 0.5))
    x += 0.5 * (np.arange(len(x)) // n_x % 2)  # every other row by half a step
    at = np.column_stack([x * width / n_x + _MARGIN - 2.5, (y / n_y + k) * height])
    at += np.random.default_rng(5).uniform(-_JITTER, _JITTER, at.shape)
    return pen.drawn(Dots.round(at, np.interp(at[:, 0], (0.0, width), _RADII)))
