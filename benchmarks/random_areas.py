"""Random edits of areas, each judged by shapely: no gap, overlap, sliver or lost dot.

python -m benchmarks.random_areas [EDITS] [SEED] [CHECK_EVERY]
"""

from __future__ import annotations

import collections
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path as FilePath

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import PAGE, PlanarMap
from stippler.drawing.planar.slivers import is_sliver
from stippler.drawing.planar.swept import dots_in_strip
from stippler.errors import GeometryError

SIZE = np.array([100.0, 80.0])
MOST_AREAS = 40
N_DOTS = 2000

Rng = np.random.Generator


def run(
    seed: int, n_edits: int, check_every: int = 1, tell: Callable[[str], None] = lambda line: None
) -> tuple[PlanarMap, collections.Counter[str]]:
    """Make random edits; every one of `check_every` is judged from scratch.

    Raises
    ------
    AssertionError
        With the seed and the edit, if areas leave gaps, overlap, are slivers, or a dot is lost.
    """
    rng = np.random.default_rng(seed)
    areas = PlanarMap.of_page(*SIZE)
    dots = rng.random((N_DOTS, 2)) * SIZE
    owner = areas.area_at(dots)
    count: collections.Counter[str] = collections.Counter()
    for i in range(n_edits):
        name = _choose(rng, areas)
        try:
            after = EDITS[name](areas, rng).map
        except GeometryError:
            count[f"{name}, refused"] += 1
            continue
        count[name] += 1
        which, new = dots_in_strip(areas, after, dots, owner)
        owner[which] = new
        if i % check_every == 0:
            try:
                judge(after, dots, owner, f"seed {seed}, edit {i}, {name}")
            except AssertionError as error:
                error.maps = (areas, after)  # type: ignore[attr-defined]
                raise
        areas = after
        if i % 10_000 == 0:
            tell(f"{i} edits, {len(areas.areas)} areas, {len(areas.arcs)} borders")
    return areas, count


def judge(areas: PlanarMap, dots: NDArray[np.float64], owner: NDArray[np.int64], what: str) -> None:
    """Compare a map with what it would be from scratch, and with what shapely thinks of it."""
    fresh = PlanarMap(areas.arcs, areas.next_arc, areas.next_area)
    try:
        fresh.check()
    except GeometryError as error:
        raise AssertionError(f"{what}: {error}") from error
    for k in fresh.areas:
        if not fresh.outline(k).equals(areas.outline(k)):
            raise AssertionError(f"{what}: area {k} is not what its borders say")
        if any(is_sliver(part) for part in fresh.parts(k)):
            raise AssertionError(f"{what}: area {k} has a sliver")
    if (fresh.area_at(dots) != owner).any():
        raise AssertionError(f"{what}: dots outside their areas")


def outline(rng: Rng) -> Path:
    """Return a random closed path: ragged, on a coarse grid, curved, or crossing itself."""
    at = rng.random(2) * SIZE
    n = int(rng.integers(3, 12))
    turn = np.sort(rng.random(n)) * 2 * np.pi
    reach = rng.uniform(0.5, 15) * rng.uniform(0.5, 1, n)
    corners = at + reach[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    kind = rng.random()
    if kind < 0.3:
        corners = np.round(corners * 2) / 2
    if kind > 0.85:
        rng.shuffle(corners)
    path = Path.polyline(corners, closed=True)
    return moves.smooth_path(path) if 0.3 < kind < 0.5 and len(path) > 3 else path


def _choose(rng: Rng, areas: PlanarMap) -> str:
    name = str(rng.choice(list(EDITS), p=_SHARES))
    grows = name in ("add", "add, cut", "split", "cut out")
    return "remove" if grows and len(areas.areas) > MOST_AREAS else name


def _one_of(rng: Rng, areas: PlanarMap, *, page: bool = False) -> int:
    ids = [k for k in areas.areas if page or k != PAGE]
    if not ids:
        raise GeometryError("there is none", "area")
    return int(rng.choice(ids))


def _border(rng: Rng, areas: PlanarMap) -> int:
    return int(rng.choice(list(areas.arcs)))


def _unite(areas: PlanarMap, rng: Rng) -> edits.Outcome:
    area = _one_of(rng, areas)
    return edits.unite(areas, [int(rng.choice(areas.neighbours(area))), area])


def _split(areas: PlanarMap, rng: Rng) -> edits.Outcome:
    area = _one_of(rng, areas)
    x0, y0, x1, y1 = areas.outline(area).bounds
    at = rng.random((int(rng.integers(2, 5)), 2)) * (x1 - x0 + 2, y1 - y0 + 2) + (x0 - 1, y0 - 1)
    return edits.split(areas, Path.polyline(at), area)


def _move(areas: PlanarMap, rng: Rng, most: int = 1) -> edits.Outcome:
    chosen = []
    for _ in range(most):
        arc = _border(rng, areas)
        nodes = areas.arcs[arc].path.nodes()
        n = min(most, len(nodes))
        chosen += [(arc, int(i)) for i in rng.choice(nodes, n, replace=False)]
    by = rng.normal(0.0, 10 ** rng.uniform(-3.5, 1), 2)
    return moves.move_by(areas, chosen, (float(by[0]), float(by[1])))


def _handles(areas: PlanarMap, rng: Rng) -> edits.Outcome:
    curved = [k for k, a in areas.arcs.items() if a.path.curves]
    if not curved:
        raise GeometryError("there is none", "curve")
    arc = int(rng.choice(curved))
    curve = int(rng.integers(len(areas.arcs[arc].path.curves)))
    handles = np.array(areas.arcs[arc].path.curves[curve].handles_mm) + rng.normal(0, 1, (2, 2))
    return moves.move_handles(areas, arc, curve, tuple((float(x), float(y)) for x, y in handles))


def _add_node(areas: PlanarMap, rng: Rng) -> edits.Outcome:
    x, y = rng.random(2) * SIZE
    return moves.add_node(areas, _border(rng, areas), (float(x), float(y)))[0]


def _remove_node(areas: PlanarMap, rng: Rng) -> edits.Outcome:
    arc = _border(rng, areas)
    return moves.remove_nodes(areas, [(arc, int(rng.choice(areas.arcs[arc].path.nodes())))])


EDITS: dict[str, Callable[[PlanarMap, Rng], edits.Outcome]] = {
    "add": lambda areas, rng: edits.add(areas, outline(rng)),
    "add, cut": lambda areas, rng: edits.add(areas, outline(rng), edits.IS_CUT),
    "add, refused": lambda areas, rng: edits.add(areas, outline(rng), edits.REFUSED),
    "add, locked": lambda areas, rng: edits.add(areas, outline(rng), locked=areas.areas[1:4]),
    "subtract": lambda areas, rng: edits.subtract(
        areas, outline(rng), [_one_of(rng, areas, page=True)]
    ),
    "extend": lambda areas, rng: edits.extend(areas, outline(rng), _one_of(rng, areas)),
    "cut out": lambda areas, rng: edits.cut(areas, outline(rng), _one_of(rng, areas, page=True)),
    "unite": _unite,
    "split": _split,
    "remove": lambda areas, rng: edits.remove(areas, _one_of(rng, areas)),
    "move": _move,
    "move several": lambda areas, rng: _move(areas, rng, 3),
    "handles": _handles,
    "add node": _add_node,
    "remove node": _remove_node,
    "simplify": lambda areas, rng: moves.simplify(
        areas, [_border(rng, areas)], 10 ** rng.uniform(-3, 1)
    ),
    "smooth": lambda areas, rng: moves.smooth(areas, [_border(rng, areas)]),
}
_WEIGHTS = (15, 5, 3, 3, 8, 5, 3, 8, 10, 5, 20, 10, 5, 3, 3, 5, 3)
_SHARES = np.array(_WEIGHTS) / sum(_WEIGHTS)


def main() -> None:
    """Run, and say how many edits of each kind were made."""
    given = [int(a) for a in sys.argv[1:]]
    n_edits, seed, check_every = (*given, *(100_000, 1, 1)[len(given) :])
    begun = time.perf_counter()
    try:
        _, count = run(seed, n_edits, check_every, lambda line: print(line, flush=True))
    except AssertionError as error:
        for name, areas in zip(("before", "after"), getattr(error, "maps", ()), strict=False):
            FilePath(f"out/random-areas-{name}.json").write_text(json.dumps(areas.to_json()))
        raise
    for name, n in sorted(count.items()):
        print(f"{n:9} {name}")
    spent = time.perf_counter() - begun
    print(f"{n_edits} edits in {spent:.0f} s: no gap, no overlap, no sliver, no dot lost")


if __name__ == "__main__":
    main()
