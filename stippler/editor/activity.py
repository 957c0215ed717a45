"""What a session is doing: one of these at a time; each takes results, and ends in an edit."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from stippler.drawing.one_step import as_one_step
from stippler.editor.messages import WARNING, Messages

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Page
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import Style
    from stippler.files.native.recovery import Lost
    from stippler.jobs.work import Source, Work
    from stippler.stippling.progress import Progress


class Desk(Protocol):
    """What an activity works on."""

    messages: Messages
    notes: tuple[str, ...]

    @property
    def document(self) -> Document | None:
        """The open drawing."""
        ...

    def open_page(self, page: Page, source: Source | None, reference: Reference | None) -> None:
        """Begin another drawing."""
        ...

    def open_document(
        self, document: Document, file: Path | None, lost: Lost | None, *, is_earlier: bool = False
    ) -> None:
        """Open a drawing that was kept."""
        ...


@dataclass(slots=True)
class Idle:
    """No job runs.

    Attributes
    ----------
    outcome : {"done", "stopped", "failed"}
        How the last one ended.
    """

    outcome: str = "done"


@dataclass(slots=True)
class Job(ABC):
    """A job runs, or is held.

    Attributes
    ----------
    request : int
        By which the worker calls it.
    stage : str
        As `Work` tells.
    done, total : int
        Of this stage; a total of 0 is unknown.
    """

    request: int
    stage: str
    done: int = field(default=0, kw_only=True)
    total: int = field(default=0, kw_only=True)
    is_held: bool = field(default=False, kw_only=True)

    @abstractmethod
    def take(self, desk: Desk, work: Work) -> Activity:
        """Take a result; return what goes on from there."""

    @abstractmethod
    def end(self, desk: Desk, outcome: str) -> None:
        """Keep what there is, as a step of the history."""

    def _note(self, work: Work) -> None:
        self.stage, self.done, self.total = work.stage, work.done, work.total


@dataclass(slots=True)
class Opening(Job):
    """A picture is read, to be stippled, or everything is made ready for an empty page.

    Attributes
    ----------
    source : Source or None
        The picture; None is an empty page.
    by_hand : bool
        Whether the picture is only to be drawn after: no dots are made of it.
    """

    source: Source | None
    style: Style
    page: Page | None = None
    by_hand: bool = False

    def take(self, desk: Desk, work: Work) -> Activity:
        """Open the page as soon as the picture is read, and go on with its dots."""
        from stippler.drawing.drawing import Page

        self._note(work)
        picture = work.reference
        if picture is None or self.source is None:
            return self
        desk.open_page(Page(picture.width_mm, picture.height_mm), self.source, picture)
        _tell(desk, work.notes)
        if self.by_hand:
            return Readying(self.request, self.stage, is_held=self.is_held)
        making = Making(self.request, self.stage, self.source, self.style)
        making.is_held = self.is_held
        return making.take(desk, work)

    def end(self, desk: Desk, outcome: str) -> None:
        """Open the empty page; a picture that was not read leaves what was open."""
        if self.page is not None and outcome == "done":
            desk.open_page(self.page, None, None)


def _tell(desk: Desk, notes: tuple[str, ...]) -> None:
    """Keep what there is to know of how a picture was read; say what is out of the way."""
    desk.notes = notes
    odd = [note for note in notes if not note.startswith("read by")]
    if odd:
        desk.messages.say(f"the picture: {'; '.join(odd)}", WARNING)


@dataclass(slots=True)
class Readying(Job):
    """A picture is open to be drawn after; what painting needs is loaded."""

    def take(self, desk: Desk, work: Work) -> Activity:
        """Go on."""
        self._note(work)
        return self

    def end(self, desk: Desk, outcome: str) -> None:
        """Say what can be done now."""
        if outcome == "done":
            desk.messages.say("open as reference only: draw after it by hand, or start the dots")


@dataclass(slots=True)
class Reopening(Job):
    """A drawing is opened that was kept.

    Attributes
    ----------
    file : Path or None
        What it is saved in.
    lost : Lost or None
        What a crash has left of it.
    is_earlier : bool
        Whether it is not what the file holds now.
    """

    file: Path | None = None
    lost: Lost | None = None
    is_earlier: bool = False
    _opened: Document | None = None

    def take(self, desk: Desk, work: Work) -> Activity:
        """Hold the drawing until everything is ready for it."""
        self._note(work)
        self._opened = work.document or self._opened
        if work.note:
            desk.messages.say(work.note, WARNING)
        return self

    def end(self, desk: Desk, outcome: str) -> None:
        """Open it; one that could not be read leaves what was open."""
        if self._opened is not None and outcome == "done":
            desk.open_document(self._opened, self.file, self.lost, is_earlier=self.is_earlier)


@dataclass(slots=True)
class Making(Job):
    """An area's dots are made.

    Attributes
    ----------
    source : Source
        The picture, as it is taken.
    style : Style
        What they are asked for with.
    last : Progress or None
        What the last result told.
    """

    source: Source
    style: Style
    area: int = 0
    last: Progress | None = None

    def take(self, desk: Desk, work: Work) -> Activity:
        """Show the dots."""
        self._note(work)
        document, made = desk.document, work.progress
        if made is not None and document is not None:
            if self.last is None:
                if work.note:
                    desk.messages.say(work.note, WARNING)
                document.begin_draft("Stipple", self.area, self.style, work.reference)
            document.draft(made.position_mm, made.radius_mm, made.holding)
            self.last = made
        return self

    def end(self, desk: Desk, outcome: str) -> None:
        """Keep the dots, and say what they fall short of."""
        if desk.document is None:
            return
        desk.document.end_draft()
        if outcome == "done":
            _report(desk, len(desk.document.dots), self.last)

    @property
    def can_be_taken_over(self) -> bool:
        """Whether there are as many dots as there will be."""
        return self.last is not None and self.stage in ("relax", "tone")


@dataclass(slots=True)
class Relaxing(Job):
    """The drawing's own dots are moved, and maybe sized; it can be edited meanwhile."""

    source: Source | None

    def take(self, desk: Desk, work: Work) -> Activity:
        """Move them."""
        self._note(work)
        if work.notes:
            desk.messages.say("; ".join(work.notes), WARNING)
        if desk.document is not None:
            if work.moved_mm is not None:
                desk.document.merge(work.moved_mm, work.held)
            if work.radius_mm is not None:
                desk.document.merge_radii(work.radius_mm)
        return self

    def end(self, desk: Desk, outcome: str) -> None:
        """Make it one step."""
        if desk.document is not None:
            desk.document.end_run()


@dataclass(slots=True)
class Filling(Job):
    """An area without a picture is filled with dots."""

    source: Source | None
    radius_mm: float

    def take(self, desk: Desk, work: Work) -> Activity:
        """Add the dots."""
        self._note(work)
        document = desk.document
        if document is not None and work.points_mm is not None:
            from stippler.drawing.dots import Dots

            dots, n_before = Dots.round(work.points_mm, self.radius_mm), len(document.dots)
            if work.held is not None and document.meetings is not None:
                document.meetings.hold(dots, work.held)
            as_one_step(document, "Fill", lambda document: document.insert(dots))
            desk.messages.say(f"{len(document.dots) - n_before:,} dots added")
        return self

    def end(self, desk: Desk, outcome: str) -> None:
        """Leave it at that: dots come all at once."""


@dataclass(slots=True)
class Processing(Job):
    """Areas are stippled anew, one after the other; all others stay untouched.

    Attributes
    ----------
    areas : tuple of int
        Those to be processed, in this order.
    n_taken : int
        How many of them are done, each as a step of its own.
    drafting : int or None
        The one that is being made.
    taken : dict of (ids, Progress) by area
        The dots that those have been given.
    """

    source: Source | None
    areas: tuple[int, ...]
    n_taken: int = 0
    drafting: int | None = None
    taken: dict[int, tuple[NDArray[np.int64], Progress]] = field(default_factory=dict)

    def take(self, desk: Desk, work: Work) -> Activity:
        """Keep the areas that are done since the last result, and show the one that is made.

        Sizes that are found anew beside an area are a part of its step.
        """
        self._note(work)
        if desk.document is None:
            return self
        known, new = work.finished[: self.n_taken], work.finished[self.n_taken :]
        for area, made in new:
            self._show(desk.document, area, made)
            self._size_again(desk.document, known)
            self.taken[area] = desk.document.draft_ids, made
            desk.document.end_draft()
            self.drafting, self.n_taken = None, self.n_taken + 1
            _warn(desk, made, f"area {desk.document.drawing.areas[area].name!r}")
        is_next = self.n_taken < len(self.areas) and work.area == self.areas[self.n_taken]
        if work.progress is not None and is_next:
            self._show(desk.document, work.area, work.progress)
        return self

    def end(self, desk: Desk, outcome: str) -> None:
        """Leave the area that is not done as it was."""
        if desk.document is not None:
            desk.document.drop_draft()
        what = "area" if len(self.areas) == 1 else "areas"
        desk.messages.say(f"{self.n_taken} of {len(self.areas)} {what} drawn")

    def _show(self, document: Document, area: int, made: Progress) -> None:
        from stippler.jobs.processing import begin

        if self.drafting != area:
            begin(document, area)
            self.drafting = area
        document.draft(made.position_mm, made.radius_mm, made.holding)

    def _size_again(self, document: Document, known: Sequence[tuple[int, Progress]]) -> None:
        for area, made in known:
            ids, before = self.taken[area]
            if made is not before:
                document.draft_sizes(ids, before.radius_mm, made.radius_mm)
                self.taken[area] = ids, made


Activity = Idle | Opening | Readying | Reopening | Making | Relaxing | Filling | Processing


def _report(desk: Desk, n_dots: int, last: Progress | None) -> None:
    """Say what has been drawn, and what it falls short of."""
    desk.messages.say(f"{n_dots:,} dots drawn")
    if not (last is not None and _warn(desk, last)) and not n_dots:
        desk.messages.say("the picture is all white: a drawing without dots", WARNING)


def _warn(desk: Desk, made: Progress, what: str = "page") -> bool:
    """Say what dots fall short of; return whether they do."""
    from stippler.stippling.progress import notes_on

    notes = notes_on(made, what)
    if notes:
        lack = made.shortfall is not None and made.shortfall.share > 0.0005
        more = ("Dark parts, in the panel Areas, makes inverse areas of them",) if lack else ()
        desk.messages.say("; ".join((*notes, *more)), WARNING)
    return bool(notes)
