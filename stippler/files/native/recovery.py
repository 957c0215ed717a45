"""What is kept of open drawings until they are closed, so that a crash costs a stroke at most.

Each open drawing has a folder: a lock that its program holds, the drawing as it was when the
journal began, and the journal. A folder whose lock nobody holds was left by a crash.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import threading
import time
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from platformdirs import user_state_path

from stippler.errors import DrawingFileError, StipplerError
from stippler.files.native import structure
from stippler.files.native.container import Members, read_container, write_container
from stippler.files.native.journal import Journal, Payload, Replay, read_journal

_ABOUT, _LOCK = "about.json", "lock"


def recovery_root() -> Path:
    """Return the folder above all; ``STIPPLER_STATE_DIR`` moves it."""
    base = os.environ.get("STIPPLER_STATE_DIR")
    return (Path(base) if base else user_state_path("stippler")) / "recovery"


class Lock:
    """A file that one process at a time holds; the system lets go of it when the process ends."""

    def __init__(self, path: Path) -> None:
        self._file = os.open(path, os.O_RDWR | os.O_CREAT, 0o600)

    def take(self) -> bool:
        """Take hold of it, if nobody does."""
        try:
            if os.name == "nt":  # pragma: no cover: another operating system
                import msvcrt

                msvcrt.locking(self._file, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
            else:
                import fcntl

                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return False
        return True

    def close(self) -> None:
        """Let go of it."""
        os.close(self._file)


@dataclass(frozen=True, slots=True)
class Lost:
    """A drawing that a crash has left, not read yet.

    Attributes
    ----------
    path : Path or None
        Of the file it was saved to, if it was.
    left_s : float
        When its last edit was kept, in seconds since 1970.
    """

    folder: Path
    name: str
    path: Path | None
    left_s: float

    def read(self) -> tuple[dict[str, bytes], Replay]:
        """Return the members of the drawing that the journal begins with, and the journal.

        Raises
        ------
        DrawingFileError
            If the drawing cannot be read; a journal that cannot is one without records.
        """
        about = _about(self.folder)
        turn = about.get("turn") if type(about.get("turn")) is int else 0
        members = read_container(self.folder / f"base-{turn}.stipple")
        try:
            replay = read_journal(self.folder / f"edits-{turn}.journal")
        except DrawingFileError:
            replay = Replay(b"", [], 0)
        if replay.drawing != _mark(about):
            replay = Replay(b"", [], 0)
        return members, replay

    def discard(self) -> None:
        """Remove it for good."""
        shutil.rmtree(self.folder, ignore_errors=True)


def lost_drawings(root: Path) -> list[Lost]:
    """Return what crashes have left, the newest first; drawings still open elsewhere are not."""
    found: list[Lost] = []
    try:
        folders = sorted(entry for entry in root.iterdir() if entry.is_dir())
    except OSError:
        return []
    for folder in folders:
        about = _about(folder)
        if not about or not _is_left(folder):
            continue
        path = about.get("path")
        left = [file.stat().st_mtime for file in folder.glob("*.journal")]
        found.append(
            Lost(
                folder,
                str(about.get("name", "Untitled"))[:200],
                Path(path) if isinstance(path, str) and "\0" not in path else None,
                max(left, default=folder.stat().st_mtime),
            )
        )
    return sorted(found, key=lambda lost: lost.left_s, reverse=True)


def is_open_elsewhere(root: Path, path: Path) -> bool:
    """Return whether a program that runs keeps a drawing of that file."""
    try:
        folders = [entry for entry in root.iterdir() if entry.is_dir()]
    except OSError:
        return False
    return any(
        _about(folder).get("path") == str(path) and not _is_left(folder) for folder in folders
    )


def _is_left(folder: Path) -> bool:
    """Return whether nobody holds a folder's lock."""
    try:
        lock = Lock(folder / _LOCK)
    except OSError:
        return False
    try:
        return lock.take()
    finally:
        lock.close()


def _about(folder: Path) -> dict[str, Any]:
    try:
        with (folder / _ABOUT).open("rb") as stream:
            about = structure.from_bytes(stream.read(1 << 16), str(folder))
    except (OSError, DrawingFileError):
        return {}
    return about if isinstance(about, dict) else {}


def _mark(about: Mapping[str, Any]) -> bytes:
    try:
        mark = bytes.fromhex(str(about.get("mark", "")))
    except ValueError:
        return b""
    return mark if len(mark) == 16 else b""


class Keeper:
    """Keeps one open drawing recoverable, from the first `begin` to `forget`; for one thread.

    Nothing here waits for a disk but `forget` and `wait`. A disk that fails is told by `problem`,
    and the next `begin` starts anew, in files of its own.
    """

    def __init__(self, root: Path) -> None:
        self._root = root
        self._folder: Path | None = None
        self._lock: Lock | None = None
        self._journals: list[Journal] = []  # the one in effect, and the one that is to be
        self._problem: StipplerError | None = None
        self._thread: threading.Thread | None = None
        self._turn = 0

    @property
    def problem(self) -> StipplerError | None:
        """Why the drawing would not survive a crash; None while it would."""
        told = (journal.problem for journal in list(self._journals))
        return self._problem or next(filter(None, told), None)

    @property
    def is_on_disk(self) -> bool:
        """Whether the drawing that `begin` was given last is kept."""
        done = self._thread is not None and not self._thread.is_alive()
        return done and self.problem is None

    def begin(
        self, make_members: Callable[[], Members], name: str, path: Path | None, program: str
    ) -> None:
        """Keep a drawing as it is now; edits follow. It takes the place of what was kept before.

        Until it is on disk the old files stay in effect, and edits go to both journals.

        Parameters
        ----------
        make_members : callable
            Makes the drawing's members, in another thread, from what does not change any more.
        """
        self.wait()
        self._turn += 1
        turn, mark, self._problem = self._turn, uuid.uuid4().bytes, None
        try:
            folder = self._folder or self._make_folder()
            journal = Journal(folder / f"edits-{turn}.journal", mark)
        except (OSError, StipplerError) as error:
            self._fail(error)
            return
        about = {
            "name": name, "path": str(path) if path else None, "turn": turn,
            "mark": mark.hex(), "began_s": time.time(),
        }  # fmt: skip
        self._journals.append(journal)

        def write() -> None:
            try:
                _write_base(folder / f"base-{turn}.stipple", make_members(), program)
                _write_about(folder, about)
            except Exception as error:  # noqa: BLE001 - the editor lives on; the person is told
                self._fail(error)
                return
            for old in self._journals[:-1]:
                old.close()
            del self._journals[:-1]
            _clean(folder, turn)

        self._thread = threading.Thread(target=write, name="recovery", daemon=True)
        self._thread.start()

    def append(self, payload: Payload) -> None:
        """Keep an edit."""
        for journal in list(self._journals):
            journal.append(payload)

    def wait(self, timeout_s: float = 30.0) -> bool:
        """Wait until all that was asked for is on disk; return whether it is."""
        if self._thread is not None:
            self._thread.join(timeout_s)
        done = [journal.flush(timeout_s) for journal in list(self._journals)]
        return all(done) and self.problem is None

    def forget(self) -> None:
        """Remove all that is kept: the drawing was closed as it should be."""
        self.wait()
        for journal in self._journals:
            journal.close()
        self._journals.clear()
        if self._lock is not None:
            self._lock.close()
            self._lock = None
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)
            self._folder = None

    def _fail(self, error: Exception) -> None:
        why = getattr(error, "strerror", None) or str(error) or type(error).__name__
        self._problem = StipplerError(
            f"the drawing cannot be kept for recovery ({why})",
            self._root,
            "save it often, or make room there",
        )

    def _make_folder(self) -> Path:
        folder = self._root / uuid.uuid4().hex
        folder.mkdir(mode=0o700, parents=True)
        lock = Lock(folder / _LOCK)
        lock.take()
        self._folder, self._lock = folder, lock
        return folder


def _write_base(path: Path, members: Members, program: str) -> None:
    with path.open("xb") as stream:
        write_container(stream, members, program)
        stream.flush()
        os.fsync(stream.fileno())


def _write_about(folder: Path, about: Mapping[str, Any]) -> None:
    """Replace the page that says which files count: from then on the new ones do."""
    part = folder / f"{_ABOUT}.part"
    with part.open("wb") as stream:
        stream.write(structure.to_bytes(about))
        stream.flush()
        os.fsync(stream.fileno())
    os.replace(part, folder / _ABOUT)


def _clean(folder: Path, turn: int) -> None:
    """Remove the files of earlier turns."""
    for file in folder.iterdir():
        kind, _, number = file.stem.rpartition("-")
        if kind in ("base", "edits") and number != str(turn):
            with contextlib.suppress(OSError):
                file.unlink()
