"""What the editor asks its workers for: frozen inputs, and generators of results.

Each result is whole in itself, so that only the latest has to be looked at. Numba, scipy, shapely
and Pillow are imported here, in the worker, when the first frame has long been shown.
"""

from __future__ import annotations

import re
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.drawing.adjustment import NEUTRAL, Adjustment
from stippler.errors import StipplerError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from shapely.geometry import MultiPolygon, Polygon

    from stippler.drawing.document import Document
    from stippler.drawing.dots import Dots
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import Style
    from stippler.files.native.recovery import Lost
    from stippler.stippling.fill import Filling
    from stippler.stippling.stipple import Progress

PREPARE, READ = "prepare", "read"
_LOOK_S = 0.1  # between two looks at a pause or a stop


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
    points_mm : (n, 2) float64 or None
        Where an area is to have more dots.
    document : Document or None
        A drawing that was kept; nobody else holds it.
    notes : tuple of str
        What a person should know of how the picture was read.
    """

    stage: str
    done: int = 0
    total: int = 0
    reference: Reference | None = None
    progress: Progress | None = None
    moved_mm: NDArray[np.float64] | None = None
    radius_mm: NDArray[np.float32] | None = None
    points_mm: NDArray[np.float64] | None = None
    document: Document | None = None
    notes: tuple[str, ...] = ()


def stipple_picture(
    source: Source, style: Style, reference: Reference | None, *, is_warm: Callable[[], bool]
) -> Iterator[Work]:
    """Stipple a picture from the file, or from its reference where it has been read before.

    Where the kernels are not compiled yet (`is_warm`), a process of its own does that first: it
    can be ended at any time, and leaves the window's thread alone.
    """
    if reference is None:
        yield Work(READ)
        reference, notes = _read(source)
        yield Work(READ, 1, 1, reference.adjusted(source.adjustment), notes=notes)
    reference = reference.adjusted(source.adjustment)
    if not is_warm():
        for n_ready, n_kernels in _prepared_kernels():
            yield Work(PREPARE, n_ready, n_kernels, reference)
    from stippler.brushes.warm_up import warm_up_brushes
    from stippler.stippling.stipple import stages

    for progress in stages(reference, style):
        yield Work(progress.stage, progress.done, progress.total, reference, progress)
    warm_up_brushes()


def read_only(source: Source, *, is_warm: Callable[[], bool]) -> Iterator[Work]:
    """Read a picture, to be drawn after by hand, and load everything that painting needs."""
    yield Work(READ)
    reference, notes = _read(source)
    yield Work(READ, 1, 1, reference.adjusted(source.adjustment), notes=notes)
    yield from make_ready(is_warm=is_warm)


def _read(source: Source) -> tuple[Reference, tuple[str, ...]]:
    """Read a picture: from the drawing that holds it, or from its file; tell what is to be said."""
    from stippler.drawing.reference import Reference
    from stippler.files.read.picture import picture_of_bytes, read_picture

    if source.data is None:
        notes: list[str] = []
        reference = read_picture(
            source.path, tone=source.tone, width_mm=source.width_mm, notes=notes
        )
        return reference, tuple(notes)
    picture = picture_of_bytes(source.data, source.path.name, source.tone)
    return Reference.of(picture, source.width_mm), ()


def make_ready(*, is_warm: Callable[[], bool]) -> Iterator[Work]:
    """Load everything that painting needs, and compile it where it is not."""
    if not is_warm():
        for n_ready, n_kernels in _prepared_kernels():
            yield Work(PREPARE, n_ready, n_kernels)
    from stippler.brushes.warm_up import warm_up_brushes

    warm_up_brushes()
    yield Work(PREPARE, 1, 1)


def relax_drawing(
    drawing: Drawing, iterations: int, *, weighted: bool, spacing: str = "even"
) -> Iterator[Work]:
    """Relax the free dots of a drawing that nobody else changes, each within what its area owns.

    Spaced evenly by the tone they keep it: see `stippler.stippling.relax_all`. Dots that lie in
    another area's part stay where they are.
    """
    yield Work("relax", 0, iterations)
    import numpy as np

    from stippler.drawing.partition import Partition

    dots, partition = drawing.dots, Partition(drawing.outlines())
    own = np.flatnonzero(partition.area_at(dots.position_mm) == dots.area)
    mine = dots if len(own) == len(dots) else dots.take(own)
    used, shape_of_dot = np.unique(mine.area, return_inverse=True)
    parts = [partition.part_of(int(k)) for k in used]
    run = _relaxed(mine, parts, shape_of_dot, drawing.reference, iterations, weighted, spacing)
    for k, (moved, sizes) in enumerate(run):
        if mine is not dots:
            moved, sizes = _among(dots.position_mm, own, moved), _among(dots.radius_mm, own, sizes)
        yield Work("relax", min(k + 1, iterations), iterations, moved_mm=moved, radius_mm=sizes)


def _relaxed(
    dots: Dots,
    parts: list[Polygon | MultiPolygon],
    shape_of_dot: NDArray[np.intp],
    reference: Reference | None,
    iterations: int,
    weighted: bool,
    spacing: str,
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float32] | None]]:
    """Yield positions after each step, and radii where they change."""
    if spacing == "even" and (weighted or reference is None):
        from stippler.stippling.relax_all import relaxed_all

        yield from relaxed_all(
            dots.position_mm, dots.radius_mm, parts, dots.fixed, shape_of_dot, reference, iterations
        )
        return
    import numpy as np

    from stippler.stippling.picture_field import PictureField
    from stippler.stippling.relax import Relaxation

    density = None
    if weighted and reference is not None:
        # dots settle at the root of their weight
        density = PictureField.of(reference, [[np.square]])
    method = "lloyd" if spacing == "even" else spacing
    engine = Relaxation(dots.position_mm, parts, dots.fixed, shape_of_dot, density, method=method)
    for _ in range(iterations):
        engine.step()
        yield engine.points, None


def _among(all_: NDArray[Any], rows: NDArray[np.intp], new: NDArray[Any] | None) -> Any:
    """Return values with those of some rows renewed; None where there are none."""
    if new is None:
        return None
    out = all_.copy()
    out[rows] = new
    return out


def carry_on(
    reference: Reference,
    style: Style,
    position_mm: NDArray[np.float64],
    radius_mm: NDArray[np.float32],
    n_done: int,
) -> Iterator[Work]:
    """Go on with a stippling whose dots have become the drawing's after so many steps."""
    from stippler.stippling.carry_on import carry_on

    yield Work("relax", n_done, style.iterations)
    for made in carry_on(reference, style, position_mm, radius_mm, n_done):
        solved = made.radius_mm if made.stage == "done" else None
        yield Work(made.stage, made.done, made.total, None, None, made.position_mm, solved)


def open_drawing(path: Path, *, is_warm: Callable[[], bool]) -> Iterator[Work]:
    """Open a drawing that was saved."""
    yield Work(READ)
    from stippler.drawing.document import Document
    from stippler.opening import open_file

    document = Document(open_file(path))
    yield Work(READ, 1, 1)
    yield from make_ready(is_warm=is_warm)
    yield Work(PREPARE, 1, 1, document=document)


def recover(lost: Lost, *, is_warm: Callable[[], bool]) -> Iterator[Work]:
    """Make a drawing anew that a crash has left, with all its steps."""
    yield Work(READ)
    document = recovered(lost)
    yield from make_ready(is_warm=is_warm)
    yield Work(PREPARE, 1, 1, document=document)


def recovered(lost: Lost) -> Document:
    """Return the drawing that a crash has left, as its last whole step was."""
    from stippler.drawing.document import Document
    from stippler.files.native.drawing_file import drawing_of
    from stippler.files.native.edit_log import replay
    from stippler.files.read.picture import picture_of_bytes

    members, journal = lost.read()
    document = Document(drawing_of(members, picture_of_bytes, lost.name)[0])
    replay(document, journal.records, picture_of_bytes)
    return document


def fill(outline: Polygon | MultiPolygon, values: Filling) -> Iterator[Work]:
    """Find places for dots in an area that has no picture."""
    yield Work("fill")
    from stippler.stippling.initial_points import fill_area

    points = fill_area(outline, values.n_dots, values.arrangement, values.seed)
    yield Work("fill", 1, 1, points_mm=points)


def _prepared_kernels() -> Iterator[tuple[int, int]]:
    """Compile the kernels in a process of its own; tell how many of how many are done."""
    lines: list[str] = []
    process = subprocess.Popen(
        [sys.executable, "-m", "stippler.warm"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    output = process.stdout
    assert output is not None
    reader = threading.Thread(target=lambda: lines.extend(output), name="preparing", daemon=True)
    reader.start()
    try:
        while reader.is_alive():
            yield _ready(lines)
            reader.join(_LOOK_S)
        if process.wait():
            raise StipplerError(
                f"the kernels could not be compiled ({lines[-1] if lines else 'no reason given'})",
                do="run python -m stippler.warm to see why",
            )
    finally:
        process.kill()
        process.wait()
        reader.join()
        output.close()


def _ready(lines: list[str]) -> tuple[int, int]:
    """Find how many of how many kernels the last line tells of."""
    found = re.search(r"(\d+)/(\d+)", lines[-1]) if lines else None
    return (int(found[1]), int(found[2])) if found else (0, 0)


@dataclass(slots=True)
class Writing:
    """A file being written, for two threads: how far it is, and whether a person gave it up."""

    n_bytes: int = 0
    given_up: bool = False


def export_drawing(
    drawing: Drawing,
    path: Path,
    options: Mapping[str, Any],
    inputs: tuple[Path, ...] = (),
    writing: Writing | None = None,
) -> Iterator[Path]:
    """Write a drawing to a file that is none of its `inputs`; yield its path when it is there.

    A worker that closes lets it be finished; only `writing` gives it up, at its next piece.
    """
    from stippler.export import save

    state = writing or Writing()

    def show(n_bytes: int) -> None:
        state.n_bytes = n_bytes
        if state.given_up:
            raise StipplerError("was given up", path.name, "nothing was written")

    save(drawing, path, inputs=inputs, show=show, **options)
    yield path
