"""Two areas were drawn as one with a third that both saw; the wall between them had been lost."""

import numpy as np
import shapely
from shapely.geometry import LineString, box

from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Partition
from stippler.drawing.planar import edits
from stippler.drawing.planar.edits import Outcome
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.policies import with_policy
from stippler.drawing.style import Style
from stippler.stippling.border_policies import BorderPolicies
from tests.stippling.test_borders import H, W, picture


def three(policy: str) -> Document:
    """A page seen through by two boxes above it, which share a border that says something else."""
    nothing = np.empty((0, 2)), np.empty(0, np.float32)
    drawing = Drawing.from_reference(picture(), *nothing, Style(n_dots=3000, border="through"))
    document = Document(drawing)
    for k, (x0, x1) in enumerate(((10, 30), (30, 50)), start=1):
        path = Path.polyline([(x0, 0), (x1, 0), (x1, 20), (x0, 20)], closed=True)
        edit_areas(document, "Draw", lambda m, p=path: edits.add(m, p), names={k: f"box {k}"})
    (k,) = (k for k, a in document.drawing.borders.items() if {a.left, a.right} == {1, 2})
    edit_areas(document, "Border", lambda m: Outcome(with_policy(m, {k: [(0, 1, policy)]})))
    return document


def test_the_wall_between_them_is_there():
    document = three("wall")
    policies = BorderPolicies(document.drawing, Partition(document.drawing.outlines()))
    assert policies.joined([0, 1, 2]) == [(0, 1, 2)]
    part = policies.part_of_all((0, 1, 2))
    assert shapely.length(shapely.intersection(part, LineString([(30, 0), (30, 20)]))) < 1e-3
    assert part.symmetric_difference(box(0, 0, W, H)).area < 1e-3


def test_those_between_which_it_bleeds_are_drawn_apart():
    document = three("bleed")
    policies = BorderPolicies(document.drawing, Partition(document.drawing.outlines()))
    assert policies.joined([0, 1, 2]) == [(0, 1), (2,)]
    assert policies.joined([0, 1, 2], drawn=False) == [(0, 1, 2)]
