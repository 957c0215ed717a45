"""The page as a picture that is drawn only when it would look different.

Panels and pointers change far more often than the page: their frames show the picture that is
there, at the cost of a rectangle.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import TYPE_CHECKING

import moderngl
from imgui_bundle import imgui

from stippler.camera import Camera, Size
from stippler.drawing.adjustment import NEUTRAL
from stippler.drawing.preview import Preview
from stippler.drawing.visible import hidden_areas
from stippler.editor.session import Session
from stippler.editor.tools.selection import Selection
from stippler.ui.canvas.lens import MARGIN, Glass
from stippler.ui.canvas.patch import Patch
from stippler.ui.canvas.side_view import SideView
from stippler.ui.look import Look
from stippler.ui.theme import Theme
from stippler.ui.widgets import Rect

if TYPE_CHECKING:
    from stippler.render.frame import Frame
    from stippler.render.lens import LensPass
    from stippler.render.renderer import Renderer
    from stippler.render.scene import Scene

MAP_EVERY_S = 0.4  # the navigator is drawn no more often
_WAITING = 0.45  # opacity of the picture
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
        self._lens: LensPass | None = None  # with the first look through it
        self._glass: Glass | None = None  # of this frame
        self._lens_drawn: object = None
        self.patch = Patch(ctx)
        self._half, self._map = SideView(ctx), SideView(ctx)
        self._shows_half = False
        self._map_camera: Camera | None = None  # of the navigator, in this frame
        self._map_size_px: Size = (1, 1)
        self._map_drawn_s = -math.inf
        self._map_late = False
        self._n_weighed = 0  # how often dots have got other shares after they were drawn
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

    def show_half(self, area: Rect, size_px: Size, scale: float, theme: Theme) -> None:
        """Put the picture over the left half of the canvas for this frame; `draw` fills it in."""
        self._shows_half = True
        texture, (x0, y0, x1, y1) = self._half.texture(size_px), area
        middle = round((x0 + x1) / 2)
        draw = imgui.get_background_draw_list()
        draw.push_clip_rect((x0, y0), (middle, y1), True)
        draw.add_image(imgui.ImTextureRef(texture.glo), area[:2], area[2:], (0.0, 1.0), (1.0, 0.0))
        draw.pop_clip_rect()
        line = imgui.get_color_u32((*theme.accent, 1.0))
        draw.add_line((middle, y0), (middle, y1), line, 1.5 * scale)

    def map_texture(self, camera: Camera, size_px: Size) -> moderngl.Texture:
        """Return the navigator's texture; `draw` fills it in, now and then."""
        self._map_camera, self._map_size_px = camera, size_px
        return self._map.texture(size_px)

    @property
    def map_is_late(self) -> bool:
        """Whether the navigator shows the page as it was."""
        return self._map_late

    @property
    def is_weighing(self) -> bool:
        """Whether the page is to be drawn once more, with the overlaps of dots as they are."""
        return self._made is not None and self._made.scene.dots.is_weighing

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
        selection: Selection,
        solo: int | None,
        camera: Camera,
        look: Look,
        preview: Preview | None,
    ) -> bool:
        """Draw the page if it would look different from the last time; return whether it did.

        Parameters
        ----------
        solo : int or None
            The area that is shown alone.
        """
        if self._target is None or self._texture is None:
            return False
        if self._made is not None:
            self._n_weighed += self._made.scene.dots.take_shares()
        content = (_content(session, selection, solo), self._n_weighed)
        frame = _frame(camera, self._texture.size, look, session)
        whole = preview if preview is None or preview.footprint is None else None
        page = (content, replace(frame, preview=whole))
        is_new = page != self._drawn
        if is_new:
            self._draw_page(session, selection, solo, replace(frame, preview=whole))
            self._drawn = page
            self.n_drawn += 1
        if self._glass is not None and session.drawing is not None:
            glass = replace(frame, camera=self._glass.camera, preview=preview)
            self._draw_lens((content, glass, self._lens), glass)
        self._glass = None
        if session.drawing is not None and not look.peek:
            self._draw_sides(session, frame, content)
        self._shows_half, self._map_camera = False, None
        if self._made is not None:
            self.patch.draw(self._made, replace(frame, preview=preview), page)
        return is_new

    def _draw_sides(self, session: Session, frame: Frame, content: object) -> None:
        """Draw the picture's half, and the navigator, where it is time for it."""
        self._map_late = False
        if self._shows_half and session.reference is not None:
            renderer = self._renderer()
            renderer.scene.set_reference(session.reference)
            alone = replace(
                frame, dots=False, marks=None, opacity=1.0, adjustment=session.adjustment
            )
            self._half.draw(renderer, alone, (alone, id(session.reference)))
        camera = self._map_camera
        if camera is None or session.drawing is None:
            return
        small = replace(frame, camera=camera, size_px=self._map_size_px, marks=None, preview=None)
        key = (content, small)
        if not self._map.is_stale(key):
            return
        held = session.document is not None and session.document.in_stroke
        now = time.monotonic()
        if held or now - self._map_drawn_s < MAP_EVERY_S:
            self._map_late = True
            return
        self._map_drawn_s = now
        self._map.draw(self._renderer(), small, key)

    def _draw_page(
        self, session: Session, selection: Selection, solo: int | None, frame: Frame
    ) -> None:
        assert self._target is not None
        if session.drawing is None:
            self._target.use()
            self._target.clear(*frame.desk, 1.0)
            return
        renderer = self._renderer()
        self._upload(renderer.scene, session, selection, solo)
        if frame.opacity:
            renderer.scene.set_reference(session.reference)
        renderer.draw(frame, self._target)

    def _draw_lens(self, key: object, frame: Frame) -> None:
        """Draw what the lens shows, if that is not what it showed the last time."""
        assert self._lens is not None
        if key == self._lens_drawn:
            return
        self._lens.draw(self._renderer(), frame)
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

            self._made = Renderer(self._ctx, live=True)
        return self._made

    def _upload(
        self, scene: Scene, session: Session, selection: Selection, solo: int | None
    ) -> None:
        """Bring what has changed since the last call to the GPU."""
        content = _content(session, selection, solo)
        if content == self._uploaded or session.drawing is None:
            return
        self._uploaded = None  # what fails is tried again
        assert session.document is not None
        hidden = hidden_areas(session.document.drawing, solo)
        scene.sync(session.document, selection.ids, hidden)
        self._uploaded = content

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
        self._half.close()
        self._map.close()
        if self._lens is not None:
            self._lens.release()
        if self._made is not None:
            self._made.release()


def _frame(camera: Camera, size_px: Size, look: Look, session: Session) -> Frame:
    """Return how a look shows the page."""
    from stippler.render.frame import FIXED, SELECTED, Frame

    theme, opacity = look.theme, look.reference_opacity if session.reference else 0.0
    if session.reference and session.busy and not session.n_dots:
        opacity = max(opacity, _WAITING)  # something to look at until there are dots
    peeks = look.peek == "picture" and session.reference is not None
    return Frame(
        camera,
        size_px,
        paper=theme.paper,
        desk=theme.desk,
        ink=theme.ink,
        marks=(FIXED, SELECTED) if look.marks_shown and not peeks else None,
        dots=look.dots_shown and not peeks,
        patterns=look.patterns_shown,
        opacity=1.0 if peeks else opacity,
        adjustment=session.adjustment if opacity or peeks else NEUTRAL,
    )


def _content(
    session: Session, selection: Selection, solo: int | None
) -> tuple[int, int, int, int | None]:
    """Return what tells one state of the dots from another."""
    edited = session.document.revision if session.document is not None else -1
    return session.revision, edited, selection.revision, solo
