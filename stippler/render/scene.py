"""What is to be drawn, as the GPU holds it: one owner of all buffers, kept up with a document."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.drawing import records
from stippler.drawing.dots import Dots
from stippler.drawing.polarity import Polarity, grounds_of, polarity_of
from stippler.drawing.reference import Reference
from stippler.drawing.visible import NONE, sized_zero
from stippler.render.dot_buffer import DotBuffer
from stippler.render.ground import GroundBuffer
from stippler.render.lines import LineBuffer
from stippler.render.reference import ReferenceTexture

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.partition import Partition

_NO_IDS: NDArray[np.int64] = np.empty(0, np.int64)


class Scene:
    """Page, lines, dots and reference on the GPU.

    Parameters
    ----------
    live : bool
        For a window, whose frames do not wait for the shares of many dots.

    Attributes
    ----------
    page_mm : (width, height)
    dots : DotBuffer
    lines : LineBuffer
    grounds : GroundBuffer
        Areas of white dots on black.
    reference : ReferenceTexture
    """

    def __init__(self, ctx: moderngl.Context, *, live: bool = False) -> None:
        self.page_mm = (1.0, 1.0)
        self.dots = DotBuffer(ctx, live=live)
        self.lines = LineBuffer(ctx)
        self.grounds = GroundBuffer(ctx)
        self.reference = ReferenceTexture(ctx)
        self._selected = np.zeros(0, np.bool_)
        self._selected_ids = _NO_IDS
        self._document: Document | None = None  # whose dots are there
        self._cursor = 0  # how far its changes are
        self._hidden = NONE

    @property
    def n_dots(self) -> int:
        """How many dots there are."""
        return self.dots.n

    @property
    def origin_mm(self) -> tuple[float, float]:
        """The middle of the page, from which the GPU measures places."""
        return self.page_mm[0] / 2, self.page_mm[1] / 2

    # --- a document ---------------------------------------------------------------------------

    def sync(
        self,
        document: Document,
        selected: NDArray[np.int64] = _NO_IDS,
        hidden: frozenset[int] = NONE,
    ) -> None:
        """Bring what has changed in a document to the GPU.

        Parameters
        ----------
        selected : ids of dots
            An array that is not changed afterwards.
        hidden : ids of areas
            Neither their dots are seen nor the grounds of those that are inverse.

        Notes
        -----
        What fails leaves nothing half done for good: the next call uploads all.
        """
        is_other = document is not self._document
        cursor, self._document = 0 if is_other else self._cursor, None
        page = document.drawing.page
        is_other = is_other or self.page_mm != (page.width_mm, page.height_mm)
        self.page_mm = (page.width_mm, page.height_mm)
        is_other = is_other or hidden != self._hidden
        self._hidden = hidden
        changed, rows = document.changes.since(cursor), None
        dots = sized_zero(document.dots, hidden)
        chosen = np.zeros(len(dots), np.bool_)
        there = document.rows(selected)
        chosen[there[there >= 0]] = True
        is_painted_anew = False
        if is_other or any(changed.has(kind) for kind in (records.AREA, records.STYLE)):
            is_painted_anew = self.set_polarity(document.drawing, lambda: document.partition)
        if not is_other and not is_painted_anew:
            rows = changed.rows
        if rows is None or self.n_dots == 0:
            self.set_dots(dots, chosen)
        else:
            if selected is not self._selected_ids:
                for ids in (self._selected_ids, selected):
                    there = document.rows(ids)
                    rows = np.union1d(rows, there[there >= 0])
            if len(rows) or len(dots) != self.n_dots:
                self.update_dots(dots, rows, chosen)
            if changed.places:
                self.set_positions(dots.position_mm, dots.radius_mm)
        if is_other or changed.has(records.LINE):
            self.set_lines(document.drawing.lines)
        if is_other or changed.has(records.PATTERN):
            self.lines.set_patterns(document.drawing.patterns.values(), self.origin_mm)  # type: ignore[arg-type]
        self._selected_ids = selected
        self._document, self._cursor = document, changed.cursor

    def clear(self, width_mm: float, height_mm: float) -> None:
        """Show an empty page."""
        self._document = None
        self.set_page(width_mm, height_mm)
        self.dots.polarity = Polarity()
        self.grounds.set((), self.origin_mm)
        self.set_dots(Dots.none(), np.zeros(0, np.bool_))
        self.set_lines({})
        self.lines.set_patterns((), self.origin_mm)

    # --- its parts --------------------------------------------------------------------------

    def set_page(self, width_mm: float, height_mm: float) -> None:
        """Set the size of the paper; call it before `set_dots`."""
        self.page_mm = (float(width_mm), float(height_mm))

    def set_polarity(
        self, drawing: Drawing, partition: Callable[[], Partition] | None = None
    ) -> bool:
        """Hold which areas are white on black, and which are hidden, from the next `set_dots` on.

        Return whether dots are painted otherwise than before.
        """
        polarity, before = polarity_of(drawing), self.dots.polarity
        self.dots.polarity = polarity
        grounds = grounds_of(drawing, polarity, partition)
        shown = [part for area, part in grounds.items() if area not in self._hidden]
        self.grounds.set(shown, self.origin_mm)
        return polarity != before

    def set_drawing(self, drawing: Drawing) -> None:
        """Hold all of a drawing but its reference, as it is now."""
        self._document, self._hidden = None, NONE
        self.set_page(drawing.page.width_mm, drawing.page.height_mm)
        self.set_polarity(drawing)
        self.set_dots(drawing.dots)
        self.set_lines(drawing.lines)

    def set_lines(self, lines: Mapping[int, Any]) -> None:
        """Hold lines by their ids; cheap for those that are there already."""
        self.lines.set(lines, self.origin_mm)

    def set_reference(self, reference: Reference | None) -> None:
        """Hold another picture; cheap if it is the one already there."""
        self.reference.set(reference)

    def set_dots(self, dots: Dots, selected: NDArray[np.bool_] | None = None) -> None:
        """Upload all dots, and which of them are selected."""
        self.dots.set(dots, self._chosen(dots, selected), self.origin_mm)

    def set_positions(
        self, position_mm: ArrayLike, radius_mm: ArrayLike, *, settled: bool = False
    ) -> None:
        """Upload positions and radii, as a worker hands them back while it is at work.

        Dots keep their shapes if there are as many as before; else all are round.

        Parameters
        ----------
        settled : bool
            The worker is done: overlapping dots may take their time (10 to 20 ms for 100,000) to
            be weighed, so that the tone is right where pixels are larger than dots.
        """
        position = np.ascontiguousarray(position_mm, np.float64).reshape(-1, 2)
        radius = np.ascontiguousarray(
            np.broadcast_to(np.asarray(radius_mm, np.float32), (len(position),))
        )
        self.dots.set_positions(position, radius, self.origin_mm, settled=settled)

    def update_dots(
        self, dots: Dots, rows: NDArray[np.intp], selected: NDArray[np.bool_] | None = None
    ) -> None:
        """Upload only the given rows; rows past the end of what is uploaded are new dots.

        Where there are fewer dots than before the rows are those of the ones that stay. If much has
        changed, all are uploaded.
        """
        self.dots.update(dots, rows, self._chosen(dots, selected), self.origin_mm)

    def _chosen(self, dots: Dots, selected: NDArray[np.bool_] | None) -> NDArray[np.bool_]:
        if selected is not None:
            self._selected = selected
        elif len(self._selected) != len(dots):
            self._selected = np.zeros(len(dots), np.bool_)
        return self._selected

    def release(self) -> None:
        """Free every GL object."""
        self.dots.release()
        self.lines.release()
        self.grounds.release()
        self.reference.release()
