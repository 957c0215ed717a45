"""The page as a picture that is drawn only when it would look different.

Panels and pointers change far more often than the page: their frames show the picture that is
there, at the cost of a rectangle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl
import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from stippler.camera import Camera, Size
from stippler.render.renderer import Renderer
from stippler.ui.look import Look
from stippler.ui.session import Session
from stippler.ui.tools.toolbox import Chosen
from stippler.ui.widgets import Rect

if TYPE_CHECKING:
    from stippler.drawing.editing import Editing


class Canvas:
    """Draws a session's page into a texture of the canvas's size.

    Attributes
    ----------
    n_drawn : int
        How often the page has been drawn.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._renderer = Renderer(ctx)
        self._texture: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None
        self._drawn: object = None
        self._uploaded: object = None
        self._edited: Editing | None = None  # whose dots are on the GPU
        self._selected: NDArray[np.int64] = np.empty(0, np.int64)
        self.n_drawn = 0

    def show(self, area: Rect, size_px: Size) -> None:
        """Put the picture behind all panels, at ImGui's coordinates."""
        texture = self._sized(size_px)
        imgui.get_background_draw_list().add_image(
            imgui.ImTextureRef(texture.glo), area[:2], area[2:], (0.0, 1.0), (1.0, 0.0)
        )

    def upload(self, session: Session, selection: Chosen) -> None:
        """Bring what has changed since the last call to the GPU."""
        editing = session.editing if session.position_mm is None else None
        edited = (editing.revision if editing else -1, selection.revision)
        if (session.revision, edited) == self._uploaded:
            return
        self._uploaded = (session.revision, edited)
        drawing = session.drawing
        if drawing is not None:
            self._renderer.set_page(drawing.page.width_mm, drawing.page.height_mm)
        if editing is not None:
            self._upload_edited(editing, selection)
        elif session.position_mm is not None and session.radius_mm is not None:
            self._renderer.set_positions(session.position_mm, session.radius_mm)
        else:
            self._renderer.set_positions(np.empty((0, 2)), np.empty(0, np.float32))
        self._edited = editing

    def _upload_edited(self, editing: Editing, selection: Chosen) -> None:
        changed, selected = editing.take_changed(), selection.mask(editing)
        if editing is not self._edited or changed is None:
            self._renderer.set_dots(editing.dots, selected)
        else:
            if selection.ids is not self._selected:
                for ids in (self._selected, selection.ids):
                    rows = editing.rows(ids)
                    changed = np.union1d(changed, rows[rows >= 0])
            self._renderer.update_dots(editing.dots, changed, selected)
        self._selected = selection.ids

    def draw(self, session: Session, selection: Chosen, camera: Camera, look: Look) -> bool:
        """Draw the page if it would look different from the last time; return whether it did."""
        if self._target is None or self._texture is None:
            return False
        self.upload(session, selection)
        shown = session.reference if look.reference_shown else None
        key = (camera, self._texture.size, self._uploaded, look.theme, look.reference_opacity)
        if key == self._drawn:
            return False
        self._renderer.set_reference(shown, look.reference_opacity)
        if session.drawing is None:
            self._target.use()
            self._target.clear(*look.theme.desk, 1.0)
        else:
            self._renderer.draw(
                camera,
                self._texture.size,
                self._target,
                paper=look.theme.paper,
                desk=look.theme.desk,
                ink=look.theme.ink,
            )
        self._drawn = key
        self.n_drawn += 1
        return True

    def _sized(self, size_px: Size) -> moderngl.Texture:
        if self._texture is None or self._texture.size != size_px:
            self._free()
            self._texture = self._ctx.texture(size_px, 4)
            self._texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._target = self._ctx.framebuffer([self._texture])
            self._drawn = None
        return self._texture

    def _free(self) -> None:
        for one in (self._target, self._texture):
            if one is not None:
                one.release()

    def close(self) -> None:
        """Free every GL object."""
        self._free()
        self._renderer.release()
