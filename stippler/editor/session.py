"""What is open and what is being made of it; knows neither GL nor ImGui."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.drawing.adjustment import NEUTRAL
from stippler.drawing.area import PAGE_AREA
from stippler.editor import processing
from stippler.editor.activity import (
    Filling,
    Idle,
    Job,
    Making,
    Opening,
    Processing,
    Relaxing,
    Reopening,
)
from stippler.editor.exports import SAVED, Exports
from stippler.editor.keeping import Keeping
from stippler.editor.messages import ERROR, WARNING, Messages
from stippler.editor.rates import StepRate
from stippler.editor.saving import Saving
from stippler.editor.session_state import SessionState, Stipple
from stippler.errors import ParameterError, StipplerError
from stippler.jobs import preflight, reading, stippling, work
from stippler.jobs.work import Source, Work
from stippler.stippling.task import SETTLE, Standing, Task

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing, Page
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import Style
    from stippler.files.native.recovery import Lost
    from stippler.jobs.worker import Update, Worker


class Session(SessionState):
    """The open drawing, the values of the next one, and the job that runs.

    Parameters
    ----------
    worker, exporter : Worker
        Where drawings are made and written; the owner closes them.
    style : Style
        To begin with.
    stipple : callable
        Makes the jobs.
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
        backups: Path | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._worker, self._stipple, self._clock = worker, stipple, clock
        self._make_ready = make_ready
        self._is_warm = is_warm
        self.messages = Messages(clock)
        self.keeping = Keeping(recovery, self.messages, clock)
        super().__init__(style, tone, width_mm, Exports(exporter, self.messages))
        self.saving = Saving(self.exports, self.messages, backups, clock)

    # --- what a person does -----------------------------------------------------------------

    def open(self, path: Path) -> None:
        """Open a picture and begin to stipple it; a job that runs is superseded."""
        again = self._read is not None and self._read.path == path
        adjustment = self.adjustment if again else NEUTRAL
        self._begin(Source(path, self.tone, self.width_mm, adjustment))

    def open_reference(self, path: Path) -> None:
        """Open a picture only to draw after it by hand: no dots are made."""
        self.supersede()
        source = Source(path, self.tone, self.width_mm, NEUTRAL)
        self.launch(
            lambda: reading.read_only(source, is_warm=self._is_warm),
            lambda k: Opening(k, work.READ, source, self.style, by_hand=True),
        )

    def open_drawing(self, path: Path) -> None:
        """Open a drawing that was saved."""
        self._reopen(reading.open_drawing(path, is_warm=self._is_warm), file=path)

    def open_earlier(self, path: Path) -> None:
        """Open an earlier version of the drawing in its place; its file stays as it is."""
        job = reading.open_drawing(path, is_warm=self._is_warm)
        self._reopen(job, file=self.exports.file, is_earlier=True)

    def recover(self, lost: Lost) -> None:
        """Open what a crash has left of a drawing."""
        self._reopen(reading.recover(lost, is_warm=self._is_warm), file=lost.path, lost=lost)

    def _reopen(
        self,
        job: Iterator[Work],
        *,
        file: Path | None,
        lost: Lost | None = None,
        is_earlier: bool = False,
    ) -> None:
        self.supersede()
        self.launch(
            lambda: job,
            lambda k: Reopening(k, work.READ, file=file, lost=lost, is_earlier=is_earlier),
        )

    def open_document(
        self, document: Document, file: Path | None, lost: Lost | None, *, is_earlier: bool = False
    ) -> None:
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
        if is_earlier:
            self.exports.differs = True
            self.messages.say("this is an earlier version; save it to go on with it")

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
        elif self.document is None or self.starts_afresh or self.document.drawing.is_plain:
            self._begin(self._as_wanted(source))
        else:
            processing.start_all(self)

    def new(self, page: Page) -> None:
        """Begin a drawing on an empty page."""
        self.supersede()
        style = self.style
        self.launch(self._make_ready, lambda k: Opening(k, work.PREPARE, None, style, page))

    def relax(
        self, iterations: int, *, weighted: bool, areas: Collection[int] | None = None
    ) -> None:
        """Relax the drawing's dots, or those of some areas, as one step; edits go on meanwhile."""
        document = self.document
        if document is None or not self.paintable or document.in_stroke:
            self.messages.say("there are no dots to relax yet", WARNING)
            return
        if not len(document.dots):
            self.messages.say("there are no dots to relax", WARNING)
            return
        self.supersede()
        label = "Relax all" if areas is None else "Relax areas"
        frozen = replace(document.drawing, dots=document.begin_run(label))
        style = replace(self.style, weighted=weighted)
        source = self.source
        self._warn("relax", self.n_dots)
        self.launch(
            lambda: stippling.relax_drawing(frozen, style, iterations, areas),
            lambda k: Relaxing(k, "relax", source, total=iterations),
        )

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
        standing = Standing(dots.position_mm, dots.radius_mm, dots.fixed)
        task = Task(style, reference, SETTLE, standing=standing, n_done=n_done)
        self.launch(
            lambda: stippling.go_on(task),
            lambda k: Relaxing(k, "relax", making.source, done=n_done, total=style.iterations,
                               is_held=making.is_held),
        )  # fmt: skip
        if making.is_held:
            self._worker.pause()
        return True

    def fill(self, areas: Collection[int] = (PAGE_AREA,)) -> None:
        """Fill the page, or some areas, with dots, as one step."""
        document, values = self.document, self.filling
        if document is None or not self.paintable or document.in_stroke:
            self.messages.say("there is no page to fill yet", WARNING)
            return
        from stippler.stippling.part_of_area import parts_met

        owned = {k: document.partition.part_of(k) for k in areas}
        try:
            parts, notes = parts_met(
                document.drawing, {k: part for k, part in owned.items() if not part.is_empty}
            )
        except StipplerError as error:
            self.messages.say(str(error), WARNING)
            return
        for note in notes:
            self.messages.say(note, WARNING)
        self.supersede()
        outlines, source = [part for part in parts.values() if not part.is_empty], self.source
        self._warn("fill", self.n_dots + values.n_dots * len(outlines))
        frozen = document.drawing.snapshot() if document.drawing.lines else None
        self.launch(
            lambda: stippling.fill(outlines, values, frozen),
            lambda k: Filling(k, "fill", source, values.radius_mm),
        )

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
            says_so = isinstance(self.activity, Processing)
            self._end("stopped")
            if not says_so:
                self.messages.say("stopped; the dots that are there stay")

    def edit_style(self, **changes: Any) -> bool:
        """Change fields of the style; a value outside its range is refused with a line."""
        try:
            self.style = replace(self.style, **changes)
        except ParameterError as error:
            self.messages.say(str(error), WARNING)
            return False
        return True

    @property
    def inputs(self) -> tuple[Path, ...]:
        """The files that the drawing is made from, which are never written over."""
        return tuple(source.path for source in (self.source, self._asked) if source)

    def export(
        self,
        path: Path,
        dpi: float,
        options: Mapping[str, Any] | None = None,
        *,
        expected_bytes: int = 0,
    ) -> None:
        """Write the drawing to a file, beside whatever else is going on.

        Parameters
        ----------
        dpi : float
            Where the options give none.
        options : mapping, optional
            Of the format; see `stippler.export.save`.
        expected_bytes : int
            About how large it will be, to tell how far it is.
        """
        if self.exporting:
            self.messages.say("the last export is still being written", WARNING)
            return
        if self.document is None:
            self.messages.say("there is no drawing to export yet", WARNING)
            return
        if not self.n_dots and not self.document.drawing.lines:
            self.messages.say("there are no dots to export", WARNING)
            return
        values = {"dpi": dpi} if options is None else options
        self.exports.start(self.document, path, values, self.inputs, expected_bytes=expected_bytes)
        self._warn("export", self.n_dots, self._pixels_at(path, values))

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
            self.saving.save(self.document, path, is_copy=is_copy)
            self._warn("save", self.n_dots)

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
        self.saving.poll(self.document)
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

    # --- inside -----------------------------------------------------------------------------

    def _begin(self, source: Source) -> None:
        self.supersede()
        known = self.reference if source.is_read_as(self._read) else None
        style, stipple = self.style, self._stipple
        self.launch(
            lambda: stipple(source, style, known),
            lambda k: (
                Opening(k, work.READ, source, style)
                if known is None
                else Making(k, "first dots", source, style)
            ),
        )

    def _warn(self, job: str, n_dots: int, n_pixels: int = 0) -> None:
        """Say so if a job will hardly fit into memory."""
        if text := preflight.warning(job, n_dots, n_pixels):
            self.messages.say(text, WARNING)

    def _pixels_at(self, path: Path, options: Mapping[str, Any]) -> int:
        """Return how many pixels an export has, if any."""
        page, dpi = self.drawing.page if self.drawing is not None else None, options.get("dpi")
        if page is None or not dpi or path.suffix.lower() not in (".png", ".tif", ".tiff"):
            return 0
        return int(page.width_mm * page.height_mm * (float(dpi) / 25.4) ** 2)

    def launch(self, run: Callable[[], Iterator[Work]], job: Callable[[int], Job]) -> None:
        """Let the worker run something; `job` makes the activity of the request's number."""
        self.activity = job(self._worker.start(run))  # type: ignore[assignment]
        self._steps = StepRate()

    def supersede(self) -> None:
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
        self.saving.begin_drawing(self.name)
        self.keeping.open(document, self.name, file, lost)
        self.revision += 1

    def _guarded(self, act: Callable[[], object]) -> None:
        """Do something; a person's or a file's error is said."""
        try:
            act()
        except StipplerError as error:
            self.messages.say(str(error), WARNING)
