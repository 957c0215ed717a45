"""Further views of the page, each in a texture of its own: the other half, the navigator."""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl

from stippler.camera import Size

if TYPE_CHECKING:
    from stippler.render.frame import Frame
    from stippler.render.renderer import Renderer


class SideView:
    """A texture that is drawn only when it would look different."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._texture: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None
        self._drawn: object = None
        self.n_drawn = 0

    def texture(self, size_px: Size) -> moderngl.Texture:
        """Return the texture; another size is another one."""
        if self._texture is None or self._texture.size != size_px:
            self.close()
            self._texture = self._ctx.texture(size_px, 4)
            self._texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._target = self._ctx.framebuffer([self._texture])
        return self._texture

    def is_stale(self, key: object) -> bool:
        """Return whether it shows something else."""
        return self._drawn != key

    def draw(self, renderer: Renderer, frame: Frame, key: object) -> None:
        """Draw a frame, if the key tells that it is not what is there."""
        if self._target is not None and self.is_stale(key):
            renderer.draw(frame, self._target)
            self._drawn = key
            self.n_drawn += 1

    def close(self) -> None:
        """Free the GL objects."""
        for one in (self._target, self._texture):
            if one is not None:
                one.release()
        self._texture = self._target = self._drawn = None
