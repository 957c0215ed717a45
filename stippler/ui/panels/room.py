"""Room for the canvas beside docked panels, for the names on tabs, and around floating panels."""

from __future__ import annotations

from collections.abc import Sequence

from imgui_bundle import imgui

_LEAST_CANVAS = 340.0  # the theme's pixels
_SHARES = (
    0.4,
    0.45,
)  # of the room: the canvas has the first, and is not held to more than the second
_LEAST_DOCK = 170.0  # the theme's pixels
_SMALLEST_TAB = 0.7
_X = 0  # ImGui's axis


def keep_canvas(
    names: Sequence[str],
    middle: imgui.internal.DockNode,
    room: float,
    scale: float,
    wanted: dict[int, float],
    *,
    grows: bool,
) -> None:
    """Make docks at the sides narrower where they would leave too little of the canvas.

    Parameters
    ----------
    wanted : dict
        How wide each was before; kept up to date.
    grows : bool
        Whether the window has another size now: then docks may be as wide again as they were.
    """
    sides = _sides(names, middle)
    for place, node in sides.items():
        if place not in wanted or not grows:
            wanted[place] = node.size.x
    for place in set(wanted) - set(sides):
        del wanted[place]
    if not sides:
        return
    least = min(max(_LEAST_CANVAS * scale, _SHARES[0] * room), _SHARES[1] * room)
    asked = sum(wanted.values())
    share = min(max(room - least, 1.0) / asked, 1.0)
    for place, node in sides.items():
        width = max(wanted[place] * share, min(_LEAST_DOCK * scale, 0.6 * room / len(sides)))
        if abs(width - node.size.x) >= 1.0:
            imgui.internal.dock_builder_set_node_size(
                place, imgui.ImVec2(round(width), node.size.y)
            )


def _sides(
    names: Sequence[str], middle: imgui.internal.DockNode
) -> dict[int, imgui.internal.DockNode]:
    """Return the docks that stand beside the canvas, each as wide as it is, by their ids."""
    above, node = set(), middle
    while node is not None:
        above.add(node.id_)
        node = node.parent_node
    found = {}
    for name in names:
        window = imgui.internal.find_window_by_name(name)
        node = window.dock_node if window is not None and window.was_active else None
        while node is not None and node.parent_node is not None:
            if node.parent_node.id_ in above:
                if node.parent_node.split_axis == _X and node.id_ not in above:
                    found[node.id_] = node
                break
            node = node.parent_node
    return found


def tab_scale(names: Sequence[str], padding: float, scale: float) -> float:
    """Return how small names on tabs have to be, that all of a dock stand beside each other."""
    rows: dict[int, list[str]] = {}
    widths: dict[int, float] = {}
    for name in names:
        window = imgui.internal.find_window_by_name(name)
        if window is not None and window.was_active and window.dock_node is not None:
            rows.setdefault(window.dock_node.id_, []).append(name)
            widths[window.dock_node.id_] = window.dock_node.size.x
    share = 1.0
    for place, row in rows.items():
        text = sum(imgui.calc_text_size(name).x for name in row)
        spare = (
            widths[place] - (40.0 + 3.0 * len(row)) * scale
        )  # with the cross of the one in front
        while share > _SMALLEST_TAB and share * text + len(row) * 2 * padding * share**3 > spare:
            share -= 0.02
    return share


def hold_inside(names: Sequence[str], low: tuple[float, float], size: tuple[float, float]) -> None:
    """Bring floating panels back between the strip, the menu and the status bar."""
    for name in names:
        window = imgui.internal.find_window_by_name(name)
        if window is None or not window.was_active:
            continue
        root = window.root_window_dock_tree
        if root is None or root.name.startswith("##host"):
            continue
        width, height = min(root.size.x, size[0]), min(root.size.y, size[1])
        if (width, height) != (root.size.x, root.size.y):
            imgui.set_window_size(root.name, (width, height))
        x = min(max(root.pos.x, low[0]), low[0] + size[0] - width)
        y = min(max(root.pos.y, low[1]), low[1] + size[1] - height)
        if (round(x), round(y)) != (round(root.pos.x), round(root.pos.y)):
            imgui.internal.set_window_pos(root, imgui.ImVec2(round(x), round(y)))
