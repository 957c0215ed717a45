"""The controls of the export dialog, made from where options are declared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from imgui_bundle import imgui

from stippler.editor.export_choices import OFFERED, Choices, profile_choices
from stippler.editor.numbers import parse_number
from stippler.errors import ParameterError, StipplerError
from stippler.files.write.formats import NONE, PLATE
from stippler.files.write.options import Option
from stippler.ui.widgets import Widgets

NOTHING = "–"
_SHORT = 24  # letters of all choices, up to which they stand side by side
_ELSEWHERE = ("profile", "column", "print_width", "press", "gain", "least_dot")
_MARK_ALL = imgui.InputTextFlags_.auto_select_all
_KNOWN_UNITS = ("mm", "%", "°", "px")


def draw_format(widgets: Widgets, choices: Choices) -> None:
    """Draw what file it is, and what a publisher asks for."""
    texts = [f"{one.name} ({one.endings[0]}): {one.purpose}" for one in OFFERED]
    chosen = OFFERED.index(choices.form) if choices.form else -1
    at = widgets.choice("Format", texts, chosen, "Of the file; its ending says the same.")
    if at != chosen:
        choices.choose_format(OFFERED[at])
    if choices.form is None or choices.form.is_data:
        return
    every = profile_choices()
    now = choices.profile
    at = next((k for k, one in enumerate(every) if (one.profile, one.column) == now), 0)
    tip = "Width, resolution, bits and kind of file that a publisher asks for, at once."
    new = widgets.choice("Publisher", [one.text for one in every], at, tip)
    if new != at:
        choices.choose_profile(every[new])
    if new:
        widgets.caption(every[new].text)


def draw_size(widgets: Widgets, choices: Choices, page_mm: tuple[float, float]) -> None:
    """Draw the width in print, and what that makes of the drawing."""
    option = next(one for one in PLATE if one.name == "print_width")
    width = _used(choices, "print_width")
    draw_option(widgets, choices, option, shown=page_mm[0] if width is None else width)
    by = (width or page_mm[0]) / page_mm[0]
    told = (
        "as drawn" if abs(by - 1) < 5e-4 else f"{'reduced' if by < 1 else 'enlarged'} to {by:.1%}"
    )
    widgets.caption(f"{page_mm[0] * by:.4g} × {page_mm[1] * by:.4g} mm, {told}")


def draw_options(widgets: Widgets, choices: Choices) -> None:
    """Draw the chosen format's own options."""
    if choices.form is None or not choices.form.options:
        return
    widgets.heading(choices.form.name)
    for option in choices.form.options:
        draw_option(widgets, choices, option, shown=_used(choices, option.name))


def draw_plate(widgets: Widgets, choices: Choices) -> None:
    """Draw what goes around the drawing, and a line instead of dots."""
    widgets.heading("Plate")
    for option in PLATE:
        if option.name in _ELSEWHERE:
            continue
        if option.name == "line_width" and choices.given.get("one_line", NONE) == NONE:
            continue
        draw_option(widgets, choices, option, shown=choices.given.get(option.name, option.default))


def _used(choices: Choices, name: str) -> Any:
    """Return the value in use, a profile's or a default included."""
    try:
        return choices.values().get(name)
    except StipplerError:
        return choices.given.get(name)


def draw_option(widgets: Widgets, choices: Choices, option: Option, *, shown: Any) -> None:
    """Draw one option as its kind asks for; a bad value gets a line and changes nothing."""

    def take(value: Any) -> None:
        try:
            choices.set(option.name, value)
        except ParameterError as error:
            widgets.refuse(str(error))

    if option.type is bool:
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + widgets.indent)
        new = widgets.check(option.title, bool(shown), option.help)
        if new != shown:
            take(new)
    elif option.choices:
        _draw_choices(widgets, option, str(shown), take)
    elif option.type is str:
        text_field(widgets, option.title, str(shown or ""), option.help, take)
    else:
        number_field(widgets, option.title, shown, option.unit, option.help, take)


def _draw_choices(
    widgets: Widgets, option: Option, shown: str, take: Callable[[Any], None]
) -> None:
    at = option.choices.index(shown) if shown in option.choices else 0
    texts = [text.capitalize() for text in option.choices]
    if sum(map(len, texts)) <= _SHORT:
        new = _segments(widgets, option, texts, at)
    else:
        new = widgets.choice(option.title, texts, at, option.help)
    if new != at:
        take(option.choices[new])


def _segments(widgets: Widgets, option: Option, texts: Sequence[str], at: int) -> int:
    """Offer choices side by side; their names are apart from those of other options."""
    widgets.label(option.title)
    gap = 2.0 * widgets.scale
    width = (imgui.get_content_region_avail().x - gap * (len(texts) - 1)) / len(texts)
    for k, text in enumerate(texts):
        if k:
            imgui.same_line(0.0, gap)
        name = f"{option.title} {text}"
        if widgets.button(text, option.help, name=name, width=width, primary=k == at):
            at = k
    return at


def text_field(
    widgets: Widgets, label: str, text: str, tip: str, take: Callable[[str], None]
) -> None:
    """Take a text as it is typed."""
    widgets.label(label)
    changed, text = imgui.input_text(f"##{label}", text, _MARK_ALL)
    widgets.note(label)
    widgets.tip(tip)
    if changed:
        take(text)


def number_field(
    widgets: Widgets,
    label: str,
    value: Any,
    unit: str,
    tip: str,
    take: Callable[[float | None], None],
) -> None:
    """Take a number, or nothing for what is found by itself; counts when the field is left."""
    shown = NOTHING if value is None else f"{value:.6g} {unit}".strip()
    widgets.label(label)
    _, text = imgui.input_text(f"##{label}", shown, _MARK_ALL)
    done = imgui.is_item_deactivated_after_edit()
    widgets.note(label)
    widgets.tip(tip)
    text = text.strip()
    if not done or text == shown:
        return
    if text.lower() in ("", NOTHING, "-", "auto", "none"):
        take(None)
        return
    known = unit if unit in _KNOWN_UNITS else ""
    try:
        take(parse_number(text if known else text.removesuffix(unit), known))
    except ParameterError as error:
        widgets.refuse(f"{label}: {error}")
