"""What pieces of borders are to dots, where they are not what their areas say.

Kept with each arc as runs of its vertices. They live on while arcs are moved, bent, split, joined
and given to other areas, as long as their place does.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from stippler.drawing.planar.path import Path
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from stippler.drawing.planar.planar_map import Arc, PlanarMap

Run = tuple[int, int, str]
"""From which vertex of an arc to which it has a policy of its own, and which."""

_SAME = 4.0  # units of the grid; a border split elsewhere is moved by less
_FAR = 1e12


def said(arc: Arc) -> list[str]:
    """Return the policy of each segment of an arc; empty where it has none of its own."""
    out = [""] * (len(arc.path) - 1)
    for first, last, policy in arc.policies:
        out[first:last] = [policy] * (last - first)
    return out


def pieces_of(arc: Arc) -> tuple[Run, ...]:
    """Return all runs of an arc's vertices in order; empty where none has a policy of its own."""
    found: list[Run] = []
    at = 0
    for first, last, policy in arc.policies:
        if at < first:
            found.append((at, first, ""))
        found.append((first, last, policy))
        at = last
    end = len(arc.path) - 1
    return (*found, (at, end, "")) if at < end else tuple(found)


def runs_of(policies: Sequence[str]) -> tuple[Run, ...]:
    """Return the policies of segments as runs."""
    found: list[Run] = []
    first = 0
    for i in range(1, len(policies) + 1):
        if i == len(policies) or policies[i] != policies[first]:
            if policies[first]:
                found.append((first, i, policies[first]))
            first = i
    return tuple(found)


def checked_runs(runs: Iterable[Sequence[object]], n_vertices: int) -> tuple[Run, ...]:
    """Return runs as read from a file; refuse what are none."""
    from stippler.drawing.style import BORDERS

    found: list[Run] = []
    at = 0
    try:
        for first, last, policy in runs:
            if type(first) is not int or type(last) is not int or not at <= first < last:
                raise ValueError("no run")
            if last >= n_vertices or policy not in BORDERS:
                raise ValueError("no run")
            found.append((first, last, str(policy)))
            at = last
    except (TypeError, ValueError) as error:
        raise GeometryError("says what is no policy", "border", "the file is damaged") from error
    return tuple(found)


def with_policy(before: PlanarMap, pieces: Mapping[int, Iterable[Run]]) -> PlanarMap:
    """Return a map in which pieces of arcs have a policy; an empty one is their areas' again."""
    changed: dict[int, Arc | None] = {}
    for k, runs in pieces.items():
        if k not in before.arcs:
            raise GeometryError("is not there", f"border {k}")
        arc = before.arcs[k]
        now = said(arc)
        for first, last, policy in runs:
            now[first:last] = [policy] * (last - first)
        changed[k] = replace(arc, policies=runs_of(now))
    after = type(before)({**before.arcs, **changed}, before.next_arc, before.next_area)  # type: ignore[dict-item]
    return after.inherit(before, ())


def with_policies_of(old: Arc, new: Arc) -> Arc:
    """Return an arc that takes an old one's place, with its policies: piece by piece."""
    if not old.policies or new.policies:
        return new
    mine = said(old)
    if len(new.path) == len(old.path):
        return replace(new, policies=old.policies)
    before, after = old.path.nodes(), new.path.nodes()
    if len(before) != len(after):
        return _along([old], new, _FAR)
    now = [""] * (len(new.path) - 1)
    for a, first, last in zip(before[:-1], after[:-1], after[1:], strict=True):
        now[first:last] = [mine[a]] * (last - first)
    return replace(new, policies=runs_of(now))


def inherited(old: Iterable[Arc], made: Sequence[Arc]) -> list[Arc]:
    """Return arcs made of the same segments, split or joined, with their policies."""
    spoken = [arc for arc in old if arc.policies]
    return [_along(spoken, arc, _SAME) for arc in made] if spoken else list(made)


def _along(old: Sequence[Arc], new: Arc, within: float) -> Arc:
    """Give each segment the policy of the old one that its middle is nearest to."""
    xy = np.concatenate([arc.path.segments() for arc in old]).astype(np.float64)
    policies = [one for arc in old for one in said(arc)]
    middle = _middles(new.path)
    tree = shapely.STRtree(shapely.linestrings(xy.reshape(-1, 2, 2)))
    which, near = tree.query_nearest(shapely.points(middle), max_distance=within, all_matches=False)
    now = [""] * len(middle)
    for i, j in zip(which.tolist(), near.tolist(), strict=True):
        now[i] = policies[j]
    return replace(new, policies=runs_of(now))


def _middles(path: Path) -> NDArray[np.float64]:
    xy = path.segments()
    return np.asarray((xy[:, :2] + xy[:, 2:]) / 2.0)
