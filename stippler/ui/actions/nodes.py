"""Commands on the chosen nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from stippler.editor.commands import SHIFT, Command, Key
from stippler.editor.tools.tool import Desk
from stippler.ui.actions.parts import Parts

if TYPE_CHECKING:
    from stippler.editor.tools.node_tool import NodeTool


def node_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on the chosen nodes."""
    painting = parts.painting

    def tool() -> NodeTool:
        return painting.toolbox.made("nodes")  # type: ignore[return-value]

    def has_some() -> bool:
        return painting.toolbox.name == "nodes" and tool().n_chosen > 0

    def doing(act: Callable[[Desk], None]) -> Callable[[], None]:
        return lambda: painting.at_desk(act, parts.view.camera.px_per_mm)

    for name, label, short, tip, act, keys in (
        ("smooth", "Smooth nodes", "Smooth", "the path goes through them without a corner.",
         lambda desk: tool().bend(desk, smooth=True), (Key("s", SHIFT),)),
        ("corner", "Make nodes corners", "Corner", "draws their handles in.",
         lambda desk: tool().bend(desk, smooth=False), (Key("c", SHIFT),)),
        ("add", "Add nodes between", "Add", "one in the middle of each piece between two.",
         lambda desk: tool().add_between(desk), ()),
        ("remove", "Remove nodes", "Remove", "what lay beside them becomes one piece.",
         lambda desk: tool().remove(desk), ()),
        ("none", "Let go of all nodes", "None", "chooses none.",
         lambda desk: tool().choose_none(), ()),
    ):  # fmt: skip
        yield Command(f"nodes.{name}", label, doing(act), keys, can=has_some, short=short, tip=tip)
