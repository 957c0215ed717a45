"""A border of a file with a vertex at -2**63 was taken: the least number has no size to look at."""

import pytest

from stippler.drawing.line import Line
from stippler.drawing.planar.path import Path
from stippler.errors import GeometryError


def test_a_vertex_beyond_all_pages_is_refused_on_either_side():
    for far in (-(2**63), 2**63 - 1):
        with pytest.raises(GeometryError, match="is no path"):
            Path.from_json({"vertices": [[0, 0], [far, 0]], "curves": []})


def test_a_line_with_one_is_refused_too():
    data = Line("one", Path.polyline([(0, 0), (5, 5)])).to_json()
    data["path"]["vertices"][1][1] = -(2**63)
    with pytest.raises(GeometryError, match="is no path"):
        Line.from_json(data)
