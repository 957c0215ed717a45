"""The parts of the open picture for tools that go by them; found beside everything else."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from stippler.editor.area_jobs import AreaJobs, Step
from stippler.editor.tools.tool import Path, Point
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.analysis.picture_parts import PictureParts
    from stippler.analysis.region_outlines import RegionOutlines
    from stippler.drawing.planar.path import Path as Curves
    from stippler.drawing.reference import Reference

Accept = Callable[[str, Sequence[Sequence["Curves"]]], None]


class PictureSource:
    """Keeps the parts of one picture.

    Parameters
    ----------
    jobs : AreaJobs or None
        Where they are looked for; without it at once.
    accept : callable or None
        Makes areas of outlines, each a list of rings, beside everything else.
    """

    def __init__(self, jobs: AreaJobs | None = None, accept: Accept | None = None) -> None:
        self.jobs, self.accept = jobs, accept
        self._of: Reference | None = None
        self._asked: Reference | None = None
        self._parts: PictureParts | None = None

    def parts(self, reference: Reference | None) -> PictureParts | None:
        """Return the picture's parts; None while they are looked for.

        Raises
        ------
        GeometryError
            If there is no picture.
        """
        if reference is None:
            raise GeometryError("there is none", "picture", "open one; this tool goes by its tones")
        if self._of is not reference:
            self._find(reference)
        return self._parts if self._of is reference else None

    def _find(self, reference: Reference) -> None:
        from stippler.analysis.picture_parts import parts_of

        if self.jobs is None:
            self._take(reference, parts_of(reference.darkness))
        elif self._asked is not reference or not self.jobs.busy:
            self._asked = reference

            def job() -> Iterator[Step]:
                yield Step(-1.0)
                yield Step(1.0, parts_of(reference.darkness))

            self.jobs.start("reading the picture's parts", job, lambda p: self._take(reference, p))

    def _take(self, reference: Reference, parts: PictureParts) -> None:
        self._of, self._parts = reference, parts

    def pixel_mm(self, reference: Reference) -> float:
        """Return the side of a pixel of the parts on the page."""
        assert self._parts is not None
        columns: int = self._parts.labels.shape[1]
        return reference.width_mm / columns

    def under(self, reference: Reference, line: Sequence[Point]) -> set[int]:
        """Return the parts under a line on the page."""
        import numpy as np

        assert self._parts is not None
        at = np.array(line) / self.pixel_mm(reference)
        found: set[int] = set()
        for k in range(len(at)):
            a, b = at[max(k - 1, 0)], at[k]
            n = max(int(np.abs(b - a).max()), 1)
            for x, y in (a + (b - a) * np.linspace(0.0, 1.0, n + 1)[:, None]).tolist():
                if (part := self._parts.at(x, y)) is not None:
                    found.add(part)
        return found


def lines_of(outlines: RegionOutlines) -> tuple[Path, ...]:
    """Return the borders between regions as an overlay draws them."""
    from stippler.drawing.planar.planar_map import OUTSIDE

    inner = [k for k, arc in outlines.arcs.items() if OUTSIDE not in (arc.left, arc.right)]
    lines = (outlines.smooth[k].points_mm.tolist() for k in inner)
    return tuple(Path(tuple((x, y) for x, y in line)) for line in lines)
