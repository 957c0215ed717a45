"""Where the machine code of this version's kernels is kept."""

from __future__ import annotations

import hashlib
import json
import os
import re
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

from platformdirs import user_cache_path

_KERNELS = Path(__file__).parent.parent
_PLUMBING = {
    "cache", "export", "numba_cache", "numba_import", "pool", "processor", "quick_numba", "store",
}  # fmt: skip
"""Rooms beside this one that no machine code depends on."""

_IMPORT = re.compile(r"^ *from stippler\.kernels\.([\w.]+) import", re.MULTILINE)


def cache_root() -> Path:
    """Return the folder above all compiled kernels; ``STIPPLER_CACHE_DIR`` moves it."""
    base = os.environ.get("STIPPLER_CACHE_DIR")
    return Path(base) if base else _usual_root()


@cache
def _usual_root() -> Path:
    """Return the user's folder for caches, or one beside temporary files for a user without."""
    usual = user_cache_path("stippler")
    there = next(folder for folder in (usual, *usual.parents) if folder.exists())
    if os.access(there, os.W_OK) or not hasattr(os, "getuid"):
        return usual
    shared = Path(tempfile.gettempdir()) / f"stippler-{os.getuid()}"
    if shared.exists() and shared.stat().st_uid != os.getuid():  # another user's trap
        return shared.with_name(f"{shared.name}-{os.getpid()}")
    return shared


def module_folder(source: str) -> Path:
    """Return the folder for the kernels of one source file; it may not exist yet.

    Numba keys its cache by the file a kernel stands in and does not see changes in functions
    imported from other files, so the folder's name carries a digest of them all.
    """
    path = Path(source)
    return cache_root() / f"{path.stem}-{_digest(_with_imports(path))}"


@cache
def source_digest(source: str) -> str:
    """Return a digest of what the kernels of one source file are made of, wherever it lies."""
    return _kept_digests().get(source) or _own_digest(Path(source))


def _own_digest(source: Path) -> str:
    return _content_digest(tuple(sorted(_with_imports(source))))


@cache
def _kept_digests() -> dict[str, str]:
    """Return the digests of all kernel files, found once for as long as none of these changes.

    Reading them all takes 10 ms of each process; a changed file has another time or size, and one
    that came or went shows, too.
    """
    stamps = dict(_stamps(_KERNELS))
    name = hashlib.sha256(str(_KERNELS).encode()).hexdigest()[:12]
    place = cache_root() / f"digests-{name}.json"
    try:
        kept = json.loads(place.read_text(encoding="utf-8"))
        if kept["stamps"] == stamps:
            return dict(kept["digests"])
    except (OSError, ValueError, KeyError, TypeError):
        pass  # none yet, or one that was cut
    digests = {path: _own_digest(Path(path)) for path in stamps}
    part = place.with_suffix(f".{os.getpid()}")
    with suppress(OSError):
        place.parent.mkdir(parents=True, exist_ok=True)
        part.write_text(json.dumps({"stamps": stamps, "digests": digests}), encoding="utf-8")
        part.replace(place)
    return digests


def _stamps(folder: Path) -> Iterator[tuple[str, list[int]]]:
    """Yield each source below a folder, with its time and size."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.is_dir():
                yield from _stamps(Path(entry.path))
            elif entry.name.endswith(".py"):
                found = entry.stat()
                yield entry.path, [found.st_mtime_ns, found.st_size]


def all_sources_digest() -> str:
    """Return a digest of what all kernels are made of."""
    return _content_digest(tuple(sorted(_KERNELS.rglob("*.py"))))


def all_digest() -> str:
    """Return a digest of all kernel sources, as numba looks at them: with where and when."""
    return _digest(_KERNELS.rglob("*.py"))


@cache
def _content_digest(sources: tuple[Path, ...]) -> str:
    digest = hashlib.sha256()
    for source in sources:
        digest.update(f"{source.name} {_text(source)}".encode())
    return digest.hexdigest()[:16]


def _with_imports(path: Path) -> set[Path]:
    """Return a file and all kernel files it imports, directly or not."""
    found, todo = set(), [path]
    while todo:
        source = todo.pop()
        if source.parent == _KERNELS / "machine" and source.stem in _PLUMBING:
            continue
        if source not in found:
            found.add(source)
            todo += _imported(source)
    return found


@cache
def _imported(source: Path) -> tuple[Path, ...]:
    """Return the kernel files that one file imports."""
    found: list[Path] = []
    for name in _IMPORT.findall(_text(source)):
        module = _KERNELS / name.replace(".", "/")
        found += module.glob("*.py") if module.is_dir() else [module.with_suffix(".py")]
    return tuple(found)


def _digest(sources: Iterable[Path]) -> str:
    from importlib import metadata  # late, for the sake of the first frame

    digest = hashlib.sha256(f"numba {metadata.version('numba')}".encode())
    for source in sorted(sources):
        # numba itself compares a source's time, so what differs in time alone is another too
        digest.update(f"{source} {source.stat().st_mtime_ns} {_text(source)}".encode())
    return digest.hexdigest()[:16]


@cache
def _text(source: Path) -> str:
    return source.read_text(encoding="utf-8")
