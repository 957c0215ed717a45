"""Writing a drawing to a file, beside whatever else is going on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.errors import StipplerError

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing


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
