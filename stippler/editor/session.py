"""What is open and what is being made of it; knows neither GL nor ImGui."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol

from stippler.drawing.adjustment import NEUTRAL
from stippler.editor.activity import (
    Activity,
    Filling,
    Idle,
    Job,
    Making,
    Opening,
    Relaxing,
    Reopening,
)
from stippler.editor.exports import SAVED, Exports
from stippler.editor.keeping import Keeping
from stippler.editor.messages import ERROR, WARNING, Messages
from stippler.editor.rates import StepRate
from stippler.errors import ParameterError, StipplerError
from stippler.jobs import work
from stippler.jobs.work import Source, Work
from stippler.names import shown
from stippler.stippling.fill import Filling as FillValues

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing, Page
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import Style
    from stippler.files.native.recovery import Lost
    from stippler.jobs.worker import Update, Worker

Phase = Literal["empty", "running", "paused", "done", "stopped", "failed"]


class Stipple(Protocol):
    """Makes a job out of a picture, a style, and the picture's reference if it is known."""

    def __call__(self, source: Source, style: Style, reference: Reference | None) -> Iterator[Work]:
        """Return the job's results to come."""
        ...


class Session:
    """The open drawing, the values of the next one, and the job that runs.

    Parameters
    ----------
    worker, exporter : Worker
        Where drawings are made and written; the owner closes them.
    style : Style
        To begin with.
    stipple : callable
        Makes the jobs.

    Attributes
    ----------
    style : Style
        As the panels show it; the drawing holds what its dots were asked for with.
    tone, width_mm, adjustment
        Likewise: how the next start takes the picture.
    activity : Activity
        What is being done now; all that concerns only that is kept there.
    document : Document or None
        The open drawing; everything that is shown, painted on and written is in it.
    filling : stippler.stippling.fill.Filling
        How a page without a picture is filled next.
    notes : tuple of str
        How the open picture was read, as far as that is to be known.
    revision : int
        Grows whenever another drawing is open.
    exports : Exports
        Which file the drawing was last written to, and whether one is being written.
    """

    def __init__(
        self,
        worker: Worker[Work],
        exporter: Worker[Path],
        style: Style,
        *,
        tone: str,
        width_mm: float,
        stipple: Stipple,
        make_ready: Callable[[], Iterator[Work]] = lambda: iter(()),
        is_warm: Callable[[], bool] = lambda: True,
        recovery: Path | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._worker, self._stipple, self._clock = worker, stipple, clock
        self._make_ready = make_ready
        self.style = style
        self.tone, self.width_mm = tone, width_mm
        self.adjustment = NEUTRAL
        self.activity: Activity = Idle()
        self.document: Document | None = None
        self.revision = 0
        self.filling = FillValues()
        self.messages = Messages(clock)
        self.notes: tuple[str, ...] = ()
        self.exports = Exports(exporter, self.messages)
        self.keeping = Keeping(recovery, self.messages, clock)
        self._is_warm = is_warm
        self._read: Source | None = None  # where the drawing's picture came from
        self._steps = StepRate()
        self._stage: tuple[str, float] = ("", 0.0)  # and since when

    # --- what a person does -----------------------------------------------------------------

    def open(self, path: Path) -> None:
        """Open a picture and begin to stipple it; a job that runs is superseded."""
        again = self._read is not None and self._read.path == path
        adjustment = self.adjustment if again else NEUTRAL
        self._begin(Source(path, self.tone, self.width_mm, adjustment))

    def open_reference(self, path: Path) -> None:
        """Open a picture only to draw after it by hand: no dots are made."""
        self._supersede()
        source = Source(path, self.tone, self.width_mm, NEUTRAL)
        request = self._worker.start(lambda: work.read_only(source, is_warm=self._is_warm))
        self._run(Opening(request, work.READ, source, self.style, by_hand=True))

    def open_drawing(self, path: Path) -> None:
        """Open a drawing that was saved."""
        self._reopen(work.open_drawing(path, is_warm=self._is_warm), file=path)

    def recover(self, lost: Lost) -> None:
        """Open what a crash has left of a drawing."""
        self._reopen(work.recover(lost, is_warm=self._is_warm), file=lost.path, lost=lost)

    def _reopen(self, job: Iterator[Work], *, file: Path | None, lost: Lost | None = None) -> None:
        self._supersede()
        request = self._worker.start(lambda: job)
        self._run(Reopening(request, work.READ, file=file, lost=lost))

    def open_document(self, document: Document, file: Path | None, lost: Lost | None) -> None:
        """Open a drawing that was kept; what a crash had left of it goes when it is kept anew."""
        is_table = file is not None and file.suffix.lower() != SAVED
        self._open(document, None, None if is_table else file, lost)
        reference = document.drawing.reference
        if reference is not None:
            self.tone, self.width_mm = reference.source.tone, reference.width_mm
            self.adjustment = reference.adjustment
            picture = reference.source
            self._read = Source(
                Path(picture.name or "picture"), self.tone, self.width_mm, NEUTRAL, picture.data
            )
        self.style = document.drawing.style_of(0)
        if lost is not None:
            self.messages.say(f"{lost.name} is as it was; save it to keep it")

    def show(self, drawing: Drawing, source: Source | None = None) -> None:
        """Open a drawing that is there; a job that runs is superseded."""
        from stippler.drawing.document import Document

        if isinstance(self.activity, Job):
            self._worker.stop()
            self._end("stopped")
        self._open(Document(drawing), source)
        self.activity = Idle()

    def start(self) -> None:
        """Stipple the open picture by the style, from the beginning."""
        source = self._asked
        if source is None:
            self.messages.say("open a picture first", WARNING)
            return
        self._begin(self._as_wanted(source))

    def new(self, page: Page) -> None:
        """Begin a drawing on an empty page."""
        self._supersede()
        request = self._worker.start(self._make_ready)
        self._run(Opening(request, work.PREPARE, None, self.style, page))

    def relax(self, iterations: int, *, weighted: bool) -> None:
        """Relax the drawing's dots; it can be edited meanwhile, and all of it is one step."""
        document = self.document
        if document is None or not self.paintable or document.in_stroke:
            self.messages.say("there are no dots to relax yet", WARNING)
            return
        if not len(document.dots):
            self.messages.say("there are no dots to relax", WARNING)
            return
        self._supersede()
        frozen = replace(document.drawing, dots=document.begin_run("Relax all"))
        spacing = self.style.spacing
        request = self._worker.start(
            lambda: work.relax_drawing(frozen, iterations, weighted=weighted, spacing=spacing)
        )
        self._run(Relaxing(request, "relax", self.source, total=iterations))

    def take_over(self) -> bool:
        """Let a person edit the dots of a draft that is being relaxed: it is adopted as it is.

        The job goes on with just these dots, as one step of the history, and leaves alone what a
        person has changed. Returns whether there was such a draft.
        """
        making, document = self.activity, self.document
        if not (isinstance(making, Making) and making.can_be_taken_over):
            return False
        assert document is not None
        reference, style = document.drawing.reference, making.style
        if reference is None:
            return False
        n_done = making.done if making.stage == "relax" else style.iterations
        document.end_draft()
        dots = document.begin_run("Settle")
        request = self._worker.start(
            lambda: work.carry_on(reference, style, dots.position_mm, dots.radius_mm, n_done)
        )
        relaxing = Relaxing(
            request, "relax", making.source, done=n_done, total=style.iterations,
            is_held=making.is_held,
        )  # fmt: skip
        self._run(relaxing)
        if relaxing.is_held:
            self._worker.pause()
        return True

    def fill(self) -> None:
        """Fill the page with dots, as one step."""
        document, values = self.document, self.filling
        if document is None or not self.paintable or document.in_stroke:
            self.messages.say("there is no page to fill yet", WARNING)
            return
        self._supersede()
        outline = document.drawing.outlines()[0]
        request = self._worker.start(lambda: work.fill(outline, values))
        self._run(Filling(request, "fill", self.source, values.radius_mm))

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

    def pause(self) -> None:
        """Hold the job where it is."""
        if isinstance(self.activity, Job) and not self.activity.is_held:
            self._worker.pause()
            self.activity.is_held = True

    def resume(self) -> None:
        """Let a held job go on."""
        if isinstance(self.activity, Job) and self.activity.is_held:
            self._worker.pause(False)
            self.activity.is_held = False
            self._steps.forget()

    def stop(self) -> None:
        """End the job; the dots that are there stay."""
        if not self.busy:
            return
        self.poll()
        if self.busy:
            self._worker.stop()
            self._end("stopped")
            self.messages.say("stopped; the dots that are there stay")

    def edit_style(self, **changes: Any) -> bool:
        """Change fields of the style; a value outside its range is refused with a line."""
        try:
            self.style = replace(self.style, **changes)
        except ParameterError as error:
            self.messages.say(str(error), WARNING)
            return False
        return True

    def export(self, path: Path, dpi: float) -> None:
        """Write the drawing to a file, beside whatever else is going on."""
        if self.exporting:
            self.messages.say("the last export is still being written", WARNING)
            return
        if self.document is None:
            self.messages.say("there is no drawing to export yet", WARNING)
            return
        if not self.n_dots:
            self.messages.say("there are no dots to export", WARNING)
            return
        inputs = tuple(source.path for source in (self.source, self._asked) if source)
        self.exports.start(self.document, path, {"dpi": dpi}, inputs)

    def save(self, path: Path, *, is_copy: bool = False) -> None:
        """Write all of the drawing to a file of its own, to go on with later.

        Parameters
        ----------
        is_copy : bool
            Whether the drawing stays that of the file it was saved in before.
        """
        if self.exporting:
            self.messages.say("the last file is still being written", WARNING)
        elif self.document is None:
            self.messages.say("there is no drawing to save yet", WARNING)
        else:
            self.exports.start(self.document, path, {}, is_copy=is_copy)

    # --- what the workers did ---------------------------------------------------------------

    def poll(self) -> bool:
        """Take the workers' latest; return whether anything changed."""
        changed = False
        if (update := self._worker.poll()) is not None:
            changed = self.apply(update)
        written = self.exports.poll()
        if written is not None and written == self.exports.file:
            self.keeping.saved(written)
        self.keeping.poll()
        return written is not None or changed

    def apply(self, update: Update[Work]) -> bool:
        """Take a job's update; that of an old request changes nothing and returns False.

        Where it cannot be taken the job ends, and that is said.
        """
        job = self.activity
        if not isinstance(job, Job) or update.request_id != job.request:
            return False
        try:
            if update.result is not None:
                self._take(job, update.result)
            if update.ended:
                self._end({"finished": "done"}.get(update.ended, update.ended))
        except Exception as error:  # noqa: BLE001 - the job ends; the drawing and the editor live on
            self._give_up(error)
            return True
        if update.ended == "failed":
            failure = update.failure
            self.messages.say(str(failure), ERROR, failure.__cause__ if failure else None)
        return True

    # --- what there is to show --------------------------------------------------------------

    @property
    def drawing(self) -> Drawing | None:
        """The open drawing; only its document changes it."""
        return self.document.drawing if self.document is not None else None

    @property
    def source(self) -> Source | None:
        """The picture that is open, as the drawing takes it; one never read never gets here."""
        if self._read is None or self.reference is None:
            return None
        return replace(self._read, adjustment=self.reference.adjustment)

    @property
    def busy(self) -> bool:
        """Whether a job runs or is held."""
        return isinstance(self.activity, Job)

    @property
    def phase(self) -> Phase:
        """How the work stands, in a word."""
        if isinstance(self.activity, Job):
            return "paused" if self.activity.is_held else "running"
        return self.activity.outcome if self.document is not None else "empty"  # type: ignore[return-value]

    @property
    def stage(self) -> str:
        """What the job is at; empty without one."""
        return self.activity.stage if isinstance(self.activity, Job) else ""

    @property
    def stage_s(self) -> float:
        """How long the job has been at its stage."""
        if self.stage != self._stage[0]:
            self._stage = (self.stage, self._clock())
        return self._clock() - self._stage[1]

    @property
    def done(self) -> int:
        """How much of its stage the job has done."""
        return self.activity.done if isinstance(self.activity, Job) else 0

    @property
    def total(self) -> int:
        """How much there is to do in this stage; 0 if it is not known."""
        return self.activity.total if isinstance(self.activity, Job) else 0

    @property
    def exporting(self) -> bool:
        """Whether a file is being written."""
        return self.exports.busy

    @property
    def unsaved(self) -> bool:
        """Whether work of a person's hand is in the drawing and not in the file it is saved in."""
        return self.document is not None and self.exports.lack(self.document)

    @property
    def starts_afresh(self) -> bool:
        """Whether `start` would read the picture anew, and so begin another drawing."""
        source = self.source
        return source is not None and not self._as_wanted(source).is_read_as(source)

    @property
    def relaxing(self) -> bool:
        """Whether the job that runs moves the drawing's own dots."""
        return isinstance(self.activity, Relaxing)

    @property
    def paintable(self) -> bool:
        """Whether the dots can be edited now: they are there, and no job makes new ones."""
        return self.document is not None and isinstance(self.activity, Idle | Relaxing)

    @property
    def steps_per_s(self) -> float:
        """Relaxation steps a second in the work that runs, or the last; 0 before any."""
        return self._steps.per_s

    @property
    def n_dots(self) -> int:
        """How many dots there are to show."""
        return len(self.document.dots) if self.document is not None else 0

    @property
    def reference(self) -> Reference | None:
        """The open picture's darkness."""
        return self.drawing.reference if self.drawing is not None else None

    @property
    def name(self) -> str:
        """File name of the picture that is open or being opened."""
        source = self._asked
        if self.exports.file is not None and not isinstance(self.activity, Opening):
            return shown(self.exports.file.name)
        return (
            shown(source.path.name) if source else "Untitled" if self.document is not None else ""
        )

    @property
    def outdated(self) -> bool:
        """Whether the dots at hand were made with other values than the panels show."""
        asked, job = self._asked, self.activity
        if asked is None:
            return False
        style = job.style if isinstance(job, Opening | Making) else self._style
        return asked != self._as_wanted(asked) or style != self.style

    # --- inside -----------------------------------------------------------------------------

    @property
    def _asked(self) -> Source | None:
        """The picture of the job that runs, or else the one that is open."""
        job = self.activity
        if isinstance(job, Opening | Making | Relaxing | Filling) and job.source is not None:
            return job.source
        return None if isinstance(job, Opening) else self.source

    @property
    def _style(self) -> Style | None:
        return self.drawing.style_of(0) if self.drawing is not None else None

    def _as_wanted(self, source: Source) -> Source:
        return replace(source, tone=self.tone, width_mm=self.width_mm, adjustment=self.adjustment)

    def _begin(self, source: Source) -> None:
        self._supersede()
        known = self.reference if source.is_read_as(self._read) else None
        style, stipple = self.style, self._stipple
        request = self._worker.start(lambda: stipple(source, style, known))
        if known is None:
            self._run(Opening(request, work.READ, source, style))
        else:
            self._run(Making(request, "first dots", source, style))

    def _run(self, job: Job) -> None:
        self.activity = job  # type: ignore[assignment]
        self._steps = StepRate()

    def _supersede(self) -> None:
        """End what goes on, since the worker's next job takes its place."""
        if isinstance(self.activity, Job) and not isinstance(self.activity, Making):
            self._end("stopped")  # what is being made is shown until there are other dots

    def _take(self, job: Job, result: Work) -> None:
        self.activity = job.take(self, result)
        if result.stage == "relax":
            self._steps.note(self._clock(), result.done)

    def _end(self, outcome: str) -> None:
        job, self.activity = self.activity, Idle(outcome)
        if isinstance(job, Job):
            job.end(self, outcome)
        if self.document is not None:
            self.document.end_draft()  # that of a job before, which this one was to replace

    def _give_up(self, error: Exception) -> None:
        """End the job whose result could not be taken; the dots that are there stay."""
        self._worker.stop()
        job, self.activity = self.activity, Idle("failed")
        try:
            if isinstance(job, Job):
                job.end(self, "failed")
        except Exception as another:  # noqa: BLE001 - then the run is dropped as it is
            error.add_note(f"and its end failed: {another}")
        what = str(error).strip().partition("\n")[0][:120]
        text = f"a result could not be taken ({type(error).__name__}: {what}); the work has ended"
        self.messages.say(text, ERROR, error)

    def open_page(self, page: Page, source: Source | None, reference: Reference | None) -> None:
        """Begin another drawing."""
        from stippler.drawing.document import Document
        from stippler.drawing.drawing import Drawing

        drawing = Drawing.blank(page, self.style)
        drawing.reference = reference
        if source is not None and (self._read is None or self._read.path != source.path):
            self.adjustment = source.adjustment
        self._open(Document(drawing), source)

    def _open(
        self,
        document: Document,
        source: Source | None,
        file: Path | None = None,
        lost: Lost | None = None,
    ) -> None:
        if self.document is not None:
            self.document.history.close()
        self.document, self._read, self.notes = document, source, ()
        self.exports.begin_drawing(file, None if lost else document)
        self.keeping.open(document, self.name, file, lost)
        self.revision += 1

    def _guarded(self, act: Callable[[], object]) -> None:
        """Do something; a person's or a file's error is said."""
        try:
            act()
        except StipplerError as error:
            self.messages.say(str(error), WARNING)
