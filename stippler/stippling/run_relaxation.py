"""A relaxation as a style asks for it: what it is weighted by, and in which order steps come."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.pool import parallel_for
from stippler.stippling.density import DensityField
from stippler.stippling.field_sums import Weights
from stippler.stippling.ground import Ground
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.relax import Relaxation
from stippler.stippling.spacing import LLOYD, TO_INK, Rules, Wanted, rules_after

_LAST_STEPS = 5  # of Lloyd's, weighted by the darkness itself
_FIRST_STEPS = 2  # Lloyd's, before the rules: they bring dots to the middle of their cells fastest
_STEPS_TO_INK = 3  # the last, after the rules
_BROKEN = 0.35  # of a spacing, by which first dots are moved so that no order is left to them

_BAND, _BANDS = 16_384, 64  # dots that numpy is given at a time: they fit the cache; at most

_READ_LATER = np.empty((0, 2))

Steps = Iterator[tuple[NDArray[np.float64], float]]


def relaxed(
    ground: Ground,
    points: NDArray[np.float64],
    fixed: NDArray[np.bool_] | None = None,
    n_done: int = 0,
    watched: bool = True,
) -> Steps:
    """Relax dots as the ground's style asks for, by the steps that are left after `n_done`.

    Parameters
    ----------
    points : (n, 2) float64, pixels
    fixed : (n,) bool, optional
    watched : bool
        Whether somebody looks at the dots of each step; else only those of the last are read out.

    Yields
    ------
    points : (n, 2) float64, pixels
        After each step; none where they are not read out.
    movement_mm : float
        Their mean movement in it.
    """
    raster, style = ground.raster, ground.style
    at = points * raster.pixel_mm
    if style.spacing == "even" and style.weighted:
        yield from _evenly(ground, at, fixed, n_done, watched)
        return
    for n_steps, field in step_weights(ground, n_done):
        method = "lloyd" if style.spacing == "even" else style.spacing
        engine = Relaxation(
            ground.inside(at), ground.outline_mm, fixed, density=field, method=method
        )
        for k in range(n_steps):
            report = engine.step()
            is_read = watched or k == n_steps - 1
            at = np.asarray(engine.points) if is_read else at
            yield at / raster.pixel_mm if is_read else _READ_LATER, float(report.mean_mm)


def _evenly(
    ground: Ground,
    at: NDArray[np.float64],
    fixed: NDArray[np.bool_] | None,
    n_done: int,
    watched: bool,
) -> Steps:
    raster, style = ground.raster, ground.style
    field = ground.ink_field()
    if n_done == 0 and style.first_dots == "random":
        from stippler.stippling.transport import evened_out

        corner = (float(raster.outline_mm()[0, 0]), float(raster.outline_mm()[0, 1]))
        at = evened_out(at, raster.density(), raster.pixel_mm, corner, fixed)
    elif n_done == 0:
        at = _with_order_broken(at, raster, style.seed, fixed)
    engine = Relaxation(
        ground.inside(at), ground.outline_mm, fixed, density=field,
        method="even", wanted=Wanted.by_rule(raster.rule, raster.pixel_mm),
    )  # fmt: skip
    sizes_follow = style.sizes == "tone" and raster.rule.varies
    schedule = _schedule(style.iterations, sizes_follow)[n_done:]
    for k, rules in enumerate(schedule, start=1):
        engine.set_rules(rules)
        report = engine.step()
        is_read = watched or k == len(schedule)
        points = np.asarray(engine.points) / raster.pixel_mm if is_read else _READ_LATER
        yield points, float(report.mean_mm)


def _schedule(n_steps: int, sizes_follow: bool) -> list[Rules]:
    """List the rules of each step: first Lloyd's, then those of even spacing.

    Where sizes can make up for it, the last steps bring each dot to the midst of its ink.
    """
    n_first = min(_FIRST_STEPS, n_steps // 3)
    n_last = min(_STEPS_TO_INK, n_steps // 3) if sizes_follow else 0
    middle = [rules_after(k) for k in range(n_steps - n_first - n_last)]
    return [LLOYD] * n_first + middle + [TO_INK] * n_last


def _with_order_broken(
    at: NDArray[np.float64], raster: PageRaster, seed: int, fixed: NDArray[np.bool_] | None
) -> NDArray[np.float64]:
    """Move each dot by chance, about a third of its spacing: rows grow from any order there is.

    Moved each by itself, dots keep the evenness that they have over longer ways.
    """
    by_chance = np.random.default_rng([seed, len(at)]).normal(0.0, _BROKEN, at.shape)
    out = np.empty_like(by_chance)

    def part(start: int, stop: int) -> None:
        px = at[start:stop] / raster.pixel_mm
        density = raster.density_under(px)
        moved = px + by_chance[start:stop] / np.sqrt(np.maximum(density, 1e-30))[:, None]
        stays = ~(raster.density_under(moved) > 0.0) | ~(density > 0.0)
        if fixed is not None:
            stays |= fixed[start:stop]
        moved[stays] = px[stays]
        out[start:stop] = moved * raster.pixel_mm

    parallel_for(part, len(at), grain=_BAND, chunks=_BANDS)
    return out


def step_weights(ground: Ground, n_done: int = 0) -> Iterator[tuple[int, Weights]]:
    """Yield how many of Lloyd's steps are left after those done, and by what they are weighted.

    By the square of the density, since dots settle at its root. The last steps are weighted by
    the darkness itself: each dot then lies in the midst of the ink that its cell asks for, and
    fine detail is drawn where it is; its size makes up for the density that is lost, so dots of
    one size do without. The paper's form weighs all ink alike; white weighs nothing in any form,
    and draws no dots.
    """
    raster, style = ground.raster, ground.style
    x, y = raster.outline_mm()[0]
    solved = style.weighted and style.sizes == "tone" and raster.rule.varies
    n_last = min(_LAST_STEPS, style.iterations // 3) if solved else 0
    n_first = style.iterations - n_last - n_done
    if n_first > 0:
        density = raster.density()
        weight = np.square(density / density.max()) if style.weighted else np.sign(density)
        yield n_first, DensityField(weight, raster.pixel_mm, (float(x), float(y)))
    n_last = min(n_last, style.iterations - n_done)
    if n_last > 0:
        yield n_last, ground.ink_field()
