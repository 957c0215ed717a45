"""Policies of pieces of borders: kept while borders are edited, and in files."""

from __future__ import annotations

import json
from itertools import pairwise

import numpy as np
import pytest

from benchmarks.random_areas import EDITS, SIZE
from stippler.drawing import records
from stippler.drawing.area_edits import current_map, edit_areas
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.edits import Outcome
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import Arc, PlanarMap
from stippler.drawing.planar.policies import runs_of, said, with_policy
from stippler.errors import GeometryError
from tests.conftest import EXAMPLES

POLICIES = ("", "", "wall", "through", "bleed", "automatic")


def box(x0, y0, x1, y1):
    return Path.polyline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], closed=True)


def by_segment(areas):
    """Return what each segment of a map says, by its ends."""
    found = {}
    for arc in areas.arcs.values():
        for (x0, y0, x1, y1), policy in zip(arc.path.segments().tolist(), said(arc), strict=True):
            found[frozenset(((x0, y0), (x1, y1)))] = policy
    return found


def spoken(areas, rng):
    """Give pieces between nodes policies by chance."""
    pieces = {}
    for k, arc in areas.arcs.items():
        stops = arc.path.nodes()
        pieces[k] = [(a, b, str(rng.choice(POLICIES))) for a, b in pairwise(stops)]
    return with_policy(areas, pieces)


@pytest.mark.parametrize("seed", range(3 * EXAMPLES))
def test_random_edits_keep_what_stays_where_it_was(seed):
    rng = np.random.default_rng(seed)
    areas = PlanarMap.of_page(*SIZE)
    n_kept = n_edits = 0
    names = sorted(EDITS)
    for i in range(60):
        name = names[int(rng.integers(len(names)))]
        try:
            after = EDITS[name](areas, rng).map
        except (GeometryError, IndexError, ValueError):
            continue
        before, now = by_segment(areas), by_segment(after)
        same = before.keys() & now.keys()
        assert {s: before[s] for s in same} == {s: now[s] for s in same}, (i, name)
        n_kept += sum(bool(before[s]) for s in same)
        n_edits += after is not areas
        areas = spoken(after, rng) if i % 10 == 0 else after
    assert n_edits > 20
    assert n_kept > 100
    again = PlanarMap.from_json(json.loads(json.dumps(areas.to_json())))
    assert again == areas


def halves():
    """A page parted in the middle, and the arc between."""
    areas = edits.add(PlanarMap.of_page(60, 40), box(0, 0, 30, 40)).map
    (k,) = (k for k, a in areas.arcs.items() if {a.left, a.right} == {0, 1})
    return areas, k


def test_a_piece_keeps_its_policy_when_its_nodes_move_or_come():
    areas, k = halves()
    areas, index = moves.add_node(areas, k, (30, 15))
    areas = with_policy(areas.map, {k: [(0, index, "through")]})
    areas = moves.move_nodes(areas, {(k, index): (33, 12)}).map
    assert said(areas.arcs[k]) == ["through", ""]
    for x, y in ((31.5, 6), (31.5, 26)):
        more = moves.add_node(areas, k, (x, y))[0].map.arcs[k]
        n = 1 + ((y < 12) == (areas.arcs[k].start[1] == 0))
        assert said(more) == ["through"] * n + [""] * (3 - n)
    smooth = moves.smooth(areas, [k]).map.arcs[k]
    at = int(np.argmin(np.hypot(*(smooth.path.points_mm - (33, 12)).T)))
    assert len(smooth.path) > 5
    assert smooth.policies == ((0, at, "through"),)


def test_a_piece_that_is_cut_or_given_away_keeps_its_policy():
    areas, k = halves()
    areas = with_policy(areas, {k: [(0, 1, "wall")]})
    cut = edits.split(areas, Path.polyline([(-1, 20), (31, 20)]), 1).map
    mine = [a for a in cut.arcs.values() if a.policies]
    assert len(mine) == 2
    assert sum(np.ptp(a.path.points_mm[:, 1]) for a in mine) == pytest.approx(40.0)
    (one,) = (a for a in edits.unite(cut, [1, 2]).map.arcs.values() if a.policies)
    assert set(said(one)) == {"wall"}
    assert {one.left, one.right} == {0, 1}
    assert not any(a.policies for a in edits.unite(areas, [1, 0]).map.arcs.values())


def test_a_policy_is_a_step_of_the_history():
    document = Document(Drawing.blank(Page(60.0, 40.0)))
    edit_areas(document, "Draw", lambda m: edits.add(m, box(0, 0, 30, 40)))
    (k,) = (k for k, a in document.drawing.borders.items() if {a.left, a.right} == {0, 1})
    edit_areas(
        document, "Border", lambda m: Outcome(with_policy(m, {k: [(0, 1, "through")]}))
    )  # fmt: skip
    assert said(current_map(document).arcs[k]) == ["through"]
    assert document.undo()
    assert said(current_map(document).arcs[k]) == [""]
    assert document.redo()
    assert document.drawing.table(records.BORDER)[k].policies == ((0, 1, "through"),)


@pytest.mark.parametrize(
    "runs",
    [[(0, 9, "wall")], [(0, 1, "open")], [(1, 1, "wall")], [(-1, 1, "wall")], [(0, 1)], 3,
     [(0, 1, "wall"), (0, 2, "wall")], [(0, 1, "")], [(0.0, 1, "wall")], [(0, 1, None)]],
)  # fmt: skip
def test_runs_that_are_none_are_refused(runs):
    arc = Arc(box(0, 0, 9, 9), 1, 0).to_json()
    with pytest.raises(GeometryError, match="no policy"):
        Arc.from_json(arc | {"policies": runs})


def test_runs_of_segments():
    assert runs_of(["", "wall", "wall", "", "through", "bleed"]) == (
        (1, 3, "wall"), (4, 5, "through"), (5, 6, "bleed"),
    )  # fmt: skip
    assert runs_of([]) == ()
