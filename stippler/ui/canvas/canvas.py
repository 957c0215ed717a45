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
from stippler.drawing.adjustment import NEUTRAL
from stippler.drawing.preview import Preview
from stippler.editor.session import Session
from stippler.editor.tools.toolbox import Chosen
from stippler.ui.canvas.lens import MARGIN, Glass
from stippler.ui.canvas.patch import Patch
from stippler.ui.look import Look
from stippler.ui.widgets import Rect

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Page
    from stippler.render.lens import LensPass
    from stippler.render.renderer import Renderer

_RIM = 1.5  # the theme's pixels; each of the two lines of a lens's rim


class Canvas:
    """Draws a session's page into a texture of the canvas's size.

    Attributes
    ----------
    n_drawn, n_lens_drawn : int
        How often the page has been drawn, and what the lens shows.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._made: Renderer | None = None  # with the first drawing
        self._texture: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None
        self._drawn: object = None
        self._uploaded: object = None
        self._edited: Document | None = None  # whose dots are on the GPU
        self._cursor = 0  # how far its changes are
        self._selected: NDArray[np.int64] = np.empty(0, np.int64)
        self._lens: LensPass | None = None  # with the first look through it
        self._glass: Glass | None = None  # of this frame
        self._lens_drawn: object = None
        self.patch = Patch(ctx)
        self.n_drawn = self.n_lens_drawn = 0

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

    def show_lens(self, area: Rect, glass: Glass, scale: float, ratio: float) -> None:
        """Put a lens over the picture for this frame; `draw` fills it in.

        Parameters
        ----------
        scale : float
            ImGui's units for each of the theme's pixels.
        ratio : float
            Pixels of the canvas for each of ImGui's.
        """
        self._glass = glass
        lens = self._lens_of(glass.diameter_px, scale * ratio)
        low = [area[k] + (glass.corner_px[k] - lens.margin_px) / ratio for k in (0, 1)]
        high = [low[k] + lens.texture.width / ratio for k in (0, 1)]
        draw = imgui.get_background_draw_list()
        draw.push_clip_rect(area[:2], area[2:], True)
        texture = imgui.ImTextureRef(lens.texture.glo)
        draw.add_image(texture, (low[0], low[1]), (high[0], high[1]), (0.0, 1.0), (1.0, 0.0))
        draw.pop_clip_rect()

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
        adjustment = session.adjustment if look.reference_opacity else NEUTRAL
        whole = preview if preview is None or preview.footprint is None else None
        shown = (content, look.theme, look.reference_opacity, adjustment, look.dots_shown, whole)
        is_new = (camera, size_px, shown) != self._drawn
        if is_new:
            self._draw_page(session, selection, camera, look, whole)
            self._drawn = (camera, size_px, shown)
            self.n_drawn += 1
        if self._glass is not None and session.drawing is not None:
            self._draw_lens(self._glass, shown, look, preview)
        self._glass = None
        if self._made is not None:
            self.patch.draw(preview, self._made, camera, size_px, look, shown)
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
        assert self._texture is not None
        if session.drawing is None:
            self._target.use()
            self._target.clear(*look.theme.desk, 1.0)
            return
        renderer, colours = self._renderer(), look.theme
        self._upload(renderer, session, selection, session.drawing.page)
        reference = session.reference if look.reference_shown else None
        renderer.set_reference(
            reference.picture if reference else None, look.reference_opacity, session.adjustment
        )
        renderer.set_preview(preview)
        renderer.draw(
            camera,
            self._texture.size,
            self._target,
            paper=colours.paper,
            desk=colours.desk,
            ink=colours.ink,
            dots=look.dots_shown,
        )
        renderer.set_preview(None)

    def _draw_lens(self, glass: Glass, shown: object, look: Look, preview: Preview | None) -> None:
        """Draw what the lens shows, if that is not what it showed the last time."""
        assert self._lens is not None
        key = (glass.camera, shown, self._lens, preview)
        if key == self._lens_drawn:
            return
        from stippler.render.lens import Colors

        colours, renderer = look.theme, self._renderer()
        renderer.set_preview(preview)
        self._lens.draw(
            renderer,
            glass.camera,
            Colors(colours.paper, colours.desk, colours.ink),
            dots=look.dots_shown,
        )
        renderer.set_preview(None)
        self._lens_drawn = key
        self.n_lens_drawn += 1

    def _lens_of(self, diameter_px: int, scale: float) -> LensPass:
        """Return the lens of a diameter; another size is another lens."""
        from stippler.render.lens import LensPass

        margin_px, rim_px = round(MARGIN * scale), max(_RIM * scale, 1.0)
        size = (diameter_px, margin_px, rim_px)
        if self._lens is None or self._lens.size != size:
            if self._lens is not None:
                self._lens.release()
            self._lens = LensPass(self._ctx, *size)
        return self._lens

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
        document = session.document
        assert document is not None
        self._upload_edited(renderer, document, selection)
        self._uploaded, self._edited = content, document

    def _upload_edited(self, renderer: Renderer, document: Document, selection: Chosen) -> None:
        cursor = self._cursor if document is self._edited else 0
        changed, selected = document.changes.since(cursor), selection.mask(document)
        dots, rows = document.dots, changed.rows
        if document is not self._edited or rows is None or renderer.n_dots == 0:
            renderer.set_dots(dots, selected)
        else:
            if selection.ids is not self._selected:
                for ids in (self._selected, selection.ids):
                    there = document.rows(ids)
                    rows = np.union1d(rows, there[there >= 0])
            if len(rows) or len(dots) != renderer.n_dots:
                renderer.update_dots(dots, rows, selected)
            if changed.places:
                renderer.set_positions(dots.position_mm, dots.radius_mm)
        self._selected, self._cursor = selection.ids, changed.cursor

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
        if self._lens is not None:
            self._lens.release()
        if self._made is not None:
            self._made.release()


def _content(session: Session, selection: Chosen) -> tuple[int, int, int]:
    """Return what tells one state of the dots from another."""
    edited = session.document.revision if session.document is not None else -1
    return session.revision, edited, selection.revision
