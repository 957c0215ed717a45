"""Small pictures of sets of polygons, to choose from; each is drawn once."""

from __future__ import annotations

import moderngl
import numpy as np
from imgui_bundle import imgui

from stippler.drawing.pattern import PolygonSet
from stippler.ui.theme import Theme

_FINE = 3  # drawn so much larger, and scaled down
_MOST_RINGS = 4000


class PatternSamples:
    """Textures by the sets they show."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._textures: dict[tuple[PolygonSet, int, Theme], moderngl.Texture] = {}

    def show(self, polygons: PolygonSet, side: float, theme: Theme) -> None:
        """Draw a set as an ImGui item, a square of a side in ImGui's pixels."""
        imgui.image(imgui.ImTextureRef(self._made(polygons, round(side), theme).glo), (side, side))

    def _made(self, polygons: PolygonSet, side: int, theme: Theme) -> moderngl.Texture:
        key = (polygons, side, theme)
        if key not in self._textures:
            from PIL import Image, ImageDraw  # late, for the sake of the first frame

            whole = side * _FINE
            paper, ink = (tuple(round(255 * c) for c in x) for x in (theme.paper, theme.ink))
            fill = tuple(round(0.75 * p + 0.25 * i) for p, i in zip(paper, ink, strict=True))
            image = Image.new("RGB", (whole, whole), paper)
            pen = ImageDraw.Draw(image)
            for ring in polygons.rings()[:_MOST_RINGS]:
                pen.polygon([tuple(at) for at in ring * whole], fill=fill, outline=ink, width=2)
            data = np.asarray(image.resize((side, side), Image.Resampling.BOX), np.uint8)
            self._textures[key] = self._ctx.texture((side, side), 3, data.tobytes(), alignment=1)
        return self._textures[key]

    def close(self) -> None:
        """Free the GL objects."""
        for texture in self._textures.values():
            texture.release()
        self._textures.clear()
