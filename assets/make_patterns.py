"""Draw the polygon sets in assets/patterns: python assets/make_patterns.py.

Each is a square of 100 by 100 that repeats without a seam, where its name does not say otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import shapely
from shapely.geometry import Polygon

OUT = Path(__file__).parent / "patterns"
Rings = list[np.ndarray]


def block(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    """Return a rectangle."""
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def shrunk(ring: np.ndarray, by: float, round_by: float = 0.0) -> np.ndarray | None:
    """Return a ring drawn in, its corners rounded; None if nothing is left."""
    shape = Polygon(ring).buffer(-by - round_by).buffer(round_by)
    shape = max(shape.geoms, key=lambda p: p.area) if hasattr(shape, "geoms") else shape
    if shape.is_empty or shape.area < 0.5:
        return None
    return shapely.get_coordinates(shape.simplify(0.03).exterior)[:-1]


def bricks() -> Rings:
    """Courses of bricks, every other one shifted by half."""
    out = []
    for j in range(10):
        for i in range(5):
            x = 20 * i + (10 if j % 2 else 0)
            out.append(block(x + 0.6, 10 * j + 0.6, x + 19.4, 10 * j + 9.4))
    return out


def cobbles() -> Rings:
    """Draw rounded stones: relaxed Voronoi cells on a torus."""
    rng = np.random.default_rng(5)
    at = rng.random((70, 2)) * 100
    shifts = np.array([(i, j) for i in (-100, 0, 100) for j in (-100, 0, 100)])
    for _ in range(4):
        every = (at[None] + shifts[:, None]).reshape(-1, 2)
        cells = _cells(every)
        at = np.array([cells[4 * 70 + k].centroid.coords[0] for k in range(70)]) % 100
    every = (at[None] + shifts[:, None]).reshape(-1, 2)
    cells = _cells(every)
    rings = [
        shrunk(shapely.get_coordinates(cells[280 + k].exterior)[:-1], 0.5, 2.2) for k in range(70)
    ]
    return [r for r in rings if r is not None]


def _cells(at: np.ndarray) -> list[Polygon]:
    found = shapely.voronoi_polygons(shapely.multipoints(at))
    cells = list(found.geoms)
    tree = shapely.STRtree(cells)
    point, cell = tree.query(shapely.points(at), predicate="intersects")
    order = dict(zip(point.tolist(), cell.tolist(), strict=True))
    return [cells[order[k]] for k in range(len(at))]


def _arc(x: float, y: float, rx: float, ry: float, a: float, b: float, n: int) -> np.ndarray:
    t = np.linspace(a, b, n)
    return np.column_stack([x + rx * np.cos(t), y + ry * np.sin(t)])


def scales() -> Rings:
    """Fish scales: each row covers half of the one before."""
    w, h = 100 / 8, 100 / 10
    out = []
    for j in range(10):
        for i in range(8):
            x = w * (i + (0.5 if j % 2 else 0.0)) + w / 2
            y = h * j
            lower = _arc(x, y, w / 2, h * 1.05, 0, math.pi, 17)
            left = _arc(x - w / 2, y - h, w / 2, h * 1.05, math.pi / 2, 0, 9)
            right = _arc(x + w / 2, y - h, w / 2, h * 1.05, math.pi, math.pi / 2, 9)
            ring = np.vstack([lower, left[:-1], right[1:]])
            inner = shrunk(ring, 0.35)
            if inner is not None:
                out.append(inner)
    return out


def feathers() -> Rings:
    """Barbs on both sides of shafts."""
    out = []
    for c in range(4):
        x = 25 * c + 12.5
        for j in range(20):
            y = 5.0 * j
            for side in (-1, 1):
                inner, outer = x + side * 0.7, x + side * 11.9
                t = np.linspace(0, 1, 9)
                top = np.column_stack([inner + (outer - inner) * t, y - 7 * t**1.4])
                low = top + np.column_stack([0 * t, 4.3 * (1 - 0.55 * t**3)])
                out.append(np.vstack([top, low[::-1]]))
    return out


def hatching() -> Rings:
    """Parallel bands."""
    return [block(0, 5 * k + 0.75, 100, 5 * k + 4.25) for k in range(20)]


def cross_hatching() -> Rings:
    """Draw the cells that two sets of slanted lines leave."""
    out = []
    for i in range(10):
        for j in range(10):
            x, y = 10 * i + (5 if j % 2 else 0), 10 * j
            ring = np.array([(x, y - 10), (x + 5, y), (x, y + 10), (x - 5, y)])
            inner = shrunk(ring, 0.6)
            if inner is not None:
                out.append(inner)
    return out


def wood_grain() -> Rings:
    """Long grain that flows around two knots."""
    out = []
    x = np.linspace(0, 100, 81)
    knots = ((30.0, 37.5, 9.0), (74.0, 78.0, 7.0))

    def edge(k: float) -> np.ndarray:
        y = np.full_like(x, k)
        y += 1.3 * np.sin(2 * np.pi * (x / 100) + k * 2 * np.pi / 50)
        for kx, ky, r in knots:
            d = (y - ky + 1e-9) / r
            push = np.exp(-(((x - kx) / (1.8 * r)) ** 2)) * np.exp(-np.abs(d) * 0.9)
            y = y + np.sign(d) * r * 0.75 * push
        return y

    n = 32
    rows = [edge(100 * k / n) for k in range(n + 1)]
    for k in range(n):
        low, high = rows[k] + 0.3, rows[k + 1] - 0.3
        if (high - low).min() < 0.15:
            middle = (low + high) / 2
            low, high = np.minimum(low, middle - 0.1), np.maximum(high, middle + 0.1)
        for a, b in ((0, 40), (40, 80)):
            cut = 0.3
            xs = x[a : b + 1].copy()
            xs[0], xs[-1] = xs[0] + cut, xs[-1] - cut
            out.append(np.vstack([np.column_stack([xs, low[a : b + 1]]),
                                  np.column_stack([xs, high[a : b + 1]])[::-1]]))  # fmt: skip
    for kx, ky, r in knots:
        out.append(_arc(kx, ky, r * 0.62, r * 0.4, 0, 2 * math.pi, 33)[:-1])
    shapes = [Polygon(r) for r in out]
    last = shapely.union_all(shapes[-2:]).buffer(0.4)
    rings = []
    for shape in shapes[:-2]:
        for part in shapely.get_parts(shape.buffer(0).difference(last)):
            rings += [shapely.get_coordinates(part.exterior)[:-1]] if part.area > 0.8 else []
    return out[-2:] + rings


def waves() -> Rings:
    """Bands that swing."""
    x = np.linspace(0, 100, 49)
    swing = 3.2 * np.sin(4 * np.pi * x / 100)
    out = []
    for k in range(12):
        y = 100 / 12 * k + swing
        thick = 6.4 - 2.2 * np.cos(4 * np.pi * x / 100 + k)
        low, high = y + (100 / 12 - thick) / 2, y + (100 / 12 + thick) / 2
        out.append(np.vstack([np.column_stack([x, low]), np.column_stack([x, high])[::-1]]))
    return out


def hexagons() -> Rings:
    """Honeycomb."""
    out = []
    w, h = 100 / 8, 100 / 10
    for j in range(10):
        for i in range(8):
            x, y = w * (i + (0.5 if j % 2 else 0)) + w / 2, h * j + h / 2
            turn = np.array([(0, -2), (1, -1), (1, 1), (0, 2), (-1, 1), (-1, -1)])
            ring = (x, y) + turn * (w / 2, h / 3)
            inner = shrunk(ring, 0.5)
            assert inner is not None
            out.append(inner)
    return out


def contour_bands() -> Rings:
    """Bands around a middle, for forms that bulge: one square, not to be repeated."""
    t = np.linspace(0, 2 * np.pi, 97)[:-1]
    out = [_arc(50, 50, 5.0, 5.0, 0, 2 * math.pi, 33)[:-1]]
    for k in range(1, 9):
        inner, outer = 5.4 * k + 0.5, 5.4 * (k + 1) - 0.4
        for half in range(3):
            a, b = half * 32 + 11 * (k % 3), half * 32 + 11 * (k % 3) + 32
            turn = np.r_[t, t + 2 * np.pi, t + 4 * np.pi][a : b + 1].copy()
            gap = min(0.25, 0.45 / max(outer, 3))
            turn[0], turn[-1] = turn[0] + gap, turn[-1] - gap
            ring = [np.column_stack([50 + r * np.cos(turn), 50 + r * np.sin(turn)])
                    for r in (inner, outer)]  # fmt: skip
            out.append(np.vstack([ring[0], ring[1][::-1]]))
    return out


def herringbone() -> Rings:
    """Blocks set at right angles, as floors are laid."""
    out = []
    u = 100 / 12
    for i in range(-24, 36):
        for j in range(-24, 36):
            x, y = i * 1.0, j * 1.0
            k = (i - j) % 4
            if k == 0:
                ring = block(x, y, x + 2, y + 1)
            elif k == 2:
                ring = block(x, y - 1, x + 1, y + 1)
            else:
                continue
            ring = ring * u
            middle = ring.mean(axis=0)
            if (middle >= 0).all() and (middle < 100).all():
                inner = shrunk(ring, 0.35)
                assert inner is not None
                out.append(inner)
    shapes = [Polygon(r) for r in out]
    kept: list[int] = []
    for k, shape in enumerate(shapes):
        if all(shape.intersection(shapes[m]).area < 0.01 for m in kept):
            kept.append(k)
    return [out[k] for k in kept]


def basket() -> Rings:
    """Weave: three strands across, three down."""
    out = []
    for j in range(5):
        for i in range(5):
            for k in range(3):
                a, b = 20 * i, 20 * j
                if (i + j) % 2:
                    out.append(block(a + 0.5, b + 6.6 * k + 0.6, a + 19.5, b + 6.6 * k + 6.2))
                else:
                    out.append(block(a + 6.6 * k + 0.6, b + 0.5, a + 6.6 * k + 6.2, b + 19.5))
    return out


SETS: dict[str, Callable[[], Rings]] = {
    "bricks": bricks, "cobbles": cobbles, "scales": scales, "feathers": feathers,
    "hatching": hatching, "cross-hatching": cross_hatching, "wood-grain": wood_grain,
    "waves": waves, "hexagons": hexagons, "contour-bands": contour_bands,
    "herringbone": herringbone, "basket": basket,
}  # fmt: skip


def main() -> None:
    """Write all sets."""
    OUT.mkdir(exist_ok=True)
    for name, draw in SETS.items():
        lines = [
            '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm"'
            ' viewBox="0 0 100 100" fill="#ddd" stroke="#000" stroke-width=".2">'
        ]
        for ring in draw():
            points = " ".join(f"{x:.3f},{y:.3f}" for x, y in ring)
            lines.append(f'<polygon points="{points}"/>')
        (OUT / f"{name}.svg").write_text("\n".join([*lines, "</svg>", ""]))


if __name__ == "__main__":
    main()
