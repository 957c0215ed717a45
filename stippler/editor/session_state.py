"""What is open, the values of the next drawing, and what is being done: to be looked at."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Literal, Protocol

from stippler.drawing.adjustment import NEUTRAL
from stippler.editor.activity import (
    Activity,
    Filling,
    Idle,
    Job,
    Making,
    Opening,
    Processing,
    Relaxing,
)
from stippler.editor.rates import StepRate
from stippler.jobs.work import Source, Work
from stippler.names import shown
from stippler.stippling.fill import Filling as FillValues

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import Style
    from stippler.editor.exports import Exports

_FROM_PICTURES = Opening | Making | Relaxing | Filling | Processing

Phase = Literal["empty", "running", "paused", "done", "stopped", "failed"]


class Stipple(Protocol):
    """Makes a job out of a picture, a style, and the picture's reference if it is known."""

    def __call__(self, source: Source, style: Style, reference: Reference | None) -> Iterator[Work]:
        """Return the job's results to come."""
        ...


class SessionState:
    """The state of a session; what changes it is `stippler.editor.session.Session`.

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

    def __init__(self, style: Style, tone: str, width_mm: float, exports: Exports) -> None:
        self.style = style
        self.tone, self.width_mm = tone, width_mm
        self.adjustment = NEUTRAL
        self.activity: Activity = Idle()
        self.document: Document | None = None
        self.revision = 0
        self.filling = FillValues()
        self.notes: tuple[str, ...] = ()
        self._stage: tuple[str, float] = ("", 0.0)  # and since when
        self.exports = exports
        self._read: Source | None = None  # where the drawing's picture came from
        self._steps = StepRate()

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
            self._stage = (self.stage, time.monotonic())
        return time.monotonic() - self._stage[1]

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

    @property
    def _asked(self) -> Source | None:
        """The picture of the job that runs, or else the one that is open."""
        job = self.activity
        if (
            isinstance(job, Opening | Making | Relaxing | Filling | Processing)
            and job.source is not None
        ):
            return job.source
        return None if isinstance(job, Opening) else self.source

    @property
    def _style(self) -> Style | None:
        return self.drawing.style_of(0) if self.drawing is not None else None

    def _as_wanted(self, source: Source) -> Source:
        return replace(source, tone=self.tone, width_mm=self.width_mm, adjustment=self.adjustment)
