"""What a stamp of each type of brush does to the dots under it.

Each effect takes a `Touch`, asks the pure functions of its family for new values, and hands them
to the drawing being edited.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stippler.brushes import move, scatter, selection, shape, size
from stippler.brushes.brush import Brush
from stippler.brushes.evening_out import evened_out
from stippler.brushes.followed_sizes import FollowedSizes
from stippler.brushes.jitter import jitter
from stippler.brushes.local_cells import areas_of
from stippler.brushes.stroke_path import Stamp
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.reference import Reference
from stippler.drawing.store import Rows
from stippler.errors import ParameterError

Floats = NDArray[np.float64]


@dataclass(slots=True, eq=False)
class Touch:
    """A stamp on a drawing: the dots under the tip, and how much of the effect each gets."""

    document: Document
    brush: Brush
    stamp: Stamp
    rng: np.random.Generator
    rows: Rows
    weight: Floats
    count: scatter.Count
    sizes: FollowedSizes

    @property
    def position_mm(self) -> Floats:
        """Of the dots under the tip; a copy."""
        return np.asarray(self.document.dots.position_mm[self.rows])

    @property
    def free(self) -> Touch:
        """The same stamp on the free dots only."""
        free = ~self.document.dots.is_fixed(self.rows)
        if free.all():
            return self
        return touch_of(self, self.rows[free], self.weight[free])

    @property
    def at_mm(self) -> tuple[float, float]:
        """The middle of the stamp."""
        return self.stamp.x, self.stamp.y

    def share(self, name: str) -> float:
        """Return a percentage among the brush's values, as a share."""
        return float(self.brush.value(name)) / 100.0

    def number(self, name: str) -> float:
        """Return one of the brush's values."""
        return float(self.brush.value(name))

    @property
    def reference(self) -> Reference:
        """The reference, for effects that go by it."""
        reference = self.document.drawing.reference
        if reference is None:
            raise ParameterError(
                "goes by the picture, and there is none", self.brush.name, "open a picture first"
            )
        return reference


def touch_of(touch: Touch, rows: Rows, weight: Floats) -> Touch:
    """Return a touch on other rows."""
    return replace(touch, rows=rows, weight=weight)


# --- dots come and go ---------------------------------------------------------------------------


def add(touch: Touch) -> None:
    """Add one dot; within the zone of a line that dots keep off, on its edge."""
    points, lines = np.array([touch.at_mm]), touch.document.meetings
    if lines is not None:
        points, held = lines.keep_off(points)
        points = points[held]
    if len(points):
        _insert(touch, points)


def spray(touch: Touch) -> None:
    """Add the dots that are due."""
    n = touch.count.take(touch.stamp.dt, touch.stamp.pressure)
    if not n:
        return
    brush = touch.brush
    points = scatter.spray(n, brush.tip, brush.radius_mm, touch.rng) + touch.at_mm
    if brush.value("by_tone"):
        points = points[touch.rng.random(len(points)) < touch.reference.at(points)]
    apart_mm = touch.number("apart_mm")
    if apart_mm > 0.0 and len(points):
        points = points[touch.document.apart(points, apart_mm)]
    if (lines := touch.document.meetings) is not None:
        points = points[lines.are_off(points)]
    if len(points):
        _insert(touch, points, apart_mm)


def _insert(touch: Touch, points: Floats, apart_mm: float = 0.0) -> None:
    """Add dots; those within reach of a line that dots adhere to lie on it, unless it is full."""
    document, radius = touch.document, touch.number("dot_mm")
    dots = Dots.round(points, radius)
    dots.seed[:] = touch.rng.integers(0, 2**32, len(dots), np.uint32)
    if (lines := document.meetings) is not None:
        least = max(apart_mm, 2.0 * radius)
        lines.line_up(dots, lambda places: document.apart(places, least))
    document.insert(dots)


def remove(touch: Touch) -> None:
    """Remove the nearest dot."""
    row = touch.document.nearest(*touch.at_mm, touch.brush.radius_mm)
    if row is not None:
        touch.document.remove(np.array([row]))


def thin(touch: Touch) -> None:
    """Remove the dots that are due."""
    n = touch.count.take(touch.stamp.dt, touch.stamp.pressure)
    if n:
        touch.document.remove(touch.rows[scatter.choose(n, touch.weight, touch.rng)])


def erase(touch: Touch) -> None:
    """Remove all dots."""
    touch.document.remove(touch.rows)


def fix(touch: Touch) -> None:
    """Fix all dots."""
    _set_fixed(touch, True)


def unfix(touch: Touch) -> None:
    """Free all dots."""
    _set_fixed(touch, False)


def _set_fixed(touch: Touch, fixed: bool) -> None:
    selection.hold(touch.document, touch.rows, fixed)


# --- dots move ----------------------------------------------------------------------------------


def relax(touch: Touch) -> None:
    """Even dots out; sizes that were solved for the tone follow when the stroke ends."""
    touch = touch.free
    if not len(touch.rows):
        return
    by_tone = bool(touch.brush.value("by_tone"))
    evened = evened_out(touch.document, touch.rows, by_tone)
    touch.sizes.note(touch.document, touch.rows, evened)
    share = np.minimum(touch.weight * touch.share("strength"), 1.0)[:, None]
    old = touch.position_mm
    touch.document.move(touch.rows, old + share * (evened.moved_mm - old))


def shake(touch: Touch) -> None:
    """Move dots at random."""
    touch = touch.free
    if not len(touch.rows):
        return
    scale: Floats | float
    if touch.brush.value("measure") == "cell":
        scale = np.sqrt(areas_of(touch.document, touch.rows))
    else:
        reach = 2.0 * touch.brush.tip.reach(touch.brush.radius_mm)
        scale = float(touch.document.nearest_distances(touch.rows, reach).mean())
    moved = jitter(touch.position_mm, touch.weight, scale * touch.share("amount"), touch.rng)
    touch.document.move(touch.rows, moved)


def push(touch: Touch) -> None:
    """Take dots along."""
    touch = touch.free
    strength = touch.share("strength")
    step = (touch.stamp.dx * strength, touch.stamp.dy * strength)
    touch.document.move(touch.rows, move.push(touch.position_mm, touch.weight, step))


def comb(touch: Touch) -> None:
    """Draw dots into lines."""
    touch = touch.free
    if math.isnan(touch.stamp.direction_rad):
        return
    moved = move.comb(
        touch.position_mm,
        touch.weight,
        touch.at_mm,
        touch.stamp.direction_rad,
        touch.number("teeth_mm"),
        touch.share("strength"),
    )
    touch.document.move(touch.rows, moved)


# --- dots change their looks --------------------------------------------------------------------


def resize(touch: Touch) -> None:
    """Change radii."""
    change = shape.size_change(touch.brush)
    if change is not None:
        shape.reshape(touch.document, touch.rows, change, touch.weight)
        return
    area = areas_of(touch.document, touch.rows)
    target = size.tone_radius(touch.position_mm, area, touch.reference)
    old = touch.document.dots.radius_mm[touch.rows].astype(np.float64)
    new = size.pulled(old, touch.weight, target, touch.share("amount"))
    touch.document.change("radius_mm", touch.rows, new.astype(np.float32))


def deform(touch: Touch) -> None:
    """Change shapes."""
    reference = touch.document.drawing.reference
    change = shape.form_change(touch.brush, touch.stamp.direction_rad, reference)
    if change is not None:
        shape.reshape(touch.document, touch.rows, change, touch.weight)


EFFECTS: dict[str, Callable[[Touch], None]] = {
    "add": add,
    "spray": spray,
    "remove": remove,
    "thin": thin,
    "erase": erase,
    "fix": fix,
    "unfix": unfix,
    "relax": relax,
    "jitter": shake,
    "size": resize,
    "shape": deform,
    "push": push,
    "comb": comb,
}
