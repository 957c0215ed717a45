"""Lines as paths whose nodes the node tool edits; dots on them go along."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from stippler.drawing.one_step import as_one_step
from stippler.drawing.planar.path import Path
from stippler.editor.line_edits import lines_of, meet, set_line
from stippler.editor.tools.line_choice import line_at
from stippler.editor.tools.node_source import Node, Trial
from stippler.editor.tools.tool import Desk, Point

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.line import Line

_NEAR_PX = 8.0
_FEW = 12  # lines whose nodes are all shown


class LineNodes:
    """Lines that are neither hidden nor locked."""

    joins = False

    def __init__(self) -> None:
        self._lines: list[tuple[int, Line]] = []
        self._key: object = object()

    def key(self, document: Document) -> object:
        """Return the same object until a line is another."""
        now = list(lines_of(document).items())
        same = len(now) == len(self._lines) and all(
            a == b and x is y for (a, x), (b, y) in zip(now, self._lines, strict=True)
        )
        if not same:
            self._lines, self._key = now, object()
        return self._key

    def paths(self, document: Document) -> Mapping[int, Path]:
        """Return their axes."""
        lines = lines_of(document).items()
        return {k: line.path for k, line in lines if not (line.hidden or line.locked)}

    def active(self, document: Document, chosen_areas: Sequence[int]) -> set[int]:
        """Return all, where they are few."""
        paths = self.paths(document)
        return set(paths) if len(paths) <= _FEW else set()

    def move(self, document: Document, to_mm: Mapping[Node, Point]) -> Trial:
        """Try to move nodes of lines."""
        from stippler.drawing.planar.nodes import move_nodes

        return _trial(document, "Move line", move_nodes, _by_path(to_mm))

    def replace(self, document: Document, label: str, paths: Mapping[int, Path]) -> Trial:
        """Try to bend lines."""
        _check(document, paths)
        label = label.replace("border", "line")
        return Trial(paths, lambda: _make(document, label, paths))

    def remove(self, document: Document, nodes: Sequence[Node]) -> Trial:
        """Try to take nodes out of lines."""
        from stippler.drawing.planar.nodes import remove_nodes

        gone: dict[int, list[int]] = {}
        for k, i in nodes:
            gone.setdefault(k, []).append(i)
        return _trial(document, "Remove nodes", remove_nodes, gone)

    def click(self, desk: Desk, at: Point) -> None:
        """Choose the line that lies there."""
        desk.lines.choose(line_at(desk.document, at, desk.mm(_NEAR_PX)), desk.mods)


def _by_path(to_mm: Mapping[Node, Point]) -> dict[int, dict[int, Point]]:
    found: dict[int, dict[int, Point]] = {}
    for (k, i), at in to_mm.items():
        found.setdefault(k, {})[i] = at
    return found


def _trial(
    document: Document, label: str, edit: Callable[[Path, Any], Path], of: Mapping[int, Any]
) -> Trial:
    lines = lines_of(document)
    paths = {k: edit(lines[k].path, what) for k, what in of.items()}
    _check(document, paths)
    return Trial(paths, lambda: _make(document, label, paths))


def _check(document: Document, paths: Mapping[int, Path]) -> None:
    """Refuse paths that make no line."""
    for k, path in paths.items():
        replace(lines_of(document)[k], path=path)


def _make(document: Document, label: str, paths: Mapping[int, Path]) -> None:
    def act(document: Document) -> None:
        for k, path in paths.items():
            set_line(document, k, replace(lines_of(document)[k], path=path))
            meet(document, k)

    as_one_step(document, label, act)
