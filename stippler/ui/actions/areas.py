"""Commands on areas."""

from __future__ import annotations

from collections.abc import Iterator

from stippler.editor.commands import CTRL, CTRL_SHIFT, Command, Key
from stippler.ui.actions.parts import Parts


def area_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on the chosen areas."""
    acts = parts.area_acts

    def has_some() -> bool:
        return acts.n_chosen > 0

    def has_two() -> bool:
        return acts.n_chosen > 1

    for name, label, short, tip, run, keys, can in (
        ("unite", "Unite areas", "Unite", "the first chosen takes the places of the others.",
         acts.unite, (Key("u", CTRL),), has_two),
        ("remove", "Remove areas", "Remove", "their places and dots are the page's then.",
         acts.remove, (Key("delete", CTRL), Key("backspace", CTRL)), has_some),
        ("smooth", "Smooth borders", "Smooth", "turns the chosen areas' borders into curves.",
         acts.smooth, (), has_some),
        ("simplify", "Simplify borders", "Simplify",
         "leaves out nodes of the chosen areas' borders, as the panel Areas says.",
         acts.simplify, (), has_some),
        ("lock", "Lock or unlock areas", "Lock",
         "brushes and work leave the dots of locked areas alone.",
         lambda: acts.toggle("locked"), (Key("l", CTRL_SHIFT),), has_some),
        ("hide", "Hide or show areas", "Hide",
         "the dots of hidden areas are neither drawn nor exported.",
         lambda: acts.toggle("hidden"), (Key("h", CTRL_SHIFT),), has_some),
        ("up", "Area up in the list", "Up", "", lambda: acts.move_up(1), (), has_some),
        ("down", "Area down in the list", "Down", "", lambda: acts.move_up(-1), (), has_some),
    ):  # fmt: skip
        yield Command(f"area.{name}", label, run, keys, can=can, short=short, tip=tip)
