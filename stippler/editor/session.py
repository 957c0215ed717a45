"""What is open and what is being made of it; knows neither GL nor ImGui."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol, get_args

from stippler.drawing.adjustment import NEUTRAL
from stippler.editor.exports import Exports
from stippler.editor.messages import ERROR, WARNING, Messages
from stippler.editor.rates import StepRate
from stippler.errors import ParameterError, StipplerError
from stippler.jobs import work
from stippler.jobs.work import Source, Work
from stippler.names import shown
from stippler.stippling.fill import Filling, fill_drawing

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from stippler.drawing.document import Document
    from stippler.drawing.dots import Dots
    from stippler.drawing.drawing import Drawing, Page
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
    tone, width_mm, adjustment
        Likewise: how the next start takes the picture.
    source : Source or None
        The picture that is open; one that could not be read never gets here.
    drawing : Drawing or None
        Page, reference and dots; its dots are those of the last job that came to an end.
    document : Document or None
        The drawing's dots, once they can be edited.
    position_mm, radius_mm : arrays or None
        The dots of a job that makes new ones; None when there is no such job.
    filling : Filling
        How a page without a picture is filled next.
    revision : int
        Grows whenever the dots to show, the page or the reference change.
    exports : Exports
        Which file the drawing was last written to, and whether one is being written.
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
        make_ready: Callable[[], Iterator[Work]] = lambda: iter(()),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._worker, self._stipple, self._clock = worker, stipple, clock
        self._make_ready = make_ready
        self.plan = plan
        self.tone, self.width_mm = tone, width_mm
        self.adjustment = NEUTRAL
        self.running_plan: Plan | None = None
        self.source: Source | None = None
        self.drawing: Drawing | None = None
        self.document: Document | None = None
        self.position_mm: NDArray[np.float64] | None = None
        self.radius_mm: NDArray[np.float32] | None = None
        self.revision = 0
        self.filling = Filling()
        self.messages = Messages(clock)
        self.exports = Exports(exporter, self.messages)
        self.phase: Phase = "empty"
        self.stage, self.done, self.total = "", 0, 0
        self._asked: Source | None = None  # what the job that runs was asked for
        self._last: Progress | None = None
        self._request: int | None = None
        self._page: Page | None = None  # a page that is asked for
        self._steps = StepRate()

    # --- what a person does -----------------------------------------------------------------

    def open(self, path: Path) -> None:
        """Open a picture and begin to stipple it; a job that runs is superseded."""
        again = self.source is not None and self.source.path == path
        adjustment = self.adjustment if again else NEUTRAL
        self._begin(Source(path, self.tone, self.width_mm, adjustment))

    def start(self) -> None:
        """Stipple the open picture by the plan, from the beginning."""
        source = self._asked if self._request is not None else self.source
        if source is None:
            self.messages.say("open a picture first", WARNING)
            return
        self._begin(self._as_wanted(source))

    def new(self, page: Page) -> None:
        """Begin a drawing on an empty page."""
        self._end_run()
        self._page, self._asked, self.running_plan = page, None, None
        self._run("running", work.PREPARE, self._make_ready)

    def relax(self, iterations: int, *, weighted: bool) -> None:
        """Relax the drawing's dots; it can be edited meanwhile, and all of it is one step."""
        document = self.document
        if document is None or not self.paintable or document.in_stroke:
            self.messages.say("there are no dots to relax yet", WARNING)
            return
        if not len(document.dots):
            self.messages.say("there are no dots to relax", WARNING)
            return
        self._end_run()
        self._asked = self.source  # not a picture that could not be read since
        assert self.drawing is not None
        frozen = replace(self.drawing, dots=document.begin_run("Relax all"))
        spacing = self.plan.spacing
        self._run(
            "running",
            "relax",
            lambda: work.relax_drawing(frozen, iterations, weighted=weighted, spacing=spacing),
        )
        self.total = iterations

    def take_over(self) -> bool:
        """Make the dots that a job is relaxing the drawing's, so that they can be edited meanwhile.

        The job goes on with just these dots, as one step of the history, and leaves alone what a
        person has changed. Returns whether there was such a job.
        """
        plan, reference, phase = self.running_plan, self.reference, self.phase
        relaxes = self.position_mm is not None and self.stage in ("relax", "tone")
        if self._request is None or plan is None or reference is None or not relaxes:
            return False
        n_done = self.done if self.stage == "relax" else plan.iterations
        self._keep_dots()
        assert self.document is not None
        dots = self.document.begin_run("Settle")
        place, radius = dots.position_mm, dots.radius_mm
        self._run(phase, "relax", lambda: work.carry_on(reference, plan, place, radius, n_done))
        self.done, self.total = n_done, plan.iterations
        if phase == "paused":
            self._worker.pause()
        return True

    def fill(self) -> None:
        """Fill the page with dots, as one step."""
        document = self.document
        if document is None or self.drawing is None or not self.paintable or document.in_stroke:
            self.messages.say("there is no page to fill yet", WARNING)
            return
        n_dots = fill_drawing(self.drawing, document, self.filling)
        self.messages.say(f"{n_dots:,} dots added")

    def undo(self) -> None:
        """Take the last step back; a relaxation that goes on ends and is taken back."""
        document = self.document
        if document is None or not self.paintable or document.in_stroke:
            return
        step = document.history.undone
        if step is not None and step.is_open:
            self.stop()
            if document.history.undone is not step:
                return  # it had not moved anything yet, and is no step
        self._guarded(document.undo)

    def redo(self) -> None:
        """Do the last undone step again."""
        document = self.document
        if document is not None and self.paintable and not document.in_stroke:
            self._guarded(document.redo)

    def _guarded(self, act: Callable[[], object]) -> None:
        """Do something; a person's or a file's error is said."""
        try:
            act()
        except StipplerError as error:
            self.messages.say(str(error), WARNING)

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
        if not self.n_dots:
            self.messages.say("there are no dots to export", WARNING)
            return
        shown = self.document if self.position_mm is None else None
        inputs = tuple(source.path for source in (self.source, self._asked) if source)
        self.exports.start(self._snapshot(self.drawing), path, dpi, shown, inputs)

    # --- what the workers did ---------------------------------------------------------------

    def poll(self) -> bool:
        """Take the workers' latest; return whether anything changed."""
        changed = False
        if (update := self._worker.poll()) is not None:
            changed = self.apply(update)
        return self.exports.poll() or changed

    def apply(self, update: Update[Work]) -> bool:
        """Take a job's update; that of an old request changes nothing and returns False."""
        if update.request_id != self._request:
            return False
        if update.result is not None:
            self._take(update.result)
        if update.ended == "finished":
            is_new = self.position_mm is not None or self.source is None
            self._end("done")
            if is_new:
                self._report()
        elif update.ended == "stopped":
            self._end("stopped")
        elif update.ended == "failed":
            self._end("failed")
            failure = update.failure
            self.messages.say(str(failure), ERROR, failure.__cause__ if failure else None)
        return True

    # --- what there is to show --------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a job runs or is held."""
        return self._request is not None

    @property
    def exporting(self) -> bool:
        """Whether a file is being written."""
        return self.exports.busy

    @property
    def unsaved(self) -> bool:
        """Whether work of a person's hand is in the drawing and not in the file last written."""
        return self.document is not None and self.exports.lack(self.document)

    @property
    def starts_afresh(self) -> bool:
        """Whether `start` would read the picture anew, and so begin another drawing."""
        source = self.source
        return source is not None and not self._as_wanted(source).is_read_as(source)

    @property
    def relaxing(self) -> bool:
        """Whether the job that runs moves the drawing's own dots."""
        return self.busy and self.document is not None and self.document.in_run

    @property
    def paintable(self) -> bool:
        """Whether the dots can be edited now: they are there, and no job makes new ones."""
        return self.document is not None and (not self.busy or self.relaxing)

    @property
    def pen(self) -> str:
        """The pen that draws the dots of a job that makes new ones; empty without such a job."""
        making = self.position_mm is not None and self.running_plan is not None
        return self.running_plan.pen if making and self.running_plan else ""

    @property
    def steps_per_s(self) -> float:
        """Relaxation steps a second in the work that runs, or the last; 0 before any."""
        return self._steps.per_s

    @property
    def n_dots(self) -> int:
        """How many dots there are to show."""
        if self.position_mm is not None:
            return len(self.position_mm)
        return len(self.document.dots) if self.document is not None else 0

    @property
    def reference(self) -> Reference | None:
        """The open picture's darkness."""
        return self.drawing.reference if self.drawing else None

    @property
    def name(self) -> str:
        """File name of the picture that is open or being opened."""
        source = self._asked if self._request is not None and self._asked else self.source
        return shown(source.path.name) if source else "Untitled" if self.drawing else ""

    @property
    def outdated(self) -> bool:
        """Whether the dots at hand were made with other values than the panels show."""
        asked = self._asked if self._request is not None else self.source
        return asked is not None and (
            asked != self._as_wanted(asked) or self.running_plan != self.plan
        )

    # --- inside -----------------------------------------------------------------------------

    def _as_wanted(self, source: Source) -> Source:
        return replace(source, tone=self.tone, width_mm=self.width_mm, adjustment=self.adjustment)

    def _begin(self, source: Source) -> None:
        self._end_run()
        known = self.reference if source.is_read_as(self.source) else None
        plan, stipple = self.plan, self._stipple
        self._page, self._asked, self.running_plan = None, source, plan
        first = work.READ if known is None else "first dots"
        self._run("running", first, lambda: stipple(source, plan, known))

    def _run(self, phase: Phase, stage: str, job: Callable[[], Iterator[Work]]) -> None:
        self._request = self._worker.start(job)
        self.phase, self.stage, self.done, self.total = phase, stage, 0, 0
        self._last = None
        self._steps = StepRate()

    def _end_run(self) -> None:
        if self.document is not None:
            self.document.end_run()

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
        if result.moved_mm is not None and self.document is not None:
            self.document.merge(result.moved_mm)
            if result.radius_mm is not None:
                self.document.merge_radii(result.radius_mm)
        if result.stage == "relax":
            self._steps.note(self._clock(), result.done)

    def _adopt(self, reference: Reference) -> None:
        from stippler.drawing.drawing import Page

        assert self._asked is not None
        if self.drawing is not None and self._asked.is_read_as(self.source):
            self._set_reference(reference)  # adjusted anew; page, dots and history stay
        else:
            self._open_page(Page(reference.width_mm, reference.height_mm), reference)
            if self.source is None or self.source.path != self._asked.path:
                self.adjustment = self._asked.adjustment
        self.source = self._asked

    def _set_reference(self, reference: Reference) -> None:
        assert self.drawing is not None
        if self.document is None:
            self.drawing.reference = reference
        else:
            self.document.begin("Adjust the picture")
            self.document.set("reference", 0, reference)
            self.document.commit(of_job=True)
        self.revision += 1

    def _open_page(self, page: Page, reference: Reference | None) -> None:
        from stippler.drawing.drawing import Drawing

        if self.document is not None:
            self.document.history.close()
        self.drawing = Drawing.blank(page)
        self.drawing.reference = reference
        self.document = self.position_mm = self.radius_mm = None
        self.exports.begin_drawing()
        self.revision += 1

    def _end(self, phase: Phase) -> None:
        self._request, self.phase = None, phase
        if self._page is not None and phase == "done":
            self._open_page(self._page, None)
            self.source = None
        self._page = None
        if self.drawing is None:
            self.phase = "empty"
        self._end_run()
        self._keep_dots()

    def _keep_dots(self) -> None:
        """Make the dots that are shown the drawing's; replacing others is a step of its history."""
        if self.drawing is None:
            return
        import numpy as np

        from stippler.drawing.document import Document
        from stippler.drawing.dots import Dots

        if self.position_mm is not None and self.radius_mm is not None:
            made = self._drawn(Dots.round(self.position_mm, self.radius_mm))
            if self.document is None:
                self.drawing.dots = made
            else:
                self.document.begin("Stipple")
                self.document.remove(np.arange(len(self.document.dots)))
                self.document.insert(made)
                self.document.commit(of_job=True)
        self.position_mm = self.radius_mm = None
        if self.document is None:
            self.document = Document(self.drawing)
        self.revision += 1

    def _snapshot(self, drawing: Drawing) -> Drawing:
        """Copy the drawing as it looks now, in the midst of a job too."""
        if self.position_mm is not None and self.radius_mm is not None:
            from stippler.drawing.dots import Dots

            made = self._drawn(Dots.round(self.position_mm, self.radius_mm))
            return replace(drawing, dots=made)
        return work.frozen(drawing)

    def _drawn(self, dots: Dots) -> Dots:
        """Return dots as the plan's pen draws them."""
        from stippler.drawing.pens import pen_named

        return pen_named(self.running_plan.pen).drawn(dots) if self.running_plan else dots

    def _report(self) -> None:
        """Say what has been drawn, and what it falls short of."""
        if self.source is None:
            return
        from stippler.stippling.stipple import notes_on

        self.messages.say(f"{self.n_dots:,} dots drawn")
        notes = notes_on(self._last) if self._last is not None else ()
        if notes:
            self.messages.say("; ".join(notes), WARNING)
        elif not self.n_dots:
            self.messages.say("the picture is all white: a drawing without dots", WARNING)
