"""What is too dark for dots of a drawing's sizes, as outlines for inverse areas."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from stippler.drawing import records
from stippler.drawing.style import WHITE_ON_BLACK

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.planar.path import Path
    from stippler.drawing.reference import Reference

LEAST_MM2 = 4.0
_MOST = 60
_MOST_SIDE = 1200
_CLOSED_PX = 2
_NAME = "dark parts"


def dark_outlines(drawing: Drawing, reference: Reference, level: float = 1.0) -> list[list[Path]]:
    """Return the outlines of what is too dark for black dots.

    That is what even overlapping dots of the page's style fall short of, and what is darker than a
    level. The largest come first; places smaller than `LEAST_MM2` are left to the dots.
    """
    from scipy import ndimage

    from stippler.analysis.region_outlines import outlines_of

    levels = reference.levels
    step = max(1, -(-max(levels.shape) // _MOST_SIDE))
    darkness = levels.darkness(slice(None, None, step), slice(None, None, step))
    pixel_mm = reference.pixel_mm * step
    dark = darkness > min(_darkest(drawing, reference), level)
    near = ndimage.generate_binary_structure(2, 2)
    dark = ndimage.binary_closing(np.pad(dark, 4), near, _CLOSED_PX)
    dark = ndimage.binary_opening(dark, near, 1)[4:-4, 4:-4]
    labels, n = ndimage.label(dark)
    size = np.bincount(labels.ravel(), minlength=n + 1) * pixel_mm**2
    size[0] = 0.0
    order = [k for k in np.argsort(-size, kind="stable").tolist() if size[k] >= LEAST_MM2]
    if not order:
        return []
    outlines = outlines_of(labels.astype(np.int32), pixel_mm, curved=True)
    return [outlines.rings(k) for k in order[:_MOST]]


def _darkest(drawing: Drawing, reference: Reference) -> float:
    """Return the darkness above which the dots that the page's style asks for fall short."""
    from stippler.stippling.tone import darkest_drawn, rule_for

    style, darkness, pixel = drawing.style_of(0), reference.darkness, reference.pixel_mm
    sizes = style.size_range_mm
    in_px = None if sizes is None else (sizes[0] / pixel, sizes[1] / pixel)
    rim = np.concatenate([darkness[0], darkness[-1], darkness[:, 0], darkness[:, -1]])
    if in_px is None or not darkness.any():
        return 1.0  # sizes are then as large as the number asks for
    return darkest_drawn(rule_for(darkness, style.n_dots, in_px, rim))


def inverse_style(document: Document) -> int:
    """Return the style of dark parts, which is the page's with white dots on black.

    It is made where it is not there yet; within a stroke.
    """
    styles = document.drawing.styles
    for i, style in styles.items():
        if style.name == _NAME and style.is_inverse:
            return i
    page = document.drawing.style_of(0)
    sizes, radius = page.size_range_mm, document.dots.radius_mm
    if sizes is None and len(radius):  # white dots as large as the black ones beside them
        low, high = np.quantile(radius, (0.05, 0.95))
        sizes = (float(low), float(high))
    made = replace(page, polarity=WHITE_ON_BLACK, name=_NAME, n_dots=None, size_range_mm=sizes)
    return document.add(records.STYLE, made)
