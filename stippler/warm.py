"""Compiling all kernels once a machine, so that nothing waits for it later.

``python -m stippler.warm`` prints a line of progress and does nothing when the kernels are there;
with ``--levels`` it makes those that a wheel carries, with ``--level`` those for processors like
this one.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.errors import DisplayError
from stippler.kernels.machine import store
from stippler.kernels.machine.cache import all_digest, cache_root
from stippler.kernels.machine.numba_import import skip_blas
from stippler.kernels.machine.pool import n_threads
from stippler.kernels.machine.processor import processor_key

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.reference import Reference


def is_warm() -> bool:
    """Return whether this version's kernels lie compiled for this processor; imports no numba."""
    return store.is_complete() if store.can_load() else _mark().exists()


def warm(show: Callable[[str, int, int], None], target: Path | None = None) -> None:
    """Compile every kernel by using it on something small; tell what is done, and how much.

    A second process begins at the other end where there are cores for it. `target`: the store to
    make, instead of this machine's own.
    """
    if not store.can_load():
        _run_parts(show)
        _mark().parent.mkdir(parents=True, exist_ok=True)
        _mark().touch()
        return
    from stippler.kernels.machine import export

    objects = cache_root() / f"objects-{processor_key()}"
    objects.mkdir(parents=True, exist_ok=True)
    helper = _second_process(objects) if n_threads() > 1 else None
    try:
        with export.recording(objects) as kernels:
            _run_parts(show)
    finally:
        if helper is not None:
            helper.kill()
            helper.wait()
    export.finish(objects, kernels, target or store.local_store())


def warm_levels(show: Callable[[str, int, int], None], *, all_of_them: bool = True) -> None:
    """Make the stores that a wheel carries: for each level of processors that runs here.

    Or only for the level of this one: enough for a wheel that is tried where it was made.
    """
    from stippler.kernels.machine.processor import level, levels

    known = levels()
    if level() not in known:  # a processor that nobody has named a level for
        return
    made = known[known.index(level()) :]
    for name in made if all_of_them else made[:1]:
        subprocess.run(
            [sys.executable, "-m", "stippler.warm", "--into", str(store.packed_stores() / name)],
            env={**os.environ, "NUMBA_CPU_NAME": name, "NUMBA_CPU_FEATURES": ""},
            check=True,
        )
        show(name, known.index(name) + 1, len(known))


def _second_process(objects: Path) -> subprocess.Popen[bytes]:
    """Start a process that compiles from the other end; what it has made is found by the first."""
    return subprocess.Popen(
        [sys.executable, "-m", "stippler.warm", "--backwards", str(objects)],
        env={**os.environ, "STIPPLER_KERNELS": "new"},
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip


def _run_parts(show: Callable[[str, int, int], None]) -> None:
    each = list(parts())
    for k, (name, run) in enumerate(each):
        show(name, k, len(each))
        run()
    show("done", len(each), len(each))


def _run_backwards(objects: Path) -> None:
    """Do the parts from the last to the first."""
    from stippler.kernels.machine import export

    with export.recording(objects):
        for _, run in reversed(list(parts())):
            run()


def _mark() -> Path:
    return cache_root() / f"complete-{all_digest()}-{processor_key()}"


def parts() -> Iterator[tuple[str, Callable[[], object]]]:
    """Name what compiles, in the order a first drawing needs it, and how to make it compile."""
    import numpy as np

    from stippler import warm_areas
    from stippler.brushes.warm_up import warm_up_brushes
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import FIRST_DOTS, Style
    from stippler.stippling.page_raster import FEWEST_WITH_BLEED
    from stippler.stippling.stipple import stages

    ramp = np.linspace(0, 1, 64 * 64, dtype=np.float32).reshape(64, 64)
    reference = Reference(ramp, 20.0)

    def draw(n_dots: int = 300, **options: Any) -> Drawing:
        *_, last = stages(reference, Style(n_dots=n_dots, iterations=3, **options))
        return Drawing.from_reference(reference, last.position_mm, last.radius_mm)

    yield "relaxation and tone", draw
    yield "dots that bleed", partial(draw, 2 * FEWEST_WITH_BLEED)
    yield "long dots", partial(draw, elongation=2.0)
    yield "clusters", _relax_crowds
    for method in FIRST_DOTS:
        yield f"first dots: {method}", partial(draw, first_dots=method)
    yield "areas", partial(_stipple_an_area, reference)
    yield "lines and cages", _bend_and_adhere
    yield "brushes", warm_up_brushes
    yield "areas", warm_areas.use_areas
    yield "borders of areas", warm_areas.use_borders
    yield "deformations", warm_areas.use_warp
    yield "lines", warm_areas.use_lines
    yield "one line", _uncross_a_way
    yield "files", lambda: _write(_some_dots(reference))


def _stipple_an_area(reference: Reference) -> None:
    import numpy as np
    from shapely.geometry import Polygon, box

    from stippler.drawing.area import Area
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.style import Style
    from stippler.jobs.processing import process_now

    drawing = Drawing.from_reference(
        reference, np.empty((0, 2)), np.empty(0, np.float32), Style(n_dots=300, iterations=3)
    )
    part = Polygon([(2, 2), (18, 5), (9, 9), (12, 18)])
    for k, half in enumerate((part & box(0, 0, 10, 20), part & box(10, 0, 20, 20)), start=1):
        drawing.areas[k] = Area(f"half {k}", half, 0)
    document = Document(drawing)
    process_now(document, [0, 1, 2])
    process_now(document, [1])


def _bend_and_adhere() -> None:
    """Bend by a cage, bring dots onto a line and away from one."""
    import numpy as np

    from stippler.drawing.deformation import Cage, Deformation
    from stippler.drawing.line import Line
    from stippler.drawing.line_index import LineIndex
    from stippler.drawing.planar.path import Path as LinePath

    box = (0.0, 0.0, 9.0, 9.0)
    bent = Deformation(cage=Cage.over(box).moved({5: (3.5, 3.5)}))
    bent.folds(box)
    index = LineIndex([Line("a", LinePath.polyline([(1, 1), (8, 8)]), meeting="adhere")], 1.0)
    places = bent.apply(np.random.default_rng(0).random((50, 2)) * 9)
    index.nearest(places)
    index.keep_distance(places)


def _some_dots(reference: Reference) -> Drawing:
    import numpy as np

    from stippler.drawing.drawing import Drawing

    position = np.random.default_rng(0).random((300, 2)) * reference.width_mm
    return Drawing.from_reference(reference, position, np.full(300, 0.3, np.float32))


def _relax_crowds() -> None:
    """Crowd dots into one cell of their grid, and along a curve."""
    import numpy as np
    from shapely.geometry import box

    from stippler.stippling.relax import Relaxation

    cluster = 0.01 * np.random.default_rng(0).random((100, 2))
    turn = np.linspace(0.0, 2.0 * np.pi, 2_000, endpoint=False)
    ring = 0.5 + 0.4 * np.column_stack((np.cos(turn), np.sin(turn)))
    for dots in (cluster, ring):
        Relaxation(dots, box(0, 0, 1, 1)).step()


def _uncross_a_way() -> None:
    """Part two steps that cross; ways that are improved have none, as a rule."""
    import numpy as np

    from stippler.kernels.tour import improve

    uncross: Any = improve.uncross
    way, ends = np.array([0, 2, 1, 3], np.int32), np.array([[0, 2, 1, 3]])
    uncross(way, np.argsort(way).astype(np.int32), ends)


def _write(drawing: Drawing) -> None:
    """Write round and deformed dots in every way there is."""
    import tempfile

    from stippler.drawing.line import Line
    from stippler.drawing.planar.path import Path as LinePath
    from stippler.export import save
    from stippler.files.write.formats import CLOSED, COMPOUND, FORMATS
    from stippler.headless import render_image

    for elongation, roughness in ((1.0, 0.0), (2.0, 0.5)):
        drawing.dots.elongation[:], drawing.dots.roughness[:] = elongation, roughness
        with tempfile.TemporaryDirectory() as folder:
            for one in FORMATS:
                save(drawing, Path(folder) / f"drawing{one.endings[0]}")
            save(drawing, Path(folder) / "strokes.svg", round_dots=COMPOUND)
            save(drawing, Path(folder) / "line.svg", one_line=CLOSED, caption="A")
            save(drawing, Path(folder) / "line.png", one_line=CLOSED, dpi=30)
            drawing.lines[0] = Line("tapered", LinePath.polyline([(1, 1), (8, 8)]), (0.2, 0.5))
            save(drawing, Path(folder) / "tapered.png", dpi=30)
            drawing.lines.clear()
        with contextlib.suppress(DisplayError):  # without OpenGL nothing needs those kernels
            for px_per_mm in (2.0, 8.0):  # seen from afar; near enough to look rough
                render_image(drawing, px_per_mm=px_per_mm)


def _main() -> None:
    skip_blas()
    if sys.argv[1:2] == ["--backwards"]:
        _run_backwards(Path(sys.argv[2]))
        return
    if sys.argv[1:2] in (["--levels"], ["--level"]):
        warm_levels(
            lambda name, done, total: print(f"Kernels for {name}: {done}/{total}"),  # noqa: T201
            all_of_them=sys.argv[1] == "--levels",
        )
        return
    target = Path(sys.argv[2]) if sys.argv[1:2] == ["--into"] else None
    if target is None and is_warm():
        return
    os.environ["STIPPLER_KERNELS"] = "new"  # of a store that is not complete nothing is used
    store.stores.cache_clear()
    start = time.perf_counter()

    def show(name: str, done: int, total: int) -> None:
        line = f"Compiling the kernels (once a machine): {done}/{total} {name}"
        end = "\n" if done == total else "\r"
        sys.stderr.write(f"{line:<78}{end}" if sys.stderr.isatty() else f"{line}\n")
        sys.stderr.flush()

    try:
        warm(show, target)
    except OSError as error:
        sys.stderr.write(f"The kernels cannot be kept ({error}); each start compiles them.\n")
        return
    sys.stderr.write(f"Ready after {time.perf_counter() - start:.0f} s.\n")


if __name__ == "__main__":
    _main()
