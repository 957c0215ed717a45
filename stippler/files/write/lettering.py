"""Text as lines of a pen: Hershey's simplex letters, so that no format needs a font."""

from __future__ import annotations

import json
import unicodedata
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.files.write.sheet import Line
from stippler.resources import assets

STROKE = 0.12
"""Width of the lines, of a capital's height."""

# marks that stand over (or under) a letter: points from the middle of its top (or its foot)
_MARKS: dict[str, list[list[float]]] = {
    "\u0300": [[-3, -5, 2, -1]],
    "\u0301": [[3, -5, -2, -1]],
    "\u0302": [[-4, -1, 0, -5, 4, -1]],
    "\u0303": [[-5, -2, -2.5, -4, 2.5, -2, 5, -4]],
    "\u0308": [[-3, -3, -3, -2.9], [3, -3, 3, -2.9]],
    "\u030a": [[0, -1, -2, -3, 0, -5, 2, -3, 0, -1]],
    "\u030c": [[-4, -5, 0, -1, 4, -5]],
}
_BELOW: dict[str, list[list[float]]] = {"\u0327": [[0, 0, 1, 2, 0, 5, -3, 5]]}
_SAME = str.maketrans({"’": "'", "‘": "'", "“": '"', "”": '"', "μ": "µ", "\u00a0": " "})


@cache
def _font() -> dict[str, Any]:
    path = assets() / "fonts" / "hershey-simplex.json"
    font: dict[str, Any] = json.loads(path.read_text("utf-8"))
    return font


def text_lines(
    text: str, at_mm: tuple[float, float], capital_mm: float, *, align: float = 0.0
) -> list[Line]:
    """Return a text as lines.

    Parameters
    ----------
    at_mm : (x, y)
        On the foot of the letters; `align` says where along the text: 0 its begin, 1 its end.
    capital_mm : float
        Height of a capital.

    Raises
    ------
    ParameterError
        If there are no strokes for a character.
    """
    glyphs, marks = _glyphs(text)
    scale = capital_mm / _font()["capital"]
    pen = max(STROKE * capital_mm, 0.01)
    x = at_mm[0] - align * width_mm(text, capital_mm)
    lines = []
    for (width, strokes), over in zip(glyphs, marks, strict=True):
        for stroke in filter(None, (*strokes, *_placed(over, width, strokes))):
            points = np.array(stroke, np.float64).reshape(-1, 2) * scale
            lines.append(Line(points + np.array([x, at_mm[1]]), pen))
        x += width * scale
    return lines


def width_mm(text: str, capital_mm: float) -> float:
    """Return how wide a text is."""
    glyphs, _ = _glyphs(text)
    total: float = sum(width for width, _ in glyphs) * capital_mm / _font()["capital"]
    return total


def wrapped(text: str, capital_mm: float, most_mm: float) -> list[str]:
    """Return a text in rows of words that are at most so wide, where words allow it."""
    rows = [""]
    for word in text.split():
        longer = f"{rows[-1]} {word}".strip()
        if rows[-1] and width_mm(longer, capital_mm) > most_mm:
            rows.append(word)
        else:
            rows[-1] = longer
    return rows


_Glyph = tuple[float, list[list[float]]]


def _glyphs(text: str) -> tuple[list[_Glyph], list[str]]:
    known = _font()["glyphs"]
    glyphs: list[_Glyph] = []
    marks: list[str] = []
    for character in text.translate(_SAME):
        parts = character if character in known else unicodedata.normalize("NFD", character)
        base, over = parts[0], parts[1:]
        if base not in known or any(mark not in _MARKS and mark not in _BELOW for mark in over):
            raise ParameterError(
                f"{character!r} cannot be lettered", "text", "use Latin letters, or write it later"
            )
        glyphs.append(tuple(known[base]))
        marks.append(over)
    return glyphs, marks


def _placed(marks: str, width: float, strokes: list[list[float]]) -> list[list[float]]:
    if not marks:
        return []
    heights: NDArray[np.float64] = np.concatenate([np.array(s[1::2]) for s in strokes])
    top, placed = float(heights.min()), []
    for mark in marks:
        shapes, foot = (_MARKS[mark], top) if mark in _MARKS else (_BELOW[mark], 0.0)
        for shape in shapes:
            moved = np.array(shape).reshape(-1, 2) + np.array([width / 2, foot])
            placed.append(moved.ravel().tolist())
    return placed
