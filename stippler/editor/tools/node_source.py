"""Whose nodes the node tool edits: a source gives paths, tries changes, and makes them.

Borders of areas are one source; whatever else has nodes and handles is another, in a file of its
own and one line in `node_tool.SOURCES`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from stippler.drawing.planar.path import Path
from stippler.editor.tools.tool import Desk, Point

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.planar.edits import Outcome
    from stippler.drawing.planar.planar_map import PlanarMap

Node = tuple[int, int]
"""A node of a path: (id of the path, vertex)."""


@dataclass(frozen=True, slots=True, eq=False)
class Trial:
    """A change that would be allowed, and is not made yet.

    Attributes
    ----------
    paths : mapping of id to Path
        Those that would be others then, for the preview.
    commit : callable
        Makes it, as one step of the history.
    """

    paths: Mapping[int, Path]
    commit: Callable[[], None]


class NodeSource(Protocol):
    """A kind of paths in a document. Every trial raises `GeometryError` where it is refused."""

    def key(self, document: Document) -> object:
        """Return what is another object, or another value, as soon as any path is another."""
        ...

    def paths(self, document: Document) -> Mapping[int, Path]:
        """Return all paths."""
        ...

    def active(self, document: Document, chosen_areas: Sequence[int]) -> set[int]:
        """Return the paths whose nodes are to be seen even if none is chosen."""
        ...

    @property
    def joins(self) -> bool:
        """Whether nodes of several paths in the same place are one node."""
        ...

    def move(self, document: Document, to_mm: Mapping[Node, Point]) -> Trial:
        """Try to move nodes."""
        ...

    def replace(self, document: Document, label: str, paths: Mapping[int, Path]) -> Trial:
        """Try to give paths other handles and inner nodes; their ends stay."""
        ...

    def remove(self, document: Document, nodes: Sequence[Node]) -> Trial:
        """Try to take nodes out."""
        ...

    def click(self, desk: Desk, at: Point) -> None:
        """Take a click beside all paths."""
        ...


class BorderNodes:
    """Borders between areas: every area that meets at a node follows it."""

    joins = True

    def key(self, document: Document) -> object:
        """Return the map of the areas."""
        from stippler.drawing import records

        if not document.drawing.table(records.BORDER):
            return None
        from stippler.drawing.area_edits import current_map

        return current_map(document)

    def paths(self, document: Document) -> Mapping[int, Path]:
        """Return borders; a page that was never divided has none to edit."""
        from stippler.drawing import records

        borders = document.drawing.table(records.BORDER)
        if len(borders) < 2:
            return {}
        return {k: arc.path for k, arc in borders.items()}

    def active(self, document: Document, chosen_areas: Sequence[int]) -> set[int]:
        """Return the borders of the chosen areas."""
        from stippler.drawing import records

        chosen = set(chosen_areas)
        borders = document.drawing.table(records.BORDER)
        return {k for k, a in borders.items() if a.left in chosen or a.right in chosen}

    def move(self, document: Document, to_mm: Mapping[Node, Point]) -> Trial:
        """Try to move nodes of borders."""
        from stippler.drawing.planar.moves import move_nodes

        return _trial(document, "Move border", lambda areas: move_nodes(areas, to_mm))

    def replace(self, document: Document, label: str, paths: Mapping[int, Path]) -> Trial:
        """Try to bend borders."""
        from stippler.drawing.planar.moves import reshape

        return _trial(document, label, lambda areas: reshape(areas, paths))

    def remove(self, document: Document, nodes: Sequence[Node]) -> Trial:
        """Try to take nodes out of borders."""
        from stippler.drawing.planar.moves import reshape
        from stippler.drawing.planar.nodes import remove_nodes
        from stippler.errors import GeometryError

        paths = self.paths(document)
        by_path: dict[int, list[int]] = {}
        for k, i in nodes:
            if paths[k].is_closed or 0 < i < len(paths[k]) - 1:
                by_path.setdefault(k, []).append(i)
        if not by_path:
            raise GeometryError(
                "cannot be removed", "a node where borders meet", "unite the areas instead"
            )
        made = {k: remove_nodes(paths[k], which) for k, which in by_path.items()}
        return _trial(document, "Remove nodes", lambda areas: reshape(areas, made))

    def click(self, desk: Desk, at: Point) -> None:
        """Choose the area that lies there."""
        desk.areas.click(desk.document, at, desk.mods)


def _trial(document: Document, label: str, edit: Callable[[PlanarMap], Outcome]) -> Trial:
    from stippler.drawing.area_edits import current_map, edit_areas, refuse_locked

    before = current_map(document)
    outcome = edit(before)
    refuse_locked(document.drawing, before, outcome.map)
    changed = {k: a.path for k, (_, a) in outcome.map.changes(before).items() if a is not None}

    def commit() -> None:
        edit_areas(document, label, lambda _: outcome)

    return Trial(changed, commit)
