"""Edits nodes and handles of borders and of whatever else is made of paths."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from stippler.editor.border_labels import BORDER_COMMANDS
from stippler.editor.events import LEFT, Event, KeyDown, Moved, Pressed
from stippler.editor.messages import WARNING
from stippler.editor.tools.border_pieces import (
    chosen_pieces,
    pieces_text,
    policies_of,
    set_policy,
)
from stippler.editor.tools.line_nodes import LineNodes
from stippler.editor.tools.node_index import NodeIndex, Owned
from stippler.editor.tools.node_source import BorderNodes, Node, NodeSource, Trial
from stippler.editor.tools.node_states import Boxing, Dragging
from stippler.editor.tools.tool import (
    NOTHING,
    RESTING,
    Desk,
    Handle,
    Overlay,
    Path,
    Point,
    Sight,
    Tool,
    ToolState,
)
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.drawing.document import Document

SOURCES: tuple[type[NodeSource], ...] = (LineNodes, BorderNodes)
"""What has nodes; where several lie in one place the first has the pointer."""

NODE_PX, HANDLE_PX, PIECE_PX = 8.0, 8.0, 6.0
_DOUBLE_S, _DOUBLE_PX = 0.35, 4.0
_MOST_SHOWN = 800
_ARROWS = {"left": (-1.0, 0.0), "right": (1.0, 0.0), "up": (0.0, -1.0), "down": (0.0, 1.0)}
_STEP_MM, _FAR = 0.1, 10.0


class Held:
    """A source, its index, and its chosen nodes."""

    def __init__(self, source: NodeSource) -> None:
        self.source = source
        self.index = NodeIndex(joins=source.joins)
        self.chosen: set[Owned] = set()
        self._piece: tuple[Node, set[Owned]] | None = None
        self._key: object = None
        self._of: Document | None = None

    def update(self, document: Document) -> None:
        """Look at the document's paths, if they are others."""
        key = self.source.key(document)
        if key is self._key and document is self._of:
            return
        self._key, self._of = key, document
        self.index.update(self.source.paths(document))
        if self.chosen:
            self.chosen = {self.index.owned(node) for node in self.index.nodes(self.chosen)}

    @property
    def nodes(self) -> list[Node]:
        """The chosen nodes, of each path that has them."""
        return self.index.nodes(self.chosen)

    def press(self, ends: tuple[Node, Node]) -> set[Owned]:
        """Note which piece was pressed; return the nodes at its ends."""
        owned = {self.index.owned(node) for node in ends}
        self._piece = (ends[0], owned)
        return owned

    @property
    def pressed(self) -> Node | None:
        """Where the piece begins that was pressed, while its ends are what is chosen."""
        if self._piece is None or self._piece[1] != self.chosen:
            return None
        return self._piece[0]


class NodeTool(Tool):
    """Chooses, drags, adds, removes nodes; bends what lies between them.

    Attributes
    ----------
    held : list of Held
        One for each source.
    """

    commands = ("nodes.smooth", "nodes.corner", "nodes.add", "nodes.remove", "nodes.none")
    groups = (("Piece of border", tuple(f"nodes.{name}" for name in BORDER_COMMANDS)),)
    shows_areas = True

    def __init__(self) -> None:
        super().__init__()
        self.held = [Held(source()) for source in SOURCES]
        self._clicked: tuple[float, Point] = (-1.0, (0.0, 0.0))
        self._document: Document | None = None

    # --- input --------------------------------------------------------------------------------

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Take hold of a handle, a node or a piece, or begin a box beside them."""
        if isinstance(event, Moved):
            return None
        if isinstance(event, KeyDown):
            return self._key(event, desk)
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        self.update(desk.document)
        at, px = desk.at(event), (event.x_px, event.y_px)
        if self._is_double(event):
            self.add_at(desk, at)
            return RESTING
        for held in self.held:
            if grabbed := held.index.handle_at(at, held.nodes, desk.mm(HANDLE_PX)):
                return Dragging(self, held, at, px, handle=grabbed)
        for held in self.held:
            if (node := held.index.node_at(at, desk.mm(NODE_PX))) is not None:
                return self._node(held, node, at, px, desk)
        for held in self.held:
            if ends := held.index.piece_at(at, desk.mm(PIECE_PX)):
                self._choose(held, held.press(ends), desk)
                return Dragging(self, held, at, px)
        return Boxing(self, at, px)

    def _node(self, held: Held, node: Node, at: Point, px: Point, desk: Desk) -> ToolState:
        mine = held.index.owned(node)
        if desk.mods.shift:
            held.chosen ^= {mine}
            if mine not in held.chosen:
                return RESTING
        elif mine not in held.chosen:
            self._choose(held, {mine}, desk)
        return Dragging(self, held, at, px, about=node)

    def _choose(self, held: Held, owned: set[Owned], desk: Desk) -> None:
        if desk.mods.shift:
            held.chosen |= owned
            return
        self.choose_none()
        held.chosen = owned

    def _is_double(self, event: Pressed) -> bool:
        (t, (x, y)), at = self._clicked, (event.x_px, event.y_px)
        self._clicked = (event.t_s, at)
        near = abs(x - at[0]) + abs(y - at[1]) <= _DOUBLE_PX
        is_second = near and event.t_s - t < _DOUBLE_S and t >= 0.0
        if is_second:
            self._clicked = (-1.0, at)
        return is_second

    def wants(self, event: KeyDown, desk: Desk) -> bool:
        """Take Delete, Escape and the arrows while nodes are chosen."""
        self.update(desk.document)
        known = event.key in ("delete", "backspace", "escape") or event.key in _ARROWS
        return known and self.n_chosen > 0 and not (event.mods.ctrl or event.mods.alt)

    def _key(self, event: KeyDown, desk: Desk) -> ToolState | None:
        if not self.wants(event, desk):
            return None
        if event.key == "escape":
            self.choose_none()
        elif event.key in _ARROWS:
            step = _STEP_MM * (_FAR if event.mods.shift else 1.0)
            dx, dy = _ARROWS[event.key]
            self.nudge(desk, (dx * step, dy * step))
        else:
            self.remove(desk)
        return RESTING

    # --- what can be done to the chosen nodes -------------------------------------------------

    def update(self, document: Document) -> None:
        """Look at a document's paths, where they are others."""
        self._document = document
        for held in self.held:
            held.update(document)

    @property
    def chosen_text(self) -> str:
        """Say how many nodes are chosen."""
        n = self.n_chosen
        if not n or self._document is None:
            return "No nodes chosen"
        pieces = pieces_text(self._document, self.held)
        return f"{n:,} {'node' if n == 1 else 'nodes'} chosen" + (pieces and f". {pieces}")

    @property
    def n_chosen(self) -> int:
        """How many nodes are chosen; one where several paths meet counts once."""
        return sum(len(held.chosen) for held in self.held)

    @property
    def has_pieces(self) -> bool:
        """Whether pieces of borders are chosen."""
        return bool(chosen_pieces(self.held))

    def says(self, document: Document, policy: str) -> bool:
        """Whether that is what all chosen pieces of borders are to dots."""
        return policies_of(document, chosen_pieces(self.held)) == {policy}

    def say(self, desk: Desk, policy: str) -> None:
        """Say what the chosen pieces of borders are to dots, as one step."""
        set_policy(desk, self.held, policy)

    def choose_none(self) -> None:
        """Choose no node."""
        for held in self.held:
            held.chosen = set()

    def choose_box(self, desk: Desk, low: Point, high: Point) -> None:
        """Choose the nodes in a box; Shift adds them."""
        if not desk.mods.shift:
            self.choose_none()
        for held in self.held:
            held.chosen |= {held.index.owned(node) for node in held.index.in_box(low, high)}

    def nudge(self, desk: Desk, by: Point) -> None:
        """Move the chosen nodes by a step."""
        for held in self.held:
            if nodes := held.nodes:
                to = self.moved(held, nodes, by)
                self.make(desk, held, partial(held.source.move, desk.document, to), to)

    def remove(self, desk: Desk) -> None:
        """Take the chosen nodes out."""
        for held in self.held:
            if nodes := held.nodes:
                self.make(desk, held, partial(held.source.remove, desk.document, nodes))

    def bend(self, desk: Desk, *, smooth: bool) -> None:
        """Make the chosen nodes smooth, or corners."""
        from stippler.drawing.planar.nodes import make_corner, make_smooth

        label = "Smooth nodes" if smooth else "Make corners"
        change = make_smooth if smooth else make_corner
        for held in self.held:
            paths = {k: change(held.index.paths[k], v) for k, v in _by_path(held.nodes).items()}
            if paths:
                self.make(desk, held, partial(held.source.replace, desk.document, label, paths))

    def add_at(self, desk: Desk, at: Point) -> None:
        """Add a node where a path is nearest, and choose it."""
        for held in self.held:
            if ends := held.index.piece_at(at, desk.mm(PIECE_PX)):
                self.choose_none()
                self._add(desk, held, ends[0][0], at)
                return

    def add_between(self, desk: Desk) -> None:
        """Add a node in the middle of each piece both of whose ends are chosen."""
        from stippler.drawing.planar.nodes import middles

        for held in self.held:
            wanted = [
                (k, at)
                for k, which in _by_path(held.nodes).items()
                for at in middles(held.index.paths[k], which)
            ]
            for k, at in wanted:
                if k in held.index.paths:
                    self._add(desk, held, k, at)

    def _add(self, desk: Desk, held: Held, k: int, at: Point) -> None:
        from stippler.drawing.planar.moves import with_node

        path, index = with_node(held.index.paths[k], at)
        x, y = path.points_mm[index].tolist()
        if len(path) != len(held.index.paths[k]):
            self.make(desk, held, lambda: held.source.replace(desk.document, "Add node", {k: path}))
        if (node := held.index.node_at((x, y), 1e-3)) is not None:
            held.chosen |= {held.index.owned(node)}

    def make(
        self,
        desk: Desk,
        held: Held,
        attempt: Callable[[], Trial],
        to_mm: Mapping[Node, Point] | None = None,
    ) -> None:
        """Make a change, or say why not; chosen nodes stay chosen where they come to be."""
        from stippler.drawing.planar.path import to_grid

        try:
            trial = attempt()
        except GeometryError as error:
            desk.say(str(error), WARNING)
            return
        after = set(held.chosen)
        for node, place in (to_mm or {}).items():
            owner, _ = held.index.owned(node)
            x, y = to_grid([place])[0].tolist()
            after.add((owner, (x, y)))
        trial.commit()
        held.chosen = after
        self.update(desk.document)

    def moved(self, held: Held, nodes: list[Node], by: Point) -> dict[Node, Point]:
        """Return where nodes come to be by a shift."""
        places = {node: held.index.place_mm(node) for node in nodes}
        return {node: (x + by[0], y + by[1]) for node, (x, y) in places.items()}

    # --- what is seen -------------------------------------------------------------------------

    def overlay(self, sight: Sight) -> Overlay:
        """Return the nodes of active paths, and the handles of the chosen ones."""
        if sight.document is None or sight.is_held:
            return NOTHING
        self.update(sight.document)
        handles: list[Handle] = []
        paths: list[Path] = []
        for held in self.held:
            self._show(held, sight, handles, paths)
        return Overlay(tuple(paths), tuple(handles))

    def _show(self, held: Held, sight: Sight, handles: list[Handle], paths: list[Path]) -> None:
        assert sight.document is not None
        index, chosen = held.index, held.nodes
        active = held.source.active(sight.document, sight.areas.ids)
        active |= {k for k, _ in chosen}
        if sight.at_mm is not None and (ends := index.piece_at(sight.at_mm, PIECE_PX * sight.mm)):
            active.add(ends[0][0])
        for node_at, at in handles_of(index, chosen):
            paths.append(Path((node_at, at)))
            handles.append(Handle(at, "control"))
        seen = {index.owned(node) for node in chosen}
        shown = 0
        for k in active & set(index.paths):
            path = index.paths[k]
            for i in path.nodes()[: -1 if path.is_closed else None]:
                if index.owned((k, i)) not in seen and shown < _MOST_SHOWN:
                    handles.append(Handle(index.place_mm((k, i)), "node"))
                    shown += 1
        done = set()
        for node in chosen:
            if (mine := index.owned(node)) not in done:
                done.add(mine)
                handles.append(Handle(index.place_mm(node), "node", chosen=True))

    def put_away(self) -> None:
        """Choose no node."""
        self.choose_none()

    def forget(self) -> None:
        """Know no paths."""
        self.held = [Held(source()) for source in SOURCES]
        self._document = None


def handles_of(index: NodeIndex, nodes: list[Node]) -> list[tuple[Point, Point]]:
    """Return where nodes with handles are, and where their handles are."""
    from stippler.drawing.planar.nodes import handles_at

    return [
        (index.place_mm(node), at)
        for node in nodes
        for at in handles_at(index.paths[node[0]], node[1]).values()
    ]


def _by_path(nodes: list[Node]) -> dict[int, list[int]]:
    found: dict[int, list[int]] = {}
    for k, i in nodes:
        found.setdefault(k, []).append(i)
    return found
