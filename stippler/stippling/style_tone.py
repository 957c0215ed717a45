"""What a style makes of the picture's tones, and of areas of different styles in one picture."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import shapely

from stippler.drawing.levels import Curve
from stippler.drawing.reference import Picture, Reference
from stippler.drawing.style import Style
from stippler.drawing.tone_curve import ToneCurve
from stippler.kernels.halftone.scan_order import outside_polygon

if TYPE_CHECKING:
    from stippler.drawing.partition import Outline


def curves_of(style: Style) -> tuple[Curve, ...]:
    """Return what darkness goes through in a style: its curve; white dots carry what is left."""
    curves: list[Curve] = []
    if style.has_curve:
        tones = (style.tone_white, style.tone_black, style.tone_gamma, style.tone_deepest)
        curves.append(ToneCurve(*tones).at)
    if style.is_inverse:
        curves.append(lambda darkness: 1.0 - darkness)
    return tuple(curves)


def toned(reference: Reference, style: Style) -> Reference:
    """Return a reference as a style sees it; itself, where the style changes nothing."""
    curves = curves_of(style)
    if not curves:
        return reference
    seen = reference.source.levels.seen_through(reference.adjustment.apply, *curves)
    return Reference.of(Picture(seen), reference.width_mm)


def toned_by_area(reference: Reference, areas: Mapping[int, tuple[Outline, Style]]) -> Reference:
    """Return a reference as the styles of areas see it, each in its part of the page."""
    changed = {k: pair for k, pair in areas.items() if curves_of(pair[1])}
    if not changed:
        return reference
    from stippler.stippling.halftone_area import edges_of

    levels, darkness = reference.source.levels, np.array(reference.darkness)
    pixel, (h, w) = reference.pixel_mm, darkness.shape
    for part, style in changed.values():
        low, high = np.array(part.bounds).reshape(2, 2) / pixel
        x0, y0 = np.clip(np.floor(low).astype(int), 0, (w - 1, h - 1))
        x1, y1 = np.clip(np.ceil(high).astype(int), (x0 + 1, y0 + 1), (w, h))
        inside = np.ones((y1 - y0, x1 - x0), np.float32)
        local = shapely.transform(part, lambda xy, at=(x0, y0): xy / pixel - at)
        outside_polygon(edges_of(local), inside)
        seen = reference.table(*curves_of(style))[levels.of_pixel[y0:y1, x0:x1]]
        darkness[y0:y1, x0:x1] = np.where(inside > 0.0, seen, darkness[y0:y1, x0:x1])
    return Reference(darkness, reference.width_mm)
