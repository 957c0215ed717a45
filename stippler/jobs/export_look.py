"""What an export will be, found beside the window: sheet, proof, faults, size, the pens' course."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from stippler.drawing.drawing import Drawing
    from stippler.files.checks import Findings, Process
    from stippler.files.write.course import Course, Moments
    from stippler.files.write.estimate import Estimate
    from stippler.files.write.format import Format
    from stippler.files.write.proof import Window
    from stippler.files.write.sheet import Sheet

_FIT = 0.98  # of the screen's part, that a whole sheet takes


@dataclass(frozen=True, slots=True)
class Sight:
    """How a sheet is looked at.

    Attributes
    ----------
    columns, rows : int
        Pixels of the screen that there are.
    px_per_mm : float or None
        None: the whole sheet.
    middle : (x, y) or None
        In mm of the sheet.
    """

    columns: int
    rows: int
    px_per_mm: float | None = None
    middle: tuple[float, float] | None = None

    def scale(self, width_mm: float, height_mm: float) -> float:
        """Return the pixels a mm has."""
        if self.px_per_mm is not None:
            return self.px_per_mm
        return _FIT * min(self.columns / width_mm, self.rows / height_mm)

    def corner(self, width_mm: float, height_mm: float) -> tuple[float, float]:
        """Return what of the sheet lies in the screen's upper left corner, in mm."""
        scale = self.scale(width_mm, height_mm)
        x, y = self.middle or (width_mm / 2, height_mm / 2)
        return x - self.columns / scale / 2, y - self.rows / scale / 2

    def window(self, width_mm: float, height_mm: float) -> Window | None:
        """Return what of a sheet is seen; None where nothing is."""
        from stippler.files.write.proof import Window

        scale = self.scale(width_mm, height_mm)
        x, y = self.corner(width_mm, height_mm)
        left, right = max(x, 0.0), min(x + self.columns / scale, width_mm)
        top, bottom = max(y, 0.0), min(y + self.rows / scale, height_mm)
        columns, rows = round((right - left) * scale), round((bottom - top) * scale)
        if columns < 1 or rows < 1:
            return None
        return Window(left, top, columns / scale, rows / scale, columns, rows)


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """What is asked.

    Attributes
    ----------
    state : object
        Tells one state of the drawing from another.
    values : dict
        Of all options of the format.
    wants_course, wants_moments : bool
        Whether pens draw it, and whether that is to be seen.
    """

    drawing: Drawing
    state: object
    form: Format
    values: dict[str, Any]
    process: Process
    sight: Sight
    wants_course: bool = False
    wants_moments: bool = False

    @property
    def sheet_key(self) -> object:
        """What the sheet depends on."""
        from stippler.files.write.formats import PLATE

        return self.state, tuple(self.values.get(option.name) for option in PLATE)

    @property
    def file_key(self) -> object:
        """What the file depends on."""
        return self.state, self.form.name, tuple(sorted(self.values.items(), key=repr))

    @property
    def proof_key(self) -> object:
        """What its picture depends on."""
        return self.file_key, self.sight

    @property
    def faults_key(self) -> object:
        """What its faults depend on."""
        return self.state, self.process


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """What is known so far; each part with what it was found for.

    Attributes
    ----------
    window : Window or None
        The part of the sheet that `picture` and `moments` show.
    picture : (rows, columns) uint8 or None
        Greys, as the file will show it.
    """

    sheet: Sheet | None = None
    sheet_key: object = None
    window: Window | None = None
    picture: NDArray[np.uint8] | None = None
    moments: Moments | None = None
    proof_key: object = None
    estimate: Estimate | None = None
    file_key: object = None
    course: Course | None = None
    course_key: object = None
    findings: Findings | None = None
    faults_key: object = None


def look(asked: Asked, known: Look, cancelled: Callable[[], bool]) -> Iterator[Look]:
    """Find what is not known yet, what is seen first; yield after each part.

    Parameters
    ----------
    cancelled : callable
        Whether nobody waits for it any more.
    """
    from stippler.drawing.visible import shown

    asked = replace(asked, drawing=shown(asked.drawing))
    if known.sheet is None or known.sheet_key != asked.sheet_key:
        sheet = _sheet(asked, cancelled)
        if cancelled():
            return
        known = Look(sheet, asked.sheet_key, findings=known.findings, faults_key=known.faults_key)
    if known.proof_key != asked.proof_key:
        known = _with_proof(asked, known)
        yield known
    if known.faults_key != asked.faults_key:
        from stippler.files.checks import check

        found = check(asked.drawing, asked.process)
        known = replace(known, findings=found, faults_key=asked.faults_key)
        yield known
    if known.file_key != asked.file_key:
        from stippler.files.write.estimate import estimate

        what = asked.drawing if asked.form.is_data else known.sheet
        assert what is not None
        told = estimate(asked.form, what, asked.values)
        known = replace(known, estimate=told, file_key=asked.file_key)
    yield known
    if asked.wants_course or asked.wants_moments:
        yield _with_course(asked, known)


def _sheet(asked: Asked, cancelled: Callable[[], bool]) -> Sheet:
    from stippler.files.write.plate import plate_of
    from stippler.files.write.sheet import sheet_of

    if asked.form.is_data:
        return sheet_of(asked.drawing)
    return plate_of(asked.drawing, asked.values, cancelled)


def _with_proof(asked: Asked, known: Look) -> Look:
    from stippler.files.write.proof import proof

    sheet = known.sheet
    assert sheet is not None
    window = asked.sight.window(sheet.width_mm, sheet.height_mm)
    if window is None:
        return replace(known, window=None, picture=None, moments=None, proof_key=asked.proof_key)
    dpi, bits = asked.values.get("dpi"), int(asked.values.get("bits", 8))
    picture = proof(sheet, window, dpi, bits)
    return replace(
        known, window=window, picture=picture, moments=None, proof_key=asked.proof_key
    )  # fmt: skip


def _with_course(asked: Asked, known: Look) -> Look:
    from stippler.files.write.course import course_of, moments_of

    assert known.sheet is not None
    if known.course is None or known.course_key != asked.file_key:
        known = replace(
            known, course=course_of(known.sheet, asked.values), course_key=asked.file_key
        )
    if asked.wants_moments and known.moments is None and known.window is not None:
        assert known.course is not None
        known = replace(known, moments=moments_of(known.course, known.window))
    return known
