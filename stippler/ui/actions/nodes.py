"""Commands on the chosen nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from stippler.editor.commands import SHIFT, Command, Key
from stippler.editor.tools.node_tool import NodeTool
from stippler.editor.tools.tool import Desk
from stippler.ui.actions.parts import Parts


def node_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on the chosen nodes."""
    painting = parts.painting
    tool = next((t for t in painting.toolbox.tools if isinstance(t, NodeTool)), None)
    if tool is None:
        return

    def has_some() -> bool:
        return painting.toolbox.tool is tool and tool.n_chosen > 0

    def doing(act: Callable[[Desk], None]) -> Callable[[], None]:
        return lambda: painting.at_desk(act, parts.view.camera.px_per_mm)

    for name, label, short, tip, act, keys in (
        ("smooth", "Smooth nodes", "Smooth", "the path goes through them without a corner.",
         lambda desk: tool.bend(desk, smooth=True), (Key("s", SHIFT),)),
        ("corner", "Make nodes corners", "Corner", "draws their handles in.",
         lambda desk: tool.bend(desk, smooth=False), (Key("c", SHIFT),)),
        ("add", "Add nodes between", "Add", "one in the middle of each piece between two.",
         tool.add_between, ()),
        ("remove", "Remove nodes", "Remove", "what lay beside them becomes one piece.",
         tool.remove, ()),
        ("none", "Let go of all nodes", "None", "chooses none.",
         lambda desk: tool.choose_none(), ()),
    ):  # fmt: skip
        yield Command(f"nodes.{name}", label, doing(act), keys, can=has_some, short=short, tip=tip)
