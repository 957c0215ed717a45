"""Sheets of every kind that formats are tried on."""

import numpy as np
from shapely.geometry import Point, box

from stippler.drawing.dots import Dots
from stippler.files.write.sheet import Layer, Line, shape_of

SIZE = (50.8, 25.4)  # a whole number of pixels at all dpi that are tried


def dots(n=300, kind="round", seed=3, inside=(2.0, 2.0, 48.0, 23.0)) -> Dots:
    rng = np.random.default_rng(seed)
    left, top, right, bottom = inside
    some = Dots.round(rng.uniform((left, top), (right, bottom), (n, 2)), rng.uniform(0.2, 0.6, n))
    if kind != "round":
        some.elongation[:] = rng.uniform(1.01, 3, n)
        some.angle_rad[:] = rng.uniform(-4, 4, n)
        some.roughness[::2] = rng.uniform(0.1, 1, len(some.roughness[::2]))
    return some


def inverse() -> Layer:
    ground = Point(25, 12.5).buffer(11.5).difference(box(23, 10, 27, 14))
    return Layer("night", dots(150, "rough", inside=(17, 5, 33, 20)), True, (shape_of(ground),))


def lined() -> Layer:
    turn = np.linspace(0, 6, 60)
    wave = np.column_stack([4 + 5.3 * turn, 14 + 7 * np.sin(turn)])
    corner = np.array([(5.0, 5.0), (12.0, 5.0), (8.0, 9.0)])
    leaf = shape_of(box(30, 4, 36, 9).difference(box(32, 5, 34, 8)))
    lines = (Line(wave, 0.6), Line(corner, 0.4, closed=True), Line(np.array([(3.0, 22.0)]), 2.0))
    return Layer("lines", dots(60), lines=lines, shapes=(leaf,))


SHEETS = {
    "round": (Layer("page", dots()),),
    "deformed": (Layer("page", dots(kind="rough")),),
    "inverse": (Layer("page", dots(200)), inverse()),
    "lined": (lined(),),
}
