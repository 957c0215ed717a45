"""The passes of one frame and their order: lines and dots, paper, reference, ink, marks."""

from __future__ import annotations

import moderngl

from stippler.drawing.preview import Preview
from stippler.render.dots import DotsPass
from stippler.render.frame import GUIDE, PATTERN, Frame
from stippler.render.ground import GroundPass
from stippler.render.ink import InkPass
from stippler.render.lines import LinesPass
from stippler.render.paper import PaperPass
from stippler.render.reference import ReferencePass
from stippler.render.scene import Scene
from stippler.render.state import set_target


class Renderer:
    """Draws a scene into any framebuffer of one GL context.

    Each pass sets all the GL state it needs, so other code may draw into the same context before
    and after; what a frame shows stands in its `Frame`, and in nothing that is left behind.

    Parameters
    ----------
    live : bool
        For a window, whose frames do not wait for the shares of many dots.

    Attributes
    ----------
    scene : Scene
        What is drawn; it owns the buffers.
    """

    def __init__(self, ctx: moderngl.Context, *, live: bool = False) -> None:
        self._ctx = ctx
        self.scene = Scene(ctx, live=live)
        self._paper = PaperPass(ctx)
        self._reference = ReferencePass(ctx)
        self._lines = LinesPass(ctx)
        self._dots = DotsPass(ctx)
        self._ground = GroundPass(ctx)
        self._ink = InkPass(ctx)

    @property
    def n_draw_calls(self) -> int:
        """How many draw calls the dots of the last frame took."""
        return self._dots.n_draw_calls

    def reach_mm(self, preview: Preview) -> float:
        """Return how far from its centre a dot may be seen when it is shown so."""
        return self._dots.reach_mm(self.scene.dots, preview.change)

    def draw(self, frame: Frame, framebuffer: moderngl.Framebuffer | None = None) -> None:
        """Draw a frame into a framebuffer, or the context's screen; it is left in use."""
        scene, camera, size_px = self.scene, frame.camera, frame.size_px
        has_ink = frame.dots or not scene.lines.is_empty
        if has_ink:
            self._gather(frame)
        set_target(self._ctx, target := framebuffer or self._ctx.screen, size_px)
        target.clear(*frame.desk, 1.0)
        shows_reference = frame.opacity > 0 and scene.reference.is_set
        # The ink pass covers the page, unless a picture lies under it or its edge needs smoothing.
        is_bare = has_ink and not shows_reference and camera.rotation_rad == 0.0
        if frame.paper != frame.desk:
            colors = (frame.paper, frame.desk)
            self._paper.draw(camera, size_px, scene.page_mm, colors, edge_only=is_bare)
        if shows_reference:
            self._reference.draw(scene.reference, frame)
        if has_ink:
            under = frame.paper if is_bare else None
            inverse = frame.dots and scene.grounds.n > 0
            self._ink.lay(camera, size_px, scene.page_mm, frame.ink, under, inverse=inverse)
        if frame.marks and frame.dots:
            self._dots.draw_marks(scene.dots, frame, scene.origin_mm, frame.marks)
        if frame.marks:
            self._draw_marks(frame)

    def _draw_marks(self, frame: Frame) -> None:
        """Draw guides, and the outlines of patterns where they are asked for."""
        scene, view = self.scene, (frame.camera, frame.size_px)
        if frame.patterns:
            self._lines.draw_marks(scene.lines.patterns, *view, scene.origin_mm, PATTERN)
        self._lines.draw_marks(scene.lines.guides, *view, scene.origin_mm, GUIDE)

    def _gather(self, frame: Frame) -> None:
        """Gather the ink of lines and black dots; grounds and white dots by themselves."""
        scene, ink, origin_mm = self.scene, self._ink, self.scene.origin_mm
        whole = ink.ink.begin(frame.size_px)
        self._lines.draw(scene.lines, frame.camera, whole, origin_mm)
        if frame.dots:
            self._dots.draw(scene.dots, frame, origin_mm, whole)
            if scene.grounds.n:
                ink.black.begin(frame.size_px)
                self._ground.draw(scene.grounds, frame.camera, whole, origin_mm)
                ink.white.begin(frame.size_px)
                self._dots.draw(scene.dots, frame, origin_mm, whole, in_white=True)

    def release(self) -> None:
        """Free every GL object, those of the scene too."""
        passes = (self._lines, self._dots, self._ground, self._ink, self._reference, self._paper)
        for one in (*passes, self.scene):
            one.release()
