"""Icons of the tools, drawn as vectors in a unit square."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from imgui_bundle import imgui

_SCATTER = (
    (0.3, 0.25),
    (0.62, 0.2),
    (0.22, 0.55),
    (0.5, 0.5),
    (0.78, 0.45),
    (0.38, 0.8),
    (0.7, 0.75),
)

_STEPS = tuple(k / 12 for k in range(13))


class _Recorder:
    """Stands for a draw list and keeps what is called, with places as ImGui has them."""

    def __init__(self) -> None:
        self.calls: list[tuple[Callable[..., None], tuple[Any, ...]]] = []

    def __getattr__(self, name: str) -> Callable[..., None]:
        method = getattr(imgui.ImDrawList, name)

        def note(*args: Any) -> None:
            kept = tuple(imgui.ImVec2(*a) if isinstance(a, tuple) else a for a in args)
            self.calls.append((method, kept))

        return note


@dataclass(frozen=True, slots=True)
class Pen:
    """Draws in a square of the screen; coordinates run from 0 to 1, y down."""

    draw: imgui.ImDrawList | _Recorder
    x: float
    y: float
    side: float
    colour: int

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Return a place on the screen."""
        return self.x + x * self.side, self.y + y * self.side

    @property
    def width(self) -> float:
        """Width of lines."""
        return max(self.side * 0.075, 1.2)

    def dot(self, x: float, y: float, radius: float = 0.09) -> None:
        """Draw a dot."""
        self.draw.add_circle_filled(self.at(x, y), radius * self.side, self.colour, 20)

    def ring(self, x: float, y: float, radius: float) -> None:
        """Draw a circle."""
        self.draw.add_circle(self.at(x, y), radius * self.side, self.colour, 28, self.width)

    def line(self, *points: tuple[float, float]) -> None:
        """Draw a chain of lines."""
        for a, b in itertools.pairwise(points):
            self.draw.add_line(self.at(*a), self.at(*b), self.colour, self.width)

    def arrow(self, a: tuple[float, float], b: tuple[float, float]) -> None:
        """Draw an arrow from a to b."""
        angle = math.atan2(b[1] - a[1], b[0] - a[0])
        self.line(a, b)
        for turn in (2.5, -2.5):
            self.line(b, (b[0] + 0.2 * math.cos(angle + turn), b[1] + 0.2 * math.sin(angle + turn)))


def _none(p: Pen) -> None:
    p.draw.add_triangle_filled(p.at(0.28, 0.12), p.at(0.28, 0.82), p.at(0.76, 0.6), p.colour)
    p.line((0.45, 0.6), (0.6, 0.92))


def _add(p: Pen) -> None:
    p.dot(0.36, 0.62, 0.2)
    p.line((0.75, 0.12), (0.75, 0.48))
    p.line((0.57, 0.3), (0.93, 0.3))


def _spray(p: Pen) -> None:
    for x, y in _SCATTER:
        p.dot(x, y, 0.075)


def _remove(p: Pen) -> None:
    p.dot(0.36, 0.62, 0.2)
    p.line((0.6, 0.16), (0.9, 0.46))
    p.line((0.9, 0.16), (0.6, 0.46))


def _thin(p: Pen) -> None:
    for k, (x, y) in enumerate(_SCATTER):
        if k % 2:
            p.draw.add_circle(p.at(x, y), 0.08 * p.side, p.colour, 16, p.width * 0.6)
        else:
            p.dot(x, y, 0.075)


def _erase(p: Pen) -> None:
    p.line((0.12, 0.62), (0.55, 0.15), (0.88, 0.42), (0.45, 0.88), (0.12, 0.62))
    p.line((0.32, 0.4), (0.66, 0.66))
    p.line((0.45, 0.88), (0.92, 0.88))


def _fix(p: Pen) -> None:
    p.dot(0.5, 0.32, 0.2)
    p.line((0.5, 0.5), (0.5, 0.92))
    p.line((0.28, 0.92), (0.72, 0.92))


def _unfix(p: Pen) -> None:
    p.ring(0.5, 0.36, 0.22)
    p.line((0.28, 0.92), (0.42, 0.92))
    p.line((0.58, 0.92), (0.72, 0.92))


def _relax(p: Pen) -> None:
    for x, y in ((0.3, 0.2), (0.7, 0.2), (0.1, 0.52), (0.5, 0.52), (0.9, 0.52), (0.3, 0.84)):
        p.dot(x, y, 0.08)
    p.dot(0.7, 0.84, 0.08)


def _jitter(p: Pen) -> None:
    p.dot(0.5, 0.5, 0.16)
    for x, y in ((0.2, 0.3), (0.75, 0.2), (0.3, 0.8), (0.82, 0.72)):
        p.line((0.5 + (x - 0.5) * 0.62, 0.5 + (y - 0.5) * 0.62), (x, y))


def _size(p: Pen) -> None:
    p.dot(0.2, 0.7, 0.08)
    p.dot(0.62, 0.45, 0.3)


def _shape(p: Pen) -> None:
    p.draw.add_ellipse_filled(
        p.at(0.5, 0.5), (0.42 * p.side, 0.2 * p.side), p.colour, -math.pi / 5, 28
    )


def _drag(p: Pen) -> None:
    p.dot(0.22, 0.75, 0.14)
    p.arrow((0.36, 0.62), (0.86, 0.14))


def _push(p: Pen) -> None:
    for y in (0.2, 0.5, 0.8):
        p.dot(0.84, y, 0.08)
    p.arrow((0.08, 0.5), (0.66, 0.5))


def _comb(p: Pen) -> None:
    p.line((0.1, 0.14), (0.9, 0.14))
    for x in (0.18, 0.5, 0.82):
        p.line((x, 0.14), (x, 0.4))
        for y in (0.58, 0.86):
            p.dot(x, y, 0.07)


def _select(p: Pen) -> None:
    for a, b in (((0.1, 0.15), (0.9, 0.15)), ((0.1, 0.85), (0.9, 0.85))):
        for k in range(3):
            x0 = a[0] + k * 0.3
            p.line((x0, a[1]), (min(x0 + 0.17, b[0]), a[1]))
    for x in (0.1, 0.9):
        for y0 in (0.15, 0.42, 0.69):
            p.line((x, y0), (x, y0 + 0.16))


def _line(p: Pen) -> None:
    turn = [(0.12 + 0.76 * t, 0.72 - 0.5 * t + 0.24 * math.sin(t * math.tau)) for t in _STEPS]
    p.line(*turn)
    for x, y in (turn[0], turn[-1]):
        p.dot(x, y, 0.08)


def _nodes(p: Pen) -> None:
    p.line((0.12, 0.78), (0.3, 0.42), (0.56, 0.3), (0.88, 0.22))
    for x, y in ((0.12, 0.78), (0.44, 0.34), (0.88, 0.22)):
        low, high = p.at(x - 0.1, y - 0.1), p.at(x + 0.1, y + 0.1)
        p.draw.add_rect_filled(low, high, p.colour)
    p.line((0.44, 0.34), (0.62, 0.86))
    p.ring(0.62, 0.86, 0.09)


def _area(p: Pen) -> None:
    p.line((0.14, 0.4), (0.46, 0.12), (0.88, 0.34), (0.74, 0.82), (0.24, 0.86), (0.14, 0.4))
    for x, y in ((0.46, 0.12), (0.88, 0.34), (0.74, 0.82), (0.24, 0.86), (0.14, 0.4)):
        p.dot(x, y, 0.08)


def _knife(p: Pen) -> None:
    p.line((0.12, 0.9), (0.9, 0.12))
    p.line((0.1, 0.5), (0.1, 0.1), (0.5, 0.1))
    p.line((0.5, 0.9), (0.9, 0.9), (0.9, 0.5))


def _bucket(p: Pen) -> None:
    p.line((0.2, 0.5), (0.5, 0.16), (0.82, 0.48), (0.48, 0.84), (0.2, 0.5))
    p.draw.add_triangle_filled(p.at(0.2, 0.5), p.at(0.82, 0.5), p.at(0.48, 0.84), p.colour)
    p.dot(0.88, 0.74, 0.08)
    p.line((0.38, 0.06), (0.5, 0.16))


def _grow(p: Pen) -> None:
    p.line((0.3, 0.56), (0.4, 0.44), (0.5, 0.58), (0.6, 0.44), (0.7, 0.56))
    for k in range(10):
        a, b = k * math.tau / 10, (k + 0.55) * math.tau / 10
        p.line(*((0.5 + 0.42 * math.cos(t), 0.5 + 0.38 * math.sin(t)) for t in (a, b)))


def _proposals(p: Pen) -> None:
    p.line((0.1, 0.12), (0.9, 0.12), (0.9, 0.88), (0.1, 0.88), (0.1, 0.12))
    p.line((0.1, 0.5), (0.36, 0.42), (0.52, 0.6), (0.9, 0.46))
    p.line((0.36, 0.42), (0.48, 0.12))
    p.line((0.52, 0.6), (0.44, 0.88))


def _pattern(p: Pen) -> None:
    for y, shift in ((0.14, 0.0), (0.38, 0.2), (0.62, 0.0), (0.86, 0.2)):
        p.line((0.1, y), (0.9, y))
        if y < 0.8:
            for x in (0.3 + shift, 0.7 + shift):
                if x < 0.9:
                    p.line((x, y), (x, y + 0.24))


def _warp(p: Pen) -> None:
    for k in (0.15, 0.5, 0.85):
        bend = 0.16 * math.sin(math.pi * k)
        p.line(*((0.12 + 0.76 * t, k - bend * math.sin(math.pi * t)) for t in _STEPS))
        p.line(*((k + bend * math.sin(math.pi * t), 0.12 + 0.76 * t) for t in _STEPS))


_ICONS: dict[str, Callable[[Pen], None]] = {
    "": _none,
    "add": _add,
    "spray": _spray,
    "remove": _remove,
    "thin": _thin,
    "erase": _erase,
    "fix": _fix,
    "unfix": _unfix,
    "relax": _relax,
    "jitter": _jitter,
    "size": _size,
    "shape": _shape,
    "drag": _drag,
    "push": _push,
    "comb": _comb,
    "select": _select,
    "line": _line,
    "pattern": _pattern,
    "warp": _warp,
    "nodes": _nodes,
    "area": _area,
    "grow": _grow,
    "proposals": _proposals,
    "knife": _knife,
    "bucket": _bucket,
}


@lru_cache(maxsize=256)
def _recorded(
    name: str, x: float, y: float, side: float, colour: int
) -> tuple[tuple[Callable[..., None], tuple[Any, ...]], ...]:
    """Return the calls that draw an icon: as a rule it stands where it stood a frame ago."""
    recorder = _Recorder()
    _ICONS[name](Pen(recorder, x, y, side, colour))
    return tuple(recorder.calls)


def draw_icon(name: str, label: str, pen: Pen) -> None:
    """Draw the icon of a tool by its name, or its letter where it has none; "" is no tool."""
    if name in _ICONS:
        for method, args in _recorded(name, pen.x, pen.y, pen.side, pen.colour):
            method(pen.draw, *args)
        return
    letter = label[:1]
    size = imgui.calc_text_size(letter)
    at = (pen.x + (pen.side - size.x) / 2, pen.y + (pen.side - size.y) / 2)
    pen.draw.add_text(at, pen.colour, letter)
