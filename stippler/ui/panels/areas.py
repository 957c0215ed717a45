"""The areas: a list with names, colours, locks; what can be done to the chosen ones."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.drawing.area import PAGE_AREA, Area
from stippler.editor.area_acts import AreaActs, counts
from stippler.editor.commands import Commands
from stippler.editor.events import Mods
from stippler.ui.panels.area_border import draw_border_policy
from stippler.ui.panels.area_work import buttons, draw_area_work
from stippler.ui.widgets import Widgets

_LOCKED, _FREE = "\uf023", "\uf3c1"
_SEEN, _HIDDEN, _SOLO = "\uf06e", "\uf070", "\uf192"
_UP, _DOWN = "\uf062", "\uf063"
_ROWS = 7.5
_DRAGGED = "area"


class AreasPanel:
    """Draws the panel; knows which name is being typed."""

    def __init__(self, acts: AreaActs) -> None:
        self._acts, self._jobs = acts, acts.jobs
        self._renamed: int | None = None
        self._fresh = False
        self._counts: tuple[object, dict[int, int]] = (None, {})

    def draw(self, widgets: Widgets, commands: Commands) -> None:
        """Draw the list, and buttons below it."""
        document = self._acts.document
        rows = self._acts.listed()
        widgets.heading("Areas")
        if not rows:
            widgets.caption("Open a picture or begin a page; then draw areas with the tool Area.")
            return
        row = imgui.get_frame_height() + imgui.get_style().item_spacing.y
        imgui.begin_child("##areas", (0.0, min(len(rows), _ROWS) * row))
        imgui.begin_disabled(document is None)
        for place, (k, area) in enumerate(rows):
            self._draw_row(widgets, place, k, area)
        imgui.end_disabled()
        imgui.end_child()
        if len(rows) == 1:
            widgets.caption(
                "The page is one area. Draw others with the tool Area (O), or import outlines."
            )
        self._draw_order(widgets, commands)
        self._draw_styles(widgets)
        widgets.rule()
        draw_area_work(widgets, self._acts, commands)
        widgets.rule()
        self._draw_borders(widgets, commands)
        widgets.rule()
        self._draw_files(widgets, commands)

    # --- the list -----------------------------------------------------------------------------

    def _draw_row(self, widgets: Widgets, place: int, k: int, area: Area) -> None:
        side, gap = imgui.get_frame_height(), 4.0 * widgets.scale
        imgui.push_id(k)
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (gap, gap))
        self._draw_swatch(widgets, k, area)
        imgui.same_line()
        room = imgui.get_content_region_avail().x - 3 * (side + gap)
        if self._renamed == k:
            self._draw_name_field(widgets, k, area, room)
        else:
            self._draw_name(widgets, place, k, area, room)
        self._draw_signs(widgets, k, area)
        imgui.pop_style_var()
        imgui.pop_id()

    def _draw_signs(self, widgets: Widgets, k: int, area: Area) -> None:
        acts = self._acts
        imgui.same_line()
        tip = "Locked: neither brushes nor work change its dots, and its outline stays."
        icon = _LOCKED if area.locked else _FREE
        if _sign(widgets, f"lock {area.name}", icon, tip, is_on=area.locked):
            acts.lock([k], not area.locked)
        imgui.same_line()
        tip = "Hidden: its dots are neither drawn nor exported."
        icon = _HIDDEN if area.hidden else _SEEN
        if _sign(widgets, f"hide {area.name}", icon, tip, is_on=area.hidden):
            acts.hide([k], not area.hidden)
        imgui.same_line()
        tip = "Shows this area alone on the screen; once more shows all again."
        if _sign(widgets, f"solo {area.name}", _SOLO, tip, is_on=acts.choice.solo == k):
            acts.solo(k)

    def _draw_swatch(self, widgets: Widgets, k: int, area: Area) -> None:
        colour = [int(area.colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        flags = imgui.ColorEditFlags_.no_inputs | imgui.ColorEditFlags_.no_label
        flags |= imgui.ColorEditFlags_.no_tooltip | imgui.ColorEditFlags_.no_alpha
        imgui.begin_disabled(k == PAGE_AREA)
        _, new = imgui.color_edit3("##colour", colour, flags)
        if imgui.is_item_deactivated_after_edit() or (new != colour and not imgui.is_item_active()):
            code = "#" + "".join(f"{round(255 * c):02x}" for c in new)
            if code != area.colour:
                self._acts.colour(k, code)
        imgui.end_disabled()
        widgets.note(f"colour {area.name}")
        widgets.tip("Its colour here and of its outline on the canvas.")

    def _draw_name(self, widgets: Widgets, place: int, k: int, area: Area, room: float) -> None:
        choice = self._acts.choice
        dim = area.hidden or choice.solo not in (None, k)
        n = self._count(k)
        if dim:
            imgui.push_style_color(imgui.Col_.text, (*widgets.theme.faint, 1.0))
        flags = imgui.SelectableFlags_.allow_double_click
        chosen = k in choice.ids
        imgui.push_style_var(imgui.StyleVar_.selectable_text_align, (0.0, 0.5))
        pressed, _ = imgui.selectable(
            f"{area.name}##name", chosen, flags, (room, imgui.get_frame_height())
        )
        imgui.pop_style_var()
        widgets.note(f"area {area.name}")
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        if dim:
            imgui.pop_style_color()
        text = f"{n:,}"
        width = imgui.calc_text_size(text).x
        at = (high.x - width - 2.0 * widgets.scale, low.y + 5.0 * widgets.scale)
        imgui.get_window_draw_list().add_text(at, widgets.packed(widgets.theme.faint), text)
        widgets.tip(
            f"{n:,} dots. Click chooses, Shift adds; a double click renames; drag to reorder."
        )
        self._drag(place, k)
        if pressed:
            if imgui.is_mouse_double_clicked(imgui.MouseButton_.left) and k != PAGE_AREA:
                self._renamed, self._fresh = k, True
            else:
                io = imgui.get_io()
                choice.choose((k,), Mods(shift=io.key_shift or io.key_ctrl))

    def _drag(self, place: int, k: int) -> None:
        """Let a row be dragged, and others be dropped on it."""
        if k != PAGE_AREA and imgui.begin_drag_drop_source():
            imgui.set_drag_drop_payload_py_id(_DRAGGED, k)
            imgui.text(self._acts.listed()[place][1].name)
            imgui.end_drag_drop_source()
        if imgui.begin_drag_drop_target():
            payload = imgui.accept_drag_drop_payload_py_id(_DRAGGED)
            if payload is not None:
                self._acts.move_to(int(payload.data_id), place)
            imgui.end_drag_drop_target()

    def _draw_name_field(self, widgets: Widgets, k: int, area: Area, room: float) -> None:
        imgui.set_next_item_width(room)
        if self._fresh:
            imgui.set_keyboard_focus_here()
        entered, name = imgui.input_text(
            "##rename", area.name,
            imgui.InputTextFlags_.enter_returns_true | imgui.InputTextFlags_.auto_select_all,
        )  # fmt: skip
        widgets.note("area name")
        if entered or imgui.is_item_deactivated():
            if entered or imgui.is_item_deactivated_after_edit():
                self._acts.rename(k, name)
            self._renamed = None
        self._fresh = False

    def _count(self, k: int) -> int:
        """Return how many dots an area has; counted once for each state of the drawing."""
        document = self._acts.any_document
        assert document is not None
        key = (id(document), document.revision)
        if self._counts[0] != key:
            self._counts = (key, counts(document))
        return self._counts[1].get(k, 0)

    # --- below it -----------------------------------------------------------------------------

    def _draw_order(self, widgets: Widgets, commands: Commands) -> None:
        for name, icon in (("area.up", _UP), ("area.down", _DOWN)):
            command = commands[name]
            imgui.begin_disabled(not command.enabled)
            if widgets.icon_button(command.label, icon, command.explained):
                command.run()
            imgui.end_disabled()
            imgui.same_line(0.0, 4.0 * widgets.scale)
        n = len(self._acts.choice.ids)
        imgui.align_text_to_frame_padding()
        imgui.text_colored(
            (*widgets.theme.faint, 1.0), f"{n} chosen" if n else "Click chooses, on the canvas too"
        )

    def _draw_styles(self, widgets: Widgets) -> None:
        """Offer the drawing's styles for the chosen areas."""
        document, ids = self._acts.document, list(self._acts.choice.ids)
        if document is None:
            return
        styles = document.drawing.styles
        ids = [k for k in ids if k in document.drawing.areas]
        if not ids:
            return
        draw_border_policy(widgets, self._acts, document.drawing, ids)
        if len(styles) < 2:
            return
        keys = sorted(styles)
        names = [styles[i].name or f"Style {i}" for i in keys]
        now = keys.index(document.drawing.areas[ids[0]].style)
        chosen = widgets.choice("Style", names, now, "How the chosen areas are drawn.")
        if chosen != now:
            self._acts.give_style(ids, keys[chosen])

    def _draw_borders(self, widgets: Widgets, commands: Commands) -> None:
        buttons(widgets, commands, ("area.unite", "area.remove", "area.smooth", "area.simplify"))
        acts = self._acts
        acts.tolerance_mm = min(max(widgets.length(
            "Tolerance", acts.tolerance_mm, "How far Simplify may move a border."
        ), 0.0), 50.0)  # fmt: skip

    def _draw_files(self, widgets: Widgets, commands: Commands) -> None:
        buttons(widgets, commands, ("area.import", "area.export", "area.dark"))
        acts = self._acts
        acts.dark_level = 0.01 * widgets.slider(
            "Dark from", 100.0 * acts.dark_level, 50.0, 100.0,
            "What of the picture is darker than this is a dark part, and so is what the dots fall "
            "short of.", "%.0f %%",
        )  # fmt: skip
        if self._jobs.busy:
            share = self._jobs.share
            widgets.progress(share if share >= 0 else -imgui.get_time(), self._jobs.label)
            if widgets.button("Cancel", "Ends it; the areas stay as they are.", name="cancel area"):
                self._jobs.stop()


def _sign(widgets: Widgets, name: str, icon: str, tip: str, *, is_on: bool) -> bool:
    """Draw a sign that is pressed; faint while it is off."""
    side = imgui.get_frame_height()
    colour = widgets.theme.accent if is_on else widgets.theme.line
    imgui.push_style_var(imgui.StyleVar_.frame_padding, (0.0, 0.0))
    imgui.push_style_color(imgui.Col_.text, (*colour, 1.0))
    imgui.push_style_color(imgui.Col_.button, (0.0, 0.0, 0.0, 0.0))
    pressed = imgui.button(f"{icon}##{name}", (side, side))
    imgui.pop_style_color(2)
    imgui.pop_style_var()
    widgets.note(name)
    widgets.tip(tip)
    return pressed
