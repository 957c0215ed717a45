"""The editor in its window: events in, panels and page out, frame by frame."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable

from imgui_bundle import imgui

from stippler.drawing.preview import Preview
from stippler.editor.area_acts import AreaActs
from stippler.editor.area_jobs import AreaJobs, Step
from stippler.editor.batches import parts_of
from stippler.editor.commands import Key
from stippler.editor.desk_state import DeskState
from stippler.editor.events import (
    CloseAsked,
    Dropped,
    Event,
    KeyDown,
    Pressed,
    Scrolled,
)
from stippler.editor.hands import Hands
from stippler.editor.lines import Lines
from stippler.editor.messages import ERROR, WARNING, Message
from stippler.editor.painting import Painting
from stippler.editor.patterns import Patterns
from stippler.editor.rates import FrameRate
from stippler.editor.schedule import Schedule
from stippler.editor.selecting import Selecting
from stippler.editor.session import Session
from stippler.editor.shaping import Shaping
from stippler.editor.view import BLANK, View
from stippler.jobs.work import PREPARE
from stippler.jobs.worker import Worker
from stippler.ui.actions import Parts, commands_for
from stippler.ui.canvas.canvas import MAP_EVERY_S, Canvas
from stippler.ui.canvas.lens import LensKey
from stippler.ui.canvas.over_page import OverPage
from stippler.ui.canvas.peek import Peek
from stippler.ui.field_commands import FieldCommands
from stippler.ui.kept_choices import KeptChoices
from stippler.ui.panels.brush_radius import tool_hint
from stippler.ui.panels.contents import Contents, Subjects
from stippler.ui.panels.docks import Panels
from stippler.ui.panels.layout import AREAS, SHAPE, Layout
from stippler.ui.panels.menu import MenuBar
from stippler.ui.panels.notice import draw_invitation, draw_notice, draw_preparing
from stippler.ui.panels.progress import progress_share
from stippler.ui.panels.status import Sight, draw_status
from stippler.ui.panels.strip import StripShape, draw_tools
from stippler.ui.panels.writing import WritingNotice
from stippler.ui.popups.file_dialogs import has_native_dialogs
from stippler.ui.popups.popups import Popups
from stippler.ui.preferences import Preferences
from stippler.ui.widgets import Rect, Widgets
from stippler.ui.window.gui import Gui
from stippler.ui.window.window import Window

_CURSORS = {"hand": imgui.MouseCursor_.resize_all, "turn": imgui.MouseCursor_.hand}
_CARET_S = 0.4  # a text field's caret blinks
_MINIMISED_S = 0.25
_WEIGHING_S = 0.02  # how often it is asked whether overlaps are known
_ANSWER_S = 0.1  # how often a system dialog is looked at
_REST_FRAMES = 2  # of the panels, until what one part of a batch has opened is there for the next


class Editor:
    """Draws a session into a window and brings the window's input to it.

    Attributes
    ----------
    widgets : Widgets
        Of the last frame, with the places of its controls.
    n_frames : int
        How many frames have been drawn.
    """

    def __init__(
        self,
        window: Window,
        session: Session,
        kept: Preferences,
        *,
        native_dialogs: bool | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._window, self._clock = window, clock
        self.session, self._kept = session, kept
        self.look = kept.look
        self.look.begin()
        self.view = View(BLANK, window.size_px)
        native = has_native_dialogs() if native_dialogs is None else native_dialogs
        self.gui = Gui(window, self.look, kept.layout, kept.layout_scale)
        self.canvas = Canvas(window.ctx)
        self.painting = Painting(session)
        self.shaping = Shaping(session, self.painting)
        self._area_worker: Worker[Step] = Worker(window.wake)
        self.area_jobs = AreaJobs(self._area_worker, session.messages)
        self.area_acts = AreaActs(session, self.painting, self.area_jobs)
        self.lines = Lines(session, self.painting)
        self.patterns = Patterns(session, self.painting)
        self.hands = Hands(self.view, self.painting)
        self.pointer = self.hands.pointer
        self._over_page = OverPage(
            self.look,
            self.gui,
            self.canvas,
            session,
            self.view,
            self.painting.toolbox,
            self.pointer,
        )
        self._desk = DeskState(session, self.view, self.painting.toolbox)
        self.popups = Popups(
            window, session, kept, self.painting.toolbox, self._px_per_mm, use_native=native
        )
        subjects = Subjects(
            session,
            self.look,
            self.view,
            self.painting,
            self.shaping,
            self.lines,
            self.patterns,
            self.area_acts,
        )
        self._contents = Contents(subjects, window.ctx, lambda: (self.widgets, self.commands))
        self.panels = Panels(self._contents.draw, kept.closed)
        self._layout = Layout(self.panels.names)
        self.peek = Peek(self.look, session, self.painting)
        self.lens_key = LensKey(self.look)
        self.menu, self._writing = MenuBar(), WritingNotice()
        self.commands = self.popups.commands = commands_for(self._parts())
        self.popups.field_commands = FieldCommands(self.gui.fields, self._show_if_panel)
        self._keeper = KeptChoices(kept, window, session, self.gui, self.painting.toolbox, clock())
        self._keeper.load_keys(self.commands)
        self.widgets = Widgets(self.look.theme, self.gui.fonts, self.gui.scale)
        self.n_frames = 0
        self._said: Message | None = None  # when the last frame was drawn
        self._schedule, self._rate = Schedule(), FrameRate()
        self._ratio = 1.0
        self._late: list[Event] = []  # commands for the next building of the panels
        self._preview: Preview | None = None
        self._last_s = clock()
        self._size_px = window.size_px

    def _parts(self) -> Parts:
        return Parts(
            self._window,
            self.session,
            self.painting,
            Selecting(self.session, self.painting),
            self.lines,
            self.patterns,
            self.area_acts,
            self.pointer,
            self.view,
            self.look,
            self.lens_key,
            self.panels,
            self.popups,
            self.show_panel,
            self.reset_panels,
            self.panels.turn_focus,
            self.peek,
        )

    # --- the loop's two halves --------------------------------------------------------------

    def sleep_s(self) -> float:
        """Return how long nothing needs to be drawn, if nothing happens."""
        if 0 in self._window.size_px:  # minimised
            return _MINIMISED_S
        return self._schedule.sleep_s(self._clock())

    @property
    def idle(self) -> bool:
        """Whether all that has happened so far has been drawn."""
        return self._schedule.idle and not self.canvas.is_weighing

    def step(self) -> bool:
        """Take what has happened; draw a frame if it is time for one, and say whether."""
        began = self._clock()
        events = self._window.take_events()
        if events:
            self._schedule.note_input()
            self._keeper.may_have_changed = True
        if self.session.poll() | self.area_jobs.poll() | self.popups.poll():
            self._schedule.note_result()
        if 0 in self._window.size_px:
            self._take_unseen(events)
            return False
        if not self._schedule.due(began):
            return False
        self._frame(events, began)
        moving = self.view.moving or self.painting.toolbox.is_timed or self.popups.moves
        self._schedule.note_frame(began, self._clock(), moving=moving)
        if self.session.messages.current is not self._said:  # ImGui hides what is new for a frame
            self._said = self.session.messages.current
            self._schedule.note_result()
        self._plan_wakes()
        self.n_frames += 1
        return True

    def _take_unseen(self, events: list[Event]) -> None:
        """Take what happens to a window that is minimised: nothing is drawn, nothing is lost."""
        for event in events:
            self._take_guarded(event, for_panels=self.gui.feed(event))
        if self.popups.filing.guard.is_open:
            self._window.restore()

    def close(self) -> None:
        """Keep brushes and preferences; let go of everything on the GPU. The window stays."""
        self.painting.toolbox.save()
        self._keeper.keep()
        self._area_worker.close()
        self.popups.close()
        self.canvas.close()
        self._contents.close()
        self.gui.close()

    def renew_graphics(self) -> None:
        """Make GL's context and all that is in it anew: the drawing never lives there alone."""
        with contextlib.suppress(Exception):  # a lost context may refuse anything
            self.canvas.close()
            self._contents.close()
        self.gui.leave()
        self._window.renew()
        self.gui.join()
        self.canvas = Canvas(self._window.ctx)
        self._contents.renew(self._window.ctx)
        self._over_page.canvas = self.canvas
        self.popups.renew()

    # --- one frame --------------------------------------------------------------------------

    def _frame(self, events: list[Event], now_s: float) -> None:
        dt_s, self._last_s = min(now_s - self._last_s, 0.1), now_s
        self._rate.tick(now_s)
        *earlier, last = parts_of(events) or [[]]
        for part in earlier:
            self._build(part, 0.0)
            for _ in range(_REST_FRAMES):
                self._build([], 0.0)
        self._build(last, dt_s)
        with self._window.frame() as screen:
            try:
                self.look.patterns_shown = self.painting.toolbox.name == "pattern"
                self.canvas.draw(
                    self.session,
                    self.painting.toolbox.selection,
                    self.painting.toolbox.areas.solo,
                    self.view.camera,
                    self.look,
                    self._preview,
                )
            except Exception as error:  # noqa: BLE001 - the editor lives on; the person is told
                self._report(error, "the page")
            screen.use()
            screen.clear(*self.look.theme.desk, 1.0)
            self.gui.draw()
        if self._window.is_lost:
            self.renew_graphics()
            self.session.messages.say("the graphics driver was reset; nothing is lost", WARNING)
        self.lens_key.note_frame(self._window.now_s)
        name, changed = self.session.name, "*" if self.session.unsaved else ""
        self._window.title = f"{name}{changed} – Stippler" if name else "Stippler"
        if self.popups.filing.note_opened():
            self._keeper.keep()

    def _build(self, events: list[Event], dt_s: float) -> None:
        """Build the window's panels once and take events meanwhile; nothing is drawn yet."""
        self.gui.dress(self.look)
        fed = [(event, False) for event in self._late]
        self._late = [event for event in events if self._is_late(event)]
        fed += [(one, self.gui.feed(one)) for one in events if one not in self._late]
        self.widgets = Widgets(
            self.look.theme,
            self.gui.fonts,
            self.gui.scale,
            self.gui.escape_level,
            lambda text: self.session.messages.say(text, WARNING),
            numbers=self.gui.numbers,
            fields=self.gui.fields,
        )
        failure = self.gui.frame(lambda: self._draw_ui(fed, dt_s))
        if failure is not None:
            self._report(failure, "the window")

    def _is_late(self, event: Event) -> bool:
        """Whether a key is a command that counts after the number that is being typed."""
        if not isinstance(event, KeyDown):
            return False
        return self.commands.owner(Key(event.key, event.mods)) is not None and (
            self.gui.ends_number(event)
        )

    def _draw_ui(self, events: list[tuple[Event, bool]], dt_s: float) -> None:
        recent = self.popups.filing.recent
        self._guarded("the menu", lambda: self.menu.draw(self.widgets, self.commands, recent))
        tools = StripShape.fitting(len(self.painting.toolbox.cards) + 1, self.gui.scale)
        area = self._layout.draw(self.gui.scale, tools.width)
        self._place(area)
        for event, for_panels in events:
            self._take_guarded(event, for_panels=for_panels)
        self.lens_key.let_pass()
        self.peek.let_pass()
        self.painting.tick(self._window.now_s)
        self.view.advance(dt_s)
        self._preview = self._previewed()
        self.canvas.show(area, self.view.size_px, self._preview, self.view.camera, self._ratio)
        over, ratio = self._over_page, self._ratio
        borders = self.panels.is_in_front(AREAS)
        self._guarded(
            "what is beside the page", lambda: over.draw_beside(self.widgets, area, ratio)
        )
        self._guarded(
            "the brush's outline",
            lambda: over.draw_marks(area, ratio, borders=borders),
        )
        self._guarded("the lens", lambda: over.draw_lens(area, ratio))
        if self.pointer.state.cursor in _CURSORS and not self.gui.wants_pointer:
            imgui.set_mouse_cursor(_CURSORS[self.pointer.state.cursor])
        self._guarded("the tools", lambda: self._draw_tools(tools))
        self.panels.draw(self._guarded, self.widgets, survey=self.popups.searches)
        if not self.panels.is_in_front(SHAPE):
            self.shaping.let_go()
        if self.session.drawing is None and not self.session.busy:
            draw_invitation(self.widgets, self.commands, recent(), area)
        if self.session.drawing is None and self.session.stage == PREPARE:
            draw_preparing(self.widgets, progress_share(self.session), area)
        self._guarded("the status bar", self._draw_status)
        self._guarded("the notice", lambda: draw_notice(self.widgets, self.session.messages, area))
        exports = self.session.exports
        self._guarded("the writing", lambda: self._writing.draw(self.widgets, exports, area))
        self.popups.draw(self.widgets, self._guarded)

    def _px_per_mm(self) -> float:
        """Return how many of the pixels that sizes are told in a mm on the page takes."""
        return self.view.camera.px_per_mm

    def _show_if_panel(self, name: str) -> None:
        if name in self.panels.names:
            self.show_panel(name)

    def show_panel(self, name: str) -> None:
        """Bring a panel to the front."""
        self.panels.show(name)
        self._schedule.note_input()

    def reset_panels(self) -> None:
        """Show every panel where it was at first."""
        self.panels.show_all()
        self._layout.reset()

    def _draw_tools(self, shape: StripShape) -> None:
        toolbox = self.painting.toolbox
        draw_tools(self.widgets, toolbox, self.commands, shape)

    def _draw_status(self) -> None:
        camera = self.view.camera
        zoom = camera.px_per_mm / self._window.px_per_mm
        sight = Sight(camera, self.pointer.at_mm, zoom, self.look.dots_shown)
        hint = tool_hint(self.painting.toolbox, self._px_per_mm())
        typed = draw_status(self.widgets, self.session, sight, self._rate, self.commands, hint)
        if typed is not None:
            self.view.zoom_to(typed * self._window.px_per_mm)

    def _previewed(self) -> Preview | None:
        """Return the change that is held in a panel, or that the brush or the style will make."""
        hovers = self.hands.is_free
        return self.shaping.preview or (
            self.painting.preview(self.pointer.at_mm) if hovers else None
        )

    def _place(self, area: Rect) -> None:
        """Tell view and pointer where the canvas is."""
        self._ratio = ratio = self._window.ratio[0]
        self.pointer.place((area[0] * ratio, area[1] * ratio))
        self.view.resize((round((area[2] - area[0]) * ratio), round((area[3] - area[1]) * ratio)))
        if self.session.drawing is not None:
            self.view.show(self.session.drawing.page)
            self._desk.follow()

    def _take_guarded(self, event: Event, *, for_panels: bool) -> None:
        """Take an event; what fails is told, and those after it are taken as ever."""
        try:
            self._take(event, for_panels=for_panels)
        except Exception as error:  # noqa: BLE001 - a faulty handler must not lose a release
            self._report(error, "the input")

    def _take(self, event: Event, *, for_panels: bool) -> None:
        """Bring one event to whom it concerns."""
        self.lens_key.take(event)
        self.peek.take(event)
        elsewhere = not self.hands.owns(event, over_panel=self.gui.wants_pointer)
        match event:
            case Scrolled() if self.lens_key.is_held:
                self.lens_key.strengthen(event.dy)
            case Dropped(paths=paths):
                self.popups.filing.drop(paths)
            case CloseAsked():
                self.popups.filing.quit()
            case KeyDown(key="escape") if self.shaping.let_go():
                imgui.internal.clear_active_id()
            case KeyDown() if self.menu.take(event) or self.popups.take(event) or for_panels:
                pass
            case Pressed(button="right") if not elsewhere and not self.painting.is_busy:
                self.popups.context.ask()
            case KeyDown() if self.hands.take_key(event) or self.commands.take(event):
                pass
            case _:
                self.hands.take(event, elsewhere=elsewhere)

    # --- what may go wrong, and what comes later ----------------------------------------------

    def _guarded(self, where: str, draw: Callable[[], None]) -> None:
        """Draw a part; if it fails, close what it left open, tell, and go on with the rest."""
        state = imgui.internal.ErrorRecoveryState()
        imgui.internal.error_recovery_store_state(state)
        try:
            draw()
        except Exception as error:  # noqa: BLE001 - a faulty panel must not end the editor
            imgui.internal.error_recovery_try_to_recover_state(state)
            self._report(error, where)

    def _report(self, error: Exception, where: str) -> None:
        what = str(error).strip().partition("\n")[0][:120]
        text = f"{where} failed ({type(error).__name__}: {what}); the drawing is safe"
        self.session.messages.say(text, ERROR, error)

    def _plan_wakes(self) -> None:
        now = self._clock()
        message = self.session.messages
        if message.current is not None:
            self._schedule.wake_at(now + message.left_s + 0.01)
        if self.gui.wants_keys:
            self._schedule.wake_at(now + _CARET_S)
        if (rest_s := self.gui.tooltip_in_s) > 0.0:
            self._schedule.wake_at(now + rest_s)
        if self.canvas.map_is_late:
            self._schedule.wake_at(now + MAP_EVERY_S)
        if self.canvas.is_weighing:
            self._schedule.wake_at(now + _WEIGHING_S)
        for at_s in self._keeper.keep_soon(now):
            self._schedule.wake_at(at_s)
        if self.popups.dialogs.waiting or self.session.exporting:
            self._schedule.wake_at(now + _ANSWER_S)
