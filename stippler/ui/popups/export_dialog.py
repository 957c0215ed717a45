"""The export dialog: file and format, a true preview, options, faults, and what it will take."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from stippler.editor.export_choices import ENDINGS, Choices
from stippler.editor.exports import bytes_text
from stippler.editor.session import Session
from stippler.errors import StipplerError
from stippler.jobs.export_look import Asked, Look, look
from stippler.jobs.worker import Worker
from stippler.ui.popups.export_fields import draw_format, draw_options, draw_plate, draw_size
from stippler.ui.popups.export_press import PressSection, draw_checks
from stippler.ui.popups.export_preview import ExportPreview, draw_playing, duration_text
from stippler.ui.popups.file_dialogs import POPUP, Dialogs, center
from stippler.ui.widgets import Widgets
from stippler.ui.window.window import Window

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing
    from stippler.editor.print_check import PrintCheck

TITLE = "Export the drawing"
_WIDTH, _HEIGHT, _FIELDS = 1080.0, 740.0, 344.0
_NOTCH = 5.0  # lines that the wheel goes


@dataclass(slots=True)
class _Going:
    """What the worker was last asked, and what would end it."""

    asked: Asked
    superseded: bool = False


class ExportDialog:
    """Open from `ask` until it is exported or cancelled; what is chosen stays for the next time.

    Parameters
    ----------
    write : callable
        Takes the file, the options given, and about how many bytes it will have.
    show_sheet : callable
        Opens the calibration sheet.

    Attributes
    ----------
    choices : Choices
        Of the file that is asked for, or was last.
    problem : str
        Why the last thing that was typed or pressed could not be done.
    print_check : PrintCheck or None
        What shows faults in the drawing, and repairs them.
    """

    def __init__(
        self,
        window: Window,
        session: Session,
        dialogs: Dialogs,
        write: Callable[[Path, dict[str, object], int], None],
        show_sheet: Callable[[], None],
    ) -> None:
        self._window, self._session, self._dialogs = window, session, dialogs
        self._write = write
        self._worker: Worker[Look] | None = None
        self._going: _Going | None = None
        self._frozen: tuple[object, Drawing] | None = None
        self.preview = ExportPreview(window.ctx)
        self._press = PressSection(self._show_sheet)
        self._open_sheet = show_sheet
        self.print_check: PrintCheck | None = None
        self.choices = Choices("")
        self.look = Look()
        self.problem = ""
        self.is_open = self._is_fresh = False

    # --- from outside -------------------------------------------------------------------------

    def ask(self, path: Path) -> None:
        """Open the dialog; the path is used unless one was chosen for this drawing before."""
        self.choices.path = str(path)
        self.problem = ""
        self.is_open = self._is_fresh = True

    @property
    def moves(self) -> bool:
        """Whether it looks different in the next frame."""
        return self.is_open and self.preview.playing.runs

    def poll(self) -> bool:
        """Take what has been found; return whether there is something new to show."""
        if self._worker is None:
            return False
        update = self._worker.poll()
        if update is None:
            return False
        if update.result is not None and self._going is not None:
            self.look = update.result
        if update.failure is not None:
            self.problem = str(update.failure)
        return self.is_open

    def close(self) -> None:
        """End the worker, and free what is on the GPU."""
        self.preview.close()
        if self._going is not None:
            self._going.superseded = True
        if self._worker is not None:
            self._worker.close()
            self._worker = None

    # --- the window ---------------------------------------------------------------------------

    def draw(self, widgets: Widgets) -> None:
        """Draw the dialog, unless a question about its file is open."""
        if not self.is_open or self._dialogs.is_open:
            return
        if self._session.document is None:
            self._end()
            return
        imgui.open_popup(TITLE)
        viewport, scale = imgui.get_main_viewport().size, widgets.scale
        width = min(_WIDTH * scale, viewport.x - 24.0 * scale)
        height = min(_HEIGHT * scale, viewport.y - 24.0 * scale)
        center(width)
        imgui.set_next_window_size((width, height))
        if not imgui.begin_popup_modal(TITLE, None, POPUP)[0]:
            return
        refuse, widgets.refuse = widgets.refuse, self._refuse
        try:
            self._draw_inside(widgets)
        finally:
            widgets.refuse = refuse
            if not self.is_open or self._dialogs.is_open:
                imgui.close_current_popup()
            imgui.end_popup()

    def _refuse(self, text: str) -> None:
        self.problem = text

    def _draw_inside(self, widgets: Widgets) -> None:
        widgets.heading(TITLE)
        before = (self.choices.path, dict(self.choices.given))
        entered = self._draw_path(widgets)
        bottom = imgui.get_frame_height_with_spacing() + 2.2 * imgui.get_text_line_height()
        room = imgui.get_content_region_avail()
        fields = min(_FIELDS * widgets.scale, 0.5 * room.x)
        left, top = imgui.get_cursor_pos()
        # the fields come first, so that Tab goes from the path to them
        imgui.set_cursor_pos((left + room.x - fields, top))
        imgui.begin_child("##fields", (fields, room.y - bottom), imgui.ChildFlags_.nav_flattened)
        self._draw_fields(widgets)
        _scroll_beside_typing()
        imgui.end_child()
        imgui.set_cursor_pos((left, top))
        width = room.x - fields - widgets.gap
        imgui.begin_child("##sheet", (width, room.y - bottom), imgui.ChildFlags_.nav_flattened)
        self._draw_preview(widgets)
        imgui.end_child()
        if (self.choices.path, self.choices.given) != before:
            self.problem = ""
        self._draw_foot(widgets, entered=entered)

    def _draw_path(self, widgets: Widgets) -> bool:
        """Draw where it is written; return whether Enter was pressed there."""
        button = 96.0 * widgets.scale
        if self._is_fresh:
            imgui.set_keyboard_focus_here()
            self._is_fresh = False
        imgui.set_next_item_width(-button - widgets.gap)
        entered, text = imgui.input_text(
            "##path",
            self.choices.path,
            imgui.InputTextFlags_.enter_returns_true | imgui.InputTextFlags_.auto_select_all,
        )
        widgets.note("path")
        self.choices.path = text
        imgui.same_line(0.0, widgets.gap)
        if widgets.button("Browse", "Looks for a folder.", width=button):
            self._browse()
        return bool(entered)

    def _browse(self) -> None:
        def take(path: Path) -> None:
            self.choices.path, self._is_fresh = str(path), True

        self._dialogs.ask_place(self.choices.file, ENDINGS, take)

    def _draw_fields(self, widgets: Widgets) -> None:
        choices, document = self.choices, self._session.document
        assert document is not None
        page = document.drawing.page
        draw_format(widgets, choices)
        if choices.form is None:
            return
        if not choices.form.is_data:
            draw_size(widgets, choices, (page.width_mm, page.height_mm))
        draw_options(widgets, choices)
        if choices.form.is_data:
            return
        draw_plate(widgets, choices)
        self._press.draw(widgets, choices)
        draw_checks(widgets, choices, self.look.findings, (self._show_faults, self._repair))

    def _draw_preview(self, widgets: Widgets) -> None:
        room, ratio = imgui.get_content_region_avail(), self._window.ratio[0]
        rows = 2 if self.preview.playing.shown else 1
        height = room.y - rows * imgui.get_frame_height_with_spacing() - 4.0 * widgets.scale
        size = (max(room.x, 8.0), max(height, 8.0))
        self.preview.draw(widgets, self.look, size, ratio)
        self._request(size, ratio)
        self._draw_sight(widgets)
        if self.preview.playing.shown:
            dt_s = float(imgui.get_io().delta_time)
            draw_playing(widgets, self.preview.playing, self.look, size[0], dt_s)

    def _draw_sight(self, widgets: Widgets) -> None:
        """Draw how large the sheet is shown, and whether as print or as the pens' work."""
        preview, playing = self.preview, self.preview.playing
        if widgets.button("Fit sheet", "Shows the whole sheet.", primary=preview.is_fitted):
            preview.fit()
        imgui.same_line(0.0, widgets.gap)
        if widgets.button("1:1", "As large as in print; the wheel goes nearer, dragging moves."):
            preview.show_at(self._window.px_per_mm)
        form = self.choices.form
        if form is None or form.is_data:
            playing.shown = False
            return
        imgui.same_line(0.0, widgets.gap)
        playing.shown = widgets.check(
            "Pens", playing.shown, "Shows the order in which a pen goes, and how long it takes."
        )

    # --- what it takes, and doing it ----------------------------------------------------------

    def _draw_foot(self, widgets: Widgets, *, entered: bool) -> None:
        problem = self.problem or self._problem()
        widgets.caption(problem or self._forecast(), widgets.theme.alarm if problem else None)
        widgets.note("forecast")
        width, gap = 104.0 * widgets.scale, widgets.gap
        imgui.set_cursor_pos_x(imgui.get_window_width() - 2 * width - gap - widgets.margin)
        cancelled = widgets.button("Cancel", "Writes nothing (Esc).", width=width)
        imgui.same_line(0.0, gap)
        pressed = widgets.button("Export", "Writes this file (Enter).", width=width, primary=True)
        if cancelled or widgets.escaped():
            self._end()
        elif pressed or entered or widgets.entered():
            self._export()

    def _problem(self) -> str:
        """Return why the values together cannot be used; a path is looked at when it is entered."""
        if self.choices.form is None:
            return ""
        try:
            self.choices.values()
        except StipplerError as error:
            return str(error)
        return ""

    def _forecast(self) -> str:
        """Return about how large the file will be, and how long it takes to write and to plot."""
        told = self.look.estimate
        going = self._going
        if told is None or going is None or self.look.file_key != going.asked.file_key:
            return "measuring …"
        text = f"About {bytes_text(told.n_bytes)}, written in {duration_text(told.seconds)}"
        course = self.look.course
        if going.asked.wants_course and course is not None:
            text += f"; plotted in about {duration_text(course.total_s)}"
            if len(course.names) > 1:
                text += f" by {len(course.names)} pens"
        return text

    def _export(self) -> None:
        choices, document = self.choices, self._session.document
        path = choices.file
        if path.is_dir():
            choices.path, self._is_fresh = f"{path}/".replace("//", "/"), True
            return
        page = document.drawing.page if document is not None else None
        self.problem = choices.problem(self._session.inputs, page)
        if self.problem:
            self._is_fresh = True
            return
        n_bytes = self.look.estimate.n_bytes if self.look.estimate else 0

        def go(chosen: Path) -> None:
            self._end()
            self._write(chosen, choices.options(), n_bytes)

        there = next((file for file in self._files(path) if file.exists()), None)
        if there is not None:
            self._is_fresh = True  # where the question may come back to
            self._dialogs.ask_replace(there, lambda _: go(path))
        else:
            go(path)

    def _files(self, path: Path) -> list[Path]:
        """Return what is written: of several pens a file for each."""
        from stippler.export import files_of

        form, sheet = self.choices.form, self.look.sheet
        if form is None or sheet is None:
            return [path]
        return files_of(form, sheet, path)

    def _end(self) -> None:
        """Close, and let go of what was found: it holds copies of the drawing."""
        self.is_open = self.preview.playing.runs = False
        self.problem = ""
        if self._going is not None:
            self._going.superseded = True
        self._going, self._frozen, self.look = None, None, Look()

    # --- faults ---------------------------------------------------------------------------------

    def _show_sheet(self) -> None:
        self._end()
        self._open_sheet()

    def _show_faults(self) -> None:
        if self.print_check is not None:
            self.print_check.process = self.choices.process()
            self._end()
            self.print_check.show_next()

    def _repair(self) -> None:
        if self.print_check is not None:
            self.print_check.process = self.choices.process()
            self.print_check.repair()

    # --- asking the worker ----------------------------------------------------------------------

    def _request(self, size: tuple[float, float], ratio: float) -> None:
        """Ask for what is not known yet of what is chosen now."""
        asked = self._asked(size, ratio)
        if asked is None or (self._going is not None and _same(asked, self._going.asked)):
            return
        if self._going is not None:
            self._going.superseded = True
        self._going = going = _Going(asked)
        if self._worker is None:
            self._worker = Worker(self._window.wake)
        known = self.look
        self._worker.start(lambda: look(asked, known, lambda: going.superseded))

    def _asked(self, size: tuple[float, float], ratio: float) -> Asked | None:
        form = self.choices.form
        if form is None:
            return None
        try:
            values, process = self.choices.values(), self.choices.process()
        except StipplerError:
            return None
        state, drawing = self._held()
        playing = self.preview.playing.shown
        return Asked(
            drawing, state, form, values, process, self.preview.sight(size, ratio),
            wants_course=form.a_file_a_layer or playing, wants_moments=playing,
        )  # fmt: skip

    def _held(self) -> tuple[object, Drawing]:
        """Return the drawing as it is, frozen; while dots move by themselves, as it was."""
        session, document = self._session, self._session.document
        assert document is not None
        state = session.revision, document.revision
        if self._frozen is None or (self._frozen[0] != state and not session.busy):
            self._frozen = state, document.drawing.snapshot()
        return self._frozen


def _same(one: Asked, other: Asked) -> bool:
    return (
        one.sheet_key == other.sheet_key
        and one.proof_key == other.proof_key
        and one.faults_key == other.faults_key
        and one.wants_course == other.wants_course
        and one.wants_moments == other.wants_moments
    )


def _scroll_beside_typing() -> None:
    """Let the wheel scroll while a text field has the keyboard, which ImGui does not."""
    wheel = imgui.get_io().mouse_wheel
    blocked = imgui.HoveredFlags_.allow_when_blocked_by_active_item
    if wheel and imgui.is_any_item_active() and imgui.is_window_hovered(blocked):
        imgui.set_scroll_y(imgui.get_scroll_y() - wheel * _NOTCH * imgui.get_text_line_height())
