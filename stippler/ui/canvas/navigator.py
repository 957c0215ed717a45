"""The navigator: the whole page in a corner of the canvas, with a frame around what is seen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from imgui_bundle import imgui

from stippler.camera import Camera, Point
from stippler.editor.view import View
from stippler.ui.widgets import Rect, Widgets

if TYPE_CHECKING:
    import moderngl

    from stippler.drawing.drawing import Page

_SIDE, _MARGIN = 150.0, 12.0  # the theme's pixels
_MOST = 0.34  # of the canvas
_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_focus_on_appearing
    | imgui.WindowFlags_.no_nav
)


def size_of(page: Page, canvas: Rect, scale: float, ratio: float) -> tuple[int, int]:
    """Return how many pixels the page has in it."""
    room = min(_SIDE * scale, _MOST * (canvas[2] - canvas[0]), _MOST * (canvas[3] - canvas[1]))
    fit = room * ratio / max(page.width_mm, page.height_mm)
    return max(round(page.width_mm * fit), 1), max(round(page.height_mm * fit), 1)


def camera_of(page: Page, size_px: tuple[int, int]) -> Camera:
    """Return the camera that shows the whole page."""
    return Camera.fit(page, size_px)


def draw_navigator(
    widgets: Widgets,
    view: View,
    page: Page,
    texture: moderngl.Texture,
    canvas: Rect,
    ratio: float,
) -> None:
    """Draw it; a press in it brings that place to the middle of the canvas."""
    scale = widgets.scale
    size = (texture.width / ratio, texture.height / ratio)
    margin = _MARGIN * scale
    at = (round(canvas[2] - margin - size[0]), round(canvas[3] - margin - size[1]))
    imgui.set_next_window_pos(at)
    imgui.set_next_window_size(size)
    imgui.push_style_var(imgui.StyleVar_.window_padding, (0.0, 0.0))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_min_size, (1.0, 1.0))
    imgui.begin("##navigator", None, _FLAGS)
    imgui.pop_style_var(3)
    draw = imgui.get_window_draw_list()
    image = imgui.ImTextureRef(texture.glo)
    draw.add_image(image, at, (at[0] + size[0], at[1] + size[1]), (0.0, 1.0), (1.0, 0.0))
    camera = camera_of(page, texture.size)
    _draw_frame(widgets, draw, view, camera, texture.size, at, ratio)
    imgui.invisible_button("##page", size)
    widgets.note("navigator")
    widgets.tip("The whole page; press or drag to move what is seen.")
    if imgui.is_item_active():
        mouse = imgui.get_mouse_pos()
        in_px = ((mouse.x - at[0]) * ratio, (mouse.y - at[1]) * ratio)
        view.centre(_page_point(camera, in_px, texture.size))
    imgui.end()


def _page_point(camera: Camera, at_px: Point, size_px: tuple[int, int]) -> Point:
    x, y = camera.screen_to_page(at_px, size_px)
    return float(x), float(y)


def _draw_frame(
    widgets: Widgets,
    draw: imgui.ImDrawList,
    view: View,
    camera: Camera,
    size_px: tuple[int, int],
    at: Point,
    ratio: float,
) -> None:
    """Draw the outline of what the canvas shows."""
    width, height = view.size_px
    corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
    seen = camera.page_to_screen(view.camera.screen_to_page(corners, view.size_px), size_px)
    points: list[Any] = [
        imgui.ImVec2(at[0] + float(x) / ratio, at[1] + float(y) / ratio) for x, y in seen
    ]
    low, high = at, (at[0] + size_px[0] / ratio, at[1] + size_px[1] / ratio)
    draw.push_clip_rect(low, high, True)
    colour = widgets.packed(widgets.theme.accent)
    draw.add_polyline(points, colour, 1.6 * widgets.scale, imgui.ImDrawFlags_.closed)
    draw.pop_clip_rect()
    draw.add_rect(low, high, widgets.packed(widgets.theme.line), 0.0, 1.0)
