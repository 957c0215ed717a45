"""What a file format is; importing it costs nothing."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from stippler.files.write.options import Option

Values = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Format:
    """A format that drawings are written in.

    Attributes
    ----------
    name, purpose : str
        As a person knows it, and what it is for.
    endings : tuple of str
        Of its files, in small letters, with the point.
    writer : str
        Module of this package and function: ``svg.chunks`` takes a sheet (or, with `is_data`, a
        drawing) and values of the options, and yields bytes.
    options : tuple of Option
        Its own.
    is_data : bool
        Whether it holds the dots' values instead of a picture of some size.
    a_file_a_layer : bool
        Whether each pen gets a file of its own.
    """

    name: str
    endings: tuple[str, ...]
    purpose: str
    writer: str
    options: tuple[Option, ...] = ()
    is_data: bool = False
    a_file_a_layer: bool = False

    def write(self, what: Any, values: Values) -> Iterator[bytes]:
        """Yield a sheet, or a drawing where `is_data`, as bytes."""
        module, function = self.writer.split(".")
        chunks: Callable[[Any, Values], Iterator[bytes]] = getattr(
            importlib.import_module(f"stippler.files.write.{module}"), function
        )
        return chunks(what, values)
