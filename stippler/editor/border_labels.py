"""What pieces of borders can be to dots, as commands and labels say it."""

from __future__ import annotations

from stippler.drawing.style import AS_STYLE, parameter_of

BORDER_COMMANDS = ("as-areas", "automatic", "wall", "through", "bleed")
"""What the commands are called, in the order of `LABELS`."""

LABELS = {AS_STYLE: "As its areas"} | {
    one.value: one.label for one in parameter_of("border").choices
}
