"""The pipeline: from a reference and a plan to dots whose ink meets the tone."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.reference import Reference
from stippler.errors import ParameterError
from stippler.kernels.ink import onto_ink, sample
from stippler.kernels.pool import run_ranges
from stippler.stippling import halftone
from stippler.stippling.tone import Rule, Shortfall, rule_for, shortfall, solve_radii

FIRST_DOTS = ("pulse-density", "floyd-steinberg", "random", "hexagonal")
"""Ways to place the first dots."""

DEFAULT_DOTS = 20_000
MAX_DOTS = 20_000_000

_PIXELS_PER_DOT = 60  # of a reference that is larger, blocks are averaged
_MIN_PIXELS = 2_500_000


@dataclass(frozen=True, slots=True)
class Plan:
    """What to make of a reference.

    Attributes
    ----------
    n_dots : int or None
        None: follows from the size range, or `DEFAULT_DOTS` without one.
    size_range_mm : (min, max) or None
        Radii; None: the range of 1:2 that meets the tone with `n_dots`.
    iterations : int
        Relaxation steps.
    seed : int
        Chooses what is left to chance.
    first_dots : {"pulse-density", "floyd-steinberg", "random", "hexagonal"}
    growth : {"circular", "triangular"}
        Order in which pulse-density regions take cells.
    weighted : bool
        Relax by the wanted density; False is the paper's unweighted form.
    """

    n_dots: int | None = None
    size_range_mm: tuple[float, float] | None = None
    iterations: int = 20
    seed: int = 1
    first_dots: str = "pulse-density"
    growth: str = "circular"
    weighted: bool = True

    def __post_init__(self) -> None:
        if self.n_dots is not None and not 1 <= self.n_dots <= MAX_DOTS:
            raise ParameterError(
                f"{self.n_dots} dots cannot be drawn", "dots", f"give 1 to {MAX_DOTS:,}"
            )
        if self.size_range_mm is not None:
            low, high = self.size_range_mm
            if not (math.isfinite(low) and math.isfinite(high) and 0 < low <= high):
                raise ParameterError(
                    f"{low:g}:{high:g} is no range of radii",
                    "size range",
                    "give MIN:MAX in mm with 0 < MIN <= MAX",
                )
        if not 0 <= self.iterations <= 100_000:
            raise ParameterError(
                f"{self.iterations} steps cannot be run", "iterations", "give 0 to 100,000"
            )
        if not 0 <= self.seed < 2**63:
            raise ParameterError(f"{self.seed} is no seed", "seed", "give 0 or more")
        if self.first_dots not in FIRST_DOTS:
            raise ParameterError(
                f"{self.first_dots!r} is unknown", "first dots", f"one of {', '.join(FIRST_DOTS)}"
            )
        if self.growth not in halftone.GROWTHS:
            raise ParameterError(
                f"{self.growth!r} is unknown", "growth", f"one of {', '.join(halftone.GROWTHS)}"
            )


@dataclass(frozen=True, slots=True, eq=False)
class Progress:
    """A snapshot of the work; its arrays are fresh and read-only.

    Attributes
    ----------
    stage : {"first dots", "relax", "tone", "done"}
    done, total : int
        Of this stage.
    position_mm : (n, 2) float64
        Empty if snapshots are off, but for the last one.
    radius_mm : (n,) float32
    movement_mm : float
        Mean movement of the last relaxation step; NaN outside relaxation.
    shortfall : Shortfall or None
        On "done".
    """

    stage: str
    done: int
    total: int
    position_mm: NDArray[np.float64]
    radius_mm: NDArray[np.float32]
    movement_mm: float = math.nan
    shortfall: Shortfall | None = None


def stages(reference: Reference, plan: Plan, *, snapshots: bool = True) -> Iterator[Progress]:
    """Stipple a reference; yield a snapshot after every piece of work.

    Close the iterator to cancel. The result depends on the reference, the plan and nothing else.

    Parameters
    ----------
    reference : Reference
    plan : Plan
    snapshots : bool
        Whether to fill the arrays of all snapshots, or only those of the last.

    Yields
    ------
    Progress
        The last one has the stage "done".
    """
    work = _Work.of(reference, plan)
    nothing = np.empty((0, 2)), np.empty(0, np.float32)

    def snapshot(
        stage: str, done: int, total: int, px: NDArray[np.float64], movement_mm: float = math.nan
    ) -> Progress:
        shown = work.show(px, work.rule_radii(px)) if snapshots else nothing
        return Progress(stage, done, total, *shown, movement_mm)

    points = np.empty((0, 2))
    for share, points in _first_dots(work, plan):
        yield snapshot("first dots", round(1000 * share), 1000, points)
    if len(points) and plan.iterations:
        for k, (moved, movement_mm) in enumerate(_relax(work, plan, points)):
            points = moved
            yield snapshot("relax", k + 1, plan.iterations, points, movement_mm)
    points = work.onto_ink(points)
    yield snapshot("tone", 0, 1, points)
    limits = (work.rule.radius_min, work.rule.radius_max)
    radii = solve_radii(points, work.darkness, limits)
    lack = shortfall(work.darkness, work.rule, work.pixel_mm, len(points), plan.n_dots)
    yield Progress("done", 1, 1, *work.show(points, radii), shortfall=lack)


@dataclass(frozen=True, slots=True, eq=False)
class _Work:
    """The reference at the resolution the dots need, and the rule for them; lengths in pixels."""

    darkness: NDArray[np.float32]
    pixel_mm: float
    size_mm: tuple[float, float]
    rule: Rule

    @classmethod
    def of(cls, reference: Reference, plan: Plan) -> _Work:
        n_dots = plan.n_dots
        if n_dots is None and plan.size_range_mm is None:
            n_dots = DEFAULT_DOTS
        darkness, k = _reduced(reference.darkness, n_dots or DEFAULT_DOTS)
        pixel_mm = reference.pixel_mm * k
        size_px = None
        if plan.size_range_mm is not None:
            size_px = (plan.size_range_mm[0] / pixel_mm, plan.size_range_mm[1] / pixel_mm)
        rule = rule_for(darkness, n_dots, size_px)
        return cls(darkness, pixel_mm, (reference.width_mm, reference.height_mm), rule)

    def density(self) -> NDArray[np.float32]:
        """Dots per square pixel; white stays exactly 0."""
        return _by_table(self.darkness, self.rule)

    def rule_radii(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        values = np.empty(len(points), np.float32)
        run_ranges(sample, len(points), points, self.darkness, values)
        return self.rule.radius(values)

    def onto_ink(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        points = np.array(points)
        moved = np.empty(len(points), np.uint8)
        run_ranges(onto_ink, len(points), points, self.darkness, max(self.darkness.shape), moved)
        kept: NDArray[np.float64] = points[moved != 2]
        return kept

    def show(
        self, points: NDArray[np.float64], radii: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        position = np.minimum(points * self.pixel_mm, self.size_mm)
        radius = (radii * self.pixel_mm).astype(np.float32)
        position.flags.writeable = False
        radius.flags.writeable = False
        return position, radius


def _by_table(darkness: NDArray[np.float32], rule: Rule) -> NDArray[np.float32]:
    """Evaluate a rule's density for a whole picture, by interpolation in a fine table."""
    levels = np.linspace(0.0, 1.0, 4097)
    table = rule.density(levels)
    density: NDArray[np.float32] = np.interp(darkness, levels, table).astype(np.float32)
    return density


def _reduced(darkness: NDArray[np.float32], n_dots: int) -> tuple[NDArray[np.float32], int]:
    """Average blocks of a picture that is finer than its dots can show."""
    enough = max(_MIN_PIXELS, _PIXELS_PER_DOT * n_dots)
    k = int(math.sqrt(darkness.size / enough))
    if k < 2:
        return darkness, 1
    h, w = darkness.shape
    rows, columns = np.arange(0, h, k), np.arange(0, w, k)
    sums = np.add.reduceat(darkness, rows, axis=0, dtype=np.float32)
    sums = np.add.reduceat(sums, columns, axis=1)
    return (sums / np.float32(k * k)).astype(np.float32), k


def _first_dots(work: _Work, plan: Plan) -> Iterator[tuple[float, NDArray[np.float64]]]:
    density = work.density()
    if plan.n_dots is not None and work.rule.thin == 1.0:
        total = float(density.sum(dtype=np.float64))
        if total > 0 and abs(total / plan.n_dots - 1) < 0.02:
            density *= np.float32(plan.n_dots / total)
    if plan.first_dots == "pulse-density":
        for share, first in halftone.pulse_density(density, plan.growth):
            yield share, first.position_px
        return
    if plan.first_dots == "floyd-steinberg":
        yield 1.0, halftone.floyd_steinberg(density).position_px
    elif plan.first_dots == "random":
        yield 1.0, halftone.random_dots(density, plan.seed).position_px
    else:
        yield 1.0, halftone.hexagonal(density).position_px


def _relax(
    work: _Work, plan: Plan, points: NDArray[np.float64]
) -> Iterator[tuple[NDArray[np.float64], float]]:
    """Run Lloyd steps; weighted, by the square of the density, since dots settle at its root."""
    from stippler.stippling.relax import DensityField, Relaxation

    width, height = work.size_mm
    page = np.array([(0, 0), (width, 0), (width, height), (0, height)], np.float64)
    field = None
    if plan.weighted:
        density = work.density()
        field = DensityField(np.square(density / density.max()), work.pixel_mm)
    engine = Relaxation(points * work.pixel_mm, page, density=field)
    for _ in range(plan.iterations):
        report = engine.step()
        yield np.asarray(engine.points) / work.pixel_mm, float(report.mean_mm)


def pulse_density(
    darkness: NDArray[np.float32],
    dots: int = DEFAULT_DOTS,
    growth: str = "circular",
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Place first dots by pulse-density modulation.

    Parameters
    ----------
    darkness : (h, w) float32, 0..1
    dots : int
        How many; met within 1 %.
    growth : {"circular", "triangular"}

    Returns
    -------
    points : (n, 2) float64, pixels
    radii : (n,) float64, pixels
    """
    work = _Work.of(Reference(darkness, float(darkness.shape[1])), Plan(n_dots=dots, growth=growth))
    *_, (_, points) = _first_dots(work, Plan(n_dots=dots, growth=growth))
    return points * work.pixel_mm, work.rule_radii(points) * work.pixel_mm
