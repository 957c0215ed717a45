"""What looks at a map of areas a second time, and gives up rather than go on for ever."""

from types import SimpleNamespace

import numpy as np
import pytest
import shapely

from stippler.drawing import area_edits
from stippler.drawing.area_edits import current_map, edit_areas, map_of
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits, moves, overlay, slivers
from stippler.drawing.planar.planar_map import PAGE, Arc, PlanarMap
from stippler.drawing.planar.rings import sectors
from stippler.errors import GeometryError
from tests.drawing.test_planar_map import box, node_at, size


@pytest.fixture
def two():
    page = PlanarMap.of_page(100, 80)
    return edits.add(edits.add(page, box(10, 10, 50, 50)).map, box(50, 10, 90, 50)).map


def drawn_over(*outlines):
    """Return what `PlanarMap.check` looks at, of outlines."""
    return SimpleNamespace(areas=range(len(outlines)), outline=lambda k: outlines[k])


SOUND = (shapely.box(0, 0, 4, 8), shapely.box(4, 0, 10, 8))
FAULTY = {
    "overlap": (shapely.box(0, 0, 5, 8), shapely.box(4, 0, 10, 8)),
    "gap": (shapely.box(0, 0, 4, 8), shapely.box(4.5, 0, 10, 8)),
    "both, of one size": (
        shapely.box(0, 0, 5, 8), shapely.box(4, 0, 9, 4), shapely.box(5, 4, 10, 8),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTY)
def test_areas_that_overlap_or_leave_gaps_are_refused(name):
    PlanarMap.check(drawn_over(*SOUND))
    with pytest.raises(GeometryError, match="overlap or leave gaps"):
        PlanarMap.check(drawn_over(*FAULTY[name]))


def test_areas_in_which_shapely_finds_fault_without_any_are_looked_at_pair_by_pair(monkeypatch):
    monkeypatch.setattr(shapely, "coverage_is_valid", lambda _: False)
    monkeypatch.setattr(shapely, "coverage_invalid_edges", lambda outlines: outlines)
    PlanarMap.check(drawn_over(*SOUND))
    for outlines in FAULTY.values():
        with pytest.raises(GeometryError, match="overlap or leave gaps"):
            PlanarMap.check(drawn_over(*outlines))


def test_areas_around_a_node_follow_each_other(two):
    nodes = {arc.start for arc in two.arcs.values()} | {arc.end for arc in two.arcs.values()}
    assert sectors(nodes, two.arcs)
    (shared,) = (k for k, arc in two.arcs.items() if {arc.left, arc.right} == {1, 2})
    arc = two.arcs[shared]
    turned = {**two.arcs, shared: Arc(arc.path, arc.right, arc.left)}
    assert not sectors(nodes, turned)
    after = two.with_arcs({shared: turned[shared]})
    with pytest.raises(GeometryError, match="lie across another"):
        moves._check_order(after, {shared: turned[shared]})


@pytest.mark.parametrize("edit", ["add", "move"])
def test_borders_that_need_ever_more_room_are_refused(two, monkeypatch, edit):
    noded = overlay._noded
    rounds = []

    def greedy(areas, taken, paths, room, *more):
        pieces, _ = noded(areas, taken, paths, room, *more)
        rounds.append(room)
        return pieces, (room[0] - 1, *room[1:])

    monkeypatch.setattr(overlay, "_noded", greedy)
    (shared,) = (k for k, arc in two.arcs.items() if {arc.left, arc.right} == {1, 2})
    act = {
        "add": lambda: edits.add(two, box(5, 5, 30, 30)),
        "move": lambda: overlay.renode(two, {shared: two.arcs[shared]}),
    }[edit]
    with pytest.raises(GeometryError, match="too close together"):
        act()
    assert len(rounds) == 6


def test_slivers_are_given_away_round_by_round_and_no_more(monkeypatch):
    page = edits.add(PlanarMap.of_page(100, 80), box(10, 10, 50, 50)).map
    thin = edits.add(page, box(50, 10, 50.5, 50)).map
    monkeypatch.setattr(slivers, "LEAST_WIDTH_MM", 1.0)
    whole = slivers.without_slivers(thin, thin.areas)
    assert size(whole, 1) + size(whole, PAGE) == pytest.approx(8000)
    assert 2 not in whole.areas
    monkeypatch.setattr(slivers, "_MOST_ROUNDS", 1)
    once = slivers.without_slivers(thin, thin.areas)
    assert {k: size(once, k) for k in once.areas} == {k: size(whole, k) for k in whole.areas}


def test_a_border_that_is_not_there_is_not_simplified(two):
    outcome = moves.simplify(two, [999], 1.0)
    assert outcome.map is two
    assert outcome.notes == ()


@pytest.fixture
def document():
    drawing = Drawing.blank(Page(100, 80))
    drawing.dots = Dots.round(np.random.default_rng(0).random((200, 2)) * (100, 80), 0.2)
    made = Document(drawing)
    edit_areas(made, "Draw area", lambda m: edits.add(m, box(10, 10, 50, 50)))
    edit_areas(made, "Draw area", lambda m: edits.add(m, box(50, 10, 90, 50)))
    return made


def test_the_map_of_a_document_is_made_anew_when_a_border_was_moved_back(document):
    before = current_map(document)
    corner = node_at(before, 50, 50)
    edit_areas(document, "Move", lambda m: moves.move_nodes(m, {corner: (50.0, 60.0)}))
    moved = current_map(document)
    assert current_map(document) is moved
    document.undo()
    again = current_map(document)
    assert again is not moved
    assert again.arcs == before.arcs == map_of(document.drawing).arcs
    assert size(again, 1) == pytest.approx(1600)


def test_dots_that_an_area_left_on_its_rim_are_taken_in(document):
    areas = current_map(document)
    document.begin("Adopt")
    inside = np.flatnonzero(document.dots.area == 1)
    document.change("area", inside, np.full(len(inside), 9, np.int32))
    area_edits._adopt(document, edits.Outcome(areas, (), (9,), ()))
    assert np.array_equal(np.flatnonzero(document.dots.area == 1), inside)
    document.cancel()
