"""Patterns by panel and menu: which set lies over which area, how, and the dots in its polygons."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.drawing.one_step import as_one_step
from stippler.editor.messages import INFO, WARNING
from stippler.editor.painting import Painting
from stippler.editor.session import Session
from stippler.errors import StipplerError

if TYPE_CHECKING:
    from stippler.drawing.area import Area
    from stippler.drawing.document import Document
    from stippler.drawing.pattern import Pattern, PolygonSet

_LARGEST_CAGE = 16


class Patterns:
    """The patterns of a session's drawing.

    Attributes
    ----------
    size_mm : float
        Of one copy of a set, when it is laid.
    added : dict of name to PolygonSet
        Sets that were read from files.
    """

    def __init__(self, session: Session, painting: Painting) -> None:
        self._session, self._painting = session, painting
        self.size_mm, self.band_mm = 40.0, 2.0
        self.added: dict[str, PolygonSet] = {}

    @property
    def document(self) -> Document | None:
        """The open drawing, where it can be edited."""
        return self._session.document if self._session.paintable else None

    @property
    def area(self) -> int:
        """The first chosen area, or the page."""
        document = self._session.document
        chosen = self._painting.toolbox.areas.alive(document) if document is not None else []
        return chosen[0] if chosen else 0

    @property
    def names(self) -> list[str]:
        """All sets: those that come with the program, then those that were read."""
        from stippler.stippling.patterns import builtin_names

        return [*builtin_names(), *self.added]

    def set_named(self, name: str) -> PolygonSet:
        """Return a set."""
        from stippler.stippling.patterns import builtin

        return self.added[name] if name in self.added else builtin(name)

    @property
    def laid(self) -> tuple[int, Pattern] | None:
        """The pattern of the area, with its id."""
        if self._session.document is None:
            return None
        from stippler.stippling.part_of_area import pattern_of

        return pattern_of(self._session.document.drawing, self.area)

    # --- which --------------------------------------------------------------------------------

    def put(self, name: str) -> None:
        """Lay a set over the area, in the place of the one that is there; as that one is bent."""
        from stippler.drawing.pattern import Pattern

        polygons, laid = self.set_named(name), self.laid
        if laid is not None and laid[1].polygons.name.startswith("bands "):
            laid = None

        def made(document: Document) -> Pattern:
            if laid is not None:
                return replace(laid[1], polygons=polygons)
            box = document.partition.part_of(self.area).bounds
            return Pattern.over(self.area, polygons, box, self.size_mm)

        self._lay(made, "Lay pattern")

    def follow(self, way: str) -> None:
        """Lay bands over the area that follow the picture, along its tone or across its edges."""

        def made(document: Document) -> Pattern:
            from stippler.errors import ParameterError
            from stippler.stippling.patterns_of_picture import following

            reference = document.drawing.reference
            if reference is None:
                raise ParameterError("there is no picture to follow", "pattern", "open one")
            part = document.partition.part_of(self.area)
            return following(self.area, part, reference, self.band_mm, way)

        self._lay(made, "Lay pattern")

    def add_file(self, path: Path) -> None:
        """Read a set from a file, and offer it from then on; say what was changed."""
        from stippler.files.read.pattern_file import read_pattern

        try:
            found, notes = read_pattern(path)
        except StipplerError as error:
            self._session.messages.say(str(error), WARNING)
            return
        self.added[found.name] = found
        told = f"pattern {found.name}: {len(found):,} polygons"
        self._session.messages.say("; ".join([told, *notes]), WARNING if notes else INFO)

    def remove(self) -> None:
        """Take the area's pattern away; its dots stay."""
        laid = self.laid
        if laid is not None:
            self._painting.act("Remove pattern", lambda d: d.set("pattern", laid[0], None))

    # --- how ----------------------------------------------------------------------------------

    def change(self, **values: Any) -> None:
        """Change values of the area's pattern, as one step."""
        laid = self.laid
        if laid is not None:
            self._lay(lambda _: replace(laid[1], **values), "Change pattern")

    def refine(self, rows: int, columns: int) -> None:
        """Give the cage other numbers of points; it bends as before at them."""
        from stippler.drawing.deformation import LEAST_CAGE, Cage

        laid = self.laid
        if laid is None or self.document is None:
            return
        rows, columns = (min(max(n, LEAST_CAGE), _LARGEST_CAGE) for n in (rows, columns))
        box = self.document.partition.part_of(self.area).bounds
        cage = laid[1].deformation.cage or Cage.over(box)
        self.change(deformation=replace(laid[1].deformation, cage=cage.refined(rows, columns)))

    def straighten(self) -> None:
        """Take cage and pins away."""
        laid = self.laid
        if laid is not None:
            self.change(deformation=replace(laid[1].deformation, cage=None, pins_mm=()))

    def part_between(self) -> None:
        """Make an area of its own, with a style of its own, of what lies between the polygons."""
        from stippler.drawing.area_edits import edit_areas
        from stippler.drawing.planar.borders import paths_of
        from stippler.drawing.planar.edits import EVEN_ODD, TAKES, add
        from stippler.stippling.patterns import cells_of

        laid, document = self.laid, self.document
        if laid is None or document is None or document.in_stroke:
            return
        area = document.drawing.areas[laid[1].area]
        part = document.partition.part_of(laid[1].area)
        try:
            between = cells_of(part, replace(laid[1], between="toned")).between
            if between is None:
                self._session.messages.say("nothing lies between the polygons", WARNING)
                return
            paths = paths_of(between)
            others = [k for k in document.drawing.areas if k not in (0, laid[1].area)]
            outcome = edit_areas(
                document, "Area between",
                lambda areas: add(areas, paths, TAKES, locked=others, rule=EVEN_ODD),
            )  # fmt: skip
        except StipplerError as error:
            self._session.messages.say(str(error), WARNING)
            return
        _give_style(document, outcome.made, area)
        self._session.messages.say("an area of its own; choose it in the panel Areas", INFO)

    # --- its dots -----------------------------------------------------------------------------

    def fill(self) -> None:
        """Fill all polygons with dots and relax them at once, in the worker.

        By the picture, in the style of the area; without one, as many as the panel *Fill* says,
        which take the place of the free dots that are there.
        """
        from stippler.editor import processing

        document = self.document
        if document is None:
            return
        if document.drawing.reference is not None:
            processing.process(self._session, [self.area])
            return
        from stippler.editor.activity import Filling
        from stippler.jobs.patterns import fill_and_relax
        from stippler.stippling.part_of_area import part_for_dots

        session, values = self._session, self._session.filling
        try:
            part = part_for_dots(document.drawing, self.area, document.partition.part_of(self.area))
        except StipplerError as error:
            session.messages.say(str(error), WARNING)
            return
        processing.clear(session, [self.area])
        session.supersede()
        source, steps = session.source, session.style.iterations or 20
        session.launch(
            lambda: fill_and_relax(part, values, steps),
            lambda k: Filling(k, "fill", source, values.radius_mm),
        )

    def relax(self) -> None:
        """Relax the area's dots, each within its polygon."""
        from stippler.editor import processing

        processing.relax(self._session, [self.area])

    def _lay(self, make: Any, label: str) -> None:
        from stippler.drawing import records
        from stippler.stippling.patterns import cells_of

        laid = self.laid
        notes: list[str] = []

        def act(document: Document) -> None:
            pattern = make(document)
            if laid is None:
                document.add(records.PATTERN, pattern)
            else:
                document.set(records.PATTERN, laid[0], pattern)
            notes.extend(cells_of(document.partition.part_of(pattern.area), pattern).notes)

        self._painting.act(label, act)
        if notes:
            self._session.messages.say("; ".join(notes), WARNING)


def _give_style(document: Document, made: Iterable[int], like: Area) -> None:
    """Give new areas a style of their own, as another area's is."""
    own = document.drawing.styles[like.style]

    def act(document: Document) -> None:
        for k in made:
            area = document.drawing.areas[k]
            i = document.add("style", replace(own, name=f"{area.name} {k}"))
            document.set("area", k, replace(area, name=f"between {like.name}", style=i))

    as_one_step(document, "Style of the area between", act)
