"""Areas that are made by themselves and see their neighbours through their borders."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from scipy.spatial import KDTree
from shapely.geometry import MultiLineString, Polygon, box

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.style import Style
from stippler.jobs.processing import process_now, tasks_of
from stippler.kernels.machine import pool
from stippler.stippling.beyond import Beyond, Seen
from tests.stippling.test_border_pieces import SPACING, beside, parted
from tests.stippling.test_borders import H, W, asked, inked, picture

LEFT, RIGHT = box(0, 0, 25, H), box(25, 0, W, H)


def spacing_along(at, x=25.0):
    """Return how far dots beside a line have it to the next, in mean spacings."""
    near = np.abs(at[:, 0] - x) < 0.6 * SPACING
    return KDTree(at).query(at[near], 2)[0][:, 1] / SPACING


def test_an_area_made_again_alone_goes_on_where_its_neighbour_ends():
    document = parted("through", "through")
    process_now(document, [0, 1])
    before = document.dots.copy()
    n = np.count_nonzero(before.area == 1)
    process_now(document, [1])
    dots = document.dots
    at, radius = dots.position_mm, dots.radius_mm.astype(float)
    np.testing.assert_array_equal(at[dots.area == 0], before.position_mm[before.area == 0])
    assert np.count_nonzero(dots.area == 1) == pytest.approx(n, rel=0.002)
    np.testing.assert_array_equal(document.partition.area_at(at), dots.area)
    assert beside(at, 1, 39) == pytest.approx(1.0, abs=0.3)
    apart = spacing_along(at)
    assert apart.min() > 0.6
    assert apart.mean() == pytest.approx(spacing_along(before.position_mm).mean(), rel=0.02)
    for part in (LEFT, RIGHT):
        assert inked(at, radius, part) == pytest.approx(asked(part), rel=0.005)
    for strip in (box(25, 0, 25 + 2 * SPACING, H), box(25 - 2 * SPACING, 0, 25, H)):
        assert inked(at, radius, strip) == pytest.approx(asked(strip), rel=0.02)


def test_where_nothing_is_there_yet_dots_are_cut_off():
    document = parted("through", "through")
    process_now(document, [0])
    assert (document.dots.area == 0).all()
    process_now(document, [1])
    at = document.dots.position_mm
    assert beside(at, 1, 39) == pytest.approx(1.0, abs=0.35)
    assert spacing_along(at).min() > 0.6
    assert len(at) == pytest.approx(3000, rel=0.005)
    walls = parted("wall", "wall")
    process_now(walls, [0])
    process_now(walls, [1])
    assert beside(walls.dots.position_mm, 1, 39) < 0.25


def test_a_wall_hides_what_lies_beyond():
    document = parted("through", "wall")
    process_now(document, [0, 1])
    process_now(document, [1])
    at = document.dots.position_mm
    assert beside(at, 1, 19) == pytest.approx(1.0, abs=0.45)
    assert beside(at, 21, 39) < 0.25


def test_areas_of_other_styles_are_seen_through_a_piece_that_says_so():
    document = parted("through", "through")
    drawing = document.drawing
    drawing.styles[1] = replace(drawing.styles[0], n_dots=1900, iterations=15)
    drawing.areas[0] = replace(drawing.areas[0], style=1)
    drawing.styles[1] = replace(drawing.styles[1], n_dots=1060)
    drawing.styles[0] = replace(drawing.styles[0], n_dots=1940)
    assert [task.areas for task in tasks_of(document, [0, 1])[0]] == [(0,), (1,)]
    process_now(document, [0, 1])
    at = document.dots.position_mm
    assert beside(at, 1, 39) == pytest.approx(1.0, abs=0.4)
    assert spacing_along(at).min() > 0.5


def test_thirty_dots_among_others_meet_the_tone():
    nothing = np.empty((0, 2)), np.empty(0, np.float32)
    style = Style(n_dots=1500, border="through", iterations=15)
    drawing = Drawing.from_reference(picture(), *nothing, style)
    part = Polygon([(27, 17), (34, 16), (36, 22), (29, 24)])
    drawing.areas[1] = Area("small", part, 0)
    document = Document(drawing)
    process_now(document, [0, 1])
    before = document.dots.position_mm[document.dots.area == 0].copy()
    process_now(document, [1])
    dots = document.dots
    mine = dots.area == 1
    assert 30 <= np.count_nonzero(mine) < 40
    np.testing.assert_array_equal(dots.position_mm[~mine], before)
    apart = KDTree(dots.position_mm).query(dots.position_mm[mine], 2)[0][:, 1]
    assert apart.min() > 0.6 * np.sqrt(W * H / 1500)
    assert inked(dots.position_mm, dots.radius_mm.astype(float), part) == pytest.approx(
        asked(part), rel=0.005
    )


def test_any_number_of_threads_gives_the_same_dots():
    found, before = [], pool.n_threads()
    try:
        for n in (1, 3):
            pool.set_threads(n)
            document = parted("through", "through")
            process_now(document, [0])
            process_now(document, [1])
            found.append((document.dots.position_mm.copy(), document.dots.radius_mm.copy()))
    finally:
        pool.set_threads(before)
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)


def test_strips_end_where_the_neighbour_does():
    line = MultiLineString([[(25, 10), (25, 30)]])
    part = box(25, 0, 27, 20)
    rng = np.random.default_rng(3)
    at = rng.uniform((0, 0), (W, H), (4000, 2))
    seen = (Seen(line, MultiLineString(), part),)
    found = Beyond.of(seen, LEFT, at, 5.0, 4000 / (W * H))
    assert shapely.union_all(found.strips).equals(box(25, 10, 27, 20))
    assert found.hold(at[found.rows]).all()
    assert len(found.rows) == np.count_nonzero(
        (at[:, 0] > 25) & (at[:, 0] < 27) & (at[:, 1] > 10) & (at[:, 1] < 20)
    )
    assert not found.cut
    none = Beyond.of(seen, LEFT, at[found.rows[:5]], 5.0, 4000 / (W * H))
    assert not none.strips
    assert [line.equals(one) for one in none.cut] == [True]
