"""A small picture of a drawing, for lists of files; made without OpenGL."""

from __future__ import annotations

import io
import math
import struct
import zipfile
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.drawing import Drawing

MEMBER = "thumbnail.png"
SIDE_PX = 256
_FINER = 4  # samples a pixel, each way
_MOST_BYTES = 1 << 20
_MOST_DOTS = 100_000  # of more a part is drawn, each with the ink of those left out


def thumbnail(drawing: Drawing, side_px: int = SIDE_PX) -> NDArray[np.uint8]:
    """Return a drawing as grey values, its longer side of `side_px` pixels.

    Dots are round here; smaller than a sample they are drawn by their share of it.
    """
    from stippler.analysis.tone_error import draw_ink

    page, dots = drawing.page, drawing.dots
    scale = side_px / max(page.width_mm, page.height_mm)
    w, h = (max(round(side * scale), 1) for side in (page.width_mm, page.height_mm))
    every = max(len(dots) // _MOST_DOTS, 1)
    x, y = (np.ascontiguousarray(column) * scale for column in dots.position_mm[::every].T)
    radii = dots.radius_mm[::every].astype(np.float64) * (scale * math.sqrt(every))
    small = radii * _FINER < 1.0
    inside = small & (x >= 0.0) & (x < w) & (y >= 0.0) & (y < h)
    areas = np.where(inside, np.pi * radii**2, 0.0)
    cell = np.where(inside, np.floor(y) * w + np.floor(x), 0.0).astype(np.int64)
    ink = np.asarray(np.bincount(cell, areas, w * h), np.float64).reshape(h, w)
    if not small.all():
        large = np.flatnonzero(~small)
        at = np.stack([x[large], y[large]], axis=1)
        ink = ink + draw_ink(at, radii[large], (h, w), _FINER)
    light = 1.0 - np.minimum(ink, 1.0)
    return np.asarray(np.rint(255.0 * light), np.uint8)


def thumbnail_png(drawing: Drawing) -> bytes:
    """Return a drawing's small picture as a PNG file."""
    from PIL import Image

    stream = io.BytesIO()
    Image.fromarray(thumbnail(drawing)).save(stream, "png")
    return stream.getvalue()


def read_thumbnail(path: Path) -> NDArray[np.uint8] | None:
    """Return the small picture in a drawing's file, reading nothing else; None if there is none.

    It is but a picture: what is damaged in the file is told when it is opened.
    """
    from PIL import Image

    try:
        with zipfile.ZipFile(path) as archive:
            entry = archive.getinfo(MEMBER)
            if entry.file_size > _MOST_BYTES or entry.flag_bits & 1:
                return None
            data = archive.read(entry)
        with Image.open(io.BytesIO(data), formats=("PNG",)) as image:
            if max(image.size) > 4 * SIDE_PX:
                return None
            return np.array(image.convert("L"))
    except _BROKEN:
        return None


_BROKEN = (
    OSError, ValueError, LookupError, SyntaxError, RuntimeError, EOFError, OverflowError,
    zipfile.BadZipFile, zlib.error, NotImplementedError, struct.error,
)  # fmt: skip
