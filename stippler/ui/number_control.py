"""The one control for numbers: it slides, steps, and takes what is typed over it.

Dragging slides; arrows and the wheel step, ten times as far with Shift; a double click, Enter, or
digits typed while the pointer is over it or while it has the focus, type. What is typed may have
units and sums; see `stippler.editor.numbers`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from stippler.editor.events import Event, KeyDown, Typed
from stippler.editor.number_steps import MANY, Scale
from stippler.editor.numbers import parse_number
from stippler.errors import ParameterError
from stippler.ui.fields import NUMBER

if TYPE_CHECKING:
    from stippler.ui.widgets import Widgets

_SIGNS = frozenset((*"0123456789.,-", *(f"kp_{k}" for k in range(10)), "kp_decimal", "kp_subtract"))
_FIRST_SIGNS = frozenset("0123456789.,-−(")
_ARROWS = {"left": -1, "right": 1, "down": -1, "up": 1}
_REST_S = (
    0.3  # the pointer rests so long on a control in a panel that scrolls, until the wheel steps
)
DRAG_PX = 2.0  # a shorter way is a click
_OVER = imgui.HoveredFlags_.allow_when_disabled
_NO_ITEM = 0
_DEAD = -1


@dataclass(frozen=True, slots=True)
class About:
    """What a control's number is, and how it slides.

    Attributes
    ----------
    slides : bool
        Whether it can be dragged between its bounds; else a click types.
    geometric : bool
        Whether equal ways of the slider are equal ratios.
    bound : str
        What else holds the value within its bounds, said where it does.
    units : mapping
        More units that can be typed, in the control's own.
    """

    scale: Scale
    slides: bool = True
    geometric: bool = False
    bound: str = ""
    units: Mapping[str, float] | None = None


class Numbers:
    """Which number has the keyboard, and what is typed over one before it is a field.

    It outlives frames; `begin` is called before each building of the panels.
    """

    def __init__(self) -> None:
        self.hovered = self.focused = _NO_ITEM  # in the last building
        self.used = _NO_ITEM  # the last one that a hand was on; until the pointer leaves the panels
        self.open = _NO_ITEM  # typed into
        self.text = ""
        self.first = ""  # what stood there
        self.is_marked = False  # the whole text is marked when it opens
        self.is_active = False  # ImGui's field has the keyboard
        self.is_entered = False  # Enter came before that
        self.steps, self.target = 0, _NO_ITEM
        self.before = (_NO_ITEM, 0.0)  # a control, and its value before it was pressed
        self.wheel = 0.0
        self.scrolled_at: tuple[float, float] | None = None  # where the wheel scrolled the panel
        self._expects = False  # the sign of the key that was just taken
        self._is_drawn = False

    def begin(self, *, over_panels: bool) -> None:
        """Take note that the panels are built anew."""
        if self.open and not self._is_drawn:
            self.close()
        self._is_drawn = False
        self.hovered = self.focused = _NO_ITEM
        if not over_panels:
            self.used = _NO_ITEM

    def ask(self, control: int, text: str | None = None) -> None:
        """Open a control for typing: with what stands there, marked, or with a first sign."""
        self.open, self.text, self.first = control, text or "", ""
        self.is_marked, self.is_active, self.is_entered = text is None, False, False
        self.used, self._is_drawn = control, True

    def close(self) -> None:
        """Type no longer."""
        self.open, self.is_active, self.is_entered, self._expects = _NO_ITEM, False, False, False

    def drawn(self) -> None:
        """Take note that what is open is there."""
        self._is_drawn = True

    def take(self, event: Event, *, is_typing: bool) -> bool:
        """Take a key that is for a number; `is_typing` is whether a field has the keyboard."""
        if is_typing and not (self.open and not self.is_active):
            return False
        match event:
            case KeyDown() if self.open and not self.is_active:
                return self._take_opening(event)
            case KeyDown():
                return self._take_key(event)
            case Typed(text=text) if self._expects or (self.open and not self.is_active):
                self.text += text
                self._expects = False
                return True
            case Typed(text=text) if (self.focused or self.hovered > 0) and text in _FIRST_SIGNS:
                self.ask(self.focused or self.hovered, text)
                return True
        return False

    def _take_opening(self, event: KeyDown) -> bool:
        if event.key in ("enter", "kp_enter"):
            self.is_entered = True
        elif event.key == "escape":
            self.close()
        elif event.key == "backspace":
            self.text = self.text[:-1]
        else:
            return not (event.mods.ctrl or event.mods.alt)
        return True

    def _take_key(self, event: KeyDown) -> bool:
        held = event.mods.ctrl or event.mods.alt
        over = self.focused or self.hovered or self.used
        if over == _NO_ITEM or held:
            return False
        if event.key in _SIGNS:
            if over != _DEAD:
                self.ask(over, "")
                self._expects = True
            return True
        own = self.focused or self.used
        if own > 0 and event.key in ("enter", "kp_enter"):
            self.ask(own)
            return True
        across = event.key in ("left", "right")
        if own > 0 and event.key in _ARROWS and (across or not self.focused):
            self.steps += _ARROWS[event.key] * (MANY if event.mods.shift else 1)
            self.target = own
            return True
        return False


def draw_number(
    widgets: Widgets, label: str, value: float, about: About, tip: str, name: str = ""
) -> float:
    """Draw a number in the width that is set; return it, or what it was changed to."""
    numbers, control = widgets.numbers, imgui.get_id(f"##{name or label}")
    told = label or name
    wish = widgets.fields.wished(name or label, NUMBER, unit=about.scale.unit)
    if wish:
        value = _entered(widgets, told, value, about, str(wish))
    elif wish is not None:
        numbers.ask(control)
    if numbers.open == control:
        value = _draw_field(widgets, told, name or label, value, about)
    elif about.slides:
        value = _draw_slider(widgets, name or label, value, about, control)
    else:
        _draw_resting(widgets, name or label, value, about, control)
    widgets.note(name or label)
    look_for(numbers, control)
    if numbers.open != control:
        value = _stepped(numbers, control, value, about)
        widgets.tip(tip)
    return value


def look_for(numbers: Numbers, control: int) -> None:
    """Note whether the pointer or the focus is on the last item, and whether a hand was on it."""
    if imgui.is_item_hovered(_OVER):
        alive = imgui.is_item_hovered()
        numbers.hovered = control if alive else numbers.hovered or _DEAD
    context = imgui.get_current_context()
    assert context is not None
    if imgui.is_item_focused() and context.nav_cursor_visible:
        numbers.focused = control
    if imgui.is_item_activated():
        numbers.used = control


def _draw_slider(widgets: Widgets, name: str, value: float, about: About, control: int) -> float:
    """Draw a slider; a press that does not move it leaves it as it is, a second one types."""
    numbers, scale = widgets.numbers, about.scale
    flags = imgui.SliderFlags_.no_input | imgui.SliderFlags_.always_clamp
    if about.geometric:
        flags |= imgui.SliderFlags_.logarithmic
    text = scale.text(value)
    size = widgets.fitting_size(text, imgui.calc_item_width() - 8.0 * widgets.scale)
    height = imgui.get_frame_height()
    shown = text.replace("%", "%%")
    if size:
        imgui.push_font(None, size)
        pad = imgui.get_style().frame_padding
        gap = max((height - imgui.get_font_size()) / 2, 0.0)
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (pad.x, gap))
    _, slid = imgui.slider_float(f"##{name}", value, scale.low, scale.high, shown, flags)
    if size:
        imgui.pop_style_var()
        imgui.pop_font()
    if imgui.is_item_activated():
        numbers.before = (control, value)
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
        numbers.ask(control)
        imgui.internal.clear_active_id()
        return numbers.before[1] if numbers.before[0] == control else value
    moved = imgui.is_mouse_dragging(imgui.MouseButton_.left, DRAG_PX * widgets.scale)
    if not (imgui.is_item_active() and moved) or slid == value:
        return value
    return scale.held(scale.rounded(slid))


def _draw_resting(widgets: Widgets, name: str, value: float, about: About, control: int) -> None:
    """Draw the field of a number while nobody types into it."""
    theme = widgets.theme
    imgui.push_style_color(imgui.Col_.button, (*theme.raised, 1.0))
    imgui.push_style_var(imgui.StyleVar_.button_text_align, (0.0, 0.5))
    width = imgui.calc_item_width()
    if widgets.fitted_button(f"{about.scale.text(value)}##{name}", width):
        widgets.numbers.ask(control)
    imgui.pop_style_var()
    imgui.pop_style_color()
    if imgui.is_item_hovered():
        imgui.set_mouse_cursor(imgui.MouseCursor_.text_input)


def _draw_field(widgets: Widgets, label: str, name: str, value: float, about: About) -> float:
    """Draw the field that is typed into; return what was typed once it is entered."""
    numbers = widgets.numbers
    numbers.drawn()
    if numbers.is_marked and not numbers.first:
        unit = about.scale.unit
        numbers.first = f"{about.scale.plain(value)}{' ' if unit else ''}{unit}"
        numbers.text = numbers.first
    if numbers.is_entered:
        text = numbers.text
        numbers.close()
        _draw_resting(widgets, name, value, about, imgui.get_id(f"##{name}"))
        return value if text == numbers.first else _entered(widgets, label, value, about, text)
    is_new = not numbers.is_active
    if is_new:
        imgui.set_keyboard_focus_here()
    flags = imgui.InputTextFlags_.callback_always
    if numbers.is_marked:
        flags |= imgui.InputTextFlags_.auto_select_all
    callback = _Caret(about, at_end=is_new and not numbers.is_marked)
    _, numbers.text = imgui.input_text(f"##{name}", numbers.text, flags, callback)
    numbers.is_active = imgui.is_item_active() or numbers.is_active
    if not imgui.is_item_deactivated():
        return value
    text, first = numbers.text, numbers.first
    escaped = imgui.is_key_pressed(imgui.Key.escape)
    numbers.close()
    return value if escaped or text == first else _entered(widgets, label, value, about, text)


class _Caret:
    """Puts the caret behind what was typed before there was a field, and steps by arrows."""

    def __init__(self, about: About, *, at_end: bool) -> None:
        self._about, self._at_end = about, at_end

    def __call__(self, data: imgui.InputTextCallbackData) -> int:
        if self._at_end:
            data.cursor_pos = data.selection_start = data.selection_end = data.buf_text_len
        up = imgui.is_key_pressed(imgui.Key.up_arrow)
        if up or imgui.is_key_pressed(imgui.Key.down_arrow):
            self._step(data, 1 if up else -1)
        return 0

    def _step(self, data: imgui.InputTextCallbackData, n: int) -> None:
        scale = self._about.scale
        try:
            value = parse_number(str(data.buf), scale.unit, self._about.units)
        except ParameterError:
            return
        value = scale.stepped(value, n, far=imgui.get_io().key_shift)
        data.delete_chars(0, data.buf_text_len)
        data.insert_chars(0, f"{scale.plain(value)}{' ' if scale.unit else ''}{scale.unit}")


def _entered(widgets: Widgets, label: str, value: float, about: About, text: str) -> float:
    """Return what a text tells, within the bounds; what is refused leaves the value."""
    scale = about.scale
    try:
        typed = parse_number(text, scale.unit, about.units)
    except ParameterError as error:
        widgets.refuse(f"{label}: {error}")
        return value
    if why := scale.refusal(typed):
        widgets.refuse(f"{label}: {why}{f', {about.bound}' if about.bound else ''}")
    return scale.held(typed)


def _stepped(numbers: Numbers, control: int, value: float, about: About) -> float:
    """Return the value after arrows and the wheel."""
    steps, far = 0, False
    if numbers.target == control:
        steps, numbers.steps, numbers.target = numbers.steps, 0, _NO_ITEM
        far, steps = abs(steps) >= MANY, steps // MANY if abs(steps) >= MANY else steps
    io = imgui.get_io()
    if imgui.is_item_hovered() and not imgui.is_item_active():
        if _wheel_is_for(numbers, control):
            imgui.internal.set_key_owner(imgui.Key.mouse_wheel_y, control)
            numbers.wheel += io.mouse_wheel
            turned = int(numbers.wheel)
            numbers.wheel -= turned
            steps, far = steps + turned, far or (turned != 0 and io.key_shift)
        elif io.mouse_wheel:
            numbers.scrolled_at = (io.mouse_pos.x, io.mouse_pos.y)
    if not steps:
        return value
    numbers.used = control
    return about.scale.stepped(value, steps, far=far)


def _wheel_is_for(numbers: Numbers, control: int) -> bool:
    """Whether the wheel is for the control under the pointer, and not for its panel.

    In a panel that scrolls, the pointer has to rest on the control first, or the control to be in
    use; else scrolling through a panel would change what comes under the pointer.
    """
    if control == numbers.used:
        return True
    window = imgui.internal.get_current_window()
    while window is not None and window.scroll_max.y <= 0.0:
        if window.parent_window is None or window.root_window.name == window.name:
            return True
        window = window.parent_window
    context, at = imgui.get_current_context(), imgui.get_io().mouse_pos
    assert context is not None
    rests = context.hovered_id == control and context.hovered_id_timer > _REST_S
    return rests and (at.x, at.y) != numbers.scrolled_at
