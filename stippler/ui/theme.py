"""The look of the editor: paper on a quiet desk, in daylight and at night."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import imgui_bundle
from imgui_bundle import imgui

TEXT_PX = 15.0
SMALL_PX = 13.0
PANEL_WIDTH = 320.0
STATUS_HEIGHT = 28.0
STRIP_WIDTH = 46.0

# Font Awesome 6 Free Solid, merged into the text font
ICON_NEW, ICON_OPEN, ICON_SAVE, ICON_DICE = "\uf15b", "\uf07c", "\uf019", "\uf522"
ICON_PLAY, ICON_PAUSE, ICON_STOP = "\uf04b", "\uf04c", "\uf04d"
ICON_FIT, ICON_PRINT, ICON_WARNING = "\uf31e", "\uf02f", "\uf071"
ICON_RESET, ICON_RELAX = "\uf0e2", "\uf2a1"
ICON_LIGHT, ICON_DARK = "\uf185", "\uf186"
ICON_LEFT, ICON_RIGHT = "\uf0e2", "\uf01e"
_ICON_RANGE = (0xE000, 0xF8FF)

Colour = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Theme:
    """Colours, sRGB in 0..1."""

    name: str
    desk: Colour
    panel: Colour
    raised: Colour  # fields, buttons
    hovered: Colour
    line: Colour
    text: Colour
    faint: Colour  # captions, units
    accent: Colour
    on_accent: Colour
    alarm: Colour
    paper: Colour = (1.0, 0.996, 0.984)
    ink: Colour = (0.07, 0.07, 0.08)


def _hex(code: str) -> Colour:
    red, green, blue = (int(code[i : i + 2], 16) / 255.0 for i in (0, 2, 4))
    return red, green, blue


LIGHT = Theme(
    name="light",
    desk=_hex("cfcbc3"),
    panel=_hex("f3f0ea"),
    raised=_hex("e4e0d7"),
    hovered=_hex("d8d3c8"),
    line=_hex("d5d0c6"),
    text=_hex("2b2a27"),
    faint=_hex("736e65"),
    accent=_hex("2f5f78"),
    on_accent=_hex("ffffff"),
    alarm=_hex("a5432d"),
)
DARK = Theme(
    name="dark",
    desk=_hex("2c2d2f"),
    panel=_hex("1e1f21"),
    raised=_hex("2e3033"),
    hovered=_hex("3b3e42"),
    line=_hex("34363a"),
    text=_hex("dedbd4"),
    faint=_hex("96938c"),
    accent=_hex("74a9c4"),
    on_accent=_hex("14181b"),
    alarm=_hex("e08a70"),
    paper=_hex("f4f1ea"),
)


@dataclass(frozen=True, slots=True)
class Fonts:
    """Text and headings; sizes are chosen where they are used."""

    text: imgui.ImFont
    heading: imgui.ImFont


def load_fonts() -> Fonts:
    """Load Roboto (Apache 2.0) with Font Awesome's signs (OFL), which imgui-bundle carries."""
    folder = Path(imgui_bundle.__file__).parent / "assets" / "fonts"
    atlas = imgui.get_io().fonts
    text = atlas.add_font_from_file_ttf(str(folder / "Roboto" / "Roboto-Regular.ttf"), TEXT_PX)
    signs = imgui.ImFontConfig()
    signs.merge_mode = True
    signs.glyph_min_advance_x = TEXT_PX
    signs.glyph_max_advance_x = TEXT_PX * 1.3
    atlas.add_font_from_file_ttf(
        str(folder / "Font_Awesome_6_Free-Solid-900.otf"), TEXT_PX * 0.86, signs
    )
    heading = atlas.add_font_from_file_ttf(str(folder / "Roboto" / "Roboto-Bold.ttf"), TEXT_PX)
    return Fonts(text, heading)


def apply(theme: Theme, scale: float) -> None:
    """Set ImGui's colours, sizes and text size for a theme and a display scale."""
    style = imgui.get_style()
    for name, size in _SIZES.items():
        setattr(style, name, round(size * scale))
    for name, (x, y) in _PAIRS.items():
        setattr(style, name, (round(x * scale), round(y * scale)))
    style.window_border_size = style.popup_border_size = 1.0
    style.frame_border_size = style.child_border_size = 0.0
    style.docking_separator_size = 1.0
    style.window_menu_button_position = imgui.Dir.none
    style.hover_delay_normal = 0.45
    style.disabled_alpha = 0.42
    style.font_size_base, style.font_scale_dpi = TEXT_PX, scale
    for colour, value, alpha in _palette(theme):
        style.set_color_(colour, (*value, alpha))


_SIZES = {
    "window_rounding": 8.0,
    "child_rounding": 5.0,
    "frame_rounding": 5.0,
    "popup_rounding": 6.0,
    "grab_rounding": 5.0,
    "tab_rounding": 5.0,
    "scrollbar_rounding": 5.0,
    "scrollbar_size": 10.0,
    "grab_min_size": 12.0,
    "indent_spacing": 16.0,
}
_PAIRS = {
    "window_padding": (16.0, 14.0),
    "frame_padding": (9.0, 5.0),
    "item_spacing": (8.0, 8.0),
    "item_inner_spacing": (6.0, 4.0),
    "cell_padding": (4.0, 3.0),
}


def _palette(theme: Theme) -> list[tuple[int, Colour, float]]:
    """Return ImGui's colours, each with its opacity."""
    col = imgui.Col_
    return [
        (col.text, theme.text, 1.0),
        (col.text_disabled, theme.faint, 1.0),
        (col.window_bg, theme.panel, 1.0),
        (col.child_bg, theme.panel, 0.0),
        (col.popup_bg, theme.panel, 1.0),
        (col.modal_window_dim_bg, theme.desk, 0.6),
        (col.menu_bar_bg, theme.panel, 1.0),
        (col.border, theme.line, 1.0),
        (col.separator, theme.line, 1.0),
        (col.separator_hovered, theme.accent, 0.6),
        (col.separator_active, theme.accent, 1.0),
        (col.frame_bg, theme.raised, 1.0),
        (col.frame_bg_hovered, theme.hovered, 1.0),
        (col.frame_bg_active, theme.hovered, 1.0),
        (col.checkbox_selected_bg, theme.raised, 1.0),
        (col.check_mark, theme.accent, 1.0),
        (col.slider_grab, theme.accent, 0.5),  # the value is read through it
        (col.slider_grab_active, theme.accent, 0.65),
        (col.button, theme.raised, 1.0),
        (col.button_hovered, theme.hovered, 1.0),
        (col.button_active, theme.line, 1.0),
        (col.header, theme.raised, 1.0),
        (col.header_hovered, theme.hovered, 1.0),
        (col.header_active, theme.hovered, 1.0),
        (col.scrollbar_bg, theme.panel, 0.0),
        (col.scrollbar_grab, theme.line, 1.0),
        (col.scrollbar_grab_hovered, theme.hovered, 1.0),
        (col.scrollbar_grab_active, theme.faint, 1.0),
        (col.title_bg, theme.panel, 1.0),
        (col.title_bg_active, theme.panel, 1.0),
        (col.title_bg_collapsed, theme.panel, 1.0),
        (col.tab, theme.panel, 1.0),
        (col.tab_hovered, theme.hovered, 1.0),
        (col.tab_selected, theme.raised, 1.0),
        (col.tab_selected_overline, theme.accent, 0.0),
        (col.tab_dimmed, theme.panel, 1.0),
        (col.tab_dimmed_selected, theme.raised, 1.0),
        (col.docking_preview, theme.accent, 0.4),
        (col.docking_empty_bg, theme.desk, 0.0),
        (col.resize_grip, theme.line, 0.0),
        (col.resize_grip_hovered, theme.accent, 0.4),
        (col.resize_grip_active, theme.accent, 0.7),
        (col.plot_histogram, theme.accent, 1.0),
        (col.text_selected_bg, theme.accent, 0.35),
        (col.input_text_cursor, theme.text, 1.0),
        (col.nav_cursor, theme.accent, 1.0),
        (col.drag_drop_target, theme.accent, 1.0),
    ]


@lru_cache(maxsize=256)
def packed(colour: Colour, alpha: float = 1.0) -> int:
    """Return a colour as draw lists take it."""
    return int(imgui.color_convert_float4_to_u32((*colour, alpha)))
