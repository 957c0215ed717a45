"""Styles that come with the program, on a shelf of small pictures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from stippler.drawing.style import Style
from stippler.drawing.style_presets import Preset, presets
from stippler.editor.session import Session
from stippler.ui.popups.shelf import Item


def style_items(session: Session) -> list[Item]:
    """Return the styles for a shelf; choosing one makes it that of the next dots."""

    def chooser(one: Preset) -> Callable[[], None]:
        def choose() -> None:
            session.style = replace(one.style, seed=session.style.seed)

        return choose

    return [Item(one.swatch, one.label, one.about, chooser(one)) for one in presets().values()]


def said_style(style: Style) -> str:
    """Return what a style is called, and whether it is as it came."""
    if not style.name:
        return "Your own"
    known = {one.style.name: one.style for one in presets().values()}.get(style.name)
    is_same = known is not None and replace(known, seed=style.seed) == style
    return style.name if is_same else f"{style.name}, changed"
