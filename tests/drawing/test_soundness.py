"""Borders that were read are a map, or what is wrong is named, and they are made anew."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import MultiPolygon, box

from benchmarks import random_areas
from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.mending import with_sound_borders
from stippler.drawing.planar import edits
from stippler.drawing.planar import soundness as soundness_module
from stippler.drawing.planar.path import UNIT_MM, Path
from stippler.drawing.planar.planar_map import PlanarMap
from stippler.drawing.planar.soundness import fault_of
from stippler.errors import DrawingFileError, GeometryError
from stippler.files.native.drawing_file import save_drawing
from stippler.opening import open_document, open_file

SIZE = (100.0, 80.0)


def map_after(seed, n_edits):
    rng = np.random.default_rng(seed)
    areas = PlanarMap.of_page(*SIZE)
    for _ in range(n_edits):
        try:
            name = random_areas._choose(rng, areas)
            areas = random_areas.EDITS[name](areas, rng).map
        except GeometryError:
            continue
    return areas


def outlines_of(areas):
    fresh = PlanarMap(areas.arcs, areas.next_arc, areas.next_area)
    return {0: MultiPolygon()} | {k: fresh.outline(k) for k in fresh.areas}


def fault(areas, outlines=None):
    return fault_of(areas.arcs, outlines or outlines_of(areas), SIZE)


@pytest.mark.parametrize("seed", range(4))
def test_what_edits_make_is_sound(seed):
    for n in (1, 20, 45):
        areas = map_after(seed, n)
        assert fault(areas) is None


def three():
    """Two areas that share a border, and an island in one of them."""
    areas = PlanarMap.of_page(*SIZE)
    for x0, y0, x1, y1 in ((10, 10, 40, 50), (40, 10, 70, 50), (20, 20, 30, 30)):
        corners = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float)
        areas = edits.add(areas, Path.polyline(corners, closed=True)).map
    return areas


def arc_between(areas, one, other):
    return next(k for k, a in areas.arcs.items() if {a.left, a.right} == {one, other})


def with_arc(areas, k, **values):
    return PlanarMap({**areas.arcs, k: replace(areas.arcs[k], **values)}, 99, 99)


def moved(areas, k, vertex, to):
    at = areas.arcs[k].path.vertices.copy()
    at[vertex] = np.array(to) / UNIT_MM
    if vertex == 0 and areas.arcs[k].path.is_closed:
        at[-1] = at[0]
    return with_arc(areas, k, path=Path(at))


def spoilt(what):
    areas = three()
    island, seam = arc_between(areas, 1, 3), arc_between(areas, 1, 2)
    rim = arc_between(areas, 0, -1)
    if what == "crossing":
        at = areas.arcs[island].path.vertices * UNIT_MM
        corner = int(np.flatnonzero((at == (30, 20)).all(axis=1))[0])
        return moved(areas, island, corner, (50, 25)), (40, 25)
    if what == "sides":
        arc = areas.arcs[seam]
        return with_arc(areas, seam, left=arc.right, right=arc.left), None
    if what == "island":
        arc = areas.arcs[island]
        sides = {k: 2 if v == 1 else v for k, v in (("left", arc.left), ("right", arc.right))}
        return with_arc(areas, island, **sides), (20, 20)
    if what == "missing":
        return PlanarMap({k: a for k, a in areas.arcs.items() if k != seam}, 99, 99), None
    if what == "twice":
        return PlanarMap({**areas.arcs, 98: areas.arcs[island]}, 99, 99), None
    if what == "stranger":
        return with_arc(areas, island, left=77), None
    if what == "page":
        return moved(areas, rim, 0, (1, 1)), None
    assert what == "rim"
    return PlanarMap({k: a for k, a in areas.arcs.items() if k != rim}, 99, 99), None


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ("crossing", r"border \d+ and border \d+ cross"), ("sides", "at once"),
        ("island", "lies in area 1"),
        ("missing", "at once"), ("twice", "lie on one another"), ("stranger", "area 77"),
        ("page", "of the page's"), ("rim", "lies in|bound"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_and_where(what, says):
    areas, place = spoilt(what)
    found = fault(areas, outlines_of(three()))
    assert found is not None
    assert re.search(says, str(found)), found
    assert " mm" in str(found)
    if place is not None:
        assert np.hypot(*(np.array(found.at_mm) - place)) < 10.0


def test_an_outline_other_than_its_borders_is_named():
    outlines = outlines_of(three())
    outlines[3] = box(20, 20, 30, 31)
    found = fault(three(), outlines)
    assert found is not None
    assert "area 3 is not what its borders bound" in found.what
    assert 20 <= found.at_mm[0] <= 30
    assert 30 <= found.at_mm[1] <= 31


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 3), st.integers(0, 10**6))
def test_what_is_found_sound_is_so_by_shapelys_judgement(seed, dice):
    areas = map_after(seed, 20)
    outlines = outlines_of(areas)
    rng = np.random.default_rng(dice)
    k = int(rng.choice(list(areas.arcs)))
    arc = areas.arcs[k]
    what = rng.integers(4)
    if what == 0:
        at = arc.path.vertices.copy()
        n = int(rng.integers(len(at)))
        at[n] += rng.integers(-40_000, 40_000, 2)
        if arc.path.is_closed and n in (0, len(at) - 1):
            at[0] = at[-1] = at[n]
        changed = with_arc(areas, k, path=Path(at))
    elif what == 1:
        changed = with_arc(areas, k, left=int(rng.choice(areas.areas)))
    elif what == 2:
        changed = PlanarMap({i: a for i, a in areas.arcs.items() if i != k}, 999, 999)
    else:
        changed = with_arc(areas, k, left=arc.right, right=arc.left)
    if fault_of(changed.arcs, outlines, SIZE) is None:
        fresh = PlanarMap(changed.arcs, 999, 999)
        fresh.check()
        for i in fresh.areas:
            odd = fresh.outline(i).symmetric_difference(outlines[i]).area
            assert odd < 0.01 * max(outlines[i].length, 1.0)


def drawing_of_three():
    document = Document(Drawing.blank(Page(*SIZE)))
    document.begin("Dots")
    document.insert(Dots.round(np.random.default_rng(1).random((300, 2)) * SIZE, 0.3))
    document.commit()
    for x0, y0, x1, y1 in ((10, 10, 40, 50), (40, 10, 70, 50), (20, 20, 30, 30)):
        corners = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float)
        path = Path.polyline(corners, closed=True)
        edit_areas(document, "Draw", lambda areas, path=path: edits.add(areas, path))
    return document.drawing


@pytest.mark.parametrize("what", ["crossing", "sides", "island", "missing", "twice", "page"])
def test_borders_are_made_anew_from_the_outlines(tmp_path, what):
    drawing = drawing_of_three()
    assert with_sound_borders(drawing) == (drawing, "")
    before = {k: a.outline_mm for k, a in drawing.areas.items()}
    owners = drawing.dots.area.copy()
    drawing.borders = dict(spoilt(what)[0].arcs)
    path = tmp_path / "spoilt.stipple"
    save_drawing(drawing, path)
    with pytest.warns(UserWarning, match=r"spoilt.stipple: its borders were made anew .* mm\)"):
        found = open_file(path)
    for k, outline in before.items():
        assert found.areas[k].outline_mm.symmetric_difference(outline).area < 1e-6
    assert np.array_equal(found.dots.area, owners)
    assert with_sound_borders(found) == (found, "")
    document, note = open_document(path)
    assert "made anew" in note
    edit_areas(document, "Remove", lambda areas: edits.remove(areas, 3))
    again = tmp_path / "again.stipple"
    save_drawing(document.drawing, again)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        open_file(again)


def test_areas_that_overlap_are_laid_over_each_other(tmp_path):
    drawing = drawing_of_three()
    drawing.areas[1] = replace(drawing.areas[1], outline_mm=box(10, 10, 60, 50))
    path = tmp_path / "overlap.stipple"
    save_drawing(drawing, path)
    with pytest.warns(UserWarning, match="area 1 is not what its borders bound"):
        found = open_file(path)
    assert found.areas[1].outline_mm.area == pytest.approx(30 * 40 - 100)
    shapes = [a.outline_mm for a in found.areas.values()]
    assert shapely.area(shapes).sum() == pytest.approx(8000)


def test_an_outline_that_crosses_itself_is_mended(tmp_path):
    drawing = drawing_of_three()
    drawing.borders = {}
    bow = shapely.from_wkt("POLYGON ((20 20, 30 30, 30 20, 20 30, 20 20))")
    drawing.areas[3] = replace(drawing.areas[3], outline_mm=bow)
    path = tmp_path / "bow.stipple"
    save_drawing(drawing, path)
    with pytest.warns(UserWarning, match=r"area 3 .*self-intersection.* 25.000, 25.000 mm"):
        found = open_file(path)
    assert found.areas[3].outline_mm.is_valid


def test_borders_too_crowded_to_be_looked_at_are_refused_or_made_anew(tmp_path, monkeypatch):
    monkeypatch.setattr(soundness_module, "MOST_PAIRS", 3)
    drawing = drawing_of_three()
    _, what = with_sound_borders(drawing)
    assert "too crowded" in what


@pytest.mark.parametrize("at", ["nan nan", "1e300 5", "inf 3"])
def test_outlines_that_are_nowhere_are_refused(tmp_path, at):
    drawing = drawing_of_three()
    drawing.borders = {}
    path = tmp_path / "odd.stipple"
    wkt = f"POLYGON ((20 20, {at}, 30 20, 20 30, 20 20))"
    with np.errstate(invalid="ignore"):
        drawing.areas[3] = replace(drawing.areas[3], outline_mm=shapely.from_wkt(wkt))
    save_drawing(drawing, path)
    with pytest.raises(DrawingFileError, match=r"odd\.stipple"):
        open_file(path)
