"""What is open and what is being made of it; knows neither GL nor ImGui."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol, get_args

from stippler.errors import ParameterError
from stippler.ui import work
from stippler.ui.messages import ERROR, WARNING, Messages
from stippler.ui.rates import StepRate
from stippler.ui.work import Source, Work

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from stippler.drawing.drawing import Drawing
    from stippler.drawing.reference import Reference
    from stippler.jobs.worker import Update, Worker
    from stippler.stippling.plan import Plan
    from stippler.stippling.stipple import Progress

Phase = Literal["empty", "running", "paused", "done", "stopped", "failed"]
PHASES: tuple[Phase, ...] = get_args(Phase)


class Stipple(Protocol):
    """Makes a job out of a picture, a plan, and the picture's reference if it is known."""

    def __call__(self, source: Source, plan: Plan, reference: Reference | None) -> Iterator[Work]:
        """Return the job's results to come."""
        ...


class Session:
    """The open picture, the plan being edited, and the job that runs.

    Parameters
    ----------
    worker, exporter : Worker
        Where drawings are made and written; the owner closes them.
    plan : Plan
        To begin with.
    stipple : callable
        Makes the jobs.

    Attributes
    ----------
    plan : Plan
        As the panels show it; `running_plan` is what the dots at hand were asked for with.
    source : Source or None
        The picture that is open; one that could not be read never gets here.
    drawing : Drawing or None
        Page, reference and dots; its dots are those of the last job that came to an end.
    position_mm, radius_mm : arrays or None
        The dots to show now: the job's latest, then the drawing's.
    revision : int
        Grows whenever the dots to show, the page or the reference change.
    """

    def __init__(
        self,
        worker: Worker[Work],
        exporter: Worker[Path],
        plan: Plan,
        *,
        tone: str,
        width_mm: float,
        stipple: Stipple,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._worker, self._exporter, self._stipple, self._clock = worker, exporter, stipple, clock
        self.plan = plan
        self.tone, self.width_mm = tone, width_mm
        self.running_plan: Plan | None = None
        self.source: Source | None = None
        self.drawing: Drawing | None = None
        self.position_mm: NDArray[np.float64] | None = None
        self.radius_mm: NDArray[np.float32] | None = None
        self.revision = 0
        self.messages = Messages(clock)
        self.phase: Phase = "empty"
        self.stage, self.done, self.total = "", 0, 0
        self._asked: Source | None = None  # what the job that runs was asked for
        self._last: Progress | None = None
        self._request: int | None = None
        self._export_request: int | None = None
        self._steps = StepRate()

    # --- what a person does -----------------------------------------------------------------

    def open(self, path: Path) -> None:
        """Open a picture and begin to stipple it; a job that runs is superseded."""
        self._begin(Source(path, self.tone, self.width_mm))

    def start(self) -> None:
        """Stipple the open picture by the plan, from the beginning."""
        source = self._asked if self._request is not None else self.source
        if source is None:
            self.messages.say("open a picture first", WARNING)
            return
        self._begin(replace(source, tone=self.tone, width_mm=self.width_mm))

    def pause(self) -> None:
        """Hold the job where it is."""
        if self.phase == "running":
            self._worker.pause()
            self.phase = "paused"

    def resume(self) -> None:
        """Let a held job go on."""
        if self.phase == "paused":
            self._worker.pause(False)
            self.phase = "running"
            self._steps.forget()

    def stop(self) -> None:
        """End the job; the dots that are there stay, and become the drawing's."""
        if self._request is None:
            return
        self.poll()
        if self._request is not None:
            self._worker.stop()
            self._end("stopped")
            self.messages.say("stopped; the dots that are there stay")

    def edit_plan(self, **changes: Any) -> bool:
        """Change fields of the plan; a value outside its range is refused with a line."""
        try:
            self.plan = replace(self.plan, **changes)
        except ParameterError as error:
            self.messages.say(str(error), WARNING)
            return False
        return True

    def export(self, path: Path, dpi: float) -> None:
        """Write the drawing to a file, beside whatever else is going on."""
        if self.exporting:
            self.messages.say("the last export is still being written", WARNING)
            return
        if self.drawing is None:
            self.messages.say("there is no drawing to export yet", WARNING)
            return
        drawing = self._snapshot(self.drawing)
        self._export_request = self._exporter.start(lambda: work.export_drawing(drawing, path, dpi))
        self.messages.say(f"writing {path.name}")

    # --- what the workers did ---------------------------------------------------------------

    def poll(self) -> bool:
        """Take the workers' latest; return whether anything changed."""
        changed = False
        if (update := self._worker.poll()) is not None:
            changed = self.apply(update)
        if (written := self._exporter.poll()) is not None:
            changed = self.apply_export(written) or changed
        return changed

    def apply(self, update: Update[Work]) -> bool:
        """Take a job's update; that of an old request changes nothing and returns False."""
        if update.request_id != self._request:
            return False
        if update.result is not None:
            self._take(update.result)
        if update.ended == "finished":
            self._end("done")
            self._report()
        elif update.ended == "stopped":
            self._end("stopped")
        elif update.ended == "failed":
            self._end("failed")
            failure = update.failure
            self.messages.say(str(failure), ERROR, failure.__cause__ if failure else None)
        return True

    def apply_export(self, update: Update[Path]) -> bool:
        """Take an export's update."""
        if update.request_id != self._export_request or not update.ended:
            return False
        self._export_request = None
        if update.failure is not None:
            self.messages.say(str(update.failure), ERROR, update.failure.__cause__)
        elif update.ended == "finished" and update.result is not None:
            self.messages.say(f"{update.result} is written")
        return True

    # --- what there is to show --------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a job runs or is held."""
        return self._request is not None

    @property
    def exporting(self) -> bool:
        """Whether a file is being written."""
        return self._export_request is not None

    @property
    def steps_per_s(self) -> float:
        """Relaxation steps a second in the work that runs, or the last; 0 before any."""
        return self._steps.per_s

    @property
    def n_dots(self) -> int:
        """How many dots there are to show."""
        return 0 if self.position_mm is None else len(self.position_mm)

    @property
    def reference(self) -> Reference | None:
        """The open picture's darkness."""
        return self.drawing.reference if self.drawing else None

    @property
    def name(self) -> str:
        """File name of the picture that is open or being opened."""
        source = self._asked if self._request is not None else self.source
        return source.path.name if source else ""

    @property
    def outdated(self) -> bool:
        """Whether the dots at hand were made with other values than the panels show."""
        asked = self._asked if self._request is not None else self.source
        return asked is not None and (
            (asked.tone, asked.width_mm) != (self.tone, self.width_mm)
            or self.running_plan != self.plan
        )

    # --- inside -----------------------------------------------------------------------------

    def _begin(self, source: Source) -> None:
        known = self.reference if source == self.source else None
        plan, stipple = self.plan, self._stipple
        self._request = self._worker.start(lambda: stipple(source, plan, known))
        self._asked, self.running_plan, self.phase = source, plan, "running"
        self.stage, self.done, self.total = work.READ if known is None else "first dots", 0, 0
        self._last = None
        self._steps = StepRate()

    def _take(self, result: Work) -> None:
        self.stage, self.done, self.total = result.stage, result.done, result.total
        if result.reference is not None and result.reference is not self.reference:
            self._adopt(result.reference)
        if result.progress is not None:
            self._last = result.progress
            self.position_mm, self.radius_mm = (
                result.progress.position_mm,
                result.progress.radius_mm,
            )
            self.revision += 1
        if result.stage == "relax":
            self._steps.note(self._clock(), result.done)

    def _adopt(self, reference: Reference) -> None:
        from stippler.drawing.drawing import Drawing, Page

        self.drawing = Drawing.blank(Page(reference.width_mm, reference.height_mm))
        self.drawing.reference = reference
        self.source = self._asked
        self.position_mm = self.radius_mm = None
        self.revision += 1

    def _end(self, phase: Phase) -> None:
        self._request, self.phase = None, phase
        if self.source is None:
            self.phase = "empty"
        self._keep_dots()

    def _keep_dots(self) -> None:
        """Make the dots that are shown the drawing's."""
        if self.drawing is None or self.position_mm is None or self.radius_mm is None:
            return
        from stippler.drawing.dots import Dots

        self.drawing.dots = Dots.round(self.position_mm, self.radius_mm)

    def _snapshot(self, drawing: Drawing) -> Drawing:
        """Copy the drawing as it looks now, in the midst of a job too."""
        if self.busy and self.position_mm is not None and self.radius_mm is not None:
            from stippler.drawing.dots import Dots

            return replace(drawing, dots=Dots.round(self.position_mm, self.radius_mm))
        return work.frozen(drawing)

    def _report(self) -> None:
        """Say what has been drawn, and what it falls short of."""
        from stippler.stippling.stipple import notes_on

        self.messages.say(f"{self.n_dots:,} dots drawn")
        notes = notes_on(self._last) if self._last is not None else ()
        if notes:
            self.messages.say("; ".join(notes), WARNING)
        elif not self.n_dots:
            self.messages.say("the picture is all white: a drawing without dots", WARNING)
