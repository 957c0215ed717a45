"""Sets of polygons from files: open paths closed and said, bad ones refused."""

import numpy as np
import pytest
import shapely

from stippler.drawing.pattern import Pattern
from stippler.errors import StipplerError
from stippler.files.read.pattern_file import read_pattern
from stippler.stippling.patterns import cells_of

SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="50mm" viewBox="0 0 100 50">'
    "{}</svg>"
)


def written(tmp_path, inner):
    path = tmp_path / "mine.svg"
    path.write_text(SVG.format(inner))
    return path


def test_closed_paths_of_any_kind_become_polygons(tmp_path):
    inner = (
        '<rect x="0" y="0" width="20" height="20"/><circle cx="50" cy="10" r="10"/>'
        '<path d="M 0 30 C 10 20 20 40 30 30 L 30 50 L 0 50 Z"/>'
        '<polygon points="60,30 100,30 100,50"/>'
    )
    made, notes = read_pattern(written(tmp_path, inner))
    assert made.name == "mine"
    assert len(made) == 4
    assert not notes
    assert made.corners.min() == pytest.approx(0)
    assert made.corners.max() == pytest.approx(1)  # the longer side
    area = sum(shapely.Polygon(ring).area for ring in made.rings()) * 100**2
    assert area == pytest.approx(400 + 314 + 400 + 600, rel=0.05)


def test_open_paths_are_closed_and_said_and_overlaps_cut(tmp_path):
    inner = (
        '<path d="M 0 0 L 40 0 L 40 40"/><path d="M 20 0 L 60 0 L 60 40 L 20 40 Z"/>'
        '<path d="M 70 0 L 80 0"/>'
    )
    made, notes = read_pattern(written(tmp_path, inner))
    assert len(made) == 2
    assert any("1 open path" in note for note in notes)
    found = cells_of(shapely.box(0, 0, 50, 50), Pattern.over(0, made, (0, 0, 50, 50), 50))
    assert any("overlap" in note for note in found.notes)
    whole = shapely.union_all(found.polygons)
    assert whole.area == pytest.approx(sum(p.area for p in found.polygons), rel=1e-9)


def test_a_hundred_thousand_polygons_are_read_and_more_refused(tmp_path):
    rng = np.random.default_rng(0)
    corners = (rng.random((100_001, 2)) * 90).round(2).tolist()
    triangles = [f"M{x} {y}h.1v.1z" for x, y in corners]
    made, _ = read_pattern(written(tmp_path, f'<path d="{"".join(triangles[:100_000])}"/>'))
    assert len(made) == 100_000
    with pytest.raises(StipplerError, match="100,001 paths"):
        read_pattern(written(tmp_path, f'<path d="{"".join(triangles)}"/>'))


@pytest.mark.parametrize("inner", ["", '<path d="M 0 0 L 10 10"/>', '<text x="3" y="3">a</text>'])
def test_files_without_a_polygon_are_refused(tmp_path, inner):
    with pytest.raises(StipplerError):
        read_pattern(written(tmp_path, inner))
