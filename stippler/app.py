"""The editor, put together: window, workers, session and the frame loop."""

from __future__ import annotations

from collections.abc import Collection
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.editor.garbage_collection import Garbage
from stippler.editor.log_file import begin_log, end_log, log_path
from stippler.editor.session import Session
from stippler.jobs.preparing import make_ready
from stippler.jobs.stippling import stipple_picture
from stippler.jobs.work import Work
from stippler.jobs.worker import Worker
from stippler.settings import settings_folder
from stippler.ui.editor_window import Editor
from stippler.ui.preferences import Preferences
from stippler.ui.window.placement import Place
from stippler.ui.window.window import Window
from stippler.warm import is_warm

if TYPE_CHECKING:
    from stippler.drawing.style import Style

_AT_REST_S = 1.0  # the next frame is so far off that nobody sees a pause
_FAREWELL_S = 2.0  # for a worker that decodes a large picture; it is let go of after that


class App:
    """The editor's parts.

    Parameters
    ----------
    style : Style
        What to make of the first picture.
    tone : {"illustration", "linear", "perceptual"}
    width_mm : float
        Of the page.
    preferences : Preferences, optional
        What is kept from the last start; without them, nothing is kept for the next.
    size : (width, height), optional
        Of the window, instead of the one that is kept.
    offscreen : bool
        Without a display, for tests and screenshots.
    ratio : float
        Pixels a unit of an offscreen window, as dense screens of some systems have them.
    recovery : Path, optional
        The folder in which open drawings are kept for the case of a crash; else they are not.
    backups : Path, optional
        The folder in which earlier versions are kept; else they are not.
    """

    def __init__(
        self,
        style: Style,
        *,
        tone: str,
        width_mm: float,
        preferences: Preferences | None = None,
        size: tuple[int, int] | None = None,
        offscreen: bool = False,
        ratio: float = 1.0,
        recovery: Path | None = None,
        backups: Path | None = None,
    ) -> None:
        self._garbage = Garbage()
        kept = preferences or Preferences()
        place = Place(size) if size is not None else kept.place
        self.window = Window("Stippler", place, offscreen=offscreen, ratio=ratio)
        self.worker: Worker[Work] = Worker(self.window.wake)
        self.exporter: Worker[Path] = Worker(self.window.wake)
        self.session = Session(
            self.worker,
            self.exporter,
            style,
            tone=tone,
            width_mm=width_mm,
            stipple=partial(stipple_picture, is_warm=is_warm),
            make_ready=partial(make_ready, is_warm=is_warm),
            is_warm=is_warm,
            recovery=recovery,
            backups=backups,
        )
        self.session.saving.wishes = kept.saving
        native = False if offscreen else None
        self.editor = Editor(self.window, self.session, kept, native_dialogs=native)

    def step(self, timeout_s: float | None = None) -> bool:
        """Wait for something to do, at most `timeout_s`; draw a frame if there is one to draw."""
        sleep_s = self.editor.sleep_s()
        if sleep_s >= _AT_REST_S and not self.session.busy:
            self._garbage.rest()
        self.window.wait(sleep_s if timeout_s is None else min(sleep_s, timeout_s))
        return self.editor.step()

    def open(self, path: Path | None) -> None:
        """Open a picture or a drawing, and offer what a crash has left."""
        from stippler.opening import is_drawing  # late, for the sake of the first frame

        if path is not None and is_drawing(path):
            self.session.open_drawing(path)
        elif path is not None:
            self.session.open(path)
        self.editor.popups.recovery.ask(quietly=True)

    def run(self) -> None:
        """Go on until the window is closed."""
        while not self.window.wants_to_close:
            self.step()

    def close(self) -> None:
        """End the workers, then the window; a file that is being written is finished first."""
        self.worker.close(_FAREWELL_S)
        self.session.saving.wait()
        self.exporter.close(None)  # half a file is worse than a window that stays
        self.editor.close()
        self.window.close()
        self._garbage.close()


def edit(
    path: Path | None, style: Style, *, tone: str, width_mm: float, given: Collection[str] = ()
) -> int:
    """Open the editor on a picture or a drawing; return the exit code when its window is closed.

    Parameters
    ----------
    given : names of the values that were asked for
        Others are as they were last used.

    Raises
    ------
    DisplayError
        If there is no display, or no OpenGL 3.3.
    """
    from stippler.files.native.backups import backups_root
    from stippler.files.native.recovery import recovery_root

    kept = Preferences.load(settings_folder())
    style, tone, width_mm = kept.begin(style, tone, width_mm, given)
    app = App(
        style, tone=tone, width_mm=width_mm, preferences=kept, recovery=recovery_root(),
        backups=backups_root(),
    )  # fmt: skip
    log = begin_log(log_path())
    app.session.messages.log_path = log_path() if log is not None else None
    try:
        app.step()  # a first frame before the worker takes its share of the processor
        app.open(path)
        app.run()
        app.session.keeping.close()  # not after an exception: then the drawing can be recovered
    finally:
        app.close()
        end_log(log)
    return 0
