"""The program's icon: a ball in dots on a sheet of paper, as SVG."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import stippler

SIDE = 256
_EDGE, _ROUND = 16, 44
_DOTS, _RADII = 330, (1.6, 5.2)


def _ball() -> NDArray[np.float64]:
    """Return a lit ball with a shadow under it, 1 for white."""
    y, x = np.mgrid[-1:1:400j, -1:1:400j]
    cx, cy, radius = 0.0, -0.06, 0.62
    u, v = (x - cx) / radius, (y - cy) / radius
    inside = u * u + v * v < 1
    z = np.sqrt(np.clip(1 - u * u - v * v, 0, 1))
    light = np.clip(-0.5 * u - 0.62 * v + 0.6 * z, 0, 1)
    shadow = ((x - 0.16) / 0.62) ** 2 + ((y - 0.62) / 0.13) ** 2
    ground = 1 - 0.55 * np.exp(-((shadow / 0.75) ** 2))
    return np.where(inside, 0.03 + 0.9 * light**1.1, np.where(ground > 0.9, 1.0, ground))


def draw() -> str:
    """Return the icon's text."""
    drawing = stippler.stipple(
        np.clip(_ball(), 0, 1), dots=_DOTS, width=SIDE, size_range=_RADII, iterations=40
    )
    dots = drawing.dots
    circles = "".join(
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r:.1f}"/>'
        for (x, y), r in zip(dots.position_mm.tolist(), dots.radius_mm.tolist(), strict=True)
        if min(x, y, SIDE - x, SIDE - y) > _EDGE + 8
    )
    side = SIDE - 2 * _EDGE
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIDE} {SIDE}">\n'
        f'<rect x="{_EDGE}" y="{_EDGE}" width="{side}" height="{side}" rx="{_ROUND}"'
        ' fill="#fbfaf6" stroke="#26241f" stroke-opacity=".35" stroke-width="3"/>\n'
        f'<g fill="#1b1a17">{circles}</g>\n</svg>\n'
    )
