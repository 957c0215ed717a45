"""What the jobs give back; each result is whole in itself: only the latest has to be looked at."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.drawing.adjustment import NEUTRAL, Adjustment

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from stippler.drawing.document import Document
    from stippler.drawing.reference import Reference
    from stippler.drawing.run import Holding
    from stippler.stippling.progress import Progress

PREPARE, READ = "prepare", "read"


@dataclass(frozen=True, slots=True)
class Source:
    """A picture and how tone is taken from it.

    Attributes
    ----------
    data : bytes or None
        The picture's file, where a drawing holds it; it is not looked for on disk then.
    """

    path: Path
    tone: str
    width_mm: float
    adjustment: Adjustment = NEUTRAL
    data: bytes | None = field(default=None, compare=False, repr=False)

    def is_read_as(self, other: Source | None) -> bool:
        """Whether both come from the file alike, however they are adjusted then."""
        return other is not None and replace(self, adjustment=other.adjustment) == other


@dataclass(frozen=True, slots=True, eq=False)
class Work:
    """How far a job has come.

    Attributes
    ----------
    stage : str
        `PREPARE`, `READ`, or a stage of `Progress`.
    done, total : int
        Of this stage; a total of 0 is unknown.
    reference : Reference or None
        The picture, once it is read.
    progress : Progress or None
        The dots, once there are some.
    moved_mm : (n, 2) float64 or None
        Where a relaxation of the drawing's own dots has brought them.
    radius_mm : (n,) float32 or None
        What their radii are to be.
    held : Holding or None
        Which lines hold them then.
    points_mm : (n, 2) float64 or None
        Where an area is to have more dots.
    document : Document or None
        A drawing that was kept; nobody else holds it.
    notes : tuple of str
        What a person should know of how the picture was read.
    note : str
        What a person should know of it.
    area : int
        Whose dots `progress` tells of.
    finished : tuple of (area, Progress)
        Areas whose dots are done, in their order.
    """

    stage: str
    done: int = 0
    total: int = 0
    reference: Reference | None = None
    progress: Progress | None = None
    moved_mm: NDArray[np.float64] | None = None
    radius_mm: NDArray[np.float32] | None = None
    held: Holding | None = None
    points_mm: NDArray[np.float64] | None = None
    document: Document | None = None
    notes: tuple[str, ...] = ()
    note: str = ""
    area: int = 0
    finished: tuple[tuple[int, Progress], ...] = ()
