"""A deformation taken hold of by what is seen of it: a box, a cage, pins."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.editor.tools.tool import Handle, Overlay, Path, Point

if TYPE_CHECKING:
    from stippler.drawing.deformation import Deformation

Box = tuple[float, float, float, float]
Grip = tuple[str, int]
"""What was taken: ("corner", k), ("side", k), ("turn", 0), ("point", k), ("pin", k), ("all", 0)."""

MOVE, PERSPECTIVE, CAGE, PINS = "move", "perspective", "cage", "pins"
WAYS = (MOVE, PERSPECTIVE, CAGE, PINS)

_TURN_PX = 30.0
_MESH = 6  # samples of a mesh's line between two points
_SNAP_RAD = math.radians(15.0)
_LEAST = 0.02


def corners_of(box: Box) -> NDArray[np.float64]:
    """Return a box's corners, clockwise from x0, y0."""
    x0, y0, x1, y1 = box
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def grips(bent: Deformation, box: Box, way: str, mm: float) -> list[tuple[Grip, Point]]:
    """Return what can be taken hold of, and where; `mm` is how long a pixel is."""
    from stippler.drawing.deformation import Cage

    corners = corners_of(box)
    if way == CAGE:
        cage = bent.cage or Cage.over(box)
        return [(("point", k), _xy(at)) for k, at in enumerate(cage.places_mm())]
    if way == PINS:
        return [(("pin", k), to) for k, (_, to) in enumerate(bent.pins_mm)]
    found: list[tuple[Grip, Point]] = [(("corner", k), _xy(at)) for k, at in enumerate(corners)]
    if way == MOVE:
        sides = (corners + np.roll(corners, -1, axis=0)) / 2
        found += [(("side", k), _xy(at)) for k, at in enumerate(sides)]
        found.append((("turn", 0), (float(sides[0, 0]), float(box[1] - _TURN_PX * mm))))
    return found


def moved(
    bent: Deformation, box: Box, way: str, grip: Grip, start: Point, at: Point, *, exact: bool
) -> Deformation:
    """Return a deformation after a grip was dragged from a place to another.

    Parameters
    ----------
    exact : bool
        Turn by whole steps, scale each way by itself.

    Raises
    ------
    GeometryError
        If it would make nothing of it.
    """
    from stippler.drawing.deformation import Cage, onto

    kind, k = grip
    if kind == "point":
        cage = bent.cage or Cage.over(box)
        x, y = cage.places_mm()[k]
        to = (float(x) + at[0] - start[0], float(y) + at[1] - start[1])
        return replace(bent, cage=cage.moved({k: to}))
    if kind == "pin":
        pins = list(bent.pins_mm)
        pins[k] = (pins[k][0], at)
        return replace(bent, pins_mm=tuple(pins))
    if way == PERSPECTIVE and kind == "corner":
        corners = corners_of(box)
        corners[k] += np.subtract(at, start)
        return _after(bent, np.array(onto(box, corners)).reshape(3, 3))
    return _after(bent, _affine(box, grip, start, at, exact=exact))


def _affine(box: Box, grip: Grip, start: Point, at: Point, *, exact: bool) -> NDArray[np.float64]:
    (kind, k), corners = grip, corners_of(box)
    by = np.subtract(at, start)
    if kind == "all":
        return np.array([[1.0, 0.0, by[0]], [0.0, 1.0, by[1]], [0.0, 0.0, 1.0]])
    if kind == "turn":
        x, y = corners.mean(axis=0)
        turn = math.atan2(at[1] - y, at[0] - x) - math.atan2(start[1] - y, start[0] - x)
        if exact:
            turn = round(turn / _SNAP_RAD) * _SNAP_RAD
        c, s = math.cos(turn), math.sin(turn)
        return _about((x, y), np.array([[c, -s], [s, c]]))
    if kind == "side":  # shear along the side
        a, b = corners[k], corners[(k + 1) % 4]
        far = corners[(k + 2) % 4]
        along = (b - a) / np.hypot(*(b - a))
        across = np.array([-along[1], along[0]])
        height = float((a - far) @ across)
        share = float(by @ along) / height
        return _about((float(far[0]), float(far[1])), np.eye(2) + share * np.outer(along, across))
    about = corners[(k + 2) % 4]
    old, new = np.subtract(start, about), np.subtract(at, about)
    if exact:
        scale = np.maximum(new / old, _LEAST)
    else:
        scale = np.full(2, max(float(new @ old) / float(old @ old), _LEAST))
    return _about((float(about[0]), float(about[1])), np.diag(scale))


def _about(at: Point, matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    out = np.eye(3)
    out[:2, :2] = matrix
    out[:2, 2] = np.array(at) - matrix @ np.array(at)
    return out


def _after(bent: Deformation, matrix: NDArray[np.float64]) -> Deformation:
    """Return a deformation whose homography is followed by another one."""
    whole = matrix @ np.array(bent.matrix).reshape(3, 3)
    return replace(bent, matrix=tuple(map(float, (whole / whole[2, 2]).ravel())))


def overlay(bent: Deformation, box: Box, way: str, mm: float, held: Grip | None = None) -> Overlay:
    """Return what is seen of a deformation: its box, mesh or pins, with handles."""
    kinds = {"corner": "scale", "side": "node", "turn": "turn", "point": "node", "pin": "control"}
    handles = tuple(
        Handle(at, kinds[grip[0]], chosen=grip == held)  # type: ignore[arg-type]
        for grip, at in grips(bent, box, way, mm)
    )
    if way == CAGE:
        return Overlay(_mesh(bent, box), handles)
    corners = tuple(_xy(at) for at in corners_of(box))
    paths = [Path(corners, closed=True, dashed=True)]
    if way == PINS:
        paths += [Path((a, b)) for a, b in bent.pins_mm if a != b]
    return Overlay(tuple(paths), handles)


def _mesh(bent: Deformation, box: Box) -> tuple[Path, ...]:
    from stippler.drawing.deformation import Cage, Deformation

    cage = bent.cage or Cage.over(box)
    only = Deformation(cage=cage)
    x0, y0, x1, y1 = cage.box_mm
    paths: list[Path] = []
    for n, lines, goes_across in (
        (cage.columns, cage.rows, True),
        (cage.rows, cage.columns, False),
    ):
        t = np.linspace(0.0, 1.0, (n - 1) * _MESH + 1)
        for k in range(lines):
            at = np.full_like(t, k / (lines - 1))
            u, v = (t, at) if goes_across else (at, t)
            points = only.apply(np.column_stack([x0 + u * (x1 - x0), y0 + v * (y1 - y0)]))
            paths.append(Path(tuple(_xy(p) for p in points)))
    return tuple(paths)


def _xy(at: NDArray[np.float64]) -> Point:
    return float(at[0]), float(at[1])
