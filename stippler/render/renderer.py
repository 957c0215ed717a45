"""The passes of one frame and their order: paper, reference, dots, overlays."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.camera import Camera, Point, Size
from stippler.drawing.adjustment import NEUTRAL, Adjustment
from stippler.drawing.dots import Dots
from stippler.drawing.preview import Preview
from stippler.drawing.reference import Reference
from stippler.render.dots import DotsPass
from stippler.render.ink import InkTarget
from stippler.render.overlay import OverlayPass
from stippler.render.paper import Color, PaperPass
from stippler.render.reference import ReferencePass
from stippler.render.state import set_target

PAPER: Color = (0.984, 0.980, 0.965)
DESK: Color = (0.827, 0.816, 0.792)
INK: Color = (0.086, 0.082, 0.094)
FIXED: Color = (0.72, 0.30, 0.12)
SELECTED: Color = (0.10, 0.42, 0.80)


class Renderer:
    """Draws a page, its reference and its dots into any framebuffer of one GL context.

    Everything is uploaded by the `set_` and `update_` methods; `draw` only draws. Each pass sets
    all the GL state it needs, so other code may draw into the same context before and after.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._page_mm = (1.0, 1.0)
        self._opacity = 0.0
        self._adjustment = NEUTRAL
        self._preview: Preview | None = None
        self._selected = np.zeros(0, np.bool_)
        self._paper = PaperPass(ctx)
        self._reference = ReferencePass(ctx)
        self._dots = DotsPass(ctx)
        self._ink = InkTarget(ctx)
        self._overlay = OverlayPass(ctx)
        self._tip: tuple[Point, float] | None = None

    @property
    def n_dots(self) -> int:
        """How many dots are uploaded."""
        return self._dots.buffer.n

    @property
    def n_draw_calls(self) -> int:
        """How many draw calls the dots of the last frame took."""
        return self._dots.n_draw_calls

    def set_page(self, width_mm: float, height_mm: float) -> None:
        """Set the size of the paper; call it before `set_dots`."""
        self._page_mm = (float(width_mm), float(height_mm))

    def set_reference(
        self,
        reference: Reference | None,
        opacity: float = 0.25,
        adjustment: Adjustment = NEUTRAL,
    ) -> None:
        """Show a reference under the dots, adjusted; cheap if it is the one already shown."""
        self._reference.set(reference)
        self._opacity, self._adjustment = float(opacity), adjustment

    def set_dots(self, dots: Dots, selected: NDArray[np.bool_] | None = None) -> None:
        """Upload all dots, and which of them are selected."""
        self._bound(self._dots.buffer.set(dots, self._chosen(dots, selected), self._origin_mm))

    def set_positions(
        self, position_mm: ArrayLike, radius_mm: ArrayLike, *, settled: bool = False
    ) -> None:
        """Upload positions and radii, as a worker hands them back while it is at work.

        Dots keep their shapes if there are as many as before; else all are round.

        Parameters
        ----------
        settled : bool
            The worker is done: overlapping dots may take their time (10 to 20 ms for 100,000) to
            be weighed, so that the tone is right where pixels are larger than dots.
        """
        position = np.ascontiguousarray(position_mm, np.float64).reshape(-1, 2)
        radius = np.ascontiguousarray(
            np.broadcast_to(np.asarray(radius_mm, np.float32), (len(position),))
        )
        buffer = self._dots.buffer
        self._bound(buffer.set_positions(position, radius, self._origin_mm, settled=settled))

    def update_dots(
        self, dots: Dots, rows: NDArray[np.intp], selected: NDArray[np.bool_] | None = None
    ) -> None:
        """Upload only the given rows; rows past the end of what is uploaded are new dots.

        If the number of dots changed in another way, all are uploaded.
        """
        buffer = self._dots.buffer
        self._bound(buffer.update(dots, rows, self._chosen(dots, selected), self._origin_mm))

    def set_preview(self, preview: Preview | None) -> None:
        """Show dots as a brush would leave them; by uniforms only."""
        self._preview = preview

    def reach_mm(self, preview: Preview) -> float:
        """Return how far from its centre a dot may be seen when it is shown so."""
        return self._dots.reach_mm(preview.change)

    def set_tip(self, center_mm: Point | None, radius_mm: float = 0.0) -> None:
        """Show the outline of a brush over the drawing, or none."""
        self._tip = None if center_mm is None else (center_mm, radius_mm)

    def draw(
        self,
        camera: Camera,
        size_px: Size,
        framebuffer: moderngl.Framebuffer | None = None,
        *,
        paper: Color = PAPER,
        desk: Color = DESK,
        ink: Color = INK,
        marks: tuple[Color, Color] | None = (FIXED, SELECTED),
        dots: bool = True,
    ) -> None:
        """Draw one frame.

        Parameters
        ----------
        framebuffer : moderngl.Framebuffer, optional
            The context's screen if not given; left in use.
        paper, desk, ink : (r, g, b)
            0..1, encoded for display.
        marks : (colour, colour) or None
            Of fixed and of selected dots; None draws them like all others.
        dots : bool
            False leaves them out.
        """
        if dots:
            self._dots.draw(camera, size_px, self._origin_mm, self._ink, self._preview)
        target = framebuffer or self._ctx.screen
        set_target(self._ctx, target, size_px)
        target.clear(*desk, 1.0)
        # The ink pass covers the page, unless a picture lies under it or its edge needs smoothing.
        is_bare = dots and not self._shows_reference and camera.rotation_rad == 0.0
        page_mm = self._page_mm
        if paper != desk:
            self._paper.draw(camera, size_px, page_mm, (paper, desk), edge_only=is_bare)
        if self._shows_reference:
            self._reference.draw(camera, size_px, self._opacity, ink, self._adjustment)
        if dots:
            self._ink.lay(camera, size_px, page_mm, ink, paper if is_bare else None)
        if dots and marks:
            self._dots.draw_marks(camera, size_px, self._origin_mm, self._preview, marks)
        if self._tip:
            self._overlay.draw(camera, size_px, *self._tip)

    def release(self) -> None:
        """Free every GL object."""
        for one in (self._overlay, self._dots, self._ink, self._reference, self._paper):
            one.release()

    @property
    def _shows_reference(self) -> bool:
        return self._opacity > 0 and self._reference.is_set

    @property
    def _origin_mm(self) -> tuple[float, float]:
        return (self._page_mm[0] / 2, self._page_mm[1] / 2)

    def _chosen(self, dots: Dots, selected: NDArray[np.bool_] | None) -> NDArray[np.bool_]:
        if selected is not None:
            self._selected = selected
        elif len(self._selected) != len(dots):
            self._selected = np.zeros(len(dots), np.bool_)
        return self._selected

    def _bound(self, is_another: bool) -> None:
        if is_another:
            self._dots.forget_buffer()
