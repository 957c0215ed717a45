"""Filling the polygons of a pattern without a picture: dots relax in all of them at once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from stippler.jobs.work import Work

if TYPE_CHECKING:
    from shapely.geometry import MultiPolygon, Polygon

    from stippler.stippling.fill import Filling


def fill_and_relax(outline: Polygon | MultiPolygon, values: Filling, steps: int) -> Iterator[Work]:
    """Find places for dots in an area whose polygons are compartments, evenly spaced in each."""
    yield Work("fill")
    import numpy as np
    import shapely

    from stippler.stippling.initial_points import random_in
    from stippler.stippling.part_of_area import FEW
    from stippler.stippling.relax import Relaxation

    cells = shapely.get_parts(outline)
    ends = np.cumsum(shapely.area(cells)) / outline.area * values.n_dots
    counts = np.diff(np.floor(ends + 0.5), prepend=0).astype(int)  # each by its size
    places = [
        random_in(cell, n, values.seed + k)
        for k, (cell, n) in enumerate(zip(cells.tolist(), counts.tolist(), strict=True))
        if n
    ]
    owner = np.repeat(np.arange(len(cells)), counts)
    points = np.concatenate(places) if places else np.empty((0, 2))
    method = "even" if len(points) >= FEW * len(cells) else "lloyd"
    engine = Relaxation(points, cells.tolist(), compartment_of_dot=owner, method=method)
    for k in range(steps):
        engine.step()
        yield Work("relax", k + 1, steps)
    yield Work("fill", 1, 1, points_mm=engine.points)
