"""Whether a job will fit into memory, estimated before it begins: by dots, pixels and format.

Estimates are of measured peaks, rounded up (`docs/reliability.md`); they warn and refuse nothing.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.drawing.style import DEFAULT_DOTS

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.style import Style

MB = 1 << 20

_PER_DOT = {"stipple": 1000, "process": 1000, "fill": 600, "relax": 600, "export": 200, "save": 200}
_PER_PIXEL = 30  # of the field that dots are made from
_PER_FILE_PIXEL = 12  # of the picture as it is decoded
_MOST_FIELD_PIXELS = 16_000_000
_ALWAYS = 100 * MB
_DO = {
    "stipple": "ask for fewer dots, or a smaller picture",
    "process": "save first, or process fewer areas at a time",
    "fill": "save first, or fill with fewer dots",
    "relax": "save first, or relax an area at a time",
    "export": "save first, and choose fewer dots per inch",
    "save": "close other programs first",
}
_RASTERS, _OWN = (".png", ".tif", ".tiff"), ".stipple"
_LEFT = 0.9  # of what is available: others need memory, too

_MEMINFO = Path("/proc/meminfo")
_GROUP = Path("/sys/fs/cgroup")


def available_bytes() -> int | None:
    """Return the memory that is free for this program; None where that cannot be told."""
    found = [value for value in (_of_machine(), _of_group()) if value is not None]
    return min(found, default=None)


def _of_machine() -> int | None:
    try:
        for line in _MEMINFO.read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) << 10
    except (OSError, ValueError, IndexError):
        pass
    return None


def _of_group() -> int | None:
    """Return what a container leaves, as systems with control groups tell."""
    try:
        most = (_GROUP / "memory.max").read_text().strip()
        used = int((_GROUP / "memory.current").read_text())
        return None if most == "max" else max(int(most) - used, 0)
    except (OSError, ValueError):
        return None


def needed_bytes(job: str, n_dots: int, n_pixels: int = 0) -> int:
    """Return about how much memory a job takes.

    Parameters
    ----------
    job : {"stipple", "process", "fill", "relax", "export", "save"}
    n_pixels : int
        Of the picture that dots are made from, or of the one that is exported.
    """
    need = _ALWAYS + _PER_DOT[job] * n_dots
    if job == "stipple":
        field = min(n_pixels, _MOST_FIELD_PIXELS)
        need += _PER_PIXEL * field + _PER_FILE_PIXEL * n_pixels
    elif job == "process":  # the picture is read already
        need += _PER_PIXEL * min(n_pixels, _MOST_FIELD_PIXELS)
    elif job == "export":
        need += n_pixels  # bands of it at a time, and what packs them
    return need


def warning(job: str, n_dots: int, n_pixels: int = 0) -> str:
    """Return what to tell a person before a job that will hardly fit; empty where it will."""
    free, need = available_bytes(), needed_bytes(job, n_dots, n_pixels)
    if free is None or need <= _LEFT * free:
        return ""
    return f"this may need {_told(need)}, and {_told(free)} are free; {_DO[job]}"


def processing_warning(drawing: Drawing, styles: Iterable[Style]) -> str:
    """Return what to tell before areas of some styles are made anew, one after the other."""
    reference = drawing.reference
    n_pixels = 0 if reference is None else reference.source.levels.size
    n_dots = max((style.n_dots or DEFAULT_DOTS for style in styles), default=0)
    return warning("process", n_dots, n_pixels)


def saving_warning(drawing: Drawing, path: Path, dpi: float | None) -> str:
    """Return what to tell before a drawing is written; `dpi` counts where the file has pixels."""
    ending = path.suffix.lower()
    page, n_pixels = drawing.page, 0
    if dpi and ending in _RASTERS:
        n_pixels = int(page.width_mm * page.height_mm * (dpi / 25.4) ** 2)
    job = "save" if ending == _OWN else "export"
    return warning(job, len(drawing.dots), n_pixels)


def _told(n_bytes: int) -> str:
    return f"{n_bytes / 1e9:.1f} GB" if n_bytes >= 1e9 else f"{n_bytes / 1e6:.0f} MB"
