"""The controls that panels are made of: one look, tooltips that name effect and unit.

Every control leaves the rectangle it took under its label in `marks`, so that scripted input can
find it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from imgui_bundle import imgui

from stippler.editor.numbers import parse_number
from stippler.errors import ParameterError
from stippler.ui.theme import SMALL_PX, TEXT_PX, Colour, Fonts, Theme

Rect = tuple[float, float, float, float]
LABEL_WIDTH = 84.0
_MARK_ALL = imgui.InputTextFlags_.auto_select_all
_EXPLAINED = imgui.HoveredFlags_.for_tooltip | imgui.HoveredFlags_.allow_when_disabled


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
    """

    theme: Theme
    fonts: Fonts
    scale: float
    escape_level: int = 0
    refuse: Callable[[str], None] = _nothing
    marks: dict[str, Rect] = field(default_factory=dict)
    rooms: dict[str, Rect] = field(default_factory=dict)

    @property
    def indent(self) -> float:
        """Where the controls begin to the right of their labels."""
        return LABEL_WIDTH * self.scale

    @property
    def gap(self) -> float:
        """Between two controls side by side."""
        return 8.0 * self.scale

    @property
    def margin(self) -> float:
        """Between the edge of a panel and its controls."""
        return 16.0 * self.scale

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
        """Write what the control to the right is for, and give that the rest of the line."""
        imgui.align_text_to_frame_padding()
        imgui.text_colored((*self.theme.faint, 1.0), text)
        imgui.same_line(self.indent)
        imgui.set_next_item_width(-1.0)

    def tip(self, text: str, *, beside: bool = False) -> None:
        """Explain the last control while the pointer rests on it, and does not hold it.

        Parameters
        ----------
        beside : bool
            To the right of the control; else below it, or above where there is no room.
        """
        if imgui.is_item_active() or not imgui.is_item_hovered(_EXPLAINED):
            return
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        gap = 4.0 * self.scale
        size = imgui.calc_text_size(text, wrap_width=280.0 * self.scale)
        bottom = imgui.get_main_viewport().size.y
        is_low = high.y + gap + size.y + 14.0 * self.scale > bottom
        if beside:
            imgui.set_next_window_pos((high.x + gap, low.y))
        elif is_low:
            imgui.set_next_window_pos((low.x, low.y - gap), imgui.Cond_.always, (0.0, 1.0))
        else:
            imgui.set_next_window_pos((low.x, high.y + gap))
        imgui.push_style_var(imgui.StyleVar_.window_padding, (10 * self.scale, 7 * self.scale))
        if imgui.begin_tooltip():
            imgui.push_text_wrap_pos(280.0 * self.scale)
            imgui.text_unformatted(text)
            imgui.pop_text_wrap_pos()
            imgui.end_tooltip()
        imgui.pop_style_var()

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

    @staticmethod
    def packed(colour: Colour, alpha: float = 1.0) -> int:
        """Return a colour as draw lists take it."""
        return int(imgui.color_convert_float4_to_u32((*colour, alpha)))

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
        pressed = imgui.button(f"{text}##{name}" if name else text, (width, 0.0))
        imgui.end_disabled()
        if primary and enabled:
            imgui.pop_style_color(4)
        self.note(name or label)
        self.tip(tip)
        return pressed

    def segments(self, label: str, options: Sequence[str], chosen: int, tips: Sequence[str]) -> int:
        """Offer a few options side by side; return the one that is chosen."""
        self.label(label)
        gap = 2.0 * self.scale
        width = (imgui.get_content_region_avail().x - gap * (len(options) - 1)) / len(options)
        for i, option in enumerate(options):
            if i:
                imgui.same_line(0.0, gap)
            if self.button(option, tips[i], width=width, primary=i == chosen):
                chosen = i
        return chosen

    def choice(self, label: str, options: Sequence[str], chosen: int, tip: str) -> int:
        """Offer options in a list that opens; return the one that is chosen."""
        self.label(label)
        _, chosen = imgui.combo(f"##{label}", chosen, list(options))
        self.note(label)
        self.tip(tip)
        return chosen

    def number(self, label: str, value: int, tip: str, *, spare: float = 0.0) -> int:
        """Take a whole number; it counts when Enter is pressed or the field is left."""
        typed = self._typed(label, f"{value}", "", tip, spare)
        return value if typed is None else round(typed)

    def length(
        self, label: str, value: float, tip: str, unit: str = "mm", *, spare: float = 0.0
    ) -> float:
        """Take a number with a unit; it counts when Enter is pressed or the field is left."""
        typed = self._typed(label, f"{value:.4g} {unit}", unit, tip, spare)
        return value if typed is None else typed

    def _typed(self, label: str, shown: str, unit: str, tip: str, spare: float) -> float | None:
        """Draw a field for a number; return what was typed, None while nothing was."""
        self.label(label)
        if spare:
            imgui.set_next_item_width(-spare)
        _, text = imgui.input_text(f"##{label}", shown, _MARK_ALL)
        done = imgui.is_item_deactivated_after_edit()
        self.note(label)
        self.tip(tip)
        if not done or text == shown:
            return None
        try:
            return parse_number(text, unit)
        except ParameterError as error:
            self.refuse(f"{label}: {error}")
            return None

    def share(self, label: str, value: float, tip: str) -> float:
        """Take a share of 0..1, shown in percent, by dragging in the rest of the line."""
        imgui.set_next_item_width(-1.0)
        _, percent = imgui.slider_float(
            f"##{label}", 100 * value, 0.0, 100.0, "%.0f %%", imgui.SliderFlags_.always_clamp
        )
        self.note(label)
        self.tip(tip)
        return percent / 100

    def slider(
        self,
        label: str,
        value: float,
        low: float,
        high: float,
        tip: str,
        form: str = "%.0f",
        flags: int = 0,
    ) -> float:
        """Take a number by dragging; Ctrl and a click types it."""
        self.label(label)
        _, value = imgui.slider_float(
            f"##{label}", value, low, high, form, imgui.SliderFlags_.always_clamp | flags
        )
        self.note(label)
        self.tip(tip)
        return value

    def check(self, label: str, value: bool, tip: str, *, name: str = "") -> bool:
        """Take a yes or no."""
        _, value = imgui.checkbox(f"{label}##{name}" if name else label, value)
        self.note(name or label)
        self.tip(tip)
        return value

    def progress(self, share: float, text: str) -> None:
        """Draw a bar; a share below 0 is unknown and moves back and forth."""
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (0.0, 0.0))
        imgui.progress_bar(share, (-1.0, 5.0 * self.scale), "")
        imgui.pop_style_var()
        self.caption(text or " ")

    def more(self, name: str) -> bool:
        """Draw a line that opens what is seldom needed; return whether it is open."""
        flags = imgui.TreeNodeFlags_.no_tree_push_on_open | imgui.TreeNodeFlags_.span_avail_width
        is_open = imgui.tree_node_ex(f"More##{name}", flags)
        self.note(f"More {name}")
        self.tip("What is seldom needed.")
        return is_open

    def rule(self) -> None:
        """Draw a line between sections."""
        imgui.dummy((0.0, 4.0 * self.scale))
        imgui.separator()

    def note(self, label: str) -> None:
        """Remember where the last control is, and what can be seen of its window."""
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        self.marks[label] = (low.x, low.y, high.x, high.y)
        draw = imgui.get_window_draw_list()
        low, high = draw.get_clip_rect_min(), draw.get_clip_rect_max()
        self.rooms[label] = (low.x, low.y, high.x, high.y)
