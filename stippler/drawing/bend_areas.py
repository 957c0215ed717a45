"""Areas that a deformation moves: their borders, and the patterns that lie over them."""

from __future__ import annotations

from collections.abc import Collection

from stippler.drawing.area_edits import current_map, edit_areas_within
from stippler.drawing.deformation import Deformation
from stippler.drawing.document import Document
from stippler.drawing.planar.moves import move_nodes
from stippler.drawing.planar.planar_map import OUTSIDE

Point = tuple[float, float]


def bend_borders(document: Document, areas: Collection[int], bent: Deformation) -> None:
    """Move the nodes of the areas' borders, within a stroke; those on the page's edge stay.

    Raises
    ------
    GeometryError
        If borders would cross.
    """
    before = current_map(document)
    edge = {
        tuple(v) for arc in before.arcs.values() if OUTSIDE in (arc.left, arc.right)
        for v in arc.path.vertices.tolist()
    }  # fmt: skip
    to_mm: dict[tuple[int, int], Point] = {}
    for k, arc in before.arcs.items():
        if OUTSIDE in (arc.left, arc.right) or not {arc.left, arc.right} & set(areas):
            continue
        nodes = [i for i in arc.path.nodes() if tuple(arc.path.vertices[i].tolist()) not in edge]
        for i, at in zip(nodes, bent.apply(arc.path.points_mm[nodes]), strict=True):
            to_mm[k, i] = (float(at[0]), float(at[1]))
    if to_mm:
        edit_areas_within(document, lambda areas_before: move_nodes(areas_before, to_mm))
