"""All that areas, patterns and lines ask of kernels, done once to something small."""

from __future__ import annotations

import numpy as np
import shapely

from stippler.drawing.deformation import Cage, Deformation, before_fold
from stippler.drawing.line import ADHERE, Line
from stippler.drawing.line_index import adhering, keeping_distance
from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.borders import snap
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import OUTSIDE, PlanarMap
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.halftone_area import pulses_inside
from stippler.stippling.picture_field import PictureField
from stippler.stippling.radii import solve_radii
from stippler.stippling.relax import Relaxation
from stippler.stippling.spacing import TO_INK, Wanted
from stippler.stippling.window import Window

_SIDE = 40.0


def use_borders() -> None:
    """Lay out areas, change them, and ask where points lie."""
    areas = PlanarMap.of_page(_SIDE, _SIDE)
    for x, y in ((5, 5), (12, 8), (30, -5)):
        square = [(x, y), (x + 12, y), (x + 12, y + 12), (x, y + 12)]
        areas = edits.add(areas, Path.polyline(square, closed=True), edits.IS_CUT).map
    areas = edits.split(areas, Path.polyline([(0, 9), (_SIDE, 10)]), areas.areas[1]).map
    arc = next(k for k, a in areas.arcs.items() if OUTSIDE not in (a.left, a.right))
    areas = moves.move_by(areas, [(arc, 0)], (0.3, 0.2)).map
    areas = edits.unite(areas, areas.areas[-2:]).map
    areas = edits.remove(areas, areas.areas[-1]).map
    areas.area_at(np.random.default_rng(1).random((100, 2)) * _SIDE)
    snap(areas, (5.0, 9.0), 2.0)
    PlanarMap.from_json(areas.to_json())


def use_warp() -> None:
    """Deform by perspective, cage and pins."""
    cage = Cage.over((0.0, 0.0, _SIDE, _SIDE))
    points = np.random.default_rng(1).random((100, 2)) * _SIDE
    for bent in (
        Deformation(cage=cage),
        Deformation(cage=cage.moved({5: (12.0, 14.0)})),
        Deformation(pins_mm=(((1.0, 1.0), (2.0, 1.0)), ((9.0, 9.0), (9.0, 8.0)))),
    ):
        bent.apply(points)
        bent.folds((0.0, 0.0, _SIDE, _SIDE))
    before_fold(Deformation(cage=cage), Deformation(cage=cage.moved({5: (39.0, 14.0)})),
                (0.0, 0.0, _SIDE, _SIDE))  # fmt: skip


def use_lines() -> None:
    """Let dots keep from lines, and adhere to them."""
    path = Path.polyline([(2.0, 2.0), (20.0, 8.0), (35.0, 30.0)])
    points = np.random.default_rng(1).random((200, 2)) * _SIDE
    line = Line("line", path, meeting=ADHERE)
    adhering([line]).nearest(points)
    keeping_distance([Line("line", path)]).keep_distance(points)


def use_areas() -> None:
    """Stipple and relax areas of two styles, with holes and borders that bleed."""
    ramp = np.linspace(0.0, 1.0, 160_000, dtype=np.float32).reshape(400, 400)
    reference = Reference(ramp, _SIDE)
    ring = shapely.Point(20, 20).buffer(12).difference(shapely.Point(20, 20).buffer(4))
    first = pulses_inside(reference, Style(n_dots=300), ring)
    pulses_inside(reference, Style(n_dots=300, start="border"), ring)
    Window.of(reference, ring.bounds, 100)
    for method in ("lloyd", "even"):
        field = PictureField.of(reference)
        wanted = Wanted.by_rule(first.rule, 1.0) if method == "even" else None
        at = first.position_mm
        engine = Relaxation(at, ring, density=field, method=method, wanted=wanted)
        engine.run(3)
        plain = Relaxation(at, ring, method=method)
        plain.run(3)
    engine.set_rules(TO_INK)
    engine.step()
    solve_radii(engine.tessellation(), first.rule)
