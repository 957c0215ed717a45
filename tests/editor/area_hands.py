"""A toolbox, a drawing of areas and dots, and events in mm: no window."""

from __future__ import annotations

import numpy as np
import shapely

from stippler.drawing import records
from stippler.drawing.area_edits import current_map, edit_areas, map_of
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.editor.events import KeyDown, KeyUp, Mods, Moved, Pressed, Released
from stippler.editor.tools.toolbox import Toolbox

PX_PER_MM = 10.0
NO = Mods()


def box(x0: float, y0: float, x1: float, y1: float) -> Path:
    return Path.polyline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], closed=True)


class AreaHands:
    """A person at a page of 100 x 80 mm."""

    def __init__(self, folder, n_dots=1500, tool=""):
        self.said: list[tuple[str, str]] = []
        self.toolbox = Toolbox(
            folder / "brushes.json", lambda text, level: self.said.append((level, text))
        )
        drawing = Drawing.blank(Page(100, 80))
        at = np.random.default_rng(0).random((n_dots, 2)) * (100, 80)
        drawing.dots = Dots.round(at, 0.2)
        self.document = Document(drawing)
        self.t_s = 0.0
        self.toolbox.choose(tool)

    @property
    def tool(self):
        return self.toolbox.tool

    @property
    def map(self):
        return current_map(self.document)

    @property
    def labels(self):
        return [step.label for step in self.document.history.steps]

    def add(self, *paths, **options):
        for path in paths:
            edit_areas(self.document, "Draw area", lambda m, p=path: edits.add(m, p, **options))

    def size(self, k):
        return self.document.drawing.areas[k].outline_mm.area

    # --- events -------------------------------------------------------------------------------

    def _take(self, event):
        return self.toolbox.take(
            event, self.document, lambda x, y: (x / PX_PER_MM, y / PX_PER_MM), PX_PER_MM
        )

    def move(self, at, mods=NO):
        self.t_s += 0.5
        return self._take(Moved(at[0] * PX_PER_MM, at[1] * PX_PER_MM, self.t_s, mods))

    def press(self, at, mods=NO, wait_s=1.0):
        self.t_s += wait_s
        return self._take(Pressed("left", at[0] * PX_PER_MM, at[1] * PX_PER_MM, self.t_s, mods))

    def release(self, at, mods=NO):
        self.t_s += 0.01
        return self._take(Released("left", at[0] * PX_PER_MM, at[1] * PX_PER_MM, self.t_s, mods))

    def click(self, at, mods=NO, wait_s=1.0):
        self.press(at, mods, wait_s)
        self.release(at, mods)

    def double_click(self, at):
        self.click(at)
        self.click(at, wait_s=0.1)

    def drag(self, *places, mods=NO):
        if mods.alt:
            self._take(KeyDown("left_alt"))
        self.press(places[0], mods)
        for place in places[1:]:
            self.move(place, mods)
        self.release(places[-1], mods)
        if mods.alt:
            self._take(KeyUp("left_alt"))

    def key(self, name, mods=NO):
        event = KeyDown(name, mods)
        if self.toolbox.is_busy or self.toolbox.wants(event, self.document):
            return self._take(event)
        return False

    # --- what has to hold -----------------------------------------------------------------------

    def check(self):
        """Areas cover the page, dots lie in theirs, outlines are those of the borders."""
        drawing = self.document.drawing
        areas = map_of(drawing)
        areas.check()
        for k in areas.areas:
            assert shapely.equals(areas.outline(k), drawing.areas[k].outline_mm)
        owner = areas.area_at(drawing.dots.position_mm)
        assert np.array_equal(owner, drawing.dots.area)


def state(document):
    """All that areas and dots are."""
    d = document.drawing
    return (
        dict(d.areas),
        dict(d.table(records.BORDER)),
        d.dots.area.copy(),
        d.dots.position_mm.copy(),
    )


def same(a, b):
    return a[:2] == b[:2] and all(np.array_equal(x, y) for x, y in zip(a[2:], b[2:], strict=True))
