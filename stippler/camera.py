"""Where the page stands on the screen: plain data, no GL.

Page coordinates are millimetres and screen coordinates pixels; in both the origin is at the top
left, x runs right and y down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

MIN_PX_PER_MM = 1e-3
MAX_PX_PER_MM = 1e5

Point = tuple[float, float]
Size = tuple[int, int]


class Paper(Protocol):
    """Anything with a width and a height in mm, such as a drawing's page."""

    @property
    def width_mm(self) -> float: ...  # noqa: D102
    @property
    def height_mm(self) -> float: ...  # noqa: D102


@dataclass(frozen=True, slots=True)
class Camera:
    """A view of the page: centred on a point, scaled, turned, perhaps seen in a mirror.

    Attributes
    ----------
    center_mm : (x, y)
        The point of the page in the middle of the screen.
    px_per_mm : float
    rotation_rad : float
        Turns the page on the screen, from x towards y (clockwise, as y runs down).
    flip : bool
        Mirrors the page left to right, before it is turned.
    """

    center_mm: Point
    px_per_mm: float
    rotation_rad: float = 0.0
    flip: bool = False

    @classmethod
    def fit(cls, paper: Paper, size_px: Size, margin_px: float = 0.0) -> Camera:
        """Show the whole page, as large as it fits inside a margin."""
        whole = cls((0.0, 0.0), 1.0)
        return whole.fitted((0.0, 0.0), (paper.width_mm, paper.height_mm), size_px, margin_px)

    def fitted(
        self, low_mm: Point, high_mm: Point, size_px: Size, margin_px: float = 0.0
    ) -> Camera:
        """Show a rectangle of the page as large as it fits inside a margin, turned as before."""
        width, height = high_mm[0] - low_mm[0], high_mm[1] - low_mm[1]
        c, s = abs(math.cos(self.rotation_rad)), abs(math.sin(self.rotation_rad))
        box = (c * width + s * height, s * width + c * height)
        scale = min(max(size_px[i] - 2 * margin_px, 1.0) / max(box[i], 1e-9) for i in (0, 1))
        center = ((low_mm[0] + high_mm[0]) / 2, (low_mm[1] + high_mm[1]) / 2)
        return replace(self, center_mm=center, px_per_mm=_held(scale))

    def linear(self) -> NDArray[np.float64]:
        """Return the (2, 2) matrix that takes a page vector in mm to screen pixels."""
        c = math.cos(self.rotation_rad) * self.px_per_mm
        s = math.sin(self.rotation_rad) * self.px_per_mm
        x = -1.0 if self.flip else 1.0
        return np.array([[c * x, -s], [s * x, c]])

    def page_to_screen(self, points_mm: ArrayLike, size_px: Size) -> NDArray[np.float64]:
        """Return where points of the page, (..., 2), lie on a screen of `size_px`."""
        offset = np.asarray(points_mm, np.float64) - self.center_mm
        return np.asarray(offset @ self.linear().T + np.asarray(size_px) / 2)

    def screen_to_page(self, points_px: ArrayLike, size_px: Size) -> NDArray[np.float64]:
        """Return the points of the page under pixels, (..., 2); undoes `page_to_screen`."""
        offset = np.asarray(points_px, np.float64) - np.asarray(size_px) / 2
        inverse = self.linear().T / self.px_per_mm**2
        return np.asarray(offset @ inverse.T + self.center_mm)

    def zoomed(self, factor: float, at_px: Point, size_px: Size) -> Camera:
        """Scale by a factor, within limits; the page's point under `at_px` stays there."""
        held = replace(self, px_per_mm=_held(self.px_per_mm * factor))
        return held._moved(self.screen_to_page(at_px, size_px), at_px, size_px)

    def panned(self, delta_px: Point) -> Camera:
        """Move the page by a vector on the screen."""
        inverse = self.linear().T / self.px_per_mm**2
        dx, dy = inverse @ np.asarray(delta_px, np.float64)
        return replace(self, center_mm=(self.center_mm[0] - dx, self.center_mm[1] - dy))

    def flipped(self, at_px: Point, size_px: Size) -> Camera:
        """Mirror the screen left to right about the vertical through `at_px`."""
        mirrored = replace(self, flip=not self.flip, rotation_rad=-self.rotation_rad)
        return mirrored._moved(self.screen_to_page(at_px, size_px), at_px, size_px)

    def tile(self, origin_px: Point, tile_px: Size, size_px: Size) -> Camera:
        """Return the camera of a smaller screen cut out of one of `size_px` at `origin_px`."""
        middle = (origin_px[0] + tile_px[0] / 2, origin_px[1] + tile_px[1] / 2)
        x, y = self.screen_to_page(middle, size_px)
        return replace(self, center_mm=(float(x), float(y)))

    def matrix(self, size_px: Size) -> NDArray[np.float32]:
        """Return the (3, 3) matrix from (x_mm, y_mm, 1) to GL's clip space, y up."""
        to_clip = np.array([[2 / size_px[0]], [-2 / size_px[1]]])
        out = np.eye(3)
        out[:2, :2] = to_clip * self.linear()
        out[:2, 2] = -out[:2, :2] @ np.asarray(self.center_mm)
        return out.astype(np.float32)

    def _moved(self, point_mm: NDArray[np.float64], to_px: Point, size_px: Size) -> Camera:
        """Bring a point of the page under a pixel."""
        x, y = self.page_to_screen(point_mm, size_px)
        return self.panned((to_px[0] - float(x), to_px[1] - float(y)))


def _held(scale: float) -> float:
    return min(max(scale, MIN_PX_PER_MM), MAX_PX_PER_MM)
