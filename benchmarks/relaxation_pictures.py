"""The pictures of ``docs/relaxation.md``: ``python -m benchmarks.relaxation_pictures``."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import Delaunay
from shapely.geometry import Point, Polygon, box

from stippler.stippling.relax import DensityField, Relaxation

Points = NDArray[np.float64]

FOLDER = Path(__file__).parents[1] / "docs" / "relaxation"
SIDE = 240.0


def holed() -> Polygon:
    """Return a concave shape with two holes and a slit."""
    a = np.linspace(0, 2 * np.pi, 240)[:-1]
    r = 0.4 * (1 + 0.22 * np.sin(5 * a))
    shape = Polygon(np.c_[0.5 + r * np.cos(a), 0.5 + r * np.sin(a)])
    shape = shape.difference(Point(0.42, 0.6).buffer(0.07)).difference(Point(0.6, 0.42).buffer(0.1))
    return shape.difference(box(0.495, 0.0, 0.505, 0.4))


def points_in(shape: Polygon, n: int, seed: int = 0) -> Points:
    """Return n random dots in a shape within the unit square."""
    xy = np.random.default_rng(seed).random((40 * n, 2))
    inside: Points = xy[shapely.contains_xy(shape, xy[:, 0], xy[:, 1])][:n]
    return inside


def panel(column: int, points: Points, title: str, shape: Polygon, radius: float = 1.6) -> str:
    """Draw dots and their border."""
    x0 = 10 + column * (SIDE + 14)
    rings = [shape.exterior, *shape.interiors]
    path = "".join(
        "M" + "L".join(f"{x * SIDE:.1f} {y * SIDE:.1f}" for x, y in ring.coords) + "Z"
        for ring in rings
    )
    dots = "".join(
        f'<circle cx="{x * SIDE:.2f}" cy="{y * SIDE:.2f}" r="{radius}"/>' for x, y in points
    )
    return (
        f'<g transform="translate({x0} 24)"><text y="-8">{title}</text>'
        f'<path d="{path}" fill="none" stroke="#bbb" stroke-width="0.8"/>{dots}</g>'
    )


def save(name: str, panels: list[str]) -> None:
    """Write panels side by side."""
    width = 20 + len(panels) * (SIDE + 14) - 14
    (FOLDER / name).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{SIDE + 34:.0f}" '
        f'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>'
        f"{''.join(panels)}</svg>\n",
        encoding="utf-8",
    )


def steps_picture() -> None:
    """Draw a run in a concave shape with holes."""
    shape = holed()
    engine = Relaxation(points_in(shape, 700), shape)
    panels = [panel(0, engine.points, "random", shape)]
    for column, more in enumerate((1, 4, 15), start=1):
        engine.run(more)
        done = (1, 5, 20)[column - 1]
        panels.append(panel(column, engine.points, f"{done} step{'s' * (done > 1)}", shape))
    save("steps.svg", panels)


def methods_picture() -> None:
    """Draw the same start relaxed by the three methods."""
    square, start = box(0, 0, 1, 1), points_in(box(0, 0, 1, 1), 700)
    panels = []
    for column, method in enumerate(("lloyd", "delaunay-mean", "springs")):
        engine = Relaxation(start, square, method=method)
        engine.run(20)
        panels.append(panel(column, engine.points, f"{method}, 20 steps", square))
    save("methods.svg", panels)


def density_picture() -> None:
    """Draw dots that follow a field with a white disc."""
    square = box(0, 0, 1, 1)
    x, y = np.meshgrid((np.arange(400) + 0.5) / 400, (np.arange(400) + 0.5) / 400)
    field = 0.05 + x**2
    field[np.hypot(x - 0.6, y - 0.5) < 0.2] = 0.0
    pick = np.random.default_rng(1).choice(field.size, 1500, p=(field / field.sum()).ravel())
    start = np.c_[x.ravel()[pick], y.ravel()[pick]] + np.random.default_rng(2).uniform(
        -1 / 900, 1 / 900, (1500, 2)
    )
    engine = Relaxation(start, square, density=DensityField(field, 1 / 400))
    panels = [panel(0, start, "drawn at random by weight", square, 1.1)]
    engine.run(30)
    panels.append(panel(1, engine.points, "30 weighted steps", square, 1.1))
    plain = Relaxation(start, square)
    plain.run(30)
    panels.append(panel(2, plain.points, "30 steps without weight", square, 1.1))
    save("density.svg", panels)


def edge_variance(points: Points) -> float:
    """Return the variance of Delaunay edges away from the border, times the number of dots."""
    margin = 2 / np.sqrt(len(points))
    inner = ((points > margin) & (points < 1 - margin)).all(axis=1)
    a, b = Delaunay(points).simplices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).T
    both = inner[a] & inner[b]
    return float(np.hypot(*(points[a[both]] - points[b[both]]).T).var() * len(points))


def variances(over: float, steps: int = 20) -> dict[int, list[float]]:
    """Return the share of the first variance left after each step, by number of dots."""
    left = {}
    for n, sets in ((150, 24), (1200, 4), (12_000, 1)):
        shares = []
        for seed in range(sets):
            xy = np.random.default_rng(seed).random((n, 2))
            engine = Relaxation(xy, box(0, 0, 1, 1), over_relaxation=over)
            found = [edge_variance(engine.points)]
            for _ in range(steps):
                engine.step()
                found.append(edge_variance(engine.points))
            shares.append(np.array(found) / found[0])
        left[n] = [float(v) for v in np.mean(shares, axis=0)]
    return left


def variance_picture() -> None:
    """Draw the paper's figure 6 and print its figures."""
    lines, labels = [], []
    for over, dash in ((1.0, ""), (1.5, ' stroke-dasharray="4 3"')):
        for (n, left), colour in zip(
            variances(over).items(), ("#c33", "#36c", "#222"), strict=True
        ):
            path = " ".join(f"{x * SIDE / 10:.1f},{SIDE * (1 - y):.1f}" for x, y in enumerate(left))
            lines.append(f'<polyline points="{path}" fill="none" stroke="{colour}"{dash}/>')
            print(f"w = {over}, {n:6} dots: {left[10]:.3f} after 10 steps, {left[20]:.3f} after 20")
            if not dash:
                labels.append((n, colour))
    key = "".join(
        f'<text x="300" y="{20 + 16 * i}" fill="{colour}">{n} dots</text>'
        for i, (n, colour) in enumerate(labels)
    )
    (FOLDER / "variance.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * SIDE + 40:.0f}" '
        f'height="{SIDE + 50:.0f}" font-family="sans-serif" font-size="12">'
        f'<rect width="100%" height="100%" fill="white"/>'
        f'<g transform="translate(25 15)"><path d="M0 0V{SIDE}H{2 * SIDE}" fill="none" '
        f'stroke="#888"/>{"".join(lines)}{key}<text x="300" y="68">dashed: w = 1.5</text>'
        f'<text y="{SIDE + 24}">variance of edge lengths, share of the start, over 20 steps</text>'
        f"</g></svg>\n",
        encoding="utf-8",
    )


def print_failures() -> None:
    """Print how many stars fail in a step, 50,000 random dots in a square."""
    engine = Relaxation(np.random.default_rng(1).random((50_000, 2)), box(0, 0, 1, 1))
    for step in range(1, 21):
        engine.step()
        if step in (2, 5, 20):
            print(f"step {step:2}: {engine.n_failed / 50_000:.1%} of the stars fail")


def main() -> None:
    """Make all pictures."""
    print_failures()
    FOLDER.mkdir(parents=True, exist_ok=True)
    steps_picture()
    methods_picture()
    density_picture()
    variance_picture()


if __name__ == "__main__":
    main()
