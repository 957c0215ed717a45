"""What print would do to a drawing, found before it is exported, and repairs that keep its tone.

Everything is measured at the size of print: a reduction makes dots and gaps smaller.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import FREE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import ParameterError
from stippler.files.write.raster import bit_strips, grey_strips
from stippler.files.write.sheet import Sheet, sheet_of

Rows = NDArray[np.int64]

_FINE_DPI = 150.0  # of the picture that a 1-bit raster is held against; 64 samples a pixel
_PART_ROUNDS = 60


@dataclass(frozen=True, slots=True)
class Process:
    """What a press, plotter or publisher can do, in mm of print.

    Attributes
    ----------
    print_width_mm : float or None
        None: as large as drawn.
    least_dot_mm : float
        Diameter below which dots are lost.
    least_gap_mm : float
        White between two dots below which it fills up.
    gain_mm : float
        How much every edge grows as ink spreads.
    dpi : float or None
        Of the 1-bit picture, if there is one.
    """

    print_width_mm: float | None = None
    least_dot_mm: float = 0.1
    least_gap_mm: float = 0.05
    gain_mm: float = 0.01
    dpi: float | None = None

    def __post_init__(self) -> None:
        for name in ("least_dot_mm", "least_gap_mm", "gain_mm"):
            value = getattr(self, name)
            if not (math.isfinite(value) and 0 <= value <= 10):
                raise ParameterError(f"{value:g} mm is none", name[:-3], "give 0 to 10 mm")

    def scale(self, drawing: Drawing) -> float:
        """Return how much larger than drawn it is printed."""
        if self.print_width_mm is None:
            return 1.0
        return self.print_width_mm / drawing.page.width_mm


@dataclass(frozen=True, slots=True, eq=False)
class Findings:
    """What a check has found, as rows of the drawing's dots.

    Attributes
    ----------
    too_small, off_page, cut : (n,) int64
        Dots below the least size, wholly beside the page, and cut by its edge.
    too_close, bleeding : (n, 2) int64
        Pairs with too little white between them, and pairs that grow together.
    tone_lost : float or None
        Share of the page's ink that a 1-bit picture loses; below 0 it gains.
    """

    too_small: Rows
    too_close: Rows
    bleeding: Rows
    off_page: Rows
    cut: Rows
    tone_lost: float | None

    @property
    def n(self) -> int:
        """How many faults there are, lost tone apart; a pair with two faults counts once."""
        pairs = np.unique(np.concatenate([self.too_close, self.bleeding]), axis=0)
        return sum(map(len, (self.too_small, pairs, self.off_page, self.cut)))

    def lines(self) -> list[str]:
        """Return a line for each kind of fault."""
        told = [
            (len(self.too_small), "dots are smaller than the process holds"),
            (len(self.too_close), "gaps between dots are narrower than it holds"),
            (len(self.bleeding), "pairs of dots grow together as ink spreads"),
            (len(self.off_page), "dots lie beside the page"),
            (len(self.cut), "dots are cut by its edge"),
        ]
        lines = [f"{n:,} {what}" for n, what in told if n]
        if self.tone_lost is not None and abs(self.tone_lost) >= 5e-4:
            what = "loses" if self.tone_lost > 0 else "gains"
            lines.append(f"a 1-bit picture {what} {100 * abs(self.tone_lost):.1f} % of the ink")
        return lines


def check(drawing: Drawing, process: Process) -> Findings:
    """Look for what print would spoil. O(n log n) for evenly spread dots."""
    scale, dots = process.scale(drawing), drawing.dots
    pairs, gaps = _near_pairs(dots, scale, max(process.least_gap_mm, 2 * process.gain_mm))
    off, cut = _beside(drawing)
    return Findings(
        np.flatnonzero(2 * scale * dots.radius_mm < process.least_dot_mm * (1 - 1e-6)),
        pairs[gaps < process.least_gap_mm * (1 - 1e-6)],
        pairs[gaps < 2 * process.gain_mm],
        np.flatnonzero(off),
        np.flatnonzero(cut & ~off),
        None if process.dpi is None else _tone_lost(sheet_of(drawing).scaled(scale), process.dpi),
    )


def _reach(dots: Dots, rows: Rows, towards_rad: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far dots reach in directions, as the ellipses they are."""
    e = dots.elongation[rows].astype(np.float64)
    turn = towards_rad - dots.angle_rad[rows]
    return np.asarray(dots.radius_mm[rows] / np.sqrt(np.cos(turn) ** 2 / e + np.sin(turn) ** 2 * e))


def _near_pairs(dots: Dots, scale: float, within_mm: float) -> tuple[Rows, NDArray[np.float64]]:
    """Return pairs with white between them, less than a width, and that width, in print."""
    none = np.empty((0, 2), np.int64), np.empty(0)
    if len(dots) < 2 or within_mm <= 0:
        return none
    from scipy.spatial import cKDTree

    at = dots.position_mm
    far = dots.radius_mm * np.sqrt(dots.elongation)
    reach = 2 * float(far.max()) + within_mm / scale
    pairs = cKDTree(at).query_pairs(reach, output_type="ndarray")
    away = at[pairs[:, 1]] - at[pairs[:, 0]]
    apart = np.hypot(away[:, 0], away[:, 1])
    near = apart < far[pairs].sum(axis=1) + within_mm / scale
    pairs, away, apart = pairs[near], away[near], apart[near]
    direction = np.arctan2(away[:, 1], away[:, 0])
    gaps = apart - _reach(dots, pairs[:, 0], direction) - _reach(dots, pairs[:, 1], direction)
    kept = (gaps * scale < within_mm) & (gaps > 0)
    return pairs[kept].astype(np.int64), gaps[kept] * scale


def _beside(drawing: Drawing) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which dots lie beside the page, and which touch its outside."""
    dots, page = drawing.dots, drawing.page
    far = np.column_stack(
        [
            _reach_along(dots, 0.0),
            _reach_along(dots, math.pi / 2),
        ]
    )
    size = np.array([page.width_mm, page.height_mm])
    low, high = dots.position_mm - far, dots.position_mm + far
    off = np.asarray(((high <= 0) | (low >= size)).any(axis=1))
    # at a corner the box may touch what the dot does not
    away = np.clip(dots.position_mm, 0, size) - dots.position_mm
    towards = _reach(dots, np.arange(len(dots)), np.arctan2(away[:, 1], away[:, 0]))
    off |= (away != 0).all(axis=1) & (np.hypot(away[:, 0], away[:, 1]) >= towards)
    cut = np.asarray(((low < -1e-9) | (high > size + 1e-9)).any(axis=1))
    return off, cut


def _reach_along(dots: Dots, axis_rad: float) -> NDArray[np.float64]:
    """Return half the width of each dot's box along an axis."""
    e = dots.elongation.astype(np.float64)
    turn = dots.angle_rad - axis_rad
    wide = np.sqrt(np.cos(turn) ** 2 * e + np.sin(turn) ** 2 / e)
    return np.asarray(dots.radius_mm * wide)


def _tone_lost(sheet: Sheet, dpi: float) -> float:
    exact = [255.0 - strip.mean(dtype=np.float64) for strip in grey_strips(sheet, _FINE_DPI)]
    rows = [len(strip) for strip in grey_strips(sheet, _FINE_DPI)]
    ink = float(np.average(exact, weights=rows)) / 255 if rows else 0.0
    n_set = n_all = 0
    width = round(sheet.width_mm * dpi / 25.4)
    for bits in bit_strips(sheet, dpi):
        n_set += int(np.bitwise_count(bits).sum())
        n_all += len(bits) * width
    return 1.0 - n_set / n_all / ink if ink > 0 else 0.0


# --- repairs ------------------------------------------------------------------------------------


def enlarged(drawing: Drawing, process: Process) -> Dots:
    """Return dots of which none is too small: those are enlarged, and so many fewer that ink stays.

    Which of them stay is decided along a short way through them, as error diffusion does, so that
    they stay evenly spread.
    """
    from stippler.files.write.press import thinned

    return thinned(drawing.dots, process.least_dot_mm / 2 / process.scale(drawing)).copy()


def parted(drawing: Drawing, process: Process) -> Dots:
    """Return dots moved apart until the gaps between them are wide enough, as far as they can.

    Fixed dots stay, and so do sizes: the ink is the same.
    """
    dots, scale = drawing.dots.copy(), process.scale(drawing)
    wanted = max(process.least_gap_mm, 2 * process.gain_mm)
    free = (dots.constraint == FREE).astype(np.float64)
    for _ in range(_PART_ROUNDS):
        pairs, gaps = _near_pairs(dots, scale, wanted)
        if not len(pairs):
            break
        away = dots.position_mm[pairs[:, 1]] - dots.position_mm[pairs[:, 0]]
        away /= np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-9)[:, None]
        lack = 1.01 * (wanted - gaps)[:, None] / scale * away
        shares = free[pairs] / np.maximum(free[pairs].sum(axis=1, keepdims=True), 1.0)
        step = np.zeros_like(dots.position_mm)
        np.add.at(step, pairs[:, 0], -lack * shares[:, :1])
        np.add.at(step, pairs[:, 1], lack * shares[:, 1:])
        dots.position_mm += step
    return dots


def within_page(drawing: Drawing) -> Dots:
    """Return the dots without those beside the page; those that its edge cuts are moved inwards."""
    dots = drawing.dots.copy()
    off, cut = _beside(drawing)
    size = np.array([drawing.page.width_mm, drawing.page.height_mm])
    for axis, rad in ((0, 0.0), (1, math.pi / 2)):
        far = np.minimum(_reach_along(dots, rad), size[axis] / 2)
        inside = np.clip(dots.position_mm[:, axis], far, size[axis] - far)
        dots.position_mm[cut, axis] = inside[cut]
    return dots.take(~off)


def repaired(drawing: Drawing, process: Process) -> Dots:
    """Return dots with all repairs made: within the page, large enough, apart."""
    dots = within_page(drawing)
    dots = enlarged(replace(drawing, dots=dots), process)
    return parted(replace(drawing, dots=dots), process)


# --- dot gain -----------------------------------------------------------------------------------

SHEET_STEPS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
"""Shares of ink that the patches of a calibration sheet have."""

_PATCH_MM, _DOT_MM = 15.0, 0.25  # side of a patch; radius of its dots


def calibration_sheet() -> Drawing:
    """Return a drawing of patches, lightest first: print it, and measure the ink of each."""
    n = len(SHEET_STEPS)
    places = [
        _hexagonal(share) + np.array([(0.1 + 1.2 * k) * _PATCH_MM, 0.1 * _PATCH_MM])
        for k, share in enumerate(SHEET_STEPS)
    ]
    one = Drawing.blank(Page(1.2 * _PATCH_MM * n, 1.2 * _PATCH_MM))
    one.dots = Dots.round(np.concatenate(places), _DOT_MM)
    return one


def gain_of(measured: Sequence[float]) -> float:
    """Return by how much edges grew, in mm, from what the patches measured.

    Parameters
    ----------
    measured : sequence of float
        Ink of each patch of `calibration_sheet`, 0 to 1, lightest first.

    Raises
    ------
    ParameterError
        If there are not as many as patches, or one is no share.
    """
    values = np.asarray(measured, np.float64)
    if values.shape != (len(SHEET_STEPS),) or not ((values >= 0) & (values <= 1)).all():
        raise ParameterError(
            "are not what a sheet measures", "dot gain", f"give {len(SHEET_STEPS)} shares, 0 to 1"
        )
    from scipy.optimize import minimize_scalar

    def off(gain: float) -> float:
        made = np.array([_patch_ink(share, gain) for share in SHEET_STEPS])
        return float(((made - values) ** 2).sum())

    found = minimize_scalar(off, bounds=(-0.8 * _DOT_MM, _DOT_MM), method="bounded")
    return float(found.x)


def _hexagonal(share: float) -> NDArray[np.float64]:
    step = _DOT_MM * math.sqrt(2 * math.pi / (math.sqrt(3) * share))
    rows = np.arange(_DOT_MM, _PATCH_MM - _DOT_MM, step * math.sqrt(3) / 2)
    columns = np.arange(_DOT_MM, _PATCH_MM - _DOT_MM - step / 2, step)
    x, y = np.meshgrid(columns, rows)
    x[1::2] += step / 2
    return np.column_stack([x.ravel(), y.ravel()])


def _patch_ink(share: float, gain: float) -> float:
    """Return the ink of a patch whose dots grew: discs, less where neighbours overlap."""
    step = _DOT_MM * math.sqrt(2 * math.pi / (math.sqrt(3) * share))
    r, cell = max(_DOT_MM + gain, 0.0), step * step * math.sqrt(3) / 2
    ink = math.pi * r * r
    if 2 * r > step:  # three lenses a dot; triple overlaps come at 1.15 of it, and are left out
        half = math.acos(step / (2 * r))
        ink -= 3 * r * r * (2 * half - math.sin(2 * half))
    return min(ink / cell, 1.0)


def compensated(drawing: Drawing, process: Process) -> Dots:
    """Return dots that print as those drawn look: smaller by what ink spreads.

    Those that the process would lose are fewer and larger, with the same printed ink.
    """
    from stippler.files.write.press import solved_dots

    scale = process.scale(drawing)
    return solved_dots(drawing.dots, process.gain_mm / scale, process.least_dot_mm / scale).copy()
