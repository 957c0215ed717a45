"""How the person looks at the page: a camera, its limits, and its way to where it should be."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from stippler.camera import Camera, Paper, Point, Size

MARGIN = 0.06  # of the smaller side, around the fitted page
MAX_PX_PER_MM = 2_000.0
SMALLEST_OF_FIT = 0.1  # zooming out ends where the page is a tenth of the fitted one
_SETTLE_S = 0.06  # in this time a smooth zoom covers 63 % of what is left
_CLOSE_ENOUGH = 0.002  # of the logarithm of the scale
_EXACT_DEG = 1e-9
_AXLE_PX = 6.0


@dataclass(frozen=True, slots=True)
class _Blank:
    """What is looked at before there is a page."""

    width_mm: float = 148.0
    height_mm: float = 111.0


BLANK = _Blank()


class View:
    """A camera on a canvas of `size_px`.

    Attributes
    ----------
    camera : Camera
        What the next frame shows.
    following : bool
        Whether the page is kept fitted as the canvas changes size; until the person moves.
    """

    def __init__(self, paper: Paper, size_px: Size) -> None:
        self._paper, self._size_px = paper, size_px
        self._to_go = 0.0  # logarithm of the zoom that is still to come
        self._at_px: Point = (0.0, 0.0)
        self.following = True
        self.camera = Camera((0.0, 0.0), 1.0)
        self.fit()

    @property
    def size_px(self) -> Size:
        """Size of the canvas."""
        return self._size_px

    @property
    def moving(self) -> bool:
        """Whether the next frame will look different without any input."""
        return self._to_go != 0.0

    def show(self, paper: Paper) -> None:
        """Look at another page: fitted, if its size is not that of the last one."""
        size = (paper.width_mm, paper.height_mm)
        if size != (self._paper.width_mm, self._paper.height_mm):
            self._paper = paper
            self.fit()

    def resize(self, size_px: Size) -> None:
        """Take the canvas's new size; what was in the middle stays there."""
        size_px = (max(size_px[0], 1), max(size_px[1], 1))
        if size_px != self._size_px:
            self._size_px = size_px
            if self.following:
                self.fit()

    def fit(self) -> None:
        """Show the whole page, turned as it is."""
        self.following, self._to_go = True, 0.0
        self.camera = self._fitted()

    def look(self, camera: Camera, *, whole_page: bool) -> None:
        """Look as a camera does, as far as the page allows; `whole_page` fits it, turned so."""
        self.camera = camera
        if whole_page:
            self.fit()
            return
        self.following, self._to_go = False, 0.0
        low, high = self._limits()
        self.camera = replace(camera, px_per_mm=min(max(camera.px_per_mm, low), high))
        self._hold()

    def show_box(self, low_mm: Point, high_mm: Point) -> None:
        """Show a rectangle of the page as large as it fits."""
        self.following, self._to_go = False, 0.0
        margin = MARGIN * min(self._size_px)
        camera = self.camera.fitted(low_mm, high_mm, self._size_px, margin)
        low, high = self._limits()
        self.camera = replace(camera, px_per_mm=min(max(camera.px_per_mm, low), high))
        self._hold()

    def print_size(self, px_per_mm: float) -> None:
        """Show the page as large as it will be printed, about the middle of the canvas."""
        self.following, self._to_go = False, 0.0
        self.camera = replace(self.camera, px_per_mm=px_per_mm)
        self._hold()

    def zoom_to(self, px_per_mm: float) -> None:
        """Show the page at a scale, about the middle of the canvas, within limits."""
        self.following, self._to_go = False, 0.0
        low, high = self._limits()
        self.camera = replace(self.camera, px_per_mm=min(max(px_per_mm, low), high))
        self._hold()

    def centre(self, at_mm: Point) -> None:
        """Bring a point of the page to the middle of the canvas."""
        self.following, self._to_go = False, 0.0
        self.camera = replace(self.camera, center_mm=at_mm)
        self._hold()

    def pan(self, delta_px: Point) -> None:
        """Move the page by a vector on the screen; part of it stays in sight."""
        self.following = False
        self.camera = self.camera.panned(delta_px)
        self._hold()

    def turn(self, by_rad: float) -> None:
        """Turn the page on the screen, clockwise, about the middle of the canvas."""
        self.turn_to(self.camera.rotation_rad + by_rad)

    def turn_to(self, angle_rad: float) -> None:
        """Turn the page so far from upright; whole degrees are met exactly."""
        if not math.isfinite(angle_rad):
            return
        angle = math.remainder(angle_rad, math.tau)
        degrees = math.degrees(angle)
        if abs(degrees - round(degrees)) < _EXACT_DEG:
            angle = math.radians(round(degrees))
        self.camera = replace(self.camera, rotation_rad=angle)

    def drag_round(self, from_px: Point, to_px: Point) -> None:
        """Turn the page as a pointer drags it round the middle of the canvas."""
        middle = (self._size_px[0] / 2, self._size_px[1] / 2)
        a, b = ((at[0] - middle[0], at[1] - middle[1]) for at in (from_px, to_px))
        if min(math.hypot(*a), math.hypot(*b)) >= _AXLE_PX:  # nearer, a pixel is a leap
            self.turn(math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]))

    def flip(self) -> None:
        """Mirror what is seen, left to right, about the middle of the canvas."""
        middle = (self._size_px[0] / 2, self._size_px[1] / 2)
        self.camera = self.camera.flipped(middle, self._size_px)

    def upright(self) -> None:
        """Neither turned nor mirrored; the middle of the canvas stays."""
        self.camera = replace(self.camera, rotation_rad=0.0, flip=False)

    def zoom(self, factor: float, at_px: Point) -> None:
        """Ask for a larger or smaller page; it gets there over the next frames."""
        if not (math.isfinite(factor) and factor > 0):
            return
        self.following = False
        low, high = self._limits()
        now = math.log(self.camera.px_per_mm)
        target = min(max(now + self._to_go + math.log(factor), math.log(low)), math.log(high))
        self._to_go, self._at_px = target - now, at_px

    def advance(self, dt_s: float) -> bool:
        """Go on with a smooth zoom; return whether the camera moved."""
        if not self._to_go:
            return False
        share = 1.0 - math.exp(-max(dt_s, 0.0) / _SETTLE_S)
        step = self._to_go * share
        if abs(self._to_go - step) < _CLOSE_ENOUGH:
            step = self._to_go
        self._to_go -= step
        self.camera = self.camera.zoomed(math.exp(step), self._at_px, self._size_px)
        self._hold()
        return True

    def at(self, x_px: float, y_px: float) -> Point:
        """Return the point of the page under a pixel of the canvas."""
        x, y = self.camera.screen_to_page((x_px, y_px), self._size_px)
        return float(x), float(y)

    def _fitted(self) -> Camera:
        page = (self._paper.width_mm, self._paper.height_mm)
        margin = MARGIN * min(self._size_px)
        return self.camera.fitted((0.0, 0.0), page, self._size_px, margin)

    def _limits(self) -> tuple[float, float]:
        fitted = self._fitted().px_per_mm
        return fitted * SMALLEST_OF_FIT, max(MAX_PX_PER_MM, fitted)

    def _hold(self) -> None:
        """Keep the middle of the canvas on the page."""
        x, y = self.camera.center_mm
        center = (min(max(x, 0.0), self._paper.width_mm), min(max(y, 0.0), self._paper.height_mm))
        if center != (x, y):
            self.camera = replace(self.camera, center_mm=center)
