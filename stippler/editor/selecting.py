"""More that can be done with a selection: choosing by what is chosen, copying, nudging."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stippler.camera import Point
from stippler.editor.messages import INFO, WARNING
from stippler.editor.painting import Painting
from stippler.editor.session import Session

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.dots import Dots

_NEIGHBOURS = 1.6  # of the mean distance to the nearest dot: as far as growing looks


class Selecting:
    """Commands on the chosen dots of a session's document."""

    def __init__(self, session: Session, painting: Painting) -> None:
        self._session, self._painting = session, painting
        self._selection = painting.toolbox.selection
        self._copied: Dots | None = None
        self._n_pasted = 0

    @property
    def has_copy(self) -> bool:
        """Whether dots have been copied."""
        return self._copied is not None

    def again(self) -> None:
        """Choose what was chosen before."""
        self._selection.again()

    def invert(self) -> None:
        """Choose all other dots."""
        document = self._document
        if document is not None:
            self._selection.choose(np.setdiff1d(document.dots.id, self._selection.ids))

    def grow(self) -> None:
        """Choose the neighbours of the chosen dots, too."""
        from scipy.spatial import cKDTree

        document = self._document
        if document is None:
            return
        mask = self._selection.mask(document)
        places = document.dots.position_mm
        if not mask.any() or mask.all():
            return
        page = document.drawing.page
        rows = np.flatnonzero(mask)
        apart = float(document.nearest_distances(rows, page.width_mm).mean())
        near, _ = cKDTree(places[mask]).query(
            places, distance_upper_bound=_NEIGHBOURS * apart, workers=-1
        )
        self._selection.choose(document.dots.id[np.isfinite(near)])

    def copy(self) -> None:
        """Keep the chosen dots for `paste`."""
        document = self._document
        rows = document.rows(self._selection.ids) if document is not None else np.empty(0, np.int64)
        rows = rows[rows >= 0]
        if document is None or not len(rows):
            self._session.messages.say("no dots are selected", WARNING)
            return
        self._copied, self._n_pasted = document.dots.take(rows), 0
        self._session.messages.say(f"{len(rows):,} dots copied", INFO)

    def cut(self) -> None:
        """Keep the chosen dots for `paste`, and remove them."""
        self.copy()
        self._painting.delete()

    def paste(self, at_mm: Point | None) -> None:
        """Add the copied dots about a point, or beside where they were; they are chosen then."""
        if self._copied is None:
            self._session.messages.say("nothing has been copied", WARNING)
            return
        from stippler.brushes.selection import paste

        copied = self._copied
        self._n_pasted += 1

        def act(document: Document) -> None:
            self._selection.choose(paste(document, copied, at_mm, self._n_pasted))

        self._painting.act("Paste", act)

    def nudge(self, dx_mm: float, dy_mm: float) -> None:
        """Move the chosen dots by a step, together."""
        from stippler.brushes.motion import moved
        from stippler.brushes.selection import alive

        ids = self._selection.ids
        self._painting.act(
            "Nudge selection",
            lambda document: moved(document, alive(document, ids), (dx_mm, dy_mm)),
        )

    @property
    def _document(self) -> Document | None:
        return self._session.document if self._session.paintable else None
