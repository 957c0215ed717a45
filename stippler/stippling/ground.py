"""What dots are laid out on: the page with its bleed, or the part of the page that is an area's."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.reference import Reference
from stippler.drawing.style import MAX_DOTS, WALL, Style
from stippler.kernels.halftone.scan_order import outside_polygon
from stippler.stippling.compartments import Compartments, Shape
from stippler.stippling.default_number import with_number
from stippler.stippling.density import DensityField
from stippler.stippling.field_sums import Weights
from stippler.stippling.halftone import DROPPED
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.picture_field import PictureField
from stippler.stippling.postprocess import at_edge, even_rim
from stippler.stippling.style_tone import curves_of, toned
from stippler.stippling.tessellation import Making, Tessellation
from stippler.stippling.tone import DotRule
from stippler.stippling.window import Tones, Window

if TYPE_CHECKING:
    from stippler.drawing.partition import Outline
    from stippler.stippling.area_bleed import Rim

Floats = NDArray[np.float64]
Within = tuple[Compartments, NDArray[np.int32]]

_INSET = 1e-4  # of a pixel; how far within the border a dot lies that was brought back
_LEAST_SIDE = 48  # pixels a side of an area's window, at least: its outline is cut out of them
_DOTS_PER_PIXEL = 0.1
_NOBODY = np.empty((0, 2))
_FEWEST = 500
_GRID_RADII = (0.1, 0.75)  # of the largest, and of the spacing: sizes carry all of the tone there


@dataclass(frozen=True, slots=True, eq=False)
class Evened:
    """Dots that were moved across edges that bleed.

    Attributes
    ----------
    points : (n, 2) float64, pixels
    beside : (n,) bool
        Those that have to do with the edges.
    around : (n,) bool or None
        Those, and all that may lie close to them; None is everyone.
    """

    points: Floats
    beside: NDArray[np.bool_]
    around: NDArray[np.bool_] | None = None


class Ground(Protocol):
    """Where dots may lie. Points are pixels of `raster` or, where said so, mm from its corner."""

    raster: PageRaster
    style: Style
    origin_mm: tuple[float, float]

    @property
    def outline_mm(self) -> Shape:
        """What bounds the dots while they are relaxed, in mm from the corner."""
        ...

    def inside(self, at_mm: Floats) -> Floats:
        """Bring places in mm from the corner into the outline."""
        ...

    def ink_field(self) -> Weights:
        """Return the darkness as a weight, in mm from the corner."""
        ...

    def tone_field(self) -> Weights:
        """Return the darkness that sizes are to meet, in mm from the corner."""
        ...

    def on_page(self, at_mm: Floats) -> Floats:
        """Return where places in mm from the corner lie on the page, read-only."""
        ...

    def within(self, points: Floats) -> Within | None:
        """Return the compartments, in pixels, and that of each dot; None is the page."""
        ...

    def cells(self, points: Floats) -> Making:
        """Compute the dots' cells, in pixels, with the ink they ask for as mass."""
        ...

    @property
    def bleeds(self) -> bool:
        """Whether dots are laid out beyond an edge, and trimmed."""
        ...

    @property
    def evens_rim(self) -> bool:
        """Whether there is an edge that dots run off."""
        ...

    @property
    def beyond(self) -> Floats:
        """Dots of others that are seen across a border, in pixels."""
        ...

    @property
    def sized_among(self) -> Floats:
        """Dots of others among whose cells the sizes are solved, in pixels."""
        ...

    def open_to_dots(self, density: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return dots per square pixel without any where others' dots are seen."""
        ...

    @property
    def after_trim(self) -> Ground:
        """What trimmed dots lie on."""
        ...

    def trimmed(self, points: Floats, n_wanted: int | None) -> Floats:
        """Return the dots that are left once the bleed is cut off, in pixels of `after_trim`."""
        ...

    def rim_evened(self, points: Floats, give: float) -> Evened:
        """Even out the ink along edges that bleed; tell which dots have to do with them."""
        ...


class PageGround:
    """The page; with its bleed, unless the dots to come are just those that are there."""

    origin_mm = (0.0, 0.0)

    def __init__(self, reference: Reference, style: Style, *, with_bleed: bool = True) -> None:
        seen = toned(reference, style)
        self.style = with_number(counted(style, seen.width_mm * seen.height_mm), seen)
        self.raster = raster_for(seen, self.style)
        w, h = self.raster.size_mm
        page = np.array([(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)])
        self._outline = self.raster.outline_mm() if with_bleed else page

    @property
    def outline_mm(self) -> Shape:
        """The corners of the page, or of its bleed."""
        return self._outline

    def inside(self, at_mm: Floats) -> Floats:
        """Bring places onto the page, or its bleed."""
        return np.clip(at_mm, self._outline[0], self._outline[2])

    def ink_field(self) -> Weights:
        """Return the darkness as a weight, mirrored in the bleed."""
        return self.raster.ink_field()

    def tone_field(self) -> Weights:
        """Return the darkness by the raster's own pixels."""
        return DensityField(self.raster.darkness, self.raster.pixel_mm)

    def on_page(self, at_mm: Floats) -> Floats:
        """Return the places as they are."""
        return at_mm

    def within(self, points: Floats) -> Within | None:
        """Return None: dots at the edge slide along it."""
        return None

    def cells(self, points: Floats) -> Making:
        """Compute the dots' cells on the page."""
        return self.raster.cells(points)

    @property
    def bleeds(self) -> bool:
        """Whether the page has a bleed."""
        return self.raster.bleed > 0

    @property
    def evens_rim(self) -> bool:
        """Whether the page has a bleed."""
        return self.bleeds

    @property
    def beyond(self) -> Floats:
        """Return none: nobody is beyond the page."""
        return _NOBODY

    @property
    def sized_among(self) -> Floats:
        """Return none."""
        return _NOBODY

    def open_to_dots(self, density: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the density as it is."""
        return density

    @property
    def after_trim(self) -> Ground:
        """Return itself."""
        return self

    def trimmed(self, points: Floats, n_wanted: int | None) -> Floats:
        """Return the dots of the page."""
        return self.raster.trim(points, n_wanted)

    def rim_evened(self, points: Floats, give: float) -> Evened:
        """Even out the ink along the page's edge."""
        evened = even_rim(points, self.raster, give)
        return Evened(evened, at_edge(evened, self.raster))


class AreaGround:
    """The part of the page that is an area's, on the window of the picture that lies under it.

    Parameters
    ----------
    reference : Reference
        Of the whole page; only the window is looked at.
    outline_mm : shapely Polygon or MultiPolygon
        On the page.
    bleed_mm : float
        How far around the page the picture goes on.
    """

    rim: Rim | None = None
    """Where dots may bleed, once they are trimmed."""

    bleeds = evens_rim = False

    beyond = _NOBODY
    """Dots of others that are seen across the border, in pixels."""

    def __init__(
        self, reference: Reference, style: Style, outline_mm: Outline, bleed_mm: float = 0.0
    ) -> None:
        from stippler.stippling.halftone_area import edges_of

        box, curves = outline_mm.bounds, curves_of(style)
        style = counted(style, outline_mm.area)
        n_box = _number_in_box(style, outline_mm)
        window = Window.of(reference, box, n_box, *curves, bleed_mm=bleed_mm)
        self.origin_mm = window.origin_mm
        self._outline = shapely.transform(outline_mm, lambda xy: xy - window.origin_mm)
        k = _division(window.darkness.shape, n_box)
        masked = np.repeat(np.repeat(window.darkness, k, 0), k, 1)
        pixel_mm = window.pixel_mm / k
        outside_polygon(edges_of(self._outline) / pixel_mm, masked)
        local = Tones(masked, pixel_mm * masked.shape[1])
        page_mm2 = reference.width_mm * reference.height_mm
        self.style = with_number(style, local, page_mm2)
        self.raster = raster_for(local, self.style, bleeds=False)
        x0, y0 = self.origin_mm
        field = PictureField.of(reference, (curves,), bleed_mm=bleed_mm)
        self._field = replace(field, origin_mm=(-x0, -y0))
        self._parts = Compartments.of(shapely.transform(self._outline, self._to_px))
        self.on_page_mm = outline_mm
        self.sized_among = _NOBODY
        self._sized_in = self._parts
        shapely.prepare([self._outline, outline_mm])

    def see(self, outline_mm: Outline, position_mm: Floats) -> None:
        """Let dots be sized among others that are seen across the border.

        Parameters
        ----------
        outline_mm : polygon
            The area and what is seen.
        position_mm : (k, 2) float64
            Of the dots there.
        """
        local = shapely.transform(outline_mm, lambda xy: self._to_px(xy - self.origin_mm))
        self._sized_in = Compartments.of(local)
        self.sized_among = self._to_px(position_mm - np.array(self.origin_mm))

    def _to_px(self, xy: Floats) -> Floats:
        return np.asarray(xy / self.raster.pixel_mm)

    @property
    def outline_mm(self) -> Shape:
        """The area's, from the window's corner."""
        return self._outline

    def inside(self, at_mm: Floats) -> Floats:
        """Bring places that lie outside just within the border next to them."""
        out = np.flatnonzero(~shapely.contains_xy(self._outline, at_mm[:, 0], at_mm[:, 1]))
        if not len(out):
            return at_mm
        at = at_mm.copy()
        at[out] = brought_into(self._outline, at_mm[out], _INSET * self.raster.pixel_mm)
        return at

    def ink_field(self) -> Weights:
        """Return the darkness as a weight; cells are cut at the border, it is not."""
        return self._field

    def tone_field(self) -> Weights:
        """Return the darkness of the picture."""
        return self._field

    def on_page(self, at_mm: Floats) -> Floats:
        """Return where places in mm from the corner lie on the page: within the outline there."""
        at: Floats = at_mm + np.array(self.origin_mm)
        out = np.flatnonzero(~shapely.contains_xy(self.on_page_mm, at[:, 0], at[:, 1]))
        if len(out):
            at[out] = brought_into(self.on_page_mm, at[out], _INSET * self.raster.pixel_mm)
        at.flags.writeable = False
        return at

    def within(self, points: Floats) -> Within | None:
        """Return the parts of the area, and that of each dot."""
        return self._parts, self._parts.find(points, None)

    def cells(self, points: Floats, which: NDArray[np.intp] | None = None) -> Making:
        """Compute the dots' cells, cut at the border, or with those that are seen across it.

        Or those of the dots `which` alone.
        """
        side = self.raster.pixel_mm
        (w, h), (x, y) = self._field.pixel_mm, self._field.origin_mm
        field = replace(self._field, pixel_mm=(w / side, h / side), origin_mm=(x / side, y / side))
        return Tessellation.making(points, list(self._sized_in.polygons), None, field, which)

    @property
    def after_trim(self) -> Ground:
        """Return itself."""
        return self

    def trimmed(self, points: Floats, n_wanted: int | None) -> Floats:
        """Return all dots, those that lie outside brought back."""
        side = self.raster.pixel_mm
        return self.inside(self.raster.trim(points, n_wanted) * side) / side

    def open_to_dots(self, density: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the density as it is."""
        return density

    def rim_evened(self, points: Floats, give: float) -> Evened:
        """Even out the ink along the lines that bleed."""
        assert self.rim is not None, "nothing bleeds"
        return self.rim.evened(self, points, give)


def raster_for(reference: Reference | Tones, style: Style, *, bleeds: bool = True) -> PageRaster:
    """Prepare the raster that a style lays its dots out on."""
    by_region = style.sizes == "regions"
    raster = PageRaster.of(
        reference,
        style.n_dots,
        style.size_range_mm,
        bleeds=bleeds
        and style.weighted
        and style.is_relaxed
        and not by_region
        and style.border != WALL,
        faintest=DROPPED if by_region else None,
    )
    if style.is_grid and style.n_dots is not None and style.size_range_mm is None:
        inked = max(int(np.count_nonzero(raster.darkness)), 1)
        largest = _GRID_RADII[1] * math.sqrt(inked / style.n_dots)
        raster = replace(raster, rule=DotRule(_GRID_RADII[0] * largest, largest))
    return raster


def without_dots_at(density: NDArray[np.float32], points: Floats) -> NDArray[np.float32]:
    """Return dots per square pixel without the room of dots that are there, in its pixels."""
    from scipy.ndimage import distance_transform_edt  # a quarter of a second to import

    h, w = density.shape
    x, y = points.astype(np.intp).T
    free = np.ones(density.shape, np.bool_)
    free[np.clip(y, 0, h - 1), np.clip(x, 0, w - 1)] = False
    distance = distance_transform_edt(free)
    density[np.pi * np.square(distance) * density < 1.0] = 0.0
    return density


def counted(style: Style, mm2: float) -> Style:
    """Return a style whose density has become a number for so large an area."""
    if style.density_per_cm2 is None:
        return style
    n_dots = min(max(round(style.density_per_cm2 * mm2 / 100.0), 1), MAX_DOTS)
    return replace(style, n_dots=n_dots, density_per_cm2=None)


def _number_in_box(style: Style, outline_mm: Outline) -> int:
    """Return how many dots an area's box would have, about: its window is as fine as they ask."""
    x0, y0, x1, y1 = outline_mm.bounds
    n_dots = float(style.n_dots or 0)
    if style.size_range_mm is not None and not n_dots:
        n_dots = outline_mm.area / (math.pi * style.size_range_mm[0] ** 2)
    share = (x1 - x0) * (y1 - y0) / max(outline_mm.area, 1e-12)
    return max(int(min(n_dots * share, 4.0 * MAX_DOTS)), _FEWEST)


def _division(shape: tuple[int, ...], n_box: int) -> int:
    """Return by how much pixels are divided: an outline is cut out of whole ones."""
    per_dot = math.sqrt(n_box / (_DOTS_PER_PIXEL * shape[0] * shape[1]))
    return max(math.ceil(per_dot), math.ceil(_LEAST_SIDE / min(shape)))


def brought_into(outline: Outline, at: Floats, inset: float) -> Floats:
    """Return the places within an outline next to places outside, so far within its border."""
    inner = outline
    for share in (1.0, 0.1, 0.01):
        smaller = shapely.buffer(outline, -share * inset)
        if not smaller.is_empty:
            inner = smaller
            break
    lines = shapely.shortest_line(inner, shapely.points(at))
    return np.asarray(shapely.get_coordinates(lines)[::2])
