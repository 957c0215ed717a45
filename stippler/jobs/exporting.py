"""Writing a drawing to a file, beside whatever else is going on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.errors import StipplerError

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing
    from stippler.files.native.backups import Backups

_PIECE = 1 << 20


@dataclass(slots=True)
class Writing:
    """A file being written, for two threads: how far it is, and whether a person gave it up.

    Attributes
    ----------
    note : str
        What a person should know, though the file is written.
    """

    n_bytes: int = 0
    given_up: bool = False
    note: str = ""


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


def save_drawing(
    complete: Callable[[], Drawing],
    path: Path,
    backups: Backups | None,
    n_backups: int,
    writing: Writing,
) -> Iterator[Path]:
    """Write a drawing to its own kind of file; yield its path when it is there.

    Parameters
    ----------
    complete : callable
        Makes the drawing with all that its file is to hold.
    backups : Backups or None
        Where the file that is replaced goes, of which `n_backups` are kept. One that cannot be
        kept is told and hinders nothing: the person's wish was to save.
    """
    from stippler.atomic_write import check_writable, replacing
    from stippler.files.native.drawing_file import file_bytes

    check_writable(path)
    data = memoryview(file_bytes(complete()))
    if backups is not None and path.exists():
        try:
            backups.keep_file(path, n_backups)
        except OSError as error:
            writing.note = f"the earlier version could not be kept ({error.strerror or error})"
    with replacing(path) as stream:
        for at in range(0, len(data), _PIECE):
            if writing.given_up:
                raise StipplerError("was given up", path.name, "nothing was written")
            writing.n_bytes += stream.write(data[at : at + _PIECE])
    yield path
