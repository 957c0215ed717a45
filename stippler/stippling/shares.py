"""How many dots areas get of a number that several have together."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Outline, Partition
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.border_policies import BorderPolicies
from stippler.stippling.borders import Borders, along_line
from stippler.stippling.ground import counted
from stippler.stippling.style_tone import curves_of
from stippler.stippling.tone import rule_for

_COARSE, _FINE = 128, 64  # places a side that ink is looked at, of a page and of an area
_FINEST = 256  # places a side that areas which would be drawn as one are looked at

Floats = NDArray[np.float64]


def number_of_areas(
    drawing: Drawing,
    partition: Partition,
    areas: tuple[int, ...],
    part: Outline,
    reference: Reference,
) -> Style:
    """Return areas' style with their share of a number that several areas have together."""
    i = drawing.areas[areas[0]].style
    style = drawing.styles[i]
    others = [k for k, one in drawing.areas.items() if one.style == i and k not in areas]
    if style.n_dots is None or not others:
        return style
    page = (0.0, 0.0, drawing.page.width_mm, drawing.page.height_mm)
    rest = _ink(partition, reference, page, _COARSE, others)
    own = _ink(partition, reference, part.bounds, _FINE, list(areas))
    share = own / (own + rest) if own > 0.0 else 0.0
    return replace(style, n_dots=max(round(style.n_dots * share), 1))


def number_of_some(
    policies: BorderPolicies,
    style: Style,
    group: tuple[int, ...],
    areas: tuple[int, ...],
    reference: Reference,
) -> Style:
    """Return the style of areas that would be drawn as one, with the dots that some get of it."""
    whole, own = (policies.part_of_all(ids) for ids in (group, areas))
    style = counted(style, whole.area)
    if style.n_dots is None:
        return style
    side = math.sqrt(whole.area) / _FINEST
    owner, dark = _sampled(policies.partition, reference, whole.bounds, side, style)
    rims = [
        np.concatenate([_rim_of(policies, ids, reference, side, style) for ids in groups])
        for groups in (policies.joined(group), [areas])
    ]
    mine, theirs = dark[np.isin(owner, areas)], dark[np.isin(owner, group)]
    sizes = style.size_range_mm
    in_px = None if sizes is None else (sizes[0] / side, sizes[1] / side)
    rule = rule_for(theirs, style.n_dots, in_px, rims[0])
    n = float(rule.density(mine).sum()) + float(rule.per_border(rims[1]).sum())
    n *= own.area / max(len(mine) * side * side, 1e-12)
    return replace(style, n_dots=max(round(n), 1))


def _rim_of(
    policies: BorderPolicies,
    areas: tuple[int, ...],
    reference: Reference,
    side_mm: float,
    style: Style,
) -> NDArray[np.float32]:
    """Return how dark it is along what bleeds of areas that are drawn as one."""
    size_mm = (reference.width_mm, reference.height_mm)
    part, border = policies.part_of_all(areas), policies.drawing.border_of(areas[0])
    lines = Borders.of(part, border, size_mm, policies.own_of(areas)).bleeding
    places = [along_line(one, max(round(one.length / side_mm), 1)) for one in lines]
    return _seen_as(style, reference, np.concatenate([np.empty((0, 2)), *places]))


def _sampled(
    partition: Partition,
    reference: Reference,
    box: tuple[float, float, float, float],
    side_mm: float,
    style: Style,
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """Return whose the places of a grid over a box are, and how dark a style sees them."""
    x0, y0, x1, y1 = box
    x, y = np.meshgrid(np.arange(x0 + side_mm / 2, x1, side_mm),
                       np.arange(y0 + side_mm / 2, y1, side_mm))  # fmt: skip
    at = np.column_stack((x.ravel(), y.ravel()))
    return partition.area_at(at), _seen_as(style, reference, at)


def _seen_as(style: Style, reference: Reference, at_mm: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return how dark a style sees places of the page."""
    levels = reference.source.levels.of_pixel
    column, row = np.clip(
        (at_mm / reference.pixel_mm).astype(np.intp).T, 0, np.array(levels.shape[::-1])[:, None] - 1
    )
    dark: NDArray[np.float32] = reference.table(*curves_of(style))[levels[row, column]]
    return dark


def _ink(
    partition: Partition,
    reference: Reference,
    box: tuple[float, float, float, float],
    n: int,
    areas: list[int],
) -> float:
    """Return about how much of a box is inked in some areas, in mm2, by n x n places."""
    x0, y0, x1, y1 = box
    at = (np.arange(n) + 0.5) / n
    x, y = np.meshgrid(x0 + (x1 - x0) * at, y0 + (y1 - y0) * at)
    owner = partition.area_at(np.column_stack((x.ravel(), y.ravel())))
    levels = reference.source.levels.of_pixel
    rows = np.clip((y / reference.pixel_mm).astype(np.intp), 0, levels.shape[0] - 1)
    columns = np.clip((x / reference.pixel_mm).astype(np.intp), 0, levels.shape[1] - 1)
    ink = reference.values[levels[rows, columns]].ravel()
    cell = (x1 - x0) * (y1 - y0) / n**2
    return float(ink[np.isin(owner, areas)].sum(dtype=np.float64)) * cell
