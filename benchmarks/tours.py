"""What others make of the same points: 2-opt as textbooks have it, OR-tools, and LKH if installed.

2-opt is a reference of its own: nearest neighbour first, then exchanges among the ten nearest until
none helps; it shares nothing with `stippler.kernels.tour`. LKH is taken from `elkai`, which is no
dependency of ours (``pip install elkai``).
"""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Points = NDArray[np.float64]
Order = NDArray[np.int64]


def two_opt(points: Points) -> Order:
    """Return a closed tour that no exchange of two steps among near points shortens."""
    near = np.asarray(cKDTree(points).query(points, k=11)[1])[:, 1:].astype(np.int64)
    order = _nearest_first(points, near)
    run: Callable[..., None] = _exchange
    run(points, near, order)
    return order


def _nearest_first(points: Points, near: Order) -> Order:
    """Go to the nearest point that is left, by lists of neighbours, else by a tree of the rest."""
    left = np.ones(len(points), np.bool_)
    order = np.empty(len(points), np.int64)
    at, tree, rows = 0, cKDTree(points), np.arange(len(points))
    for k in range(len(points)):
        order[k], left[at] = at, False
        if k + 1 == len(points):
            break
        free = near[at][left[near[at]]]
        if len(free):
            at = int(free[0])
            continue
        n = 16
        while True:  # many around are taken: look farther, and forget those from time to time
            found = rows[np.atleast_1d(tree.query(points[at], k=min(n, len(rows)))[1])]
            found = found[left[found]]
            if len(found):
                at = int(found[0])
                break
            n *= 4
            if n > 4096:
                rows = np.flatnonzero(left)
                tree, n = cKDTree(points[rows]), 16
    return order


@numba.njit(cache=True)  # type: ignore[misc,unused-ignore]
def _exchange(points, near, order):  # type: ignore[no-untyped-def]
    n = len(order)
    place = np.empty(n, np.int64)
    for k in range(n):
        place[order[k]] = k
    found = True
    while found:
        found = False
        for a in range(n):
            for way in (1, -1):
                b = order[(place[a] + way) % n]
                ab = np.sqrt(((points[a] - points[b]) ** 2).sum())
                for c in near[a]:
                    ac = np.sqrt(((points[a] - points[c]) ** 2).sum())
                    if ac >= ab:
                        break
                    d = order[(place[c] + way) % n]
                    cd = np.sqrt(((points[c] - points[d]) ** 2).sum())
                    bd = np.sqrt(((points[b] - points[d]) ** 2).sum())
                    if ac + bd < ab + cd - 1e-12:
                        i, j = (place[b], place[c]) if way == 1 else (place[c], place[b])
                        inside = (j - i) % n + 1
                        if 2 * inside > n:
                            i, j, inside = (j + 1) % n, (i - 1) % n, n - inside
                        for _ in range(inside // 2):
                            p, q = order[i], order[j]
                            order[i], order[j] = q, p
                            place[q], place[p] = i, j
                            i, j = (i + 1) % n, (j - 1) % n
                        found = True
                        break


def or_tools(points: Points, limit_s: int) -> Order | None:
    """Return what guided local search finds in a time; None without OR-tools."""
    if importlib.util.find_spec("ortools") is None:
        return None
    from ortools.constraint_solver import (  # type: ignore[import-untyped,unused-ignore]
        pywrapcp,
        routing_enums_pb2,
    )

    away = np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1))
    manager = pywrapcp.RoutingIndexManager(len(points), 1, 0)
    routing = pywrapcp.RoutingModel(manager)
    index = routing.RegisterTransitMatrix(np.rint(1e6 * away).astype(int).tolist())
    routing.SetArcCostEvaluatorOfAllVehicles(index)
    parameters = pywrapcp.DefaultRoutingSearchParameters()
    first, search = (
        routing_enums_pb2.FirstSolutionStrategy,
        routing_enums_pb2.LocalSearchMetaheuristic,
    )
    parameters.first_solution_strategy = first.SAVINGS
    parameters.local_search_metaheuristic = search.GUIDED_LOCAL_SEARCH
    parameters.time_limit.seconds = limit_s
    solution = routing.SolveWithParameters(parameters)
    at, order = routing.Start(0), []
    while not routing.IsEnd(at):
        order.append(manager.IndexToNode(at))
        at = solution.Value(routing.NextVar(at))
    return np.array(order)


def lkh(points: Points) -> Order | None:
    """Return what one run of LKH 3 finds; None without elkai."""
    if importlib.util.find_spec("elkai") is None:
        return None
    import elkai  # type: ignore[import-not-found,unused-ignore]

    places = {str(k): (float(x), float(y)) for k, (x, y) in enumerate(1e4 * points)}
    return np.array([int(k) for k in elkai.Coordinates2D(places).solve_tsp(runs=1)[:-1]])


def main() -> None:
    """Print each beside ours."""
    from stippler.stippling.tour import length_of, tour

    for n, names in ((1000, ("lkh", "or-tools 10 s", "2-opt")), (2000, ("or-tools 20 s", "2-opt"))):
        points = np.random.default_rng(n).random((n, 2))
        ours = {
            e: length_of(points, tour(points, closed=True, effort=e), closed=True) for e in (0, 0.6)
        }
        for name in names:
            start = time.perf_counter()
            call = {"lkh": lkh, "2-opt": two_opt}.get(
                name, lambda p, s=10 * n // 1000: or_tools(p, s)
            )
            found = call(points)
            if found is None:
                continue
            taken = time.perf_counter() - start
            length = length_of(points, found, closed=True)
            told = ", ".join(f"effort {e:g} {own / length:.4f}" for e, own in ours.items())
            print(f"{n:,} points, {name} ({taken:.1f} s): ours {told}")


if __name__ == "__main__":
    main()
