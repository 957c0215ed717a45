"""The raster that dots are laid out on: the page with a bleed around it.

Printers let a picture run over the edge of the page and trim it. So do dots: relaxed on the page
alone they would line up along its edge, half a spacing inside it, and leave a light rim. The
bleed repeats the picture's border mirrored; dots in it are trimmed, those that still reach into
the page are drawn back to its edge. Lengths are pixels of the raster's own resolution.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.reference import Reference
from stippler.drawing.style import MAX_DOTS
from stippler.errors import ParameterError
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tone.darkness_levels import look_up_levels
from stippler.kernels.tone.pixel_owner import onto_ink, sample
from stippler.stippling.compartments import Shape
from stippler.stippling.density import DensityField
from stippler.stippling.halftone import CELLS_PER_DOT, ink_box
from stippler.stippling.tessellation import Making, Tessellation
from stippler.stippling.tone import DotRule, rule_for
from stippler.stippling.window import Tones, Window

BLEED_SPACINGS = 3.0  # mean spacings
LEAST_WIDTH = 4.0  # mean spacings; a narrower page would be nearly all rim
FEWEST_WITH_BLEED = 500  # below this a bleed is not worth it
_LEVELS = 65_535
_MOST_CELLS = 100_000_000  # of a halftone, whose cells are as fine as its densest part asks for
_FARTHEST = 2.0  # radii beyond the edge from which a dot is drawn back to it, at most
_WEIGHED = 8.0  # pixels of the densest dots' cells by which these are weighed, at least
_BAND, _BANDS = 16_384, 64  # dots that numpy is given at a time: they fit the cache; at most
_INSIDE = 1e-9  # of the page; no dot lies on its edge itself


@dataclass(frozen=True, slots=True, eq=False)
class PageRaster:
    """A reference at the resolution its dots need, its bleed, and the rule for the dots.

    Attributes
    ----------
    darkness : (h, w) float32, read-only
        Of the page.
    bleed : int
        Pixels around the page.
    rule : DotRule
        In pixels.
    pixel_mm : float
    size_mm : (float, float)
        Of the page.
    divided : int
        Pixels a side that each pixel of the picture was divided into.
    """

    darkness: NDArray[np.float32]
    bleed: int
    rule: DotRule
    pixel_mm: float
    size_mm: tuple[float, float]
    divided: int = 1

    @classmethod
    def of(
        cls,
        reference: Reference | Tones,
        n_dots: int | None,
        size_range_mm: tuple[float, float] | None,
        bleeds: bool,
        faintest: float | None = None,
    ) -> PageRaster:
        """Prepare a reference for so many dots or dots of such sizes; `faintest` as in a rule."""
        width, height = reference.width_mm, reference.height_mm
        guess = n_dots or _number_for(reference, size_range_mm)
        if guess > MAX_DOTS:
            raise ParameterError(
                f"about {guess:,} dots of this size would be needed", "size range",
                f"allow larger ones; {MAX_DOTS:,} can be drawn",
            )  # fmt: skip
        window = Window.of_page(reference, guess)
        darkness, pixel_mm = window.darkness, window.pixel_mm
        size_px = None
        if size_range_mm is not None:
            size_px = (size_range_mm[0] / pixel_mm, size_range_mm[1] / pixel_mm)
        bleed = 0
        spacing = math.sqrt(darkness.size / guess)
        wide = min(darkness.shape) >= LEAST_WIDTH * spacing
        if bleeds and wide and guess >= FEWEST_WITH_BLEED and _border(darkness).any():
            bleed = math.ceil(BLEED_SPACINGS * spacing)
        border = _border(darkness) if bleed else darkness[0, :0]
        rule = rule_for(darkness, n_dots, size_px, border, faintest=faintest)
        share = _share_that_fits(rule, darkness, bleed, guess)
        if share < 1.0 and size_px is None:
            n_dots = max(int(share * guess), 1)
            rule = rule_for(darkness, n_dots, None, border, faintest=faintest)
        elif share < 1.0:
            rule = replace(rule, thin=share * rule.thin)
        return cls(
            darkness, bleed, rule, pixel_mm, (width, height), max(1, round(1.0 / window.scale))
        )

    def density(self) -> NDArray[np.float32]:
        """Dots per square pixel, bleed included; white stays exactly 0."""
        darkest = float(self.darkness.max()) or 1.0
        table = self.rule.density(np.linspace(0.0, darkest, _LEVELS + 1)).astype(np.float32)
        density = np.empty(self.darkness.shape, np.float32)
        scale = float(np.float32(_LEVELS / darkest))
        rows = len(density)
        parallel_for(look_up_levels, rows, self.darkness, scale, table, density, grain=64)
        return self.with_bleed(density)

    def ink_field(self) -> DensityField:
        """Return the darkness as a weight of the page, bleed included, in mm.

        Where a dot's cell has far more pixels than tell where its ink lies, blocks are averaged. A
        picture whose pixels were divided for its dots is taken as it came: it weighs the same.
        """
        if self.divided > 1:
            k = self.divided
            values, bleed = self.darkness[::k, ::k], -(-self.bleed // k)
            if bleed:
                values = np.pad(values, bleed, mode="symmetric")
        else:
            densest = float(self.rule.density(np.linspace(0.0, 1.0, 257)).max())
            k = max(int(math.sqrt(1.0 / max(_WEIGHED * densest, 1e-9))), 1)
            k = min(k, *self.darkness.shape)
            values, bleed = _blocks(self.darkness, k, self.bleed)
        pixel_mm = k * self.pixel_mm
        return DensityField(values, pixel_mm, (-bleed * pixel_mm, -bleed * pixel_mm))

    def with_bleed(self, field: NDArray[np.float32]) -> NDArray[np.float32]:
        """Repeat a field of the page in the bleed, mirrored."""
        return np.pad(field, self.bleed, mode="symmetric") if self.bleed else field

    def outline_mm(self) -> NDArray[np.float64]:
        """Corners of the raster, bleed included; the page's top left is the origin."""
        b = self.bleed * self.pixel_mm
        w, h = self.size_mm
        return np.array([(-b, -b), (w + b, -b), (w + b, h + b), (-b, h + b)])

    def trim(self, points: NDArray[np.float64], n_wanted: int | None) -> NDArray[np.float64]:
        """Return the dots of the page: those in it, and those in the bleed that reach into it.

        The latter go to the page's edge; how far they have to reach is chosen so that there are
        `n_wanted` dots, as nearly as possible.
        """
        size = np.array(self.size_mm) / self.pixel_mm
        at = np.clip(points, _INSIDE * size, (1.0 - _INSIDE) * size)
        if not self.bleed:
            return at
        out = np.hypot(points[:, 0] - at[:, 0], points[:, 1] - at[:, 1])
        beyond = np.flatnonzero(out > 0.0)
        depth = out[beyond] / self.radii(at[beyond])
        rank = np.argsort(depth, kind="stable")
        n_kept, n_over = int(np.searchsorted(depth[rank], DotRule.BLEED_REACH)), 0
        if n_wanted is not None:
            room = n_wanted - (len(points) - len(beyond))
            n_over = max(-room, 0)
            n_kept = min(max(room, 0), int(np.searchsorted(depth[rank], _FARTHEST)))
        drop = np.zeros(len(points), bool)
        drop[beyond[rank[n_kept:]]] = True
        if n_over:  # those of the page alone are too many: leave out the ones nearest to its edge
            inner = np.flatnonzero(out == 0.0)
            inwards = np.minimum(points[inner], size - points[inner]).min(axis=1)
            drop[inner[np.argsort(inwards, kind="stable")[:n_over]]] = True
        kept: NDArray[np.float64] = at[~drop]
        return kept

    def radii(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the radius that the rule gives each dot of the page."""
        radii = np.empty(len(points))

        def part(start: int, stop: int) -> None:
            radii[start:stop] = self.rule.radius(self.darkness_under(points[start:stop]))

        parallel_for(part, len(points), grain=_BAND, chunks=_BANDS)
        return radii

    def cells(
        self,
        points: NDArray[np.float64],
        which: NDArray[np.integer] | None = None,
        depth: float = math.inf,
    ) -> Making:
        """Compute the cells of dots on the page, in pixels, with the ink they ask for as mass.

        Parameters
        ----------
        points : (n, 2) float64, pixels
        which : (k,) int, optional
            Only of these.
        depth : float, pixels
            How far from the page's edge the dots lie at most: their cells go no farther.
        """
        (h, w), k = self.darkness.shape, self.divided
        page: Shape = np.array([(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)])
        if 2.0 * depth < min(w, h):
            page = shapely.box(0.0, 0.0, w, h) - shapely.box(depth, depth, w - depth, h - depth)
        at = np.clip(points, 0.0, (w, h))
        ink = DensityField(self.darkness[::k, ::k], float(k))  # pixels as they came weigh the same
        return Tessellation.making(at, page, None, ink, which)

    def wanted_at(
        self, points: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the radius and the density that the rule gives where each dot of the page lies."""
        radii, density = np.empty(len(points)), np.empty(len(points))

        def part(start: int, stop: int) -> None:
            values = self.darkness_under(points[start:stop])
            radii[start:stop] = self.rule.radius(values)
            density[start:stop] = self.rule.density(values)

        parallel_for(part, len(points), grain=_BAND, chunks=_BANDS)
        return radii, density

    def density_under(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the density that the rule gives where dots lie; 0 beyond the bleed."""
        h, w = self.darkness.shape
        mirrored = np.column_stack([
            _mirrored(points[:, axis], float(size)) for axis, size in ((0, w), (1, h))
        ])  # fmt: skip
        density: NDArray[np.float64] = self.rule.density(self.darkness_under(mirrored))
        beyond = np.abs(points - 0.5 * np.array([w, h])) > 0.5 * np.array([w, h]) + self.bleed
        density[beyond[:, 0] | beyond[:, 1]] = 0.0
        return density

    def darkness_under(self, points: NDArray[np.float64]) -> NDArray[np.float32]:
        """Return the darkness of the pixels of the page that dots lie on."""
        values = np.empty(len(points), np.float32)
        points = np.ascontiguousarray(points)
        parallel_for(sample, len(points), points, self.darkness, values)
        return values

    def onto_ink(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Move dots off pixels that are white, to the nearest that is not."""
        points = np.array(points)
        moved = np.empty(len(points), np.uint8)
        reach = max(self.darkness.shape)
        parallel_for(onto_ink, len(points), points, self.darkness, reach, moved)
        is_left = moved != 2
        if is_left.all():
            return points
        kept: NDArray[np.float64] = points[is_left]
        return kept

    def on_page(
        self, points: NDArray[np.float64], radii: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        """Return fresh read-only arrays in mm."""
        position = np.minimum(points * self.pixel_mm, self.size_mm)
        radius = (radii * self.pixel_mm).astype(np.float32)
        position.flags.writeable = False
        radius.flags.writeable = False
        return position, radius


def _share_that_fits(
    rule: DotRule, darkness: NDArray[np.float32], bleed: int, n_dots: int
) -> float:
    """Return the share of the dots that can be drawn, where little of the page holds them all."""
    densest = float(rule.density(np.linspace(0.0, float(darkness.max()), 257)).max())
    rows, columns = ink_box(darkness)
    h, w = rows.stop - rows.start, columns.stop - columns.start
    n_cells = CELLS_PER_DOT * densest * (h + 2 * bleed) * (w + 2 * bleed)
    return float(max(_MOST_CELLS, 16 * CELLS_PER_DOT * n_dots) / max(n_cells, 1.0))


def _blocks(field: NDArray[np.float32], k: int, bleed: int) -> tuple[NDArray[np.float32], int]:
    """Return the means of blocks of k x k pixels, and how many of them the bleed has.

    The bleed repeats the field, mirrored, and so does what the last blocks lack.
    """
    n = -(-bleed // k)
    pads = [(n * k, n * k + -size % k) for size in field.shape]
    if any(map(any, pads)):
        field = np.pad(field, pads, mode="symmetric")
    if k == 1:
        return field, n
    h, w = (size // k for size in field.shape)
    return field.reshape(h, k, w, k).mean(axis=(1, 3), dtype=np.float32), n


def _mirrored(x: NDArray[np.float64], size: float) -> NDArray[np.float64]:
    """Return where on the page the bleed's places are repeated from, along one axis."""
    inside = np.abs(x)
    back: NDArray[np.float64] = np.clip(size - np.abs(size - inside), 0.0, size)
    return back


def _border(darkness: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the pixels along the edge of the page; corners count twice."""
    return np.concatenate((darkness[0], darkness[-1], darkness[:, 0], darkness[:, -1]))


def _number_for(reference: Reference | Tones, size_range_mm: tuple[float, float] | None) -> int:
    """Return how many dots of these sizes a reference takes, about."""
    if size_range_mm is None:
        return FEWEST_WITH_BLEED
    mean_area = math.pi * (0.5 * (size_range_mm[0] + size_range_mm[1])) ** 2
    ink = float(reference.darkness.mean(dtype=np.float64))
    return max(1, int(ink * reference.width_mm * reference.height_mm / mean_area))
