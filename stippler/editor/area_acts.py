"""What can be done to areas besides drawing them; each is one step of the history."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from stippler.drawing import records
from stippler.drawing.area import PAGE_AREA, Area
from stippler.drawing.one_step import as_one_step
from stippler.editor.area_choice import AreaChoice
from stippler.editor.area_jobs import AreaJobs
from stippler.editor.messages import INFO, WARNING
from stippler.editor.painting import Painting
from stippler.editor.session import Session
from stippler.editor.tools.picture_source import PictureSource
from stippler.errors import GeometryError, StipplerError
from stippler.names import shown

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.planar.edits import Outcome
    from stippler.drawing.planar.path import Path
    from stippler.drawing.planar.planar_map import PlanarMap
    from stippler.editor.tools.tool import Tool

Edit = Callable[["PlanarMap"], "Outcome"]


class AreaActs:
    """Commands on the areas of a session's document.

    Attributes
    ----------
    session : Session
    jobs : AreaJobs
        What takes longer than a frame.
    tolerance_mm : float
        What `simplify` may move a border by.
    dark_level : float
        What is darker than this is a dark part, even if dots could draw it.
    """

    def __init__(self, session: Session, painting: Painting, jobs: AreaJobs) -> None:
        self.session, self._painting, self.jobs = session, painting, jobs
        self.tolerance_mm, self.dark_level = 0.2, 0.9
        self._source = PictureSource(jobs, self.lay)
        for name in ("grow", "proposals"):
            painting.toolbox.prepare[name] = self._give_source

    def _give_source(self, tool: Tool) -> None:
        """Let a tool see the picture."""
        tool.source = self._source  # type: ignore[attr-defined]

    @property
    def choice(self) -> AreaChoice:
        """The chosen areas."""
        return self._painting.toolbox.areas

    @property
    def document(self) -> Document | None:
        """The open document, if it can be edited now."""
        session = self.session
        ready = session.document is not None and session.paintable
        free = not self._painting.is_busy
        return session.document if ready and free else None

    @property
    def any_document(self) -> Document | None:
        """The open document, if only to look at."""
        return self.session.document

    def listed(self) -> list[tuple[int, Area]]:
        """Return the areas in the order of the list, the page last."""
        if self.session.document is None:
            return []
        return in_order(self.session.document.drawing.areas)

    @property
    def n_listed(self) -> int:
        """How many areas there are."""
        return len(self.session.document.drawing.areas) if self.session.document else 0

    @property
    def n_chosen(self) -> int:
        """How many areas are chosen, the page's not counted."""
        document = self.session.document
        return len(self.choice.drawn(document)) if document is not None else 0

    # --- borders ------------------------------------------------------------------------------

    def unite(self) -> None:
        """Let the first chosen area take the places of the others."""
        chosen = self._chosen()
        if len(chosen) < 2:
            self._warn("choose two areas or more: the first takes the places of the others")
            return
        from stippler.drawing.planar.edits import unite

        if self.edit("Unite areas", lambda areas: unite(areas, chosen)):
            self.choice.choose(chosen[:1])

    def remove(self) -> None:
        """Give the places of the chosen areas to the page; their dots stay."""
        chosen = self._chosen()

        def edit(areas: PlanarMap) -> Outcome:
            from stippler.drawing.planar.edits import Outcome, remove

            gone: tuple[int, ...] = ()
            for k in chosen:
                if k in areas.areas:
                    areas, gone = remove(areas, k).map, (*gone, k)
            return Outcome(areas, (), gone)

        if chosen and self.edit("Remove areas", edit):
            self.choice.choose(())

    def smooth(self) -> None:
        """Turn the borders of the chosen areas into curves."""
        from stippler.drawing.planar.moves import smooth

        self._borders("Smooth borders", smooth)

    def simplify(self) -> None:
        """Leave out nodes of the chosen areas' borders."""
        from stippler.drawing.planar.moves import simplify

        self._borders("Simplify borders", lambda m, arcs: simplify(m, arcs, self.tolerance_mm))

    def _borders(self, label: str, act: Callable[[PlanarMap, list[int]], Outcome]) -> None:
        """Change the borders of the chosen areas that no locked one has; the page's edge stays."""
        from stippler.drawing.area_edits import held_areas
        from stippler.drawing.planar.planar_map import OUTSIDE

        document, chosen = self.document, set(self._chosen())
        if document is None or not chosen:
            return
        held = {OUTSIDE, *held_areas(document.drawing)}

        def edit(areas: PlanarMap) -> Outcome:
            sides = {k: {a.left, a.right} for k, a in areas.arcs.items()}
            arcs = [k for k, s in sides.items() if s & chosen and not s & held]
            return act(areas, arcs)

        self.edit(label, edit)

    def edit(self, label: str, edit: Edit) -> bool:
        """Edit the borders as one step; say what was repaired, or why it is refused."""
        from stippler.drawing.area_edits import edit_areas

        document = self.document
        if document is None:
            return False
        try:
            outcome = edit_areas(document, label, edit)
        except GeometryError as error:
            self._warn(str(error))
            return False
        for note in outcome.notes:
            self.session.messages.say(note, INFO)
        return True

    # --- processing ---------------------------------------------------------------------------

    def process(self) -> None:
        """Stipple the chosen areas anew, one after the other, each in its style."""
        from stippler.editor import processing

        if self._ready():
            processing.process(self.session, self._all_chosen())

    def relax(self) -> None:
        """Relax the chosen areas."""
        from stippler.editor import processing

        if self._ready():
            processing.relax(self.session, self._all_chosen())

    def fill(self) -> None:
        """Add dots to the chosen areas."""
        from stippler.editor import processing

        if self._ready():
            processing.fill(self.session, self._all_chosen())

    def resize(self, percent: float) -> None:
        """Make the dots of the chosen areas larger or smaller."""
        from stippler.editor import processing

        if self._ready():
            processing.resize(self.session, self._all_chosen(), percent)

    def clear(self) -> None:
        """Remove the dots of the chosen areas."""
        from stippler.editor import processing

        if self._ready():
            processing.clear(self.session, self._all_chosen())

    def _ready(self) -> bool:
        """Return whether areas are chosen and nothing is held; say what is missing."""
        if self._all_chosen() and not self._painting.is_busy:
            return True
        self._warn("choose an area first, in the list or on the canvas with the tool Nodes")
        return False

    # --- from the picture ---------------------------------------------------------------------

    def lay(
        self,
        label: str,
        outlines: Sequence[Sequence[Path]],
        name: str = "part",
        also: Callable[[Outcome], None] | None = None,
    ) -> None:
        """Make areas of outlines, each a list of rings, beside everything else, as one step."""
        from stippler.drawing.area_edits import current_map, held_areas
        from stippler.editor.area_files import Imported, lay_job

        document = self.document
        if document is None or not outlines:
            return
        before, held = current_map(document), held_areas(document.drawing)

        def take(found: Imported) -> None:
            self._take_map(document, label, found.before, found.map, found.names, also)

        self.jobs.start("making areas", lay_job(before, outlines, held, name), take)

    def dark_parts(self) -> None:
        """Make inverse areas of what is too dark for the dots of the page's style."""
        from stippler.editor.dark_parts import dark_outlines, inverse_style

        document = self.document
        reference = self.session.reference
        if document is None or reference is None:
            self._warn("open a picture first: dark parts are found by its tones")
            return
        outlines = dark_outlines(document.drawing, reference, self.dark_level)
        if not outlines:
            self.session.messages.say("nothing is as dark as that", INFO)
            return

        def also(outcome: Outcome) -> None:
            style = inverse_style(document)
            for k in outcome.made:
                area = document.drawing.areas[k]
                document.set(records.AREA, k, replace(area, style=style))

        self.lay("Dark parts", outlines, "dark part", also)

    # --- files --------------------------------------------------------------------------------

    def import_outlines(self, path: FilePath) -> None:
        """Make areas of the outlines in a file, beside everything else, as one step."""
        from stippler.drawing.area_edits import current_map, held_areas
        from stippler.editor.area_files import Imported, import_job

        document = self.document
        if document is None:
            self._warn("begin a page, or open a picture, before outlines are imported")
            return
        before, page = current_map(document), document.drawing.page
        size_mm, held = (page.width_mm, page.height_mm), held_areas(document.drawing)

        def take(found: Imported) -> None:
            self._take_map(document, "Import areas", found.before, found.map, found.names)
            for note in found.notes:
                self.session.messages.say(note, INFO)

        job = import_job(path, before, size_mm, held)
        self.jobs.start(f"reading {shown(path.name)}", job, take)

    def export_outlines(self, path: FilePath) -> None:
        """Write the outlines of all areas to a file."""
        from stippler.editor.area_files import write_areas

        document = self.session.document
        if document is None:
            return
        try:
            n = write_areas(document.drawing, path)
        except StipplerError as error:
            self._warn(str(error))
            return
        self.session.messages.say(f"{n} areas written to {shown(path.name)}", INFO)

    def _take_map(
        self,
        of: Document,
        label: str,
        before: PlanarMap,
        after: PlanarMap,
        names: Mapping[int, str],
        also: Callable[[Outcome], None] | None = None,
    ) -> None:
        """Use a map that was worked out meanwhile, if the areas are still those it began with."""
        from stippler.drawing.area_edits import current_map, edit_areas
        from stippler.drawing.planar.edits import Outcome

        if self.document is not of or current_map(of) is not before:
            self._warn("the areas have changed meanwhile; do it once more")
            return
        made = tuple(k for k in after.areas if k not in set(before.areas))
        gone = tuple(k for k in before.areas if k not in set(after.areas))
        outcome = Outcome(after, made, gone)
        try:
            edit_areas(of, label, lambda _: outcome, names=names, also=also)
        except GeometryError as error:
            self._warn(str(error))
            return
        self.choice.choose(made)

    # --- what an area is called, and whether it is locked, hidden ------------------------------

    def rename(self, k: int, name: str) -> None:
        """Give an area another name."""
        name = " ".join(name.split())[:80]
        if name:
            self._set("Rename area", {k: {"name": name}})

    def colour(self, k: int, colour: str) -> None:
        """Give an area another colour in the list."""
        self._set("Colour area", {k: {"colour": colour}})

    def lock(self, ids: Iterable[int], locked: bool) -> None:
        """Lock areas, or unlock them."""
        label = "Lock areas" if locked else "Unlock areas"
        self._set(label, {k: {"locked": locked} for k in ids})

    def hide(self, ids: Iterable[int], hidden: bool) -> None:
        """Hide areas, or show them."""
        label = "Hide areas" if hidden else "Show areas"
        self._set(label, {k: {"hidden": hidden} for k in ids})

    def give_style(self, ids: Iterable[int], style: int) -> None:
        """Let areas be drawn in a style."""
        self._set("Style of areas", {k: {"style": style} for k in ids})

    def set_border(self, ids: Iterable[int], border: str) -> None:
        """Say what the borders of areas are to their dots; `AS_STYLE` leaves it to their styles."""
        self._set("Border of areas", {k: {"border": border} for k in ids})

    def move_to(self, k: int, place: int) -> None:
        """Give an area another place in the list, counted from its top."""
        ids = [i for i, _ in self.listed() if i != PAGE_AREA]
        if k not in ids:
            return
        ids.remove(k)
        ids.insert(min(max(place, 0), len(ids)), k)
        self._set("Order of areas", {i: {"rank": n} for n, i in enumerate(reversed(ids), 1)})

    def move_up(self, by: int) -> None:
        """Move the first chosen area up in the list, or down."""
        ids = [i for i, _ in self.listed() if i != PAGE_AREA]
        chosen = [k for k in self._chosen() if k in ids]
        if chosen:
            self.move_to(chosen[0], ids.index(chosen[0]) - by)

    def solo(self, k: int | None) -> None:
        """Show one area alone, or all again."""
        self.choice.show_alone(None if k == self.choice.solo else k)

    def toggle(self, what: str) -> None:
        """Lock or hide the chosen areas; undo that where all of them are."""
        document, chosen = self.document, self._all_chosen()
        if document is None or not chosen:
            return
        areas = document.drawing.areas
        value = not all(getattr(areas[k], what) for k in chosen)
        (self.lock if what == "locked" else self.hide)(chosen, value)

    def _set(self, label: str, fields: dict[int, dict[str, Any]]) -> None:
        document = self.document
        if document is None:
            return

        def act(document: Document) -> None:
            areas = document.drawing.areas
            for k, values in fields.items():
                if k in areas:
                    document.set(records.AREA, k, replace(areas[k], **values))

        as_one_step(document, label, act)

    # --- inside -------------------------------------------------------------------------------

    def _chosen(self) -> list[int]:
        document = self.session.document
        return self.choice.drawn(document) if document is not None else []

    def _all_chosen(self) -> list[int]:
        document = self.session.document
        return self.choice.alive(document) if document is not None else []

    def _warn(self, text: str) -> None:
        self.session.messages.say(text, WARNING)


def in_order(areas: dict[int, Area]) -> list[tuple[int, Area]]:
    """Return areas from the top of the list to the page, which is last."""
    key: Callable[[int], tuple[bool, int, int]] = lambda k: (  # noqa: E731
        k == PAGE_AREA, -areas[k].rank, -k,
    )  # fmt: skip
    return [(k, areas[k]) for k in sorted(areas, key=key)]


def counts(document: Document) -> dict[int, int]:
    """Return how many dots each area has."""
    import numpy as np

    area = document.dots.area
    n = np.bincount(np.maximum(area, 0)) if len(area) else np.zeros(0, np.int64)
    found: Sequence[int] = n.tolist()
    return dict(enumerate(found))
