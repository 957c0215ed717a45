"""Earlier versions of drawings, numbered, in the program's own folder.

A person's folders are left alone. Each drawing has a folder here: what a save is about to replace
is put in it, and what is saved by itself now and then; the oldest go when there are more than a
person wants.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from platformdirs import user_state_path

from stippler.atomic_write import replacing
from stippler.files.native.signature import is_container

_NUMBERED = re.compile(r"(\d{1,9})(-auto)?\.stipple")
_WHOSE = "whose.txt"


def backups_root() -> Path:
    """Return the folder above all; ``STIPPLER_STATE_DIR`` moves it."""
    base = os.environ.get("STIPPLER_STATE_DIR")
    return (Path(base) if base else user_state_path("stippler")) / "backups"


@dataclass(frozen=True, slots=True)
class Backup:
    """An earlier version.

    Attributes
    ----------
    path : Path
    number : int
        Grows with time.
    is_auto : bool
        Whether it was saved by itself, rather than replaced by a save.
    saved_s : float
        When, in seconds since 1970.
    """

    path: Path
    number: int
    is_auto: bool
    saved_s: float


class Backups:
    """The earlier versions of one drawing.

    Parameters
    ----------
    root : Path
        The folder above all.
    whose : Path or str
        The drawing's file; a text of any kind for one that has none yet.
    """

    def __init__(self, root: Path, whose: Path | str) -> None:
        name = str(whose.absolute() if isinstance(whose, Path) else whose)
        digest = hashlib.blake2b(name.encode("utf-8", "surrogateescape"), digest_size=10)
        self._whose, self.folder = name, root / digest.hexdigest()

    def listed(self) -> list[Backup]:
        """Return what there is, the newest first."""
        found = []
        with contextlib.suppress(OSError):
            for entry in os.scandir(self.folder):
                if told := _NUMBERED.fullmatch(entry.name):
                    at_s = entry.stat().st_mtime
                    path = Path(entry.path)
                    found.append(Backup(path, int(told[1]), told[2] is not None, at_s))
        return sorted(found, key=lambda backup: backup.number, reverse=True)

    def keep_file(self, path: Path, most: int) -> Path | None:
        """Keep a file as it is, before it is replaced; None where it is no drawing.

        Raises
        ------
        OSError
            If it cannot be kept.
        """
        path = path.resolve()
        if most < 1 or not is_container(path):
            return None

        def put(target: Path) -> None:
            part = target.with_suffix(".part")
            shutil.copyfile(path, part)
            shutil.copystat(path, part)
            os.replace(part, target)

        return self._add("", put, most)

    def keep_bytes(self, data: bytes, most: int) -> Path | None:
        """Keep a drawing's file that lies nowhere yet.

        Raises
        ------
        OSError
            If it cannot be kept.
        """

        def put(target: Path) -> None:
            with replacing(target) as stream:
                stream.write(data)

        return self._add("-auto", put, most) if most > 0 else None

    def _add(self, mark: str, put: Callable[[Path], None], most: int) -> Path:
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        (self.folder / _WHOSE).write_text(self._whose, "utf-8", "surrogateescape")
        before = self.listed()
        number = before[0].number + 1 if before else 1
        target = self.folder / f"{number:04}{mark}.stipple"
        put(target)
        for old in before[most - 1 :]:
            with contextlib.suppress(OSError):
                old.path.unlink()
        return target
