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
from stippler.drawing.preview import Preview
from stippler.ui.look import Look
from stippler.ui.patch import Patch
from stippler.ui.session import Session
from stippler.ui.tools.toolbox import Chosen
from stippler.ui.widgets import Rect

if TYPE_CHECKING:
    from stippler.drawing.drawing import Page
    from stippler.drawing.editing import Editing
    from stippler.render.renderer import Renderer


class Canvas:
    """Draws a session's page into a texture of the canvas's size.

    Attributes
    ----------
    n_drawn : int
        How often the page has been drawn.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._made: Renderer | None = None  # with the first drawing
        self._texture: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None
        self._drawn: object = None
        self._uploaded: object = None
        self._edited: Editing | None = None  # whose dots are on the GPU
        self._selected: NDArray[np.int64] = np.empty(0, np.int64)
        self.patch = Patch(ctx)
        self.n_drawn = 0

    def show(
        self, area: Rect, size_px: Size, preview: Preview | None, camera: Camera, ratio: float
    ) -> None:
        """Put the picture behind all panels, at ImGui's coordinates.

        Parameters
        ----------
        ratio : float
            Pixels of the canvas for each of ImGui's.
        """
        texture = self._sized(size_px)
        imgui.get_background_draw_list().add_image(
            imgui.ImTextureRef(texture.glo), area[:2], area[2:], (0.0, 1.0), (1.0, 0.0)
        )
        self.patch.place(preview, self._made, camera, size_px)
        self.patch.show(area, ratio)

    def draw(
        self,
        session: Session,
        selection: Chosen,
        camera: Camera,
        look: Look,
        preview: Preview | None,
    ) -> bool:
        """Draw the page if it would look different from the last time; return whether it did."""
        if self._target is None or self._texture is None:
            return False
        size_px = self._texture.size
        content = _content(session, selection)
        whole = preview if preview is None or preview.footprint is None else None
        key = (camera, size_px, content, look.theme, look.reference_opacity, whole)
        is_new = key != self._drawn
        if is_new:
            self._draw_page(session, selection, camera, look, whole)
            self._drawn = key
            self.n_drawn += 1
        if self._made is not None:
            self.patch.draw(preview, self._made, camera, size_px, look, key)
        return is_new

    def _draw_page(
        self,
        session: Session,
        selection: Chosen,
        camera: Camera,
        look: Look,
        preview: Preview | None,
    ) -> None:
        assert self._target is not None
        if session.drawing is None:
            self._target.use()
            self._target.clear(*look.theme.desk, 1.0)
        else:
            renderer = self._renderer()
            self._upload(renderer, session, selection, session.drawing.page)
            renderer.set_reference(
                session.reference if look.reference_shown else None, look.reference_opacity
            )
            colours = look.theme
            renderer.set_preview(preview)
            renderer.draw(
                camera,
                self._target.size,
                self._target,
                paper=colours.paper,
                desk=colours.desk,
                ink=colours.ink,
            )
            renderer.set_preview(None)

    def _renderer(self) -> Renderer:
        """Return the renderer; it is imported late, for the sake of the first frame."""
        if self._made is None:
            from stippler.render.renderer import Renderer

            self._made = Renderer(self._ctx)
        return self._made

    def _upload(self, renderer: Renderer, session: Session, selection: Chosen, page: Page) -> None:
        """Bring what has changed since the last call to the GPU."""
        content = _content(session, selection)
        if content == self._uploaded:
            return
        renderer.set_page(page.width_mm, page.height_mm)
        editing = session.editing if session.position_mm is None else None
        if editing is not None:
            self._upload_edited(renderer, editing, selection)
        elif session.position_mm is not None and session.radius_mm is not None:
            renderer.set_positions(session.position_mm, session.radius_mm)
        else:
            renderer.set_positions(np.empty((0, 2)), np.empty(0, np.float32))
        self._uploaded, self._edited = content, editing

    def _upload_edited(self, renderer: Renderer, editing: Editing, selection: Chosen) -> None:
        changed, selected = editing.take_changed(), selection.mask(editing)
        dots, rows = editing.dots, changed.rows
        if editing is not self._edited or rows is None or renderer.n_dots == 0:
            renderer.set_dots(dots, selected)
        else:
            if selection.ids is not self._selected:
                for ids in (self._selected, selection.ids):
                    there = editing.rows(ids)
                    rows = np.union1d(rows, there[there >= 0])
            if len(rows) or len(dots) != renderer.n_dots:
                renderer.update_dots(dots, rows, selected)
            if changed.places:
                renderer.set_positions(dots.position_mm, dots.radius_mm)
        self._selected = selection.ids

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
        self.patch.close()
        if self._made is not None:
            self._made.release()


def _content(session: Session, selection: Chosen) -> tuple[int, int, int]:
    """Return what tells one state of the dots from another."""
    edited = session.editing.revision if session.editing is not None else -1
    return session.revision, edited, selection.revision
