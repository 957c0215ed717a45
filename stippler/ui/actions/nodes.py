"""Commands on the chosen nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from stippler.drawing.style import THROUGH, parameter_of
from stippler.editor.border_labels import BORDER_COMMANDS, LABELS
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

    def has_pieces() -> bool:
        return has_some() and tool().has_pieces

    def is_said(policy: str) -> bool:
        document = parts.session.document
        if document is None or not has_pieces():
            return False
        return tool().says(document, policy)

    yield from _border_commands(doing, has_pieces, is_said, tool)


def _border_commands(
    doing: Callable[[Callable[[Desk], None]], Callable[[], None]],
    can: Callable[[], bool],
    is_said: Callable[[str], bool],
    tool: Callable[[], NodeTool],
) -> Iterator[Command]:
    """Yield what the pieces of borders between chosen nodes can be to dots."""
    tips = {one.value: one.help for one in parameter_of("border").choices}
    for name, policy in zip(BORDER_COMMANDS, LABELS, strict=True):
        short = LABELS[policy]
        tip = tips.get(policy, "What the areas beside the piece say, or their styles.")
        if policy == THROUGH:
            tip = "Dots on both sides of the piece see each other across it."
        act = doing(lambda desk, one=policy: tool().say(desk, one))  # type: ignore[misc]
        label = f"Piece of border: {short.lower()}"
        yield Command(f"nodes.{name}", label, act, (), can=can, short=short, tip=tip,
                      is_on=lambda one=policy: is_said(one))  # type: ignore[misc]  # fmt: skip
