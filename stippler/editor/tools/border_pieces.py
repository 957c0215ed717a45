"""The pieces of borders between chosen nodes, and what they are to dots."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from stippler.editor.border_labels import LABELS
from stippler.editor.messages import WARNING
from stippler.editor.tools.node_source import BorderNodes
from stippler.editor.tools.tool import Desk
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.planar.edits import Outcome
    from stippler.drawing.planar.planar_map import PlanarMap
    from stippler.editor.tools.node_tool import Held

Pieces = dict[int, list[tuple[int, int]]]
"""By border: from which vertex to which."""


def chosen_pieces(held: Sequence[Held]) -> Pieces:
    """Return the pieces of borders both of whose ends are chosen; the pressed one alone."""
    found: Pieces = {}
    for one in held:
        if not isinstance(one.source, BorderNodes):
            continue
        paths = one.index.paths
        nodes = set(one.nodes)
        pressed = one.pressed
        for k in {k for k, _ in nodes}:
            n = len(paths[k]) - 1
            mine = {i for j, i in nodes if j == k}
            if paths[k].is_closed and 0 in mine:
                mine.add(n)
            stops = paths[k].nodes()
            pieces = [
                (a, b) for a, b in pairwise(stops)
                if a in mine and b in mine
                and (pressed is None or pressed == (k, a))
            ]  # fmt: skip
            if pieces:
                found[k] = pieces
    return found


def policies_of(document: Document, pieces: Pieces) -> set[str]:
    """Return what pieces say of themselves."""
    from stippler.drawing.area_edits import current_map
    from stippler.drawing.planar.policies import said

    arcs = current_map(document).arcs
    return {said(arcs[k])[a] for k, runs in pieces.items() if k in arcs for a, _ in runs}


def set_policy(desk: Desk, held: Sequence[Held], policy: str) -> None:
    """Say what the chosen pieces are to dots, as one step; `AS_STYLE` leaves it to their areas."""
    from stippler.drawing.area_edits import edit_areas
    from stippler.drawing.planar.edits import Outcome
    from stippler.drawing.planar.policies import with_policy

    pieces = chosen_pieces(held)
    if not pieces:
        desk.say("press a piece of a border, or choose both its nodes", WARNING)
        return
    if policies_of(desk.document, pieces) == {policy}:
        return

    def edit(areas: PlanarMap) -> Outcome:
        runs = {k: [(a, b, policy) for a, b in ends] for k, ends in pieces.items()}
        return Outcome(with_policy(areas, runs))

    try:
        edit_areas(desk.document, f"Border: {LABELS[policy].lower()}", edit)
    except GeometryError as error:
        desk.say(str(error), WARNING)


def pieces_text(document: Document, held: Sequence[Held]) -> str:
    """Say what the chosen pieces are to dots; nothing where none is chosen."""
    pieces = chosen_pieces(held)
    if not pieces:
        return ""
    policies = policies_of(document, pieces)
    what = LABELS[policies.pop()].lower() if len(policies) == 1 else "several"
    n = sum(len(runs) for runs in pieces.values())
    return f"Border of {n:,} {'piece' if n == 1 else 'pieces'}: {what}"
