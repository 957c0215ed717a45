"""Compiling all kernels once a machine, so that nothing waits for it later.

``python -m stippler.warm`` prints a line of progress and does nothing when the kernels are there.
"""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.errors import DisplayError
from stippler.kernels.machine.cache import all_digest, cache_root
from stippler.kernels.machine.numba_import import skip_blas

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing


def is_warm() -> bool:
    """Return whether this version's kernels lie compiled on disk; cheap, imports no numba."""
    return _mark().exists()


def warm(show: Callable[[str, int, int], None]) -> None:
    """Compile every kernel by using it on something small; tell what is done, and how much."""
    parts = list(_parts())
    for k, (name, run) in enumerate(parts):
        show(name, k, len(parts))
        run()
    show("done", len(parts), len(parts))
    mark = _mark()
    mark.parent.mkdir(parents=True, exist_ok=True)
    mark.touch()


def _mark() -> Path:
    return cache_root() / f"complete-{all_digest()}"


def _parts() -> Iterator[tuple[str, Callable[[], object]]]:
    """Name what compiles, in the order a first drawing needs it, and how to make it compile."""
    import numpy as np

    from stippler.brushes.warm_up import warm_up_brushes
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.reference import Reference
    from stippler.stippling.plan import FIRST_DOTS, Plan
    from stippler.stippling.stipple import stages

    ramp = np.linspace(0, 1, 64 * 64, dtype=np.float32).reshape(64, 64)
    reference = Reference(ramp, 20.0)

    def draw(**options: Any) -> Drawing:
        *_, last = stages(reference, Plan(n_dots=300, iterations=3, **options))
        return Drawing.from_reference(reference, last.position_mm, last.radius_mm)

    yield "relaxation and tone", draw
    yield "clusters", _relax_a_cluster
    for method in FIRST_DOTS:
        yield f"first dots: {method}", partial(draw, first_dots=method)
    yield "brushes", warm_up_brushes
    yield "files", lambda: _write(draw())


def _relax_a_cluster() -> None:
    """Crowd dots into one cell of their grid."""
    import numpy as np
    from shapely.geometry import box

    from stippler.stippling.relax import Relaxation

    dots = np.random.default_rng(0).random((100, 2))
    Relaxation(0.01 * dots, box(0, 0, 1, 1)).step()


def _write(drawing: Drawing) -> None:
    """Write round and deformed dots in every way there is."""
    import tempfile

    from stippler.export import save
    from stippler.files.write.formats import CLOSED, COMPOUND, FORMATS
    from stippler.headless import render_image

    for elongation, roughness in ((1.0, 0.0), (2.0, 0.5)):
        drawing.dots.elongation[:], drawing.dots.roughness[:] = elongation, roughness
        with tempfile.TemporaryDirectory() as folder:
            for one in FORMATS:
                save(drawing, Path(folder) / f"drawing{one.endings[0]}")
            line: dict[str, Any] = {"one_line": CLOSED, "caption": "A", "round_dots": COMPOUND}
            save(drawing, Path(folder) / "line.svg", **line)
            save(drawing, Path(folder) / "line.png", one_line=CLOSED, dpi=30)
        with contextlib.suppress(DisplayError):  # without OpenGL nothing needs those kernels
            for px_per_mm in (2.0, 8.0):  # seen from afar; near enough to look rough
                render_image(drawing, px_per_mm=px_per_mm)


def _main() -> None:
    skip_blas()
    if is_warm():
        return
    start = time.perf_counter()

    def show(name: str, done: int, total: int) -> None:
        line = f"Compiling the kernels (once a machine): {done}/{total} {name}"
        end = "\n" if done == total else "\r"
        sys.stderr.write(f"{line:<78}{end}" if sys.stderr.isatty() else f"{line}\n")
        sys.stderr.flush()

    warm(show)
    sys.stderr.write(f"Ready after {time.perf_counter() - start:.0f} s.\n")


if __name__ == "__main__":
    _main()
