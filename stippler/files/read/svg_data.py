"""SVG's small languages: path data, transforms, lengths, numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
Piece = NDArray[np.float64]
"""2 control points (straight) or 4 (cubic)."""

Subpath = tuple[list[Piece], bool]
"""Pieces that hang together, and whether they were closed."""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_TOKEN = re.compile(
    r"\s*,?\s*(?:([MmZzLlHhVvCcSsQqTtAa])|([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?))"
)
_FLAG = re.compile(r"\s*,?\s*([01])")
_TRANSFORM = re.compile(r"(\w+)\s*\(([^)]*)\)")
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-z%]*)\s*$")
_MM = {
    "": 25.4 / 96, "px": 25.4 / 96, "mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72,
    "pc": 25.4 / 6, "q": 0.25,
}  # fmt: skip

PX_MM = _MM["px"]


def numbers(text: str) -> list[float]:
    """Return all numbers in a text."""
    return [float(n) for n in _NUMBER.findall(text)]


def length_mm(text: str) -> float | None:
    """Return a length with a unit in mm; None if it is a share or none."""
    found = _LENGTH.match(text.lower())
    if not found or found[2] not in _MM:
        return None
    return float(found[1]) * _MM[found[2]]


def user_length(text: str | None, default: float = 0.0) -> float:
    """Return a length in user units."""
    mm = length_mm(text) if text else None
    return default if mm is None else mm / PX_MM


def matrix(text: str) -> Matrix:
    """Return the (2, 3) matrix of a transform list; what is not known does nothing.

    Raises
    ------
    ValueError
        If a transform is unknown or has too few numbers.
    """
    out = np.eye(3)
    for name, inside in _TRANSFORM.findall(text):
        v = numbers(inside)
        out = out @ _transform(name, v)
    return np.asarray(out[:2])


def _transform(name: str, v: list[float]) -> Matrix:
    m = np.eye(3)
    try:
        if name == "matrix":
            m[:2] = np.array(v[:6]).reshape(3, 2).T
        elif name == "translate":
            m[:2, 2] = v[0], v[1] if len(v) > 1 else 0.0
        elif name == "scale":
            m[0, 0], m[1, 1] = v[0], v[1] if len(v) > 1 else v[0]
        elif name == "rotate":
            c, s = math.cos(math.radians(v[0])), math.sin(math.radians(v[0]))
            x, y = (v[1], v[2]) if len(v) > 2 else (0.0, 0.0)
            m[:2] = [[c, -s, x - c * x + s * y], [s, c, y - s * x - c * y]]
        elif name == "skewX":
            m[0, 1] = math.tan(math.radians(v[0]))
        elif name == "skewY":
            m[1, 0] = math.tan(math.radians(v[0]))
        else:
            raise ValueError(name)
    except IndexError as error:
        raise ValueError(name) from error
    return m


def joined(outer: Matrix, inner: Matrix) -> Matrix:
    """Return the matrix that does the inner first."""
    square = np.eye(3)
    square[:2] = inner
    return np.asarray(outer @ square)


def mapped(piece: Piece, by: Matrix) -> Piece:
    """Return control points moved by a matrix."""
    return np.asarray(piece @ by[:, :2].T + by[:, 2])


class _Reader:
    """Reads path data command by command; keeps the pen's place."""

    def __init__(self) -> None:
        self.at = self.start = (0.0, 0.0)
        self.handle: tuple[str, tuple[float, float]] = ("", (0.0, 0.0))
        self.pieces: list[Piece] = []

    def line(self, to: tuple[float, float]) -> None:
        self.pieces.append(np.array([self.at, to]))
        self.at = to

    def cubic(
        self, a: tuple[float, float], b: tuple[float, float], to: tuple[float, float]
    ) -> None:
        self.pieces.append(np.array([self.at, a, b, to]))
        self.at = to

    def quadratic(self, q: tuple[float, float], to: tuple[float, float]) -> None:
        p = self.at
        a = (p[0] + 2 / 3 * (q[0] - p[0]), p[1] + 2 / 3 * (q[1] - p[1]))
        b = (to[0] + 2 / 3 * (q[0] - to[0]), to[1] + 2 / 3 * (q[1] - to[1]))
        self.cubic(a, b, to)

    def mirrored(self, kinds: str) -> tuple[float, float]:
        kind, h = self.handle
        if kind not in kinds or not kind:
            return self.at
        return 2 * self.at[0] - h[0], 2 * self.at[1] - h[1]


_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}


def _commands(text: str) -> Iterator[tuple[str, list[float]]]:
    """Yield commands with their numbers, repeated ones spelt out; stop at the first error."""
    command, values = "", list[float]()
    flags = 0
    k = 0
    while k < len(text):
        if command in "Aa" and command and flags in (3, 4):  # flags need no separators
            found = _FLAG.match(text, k)
            if found:
                values.append(float(found[1]))
                flags += 1
                k = found.end()
                continue
        token = _TOKEN.match(text, k)
        if not token:
            return
        k = token.end()
        if token[1]:
            if values:
                return
            command = token[1]
            if command in "Zz":
                yield "Z", []
                command = ""
            flags = 0
            continue
        if not command:
            return
        values.append(float(token[2]))
        flags += 1
        if len(values) == _COUNTS[command.upper()]:
            yield command, values
            values, flags = [], 0
            command = {"M": "L", "m": "l"}.get(command, command)


def subpaths(text: str, most: int) -> tuple[list[Subpath], bool]:
    """Return the subpaths of path data, and whether all of it was read.

    As SVG asks, what comes before an error is drawn.
    """
    out: list[Subpath] = []
    pen = _Reader()
    n = 0
    begun = False
    for command, v in _commands(text):
        n += 1
        if n > most:
            break
        if command == "Z":
            if pen.pieces:
                out.append((pen.pieces, True))
            pen.pieces, pen.at = [], pen.start
            pen.handle = ("", pen.at)
            continue
        if not begun and command not in "Mm":
            return out, False
        begun = True
        if command in "Mm":
            if pen.pieces:
                out.append((pen.pieces, False))
            dx, dy = pen.at if command == "m" else (0.0, 0.0)
            pen.pieces, pen.at = [], (v[0] + dx, v[1] + dy)
            pen.start = pen.at
            pen.handle = ("", pen.at)
            continue
        _draw(pen, command, v)
    if pen.pieces:
        out.append((pen.pieces, False))
    left = _TOKEN.sub("", text).strip(" \t\r\n,") if n else text.strip()
    return out, n <= most and not left


def _draw(pen: _Reader, command: str, v: list[float]) -> None:
    kind = command.upper()
    dx, dy = pen.at if command.islower() else (0.0, 0.0)
    if kind == "A":
        to = (v[5] + dx, v[6] + dy)
        pen.pieces += arc(pen.at, v[0], v[1], v[2], bool(v[3]), bool(v[4]), to)
        pen.at, pen.handle = to, ("", to)
        return
    if kind in "HV":
        to = (v[0] + dx, pen.at[1]) if kind == "H" else (pen.at[0], v[0] + dy)
        pen.line(to)
        pen.handle = ("", to)
        return
    p = [(v[i] + dx, v[i + 1] + dy) for i in range(0, len(v), 2)]
    if kind == "L":
        pen.line(p[0])
        pen.handle = ("", p[0])
    elif kind == "C":
        pen.cubic(*p)
        pen.handle = ("C", p[1])
    elif kind == "S":
        pen.cubic(pen.mirrored("C"), p[0], p[1])
        pen.handle = ("C", p[0])
    elif kind == "Q":
        pen.quadratic(p[0], p[1])
        pen.handle = ("Q", p[0])
    else:
        q = pen.mirrored("Q")
        pen.quadratic(q, p[0])
        pen.handle = ("Q", q)


def arc(
    start: tuple[float, float],
    rx: float,
    ry: float,
    turn_deg: float,
    large: bool,
    sweep: bool,
    end: tuple[float, float],
) -> list[Piece]:
    """Return an elliptic arc as cubics; SVG 1.1, appendix F.6."""
    p, q = np.array(start), np.array(end)
    if (p == q).all():
        return []
    rx, ry = abs(rx), abs(ry)
    if rx == 0.0 or ry == 0.0:
        return [np.array([p, q])]
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    turn = np.array([[c, s], [-s, c]])
    x, y = turn @ (p - q) / 2
    size = (x / rx) ** 2 + (y / ry) ** 2
    if size > 1.0:
        rx, ry, size = rx * math.sqrt(size), ry * math.sqrt(size), 1.0
    root = math.sqrt(max(1.0 / size - 1.0, 0.0)) * (-1.0 if large == sweep else 1.0)
    middle = np.array([root * rx * y / ry, -root * ry * x / rx])
    a0 = math.atan2((y - middle[1]) / ry, (x - middle[0]) / rx)
    a1 = math.atan2((-y - middle[1]) / ry, (-x - middle[0]) / rx)
    swept = (a1 - a0) % (2 * math.pi)
    if not sweep:
        swept -= 2 * math.pi
    n = max(1, math.ceil(abs(swept) / (math.pi / 2) - 1e-9))
    centre = turn.T @ middle + (p + q) / 2
    k = 4 / 3 * math.tan(swept / n / 4)
    out = []
    for i in range(n):
        u, w = a0 + swept * i / n, a0 + swept * (i + 1) / n
        unit = np.array(
            [
                [math.cos(u), math.sin(u)],
                [math.cos(u) - k * math.sin(u), math.sin(u) + k * math.cos(u)],
                [math.cos(w) + k * math.sin(w), math.sin(w) - k * math.cos(w)],
                [math.cos(w), math.sin(w)],
            ]
        )
        out.append((unit * (rx, ry)) @ turn + centre)
    out[0][0], out[-1][-1] = p, q
    return out
