"""Shaping all dots or the chosen ones: shown while a control is held, made when it is let go."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from stippler.drawing.preview import Preview
from stippler.editor.painting import Painting
from stippler.editor.session import Session

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.shape_change import ShapeChange

DIRECTIONS = ("own", "angle", "random", "edges")


@dataclass(frozen=True, slots=True)
class Averages:
    """What the dots to be shaped have now."""

    n: int = 0
    elongation: float = 1.0
    roughness: float = 0.0


class Shaping:
    """The change of shape that a person holds in a panel, over the drawing of a session.

    Attributes
    ----------
    selected : bool
        Whether changes are for the chosen dots only.
    direction : str
        One of `DIRECTIONS`: where elongated dots point.
    angle_rad, scatter_rad : float
    holder : str
        The control that a person has hold of; empty if none.
    value : float
        Of that control.
    """

    def __init__(self, session: Session, painting: Painting) -> None:
        self._session, self._painting = session, painting
        self.selected = False
        self.direction = "own"
        self.angle_rad = self.scatter_rad = 0.0
        self.holder, self.value = "", 0.0
        self._held: ShapeChange | None = None  # what is shown and not made yet
        self._of: Document | None = None  # whose dots `held` is for
        self._averages: tuple[object, Averages] = (None, Averages())

    @property
    def can(self) -> bool:
        """Whether there are dots to be shaped, and nothing else has hold of them."""
        return self._session.paintable and not self._painting.is_busy and self.averages.n > 0

    @property
    def averages(self) -> Averages:
        """What the dots to be shaped have now."""
        document, chosen = self._session.document, self._painting.toolbox.selection
        revision = document.revision if document is not None else -1
        key = (id(document), revision, chosen.revision, self.selected)
        if key != self._averages[0]:
            self._averages = (key, self._measured(document))
        return self._averages[1]

    def _measured(self, document: Document | None) -> Averages:
        if document is None:
            return Averages()
        elongation, roughness = document.dots.elongation, document.dots.roughness
        if self.selected:
            rows = document.rows(self._painting.toolbox.selection.ids)
            rows = rows[rows >= 0]
            elongation, roughness = elongation[rows], roughness[rows]
        n = len(elongation)
        return Averages(n, float(elongation.mean()), float(roughness.mean())) if n else Averages()

    @property
    def preview(self) -> Preview | None:
        """What is to be shown; nothing once another drawing is open or dots are being made."""
        if self._held is None or self._of is not self._session.document or not self.can:
            self.let_go()
            return None
        return Preview(self._held, "selected" if self.selected else "all")

    def facing(self) -> dict[str, Any]:
        """Return the direction that dots are to take, as values of a `ShapeChange`."""
        reference, document = self._session.reference, self._session.document
        if self.direction == "angle":
            return {"angle_rad": self.angle_rad, "scatter_rad": self.scatter_rad}
        if self.direction == "random":
            return {"angle_rad": 0.0, "scatter_rad": math.pi / 2}
        if self.direction == "edges" and reference is not None and document is not None:
            from stippler.drawing.shape_change import Edges

            page = document.drawing.page
            apart_mm = math.sqrt(page.width_mm * page.height_mm / max(len(document.dots), 1))
            edges = Edges(reference, max(apart_mm, reference.pixel_mm))
            return {"edges": edges, "scatter_rad": self.scatter_rad}
        return {}

    @property
    def has_edges(self) -> bool:
        """Whether there is a picture to go by."""
        return self._session.reference is not None

    def hold(self, holder: str, value: float, change: ShapeChange) -> None:
        """Show a change; the drawing stays as it is."""
        self.holder, self.value = holder, value
        self._held, self._of = change, self._session.document

    def let_go(self) -> bool:
        """Show the drawing as it is again; return whether anything was held."""
        was, self._held = self._held is not None, None
        self.holder = ""
        return was

    def make(self, what: str, change: ShapeChange) -> None:
        """Change the drawing; one step of its history."""
        self.let_go()
        if self.can:
            dots = "selected dots" if self.selected else "all dots"
            self._painting.reshape(f"{what} {dots}", change, selected=self.selected)
