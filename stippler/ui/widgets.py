"""The controls that panels are made of: one look, tooltips that name effect and unit.

Every control leaves the rectangle it took under its label in `marks` for scripted input, where
`Fields.is_watched`. A label that finds no room is written smaller, or above its control; what still
has to be cut is noted in `cut`.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from imgui_bundle import imgui

from stippler.editor.number_steps import Scale
from stippler.ui.fields import CHECK, CHOICE, Fields
from stippler.ui.number_control import About, Numbers, draw_number
from stippler.ui.theme import SMALL_PX, TEXT_PX, Colour, Fonts, Theme, packed

Rect = tuple[float, float, float, float]
LABEL_WIDTH = 84.0
_NARROW = 250.0  # the theme's pixels; in panels that are no wider, labels stand above controls
_TIP_WIDTH = 280.0  # the theme's pixels
_SMALLEST = 0.62  # of the size of text, for a label that finds no room
_EXPLAINED = imgui.HoveredFlags_.for_tooltip | imgui.HoveredFlags_.allow_when_disabled
_FORM = re.compile(r"%\+?\.(\d)f ?(.*)")


def _nothing(_: str) -> None:
    pass


@dataclass(slots=True)
class Widgets:
    """Draws controls in the current ImGui window.

    Attributes
    ----------
    escape_level : int
        How many popups were open when Esc was pressed in this frame; 0 if it was not.
    refuse : callable
        Tells the person why what was typed is not taken.
    marks : dict
        Label to (x0, y0, x1, y1), in ImGui's coordinates, of what was drawn this frame.
    rooms : dict
        The same of the part of the window in which each control can be seen.
    numbers : Numbers
        Which number has the keyboard; outlives frames.
    fields : Fields
        What the palette knows of panels; outlives frames.
    cut : list of str
        Labels that found no room.
    why_off : str
        Why the controls that are drawn now are dead; empty where they are not.
    """

    theme: Theme
    fonts: Fonts
    scale: float
    escape_level: int = 0
    refuse: Callable[[str], None] = _nothing
    marks: dict[str, Rect] = field(default_factory=dict)
    rooms: dict[str, Rect] = field(default_factory=dict)
    numbers: Numbers = field(default_factory=Numbers)
    fields: Fields = field(default_factory=Fields)
    cut: list[str] = field(default_factory=list)
    why_off: str = ""

    @property
    def is_narrow(self) -> bool:
        """Whether labels stand above their controls."""
        return imgui.get_window_width() < _NARROW * self.scale

    @property
    def indent(self) -> float:
        """Where the controls begin to the right of their labels."""
        return self.margin if self.is_narrow else LABEL_WIDTH * self.scale

    @property
    def gap(self) -> float:
        """Between two controls side by side."""
        return 8.0 * self.scale

    @property
    def margin(self) -> float:
        """Between the edge of a panel and its controls."""
        return 16.0 * self.scale

    # --- room -------------------------------------------------------------------------------

    def fitting_size(self, text: str, room: float) -> float:
        """Return the size in which a text fits into so much room; 0 where it does as it is."""
        width = imgui.calc_text_size(text, True).x
        if width <= room or width <= 0.0:
            return 0.0
        unscaled = imgui.get_font_size() / self.scale
        if room < _SMALLEST * width and (shown := text.partition("##")[0]) not in self.cut:
            self.cut.append(shown)
        return unscaled * max(room / width, _SMALLEST)

    def fitted_button(self, text: str, width: float) -> bool:
        """Draw a button whose text is as small as its width wants it; 0 is as wide as the text."""
        style = imgui.get_style()
        if width < 0.0:
            width = imgui.get_content_region_avail().x + min(width + 1.0, 0.0)
        if not width:
            return imgui.button(text, (0.0, 0.0))
        height, pad = imgui.get_frame_height(), style.frame_padding
        tight = min(pad.x, 3.0 * self.scale)
        room = width - 2 * tight
        size = self.fitting_size(text, room)
        is_tight = imgui.calc_text_size(text, True).x > width - 2 * pad.x
        if is_tight:
            imgui.push_style_var(imgui.StyleVar_.frame_padding, (tight, pad.y))
        if size:
            imgui.push_font(None, size)
        pressed = imgui.button(text, (width, height))
        if size:
            imgui.pop_font()
        if is_tight:
            imgui.pop_style_var()
        return pressed

    def columns(self, n: int) -> float:
        """Return the width of each of n buttons side by side, with gaps between them."""
        return (imgui.get_content_region_avail().x - (n - 1) * self.gap) / n

    @contextlib.contextmanager
    def off(self, why: str) -> Iterator[None]:
        """Draw controls that cannot be used, and say why; an empty reason leaves them alive."""
        before, self.why_off = self.why_off, why or self.why_off
        imgui.begin_disabled(bool(why))
        try:
            yield
        finally:
            imgui.end_disabled()
            self.why_off = before

    # --- text -------------------------------------------------------------------------------

    def heading(self, text: str) -> None:
        """Begin a section."""
        imgui.dummy((0.0, 4.0 * self.scale))
        imgui.push_font(self.fonts.heading, TEXT_PX)
        imgui.text(text)
        imgui.pop_font()

    def caption(self, text: str, colour: Colour | None = None) -> None:
        """Write a small line that wraps."""
        imgui.push_font(None, SMALL_PX)
        imgui.push_style_color(imgui.Col_.text, (*(colour or self.theme.faint), 1.0))
        imgui.push_text_wrap_pos(0.0)
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
        imgui.pop_style_color()
        imgui.pop_font()

    def paragraph(self, text: str) -> None:
        """Write a text that wraps."""
        imgui.push_text_wrap_pos(0.0)
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()

    def label(self, text: str) -> None:
        """Write what the control to the right is for, and give that the rest of the line.

        In a narrow panel it stands above.
        """
        colour = (*self.theme.faint, 1.0)
        if self.is_narrow:
            imgui.push_font(None, SMALL_PX)
            imgui.text_colored(colour, text)
            imgui.pop_font()
            imgui.set_next_item_width(-1.0)
            return
        imgui.align_text_to_frame_padding()
        room = self.indent - imgui.get_cursor_pos_x() - 4.0 * self.scale
        if size := self.fitting_size(text, room):
            imgui.push_font(None, size)
        imgui.text_colored(colour, text)
        if size:
            imgui.pop_font()
        imgui.same_line(self.indent)
        imgui.set_next_item_width(-1.0)

    def tip(self, text: str, at_once: str = "") -> None:
        """Explain the last control while the pointer rests on it, and does not hold it.

        Beside the control's window, so that it covers no neighbour; where there is no room, below
        the control or above it. `at_once` is told before the pointer rests: the name of a sign.
        """
        is_told = imgui.is_item_hovered(_EXPLAINED)
        if not (is_told or (at_once and imgui.is_item_hovered())) or imgui.is_item_active():
            return
        text = text if is_told else at_once
        if self.why_off:
            text = f"{self.why_off}\n{text}"
        pad = (10.0 * self.scale, 7.0 * self.scale)
        size = imgui.calc_text_size(text, wrap_width=_TIP_WIDTH * self.scale)
        place = self._tip_place(size.x + 2 * pad[0], size.y + 2 * pad[1])
        imgui.set_next_window_pos(place)
        imgui.push_style_var(imgui.StyleVar_.window_padding, pad)
        if imgui.begin_tooltip():
            imgui.push_text_wrap_pos(_TIP_WIDTH * self.scale)
            imgui.text_unformatted(text)
            imgui.pop_text_wrap_pos()
            imgui.end_tooltip()
        imgui.pop_style_var()

    def _tip_place(self, width: float, height: float) -> tuple[float, float]:
        """Return where the last control's tooltip begins."""
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        screen, gap = imgui.get_main_viewport().size, 4.0 * self.scale
        window = imgui.internal.get_current_window().root_window
        top = max(min(low.y, screen.y - height), 0.0)
        if window.pos.x + window.size.x + gap + width <= screen.x:
            return window.pos.x + window.size.x + gap, top
        if window.pos.x - gap - width >= 0.0:
            return window.pos.x - gap - width, top
        left = max(min(low.x, screen.x - width), 0.0)
        is_low = high.y + gap + height > screen.y
        return left, low.y - gap - height if is_low else high.y + gap

    def icon_button(self, name: str, icon: str, tip: str) -> bool:
        """Draw a square button with a sign and no text."""
        side = imgui.get_frame_height()
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (0.0, 0.0))
        pressed = imgui.button(f"{icon}##{name}", (side, side))
        imgui.pop_style_var()
        self.note(name)
        self.tip(tip)
        return pressed

    def heading_button(self, name: str, icon: str, tip: str) -> bool:
        """Draw a square button at the right end of a heading."""
        imgui.same_line(imgui.get_content_region_avail().x - imgui.get_frame_height() + self.margin)
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - 5.0 * self.scale)
        return self.icon_button(name, icon, tip)

    packed = staticmethod(packed)

    # --- keys of the popup that is drawn ------------------------------------------------------

    def escaped(self) -> bool:
        """Return whether Esc is pressed in the popup that is drawn, with none above it."""
        context = imgui.get_current_context()
        assert context is not None
        return self.escape_level == context.begin_popup_stack.size() > 0

    def entered(self) -> bool:
        """Return whether Enter is pressed there, and no other control has the focus."""
        context = imgui.get_current_context()
        assert context is not None
        pressed = imgui.is_key_pressed(imgui.Key.enter) or imgui.is_key_pressed(
            imgui.Key.keypad_enter
        )
        is_topmost = context.open_popup_stack.size() == context.begin_popup_stack.size()
        held = context.active_id or context.active_id_previous_frame  # a field has taken it
        return pressed and is_topmost and not context.nav_cursor_visible and not held

    def verbs(self, verb: str, tip: str, cancel_tip: str, *, cancel: str = "") -> tuple[bool, bool]:
        """Draw "Cancel" and the verb at the right; return whether each was pressed, verb first.

        Enter is the verb, which has the keyboard at first, and Esc is "Cancel".
        """
        width = 104.0 * self.scale
        imgui.dummy((0.0, 2.0 * self.scale))
        imgui.set_cursor_pos_x(imgui.get_window_width() - 2 * width - self.gap - self.margin)
        cancelled = self.button("Cancel", cancel_tip, name=cancel, width=width)
        imgui.same_line(0.0, self.gap)
        pressed = self.button(verb, tip, width=width, primary=True)
        imgui.set_item_default_focus()
        return pressed or self.entered(), cancelled or self.escaped()

    # --- controls ---------------------------------------------------------------------------

    def button(
        self,
        label: str,
        tip: str,
        *,
        name: str = "",
        icon: str = "",
        width: float = 0.0,
        primary: bool = False,
        enabled: bool = True,
    ) -> bool:
        """Draw a button; return whether it was pressed. A width of -1 takes the rest.

        One of several buttons with the same label needs a name.
        """
        if primary and enabled:
            accent = self.theme.accent
            imgui.push_style_color(imgui.Col_.button, (*accent, 1.0))
            imgui.push_style_color(imgui.Col_.button_hovered, (*accent, 0.88))
            imgui.push_style_color(imgui.Col_.button_active, (*accent, 0.76))
            imgui.push_style_color(imgui.Col_.text, (*self.theme.on_accent, 1.0))
        imgui.begin_disabled(not enabled)
        text = f"{icon}  {label}" if icon else label
        if icon and width > 0.0 and imgui.calc_text_size(text).x > width - 6.0 * self.scale:
            text = label
        pressed = self.fitted_button(f"{text}##{name}" if name else text, width)
        imgui.end_disabled()
        if primary and enabled:
            imgui.pop_style_color(4)
        self.note(name or label)
        self.tip(tip)
        return pressed

    def segments(self, label: str, options: Sequence[str], chosen: int, tips: Sequence[str]) -> int:
        """Offer a few options side by side; return the one that is chosen."""
        wish = self.fields.wished(label, CHOICE, tuple(options), chosen)
        self.label(label)
        gap = 2.0 * self.scale
        n = self._across(options, gap)
        width = (imgui.get_content_region_avail().x - gap * (n - 1)) / n
        left = imgui.get_cursor_pos_x()
        for i, option in enumerate(options):
            if i % n:
                imgui.same_line(0.0, gap)
            elif i:
                imgui.set_cursor_pos_x(left)
            if self.button(option, tips[i], width=width, primary=i == chosen):
                chosen = i
        return chosen if wish is None else int(wish)

    def _across(self, options: Sequence[str], gap: float) -> int:
        """Return how many options stand side by side, so that their labels can be read."""
        room = imgui.get_content_region_avail().x
        widest = max(imgui.calc_text_size(option).x for option in options)
        for n in range(len(options), 1, -1):
            if (room - gap * (n - 1)) / n >= 0.8 * widest + 6.0 * self.scale:
                return n
        return 1

    def choice(self, label: str, options: Sequence[str], chosen: int, tip: str) -> int:
        """Offer options in a list that opens; return the one that is chosen."""
        wish = self.fields.wished(label, CHOICE, tuple(options), chosen)
        self.label(label)
        room = imgui.calc_item_width() - imgui.get_frame_height() - 12.0 * self.scale
        size = self.fitting_size(options[chosen], room) if 0 <= chosen < len(options) else 0.0
        if size:
            imgui.push_font(None, size)
            gap = max((imgui.get_font_size() * (TEXT_PX / size) - imgui.get_font_size()) / 2, 0.0)
            pad = imgui.get_style().frame_padding
            imgui.push_style_var(imgui.StyleVar_.frame_padding, (pad.x, pad.y + gap))
        _, chosen = imgui.combo(f"##{label}", chosen, list(options))
        if size:
            imgui.pop_style_var()
            imgui.pop_font()
        self.note(label)
        self.tip(tip)
        return chosen if wish is None else int(wish)

    # --- numbers: see `number_control` for what all of them do ------------------------------

    def number(
        self,
        label: str,
        value: int,
        tip: str,
        *,
        spare: float = 0.0,
        low: float = -float("inf"),
        high: float = float("inf"),
        step: float = 0.0,
        bound: str = "",
    ) -> int:
        """Take a whole number; it counts when Enter is pressed or the field is left."""
        scale = Scale("", 0, step, low, high)
        return round(
            self._numbered(label, value, About(scale, slides=False, bound=bound), tip, spare)
        )

    def length(
        self,
        label: str,
        value: float,
        tip: str,
        unit: str = "mm",
        *,
        spare: float = 0.0,
        low: float = -float("inf"),
        high: float = float("inf"),
        bound: str = "",
    ) -> float:
        """Take a number with a unit; it counts when Enter is pressed or the field is left."""
        about = About(Scale(unit, None, 0.0, low, high), slides=False, bound=bound)
        return self._numbered(label, value, about, tip, spare)

    def share(self, label: str, value: float, tip: str) -> float:
        """Take a share of 0..1, shown in percent, by dragging in the rest of the line."""
        imgui.set_next_item_width(-1.0)
        about = About(Scale("%", 0, 1.0, 0.0, 100.0))
        return draw_number(self, "", 100 * value, about, tip, label) / 100

    def slider(
        self,
        label: str,
        value: float,
        low: float,
        high: float,
        tip: str,
        form: str = "%.0f",
        flags: int = 0,
        *,
        bound: str = "",
        units: Mapping[str, float] | None = None,
        spare: float = 0.0,
    ) -> float:
        """Take a number between two others by dragging; its form tells decimals and unit."""
        found = _FORM.fullmatch(form)
        decimals, unit = (int(found[1]), found[2].replace("%%", "%")) if found else (None, "")
        logarithmic = bool(flags & imgui.SliderFlags_.logarithmic)
        scale = Scale(unit, None if unit == "mm" else decimals, 0.0, low, high)
        about = About(scale, geometric=logarithmic, bound=bound, units=units)
        return self._numbered(label, value, about, tip, spare)

    def span(
        self,
        label: str,
        value: tuple[float, float],
        limits: tuple[float, float],
        unit: str,
        tip: str,
    ) -> tuple[float, float]:
        """Take two numbers, the second at least as large as the first, by dragging."""
        self.label(label)
        width = (imgui.get_content_region_avail().x - self.gap / 2) / 2
        ends = list(value)
        for k, (end, bounds, other) in enumerate(
            (
                ("from", (limits[0], value[1]), "which the other end bounds"),
                ("to", (value[0], limits[1]), "which the other end bounds"),
            )
        ):
            if k:
                imgui.same_line(0.0, self.gap / 2)
            imgui.set_next_item_width(width)
            about = About(Scale(unit, None, 0.0, *bounds), geometric=True, bound=other)
            ends[k] = draw_number(self, label, ends[k], about, tip, f"{label} {end}")
        return ends[0], ends[1]

    def _numbered(
        self, label: str, value: float, about: About, tip: str, spare: float, name: str = ""
    ) -> float:
        self.label(label)
        if spare:
            imgui.set_next_item_width(-spare)
        return draw_number(self, label, value, about, tip, name)

    def check(self, label: str, value: bool, tip: str, *, name: str = "") -> bool:
        """Take a yes or no."""
        wish = self.fields.wished(name or label, CHECK, chosen=int(value))
        room = imgui.get_content_region_avail().x - imgui.get_frame_height() - 8.0 * self.scale
        if size := self.fitting_size(label, room):
            imgui.push_font(None, size)
        _, value = imgui.checkbox(f"{label}##{name}" if name else label, value)
        if size:
            imgui.pop_font()
        self.note(name or label)
        self.tip(tip)
        return value if wish is None else bool(wish)

    def progress(self, share: float, text: str) -> None:
        """Draw a bar; a share below 0 is unknown and moves back and forth."""
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (0.0, 0.0))
        imgui.progress_bar(share, (-1.0, 5.0 * self.scale), "")
        imgui.pop_style_var()
        self.caption(text or " ")

    def more(self, name: str, label: str = "More", tip: str = "What is seldom needed.") -> bool:
        """Draw a line that opens what is seldom needed; return whether it is open."""
        flags = imgui.TreeNodeFlags_.no_tree_push_on_open | imgui.TreeNodeFlags_.span_avail_width
        if self.fields.is_survey:
            return True
        if self.fields.has_wishes:
            imgui.set_next_item_open(True)
        is_open = imgui.tree_node_ex(f"{label}##{name}", flags)
        self.note(f"More {name}")
        self.tip(tip)
        return is_open

    def rule(self) -> None:
        """Draw a line between sections."""
        imgui.dummy((0.0, 4.0 * self.scale))
        imgui.separator()

    def note(self, label: str) -> None:
        """Remember where the last control is, and what can be seen of its window, if asked to."""
        if self.fields.is_survey or not self.fields.is_watched:
            return
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        self.marks[label] = (low.x, low.y, high.x, high.y)
        draw = imgui.get_window_draw_list()
        low, high = draw.get_clip_rect_min(), draw.get_clip_rect_max()
        self.rooms[label] = (low.x, low.y, high.x, high.y)
