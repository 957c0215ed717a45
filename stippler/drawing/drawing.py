"""The whole drawing, as plain data."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon, box

from stippler.drawing import records
from stippler.drawing.area import PAGE_AREA, Area
from stippler.drawing.dots import Dots
from stippler.drawing.foreign import Foreign
from stippler.drawing.page import MAX_PAGE_MM, Page
from stippler.drawing.records import Record
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.drawing.style_shape import shaped

__all__ = ["MAX_PAGE_MM", "Drawing", "Page"]


def _one_style() -> dict[int, Style]:
    return {0: Style()}


@dataclass(slots=True, eq=False)
class Drawing:
    """Page, dots, reference, and records of other kinds by their ids.

    While it is edited only a `Document` changes it.

    Attributes
    ----------
    areas, styles, lines, patterns, borders : dict of id to value
        The area of id 0 is the page itself. Borders are what areas share, once areas were drawn.
    reference : Reference or None
        What tone is taken from.
    next_id : dict of kind to int
        The first id of each kind that was never given; see `first_free`.
    foreign : Foreign
        What a later program has put into its file.
    """

    page: Page
    areas: dict[int, Area]
    dots: Dots = field(default_factory=Dots.none)
    reference: Reference | None = None
    styles: dict[int, Style] = field(default_factory=_one_style)
    lines: dict[int, Record] = field(default_factory=dict)
    patterns: dict[int, Record] = field(default_factory=dict)
    borders: dict[int, Record] = field(default_factory=dict)
    next_id: dict[str, int] = field(default_factory=dict)
    foreign: Foreign = field(default_factory=Foreign)

    @classmethod
    def blank(cls, page: Page, style: Style | None = None) -> Self:
        """Make an empty drawing whose one area is the page."""
        outline = box(0.0, 0.0, page.width_mm, page.height_mm)
        return cls(page, {PAGE_AREA: Area("page", outline)}, styles={0: style or Style()})

    @classmethod
    def from_reference(
        cls,
        reference: Reference,
        position_mm: NDArray[np.float64],
        radius_mm: NDArray[np.float32],
        style: Style | None = None,
    ) -> Self:
        """Make a drawing on a page of the reference's size; the style's pen gives dots shapes."""
        drawing = cls.blank(Page(reference.width_mm, reference.height_mm), style)
        made = Dots.round(position_mm, radius_mm)
        drawing.dots = shaped(made, drawing.style_of(PAGE_AREA), reference)
        drawing.reference = reference
        return drawing

    def style_of(self, area: int) -> Style:
        """Return the style of an area."""
        return self.styles[self.areas[area].style]

    def border_of(self, area: int) -> str:
        """Return what an area's border is to its dots: as it says itself, or else its style."""
        return self.areas[area].border or self.style_of(area).border

    @property
    def is_plain(self) -> bool:
        """Whether it is the page alone, without further areas, patterns or lines."""
        return len(self.areas) == 1 and not (self.patterns or self.lines)

    def outlines(self) -> dict[int, Polygon | MultiPolygon]:
        """Return the outlines of all areas in mm, from the lowest to the uppermost."""
        return {i: self.areas[i].outline_mm for i in sorted(self.areas)}

    def table(self, kind: str) -> dict[int, Any]:
        """Return the values of a kind by their ids; not for `SINGLE` kinds."""
        tables: dict[str, dict[int, Any]] = {
            records.AREA: self.areas,
            records.STYLE: self.styles,
            records.LINE: self.lines,
            records.PATTERN: self.patterns,
            records.BORDER: self.borders,
        }
        return tables[kind]

    def get(self, kind: str, i: int = 0) -> Any:
        """Return a value; None where there is none."""
        if kind in records.SINGLE:
            return getattr(self, kind)
        return self.table(kind).get(i)

    def put(self, kind: str, i: int, value: Any) -> None:
        """Set a value; None takes it out."""
        if kind in records.SINGLE:
            setattr(self, kind, value)
        elif value is None:
            self.table(kind).pop(i, None)
        else:
            self.table(kind)[i] = value

    def first_free(self, kind: str) -> int:
        """Return the first id of a kind that was never given."""
        used = self.dots.id if kind == records.DOT else np.fromiter(self.table(kind), np.int64)
        return max(self.next_id.get(kind, 0), int(used.max()) + 1 if len(used) else 0)

    def snapshot(self) -> Self:
        """Return a copy that stays as it is, whatever becomes of this drawing."""
        return replace(
            self,
            dots=self.dots.copy(),
            areas=dict(self.areas),
            styles=dict(self.styles),
            lines=dict(self.lines),
            patterns=dict(self.patterns),
            borders=dict(self.borders),
            next_id=dict(self.next_id),
        )
