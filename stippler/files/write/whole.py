"""A drawing whole, as the program opens it again."""

from __future__ import annotations

from collections.abc import Iterator

from stippler.drawing.drawing import Drawing
from stippler.files.native.drawing_file import file_bytes
from stippler.files.write.format import Values


def chunks(drawing: Drawing, values: Values) -> Iterator[bytes]:
    """Yield a drawing with all of its parts."""
    yield file_bytes(drawing)
