"""Values that panels, the command line and files ask: of areas, parameters, pens, pictures."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.history import History
from stippler.drawing.outline_grid import OutlineGrid
from stippler.drawing.parameter import Choice, Kind, Parameter, by_default
from stippler.drawing.pens import PENS
from stippler.drawing.reference import Picture
from stippler.drawing.style import BORDERS, Style
from stippler.drawing.validation import floats
from stippler.errors import ParameterError

SQUARE = shapely.box(0, 0, 5, 5)


def test_a_border_that_no_area_can_have_is_refused():
    for border in ("", *BORDERS):
        assert Area("ear", SQUARE, border=border).border == border
    with pytest.raises(ParameterError, match=r"'fence' is unknown.*wall"):
        Area("ear", SQUARE, border="fence")


def test_an_areas_border_is_its_own_or_its_styles():
    drawing = Drawing.blank(Page(10, 10), Style(border="wall"))
    drawing.areas[3] = Area("ear", SQUARE, border="through")
    drawing.areas[4] = Area("eye", SQUARE)
    assert [drawing.border_of(i) for i in (0, 3, 4)] == ["wall", "through", "wall"]


NUMBER = Parameter("gap", Kind.NUMBER, 1.0, "Gap", "How far.", low=0.5, high=4.0, unit="mm")
WHOLE = Parameter("n", Kind.WHOLE, 1, "Number", "How many.", low=1, high=math.inf)
CHOICE = Parameter("how", Kind.CHOICE, "a", "How", "Way.", choices=(Choice("a", "A"),))
FLAG = Parameter("on", Kind.FLAG, True, "On", "Whether.", flag="--off", keyword="is_on")


@pytest.mark.parametrize(
    ("about", "good", "bad"),
    [
        (NUMBER, [0.5, 1, 4.0, np.float32(2)], [0.49, 4.01, math.nan, "2", True, None, [1]]),
        (WHOLE, [1, 10**9, np.int64(7)], [0, -1, 1.5, True, "x", None]),
        (CHOICE, ["a"], ["b", "", 1, None]),
        (FLAG, [True, False, np.True_], [0, 1, "yes", None]),
        (replace(NUMBER, may_lack=True), [None, 1.0], ["", math.inf]),
    ],
)
def test_what_a_parameter_allows_is_what_it_does_not_refuse(about, good, bad):
    assert [about.allows(value) for value in good] == [True] * len(good)
    assert [about.allows(value) for value in bad] == [False] * len(bad)
    for value in bad:
        with pytest.raises(ParameterError):
            about.checked(value)


def test_a_parameter_is_called_and_bounded_as_people_say_it():
    assert (NUMBER.bounds, WHOLE.bounds) == ("0.5 to 4 mm", "1 or more")
    assert (FLAG.option, replace(FLAG, flag="").option) == ("--off", "--is-on")
    assert [p.is_dragged for p in (NUMBER, WHOLE, replace(NUMBER, high=101.0))] == [1, 0, 0]
    edges = [replace(NUMBER, low=0.0, high=high).decimals for high in (99.0, 99.5)]
    assert edges == [2, 0]
    assert [by_default("a", "A", value, "").kind for value in (True, 0.5)] == [
        Kind.FLAG, Kind.NUMBER,
    ]  # fmt: skip
    assert by_default("a", "A", "x", "", options=("x", "y")).values == ("x", "y")


def test_one_counts_only_beside_what_it_belongs_to():
    tied = replace(NUMBER, only=("how", ("a", "b")))
    others = [type("Style", (), {"how": how}) for how in ("a", "b", "c")]
    assert [tied.counts(other) for other in others] == [True, True, False]
    assert NUMBER.counts(None)


def test_pens_are_called_as_people_read_it():
    assert {pen.label for pen in PENS} >= {"Quill", "Technical pen", "Rough paper"}


def test_pictures_are_equal_by_what_they_show_and_hash_alike():
    dark = np.linspace(0, 1, 12, dtype=np.float32).reshape(3, 4)
    one, same, other = (
        Picture.of(d, "linear", n) for d, n in ((dark, "a"), (dark, "b"), (dark / 2, "a"))
    )
    assert one == same != other
    assert len({one, same, other}) == 2
    assert one != "a"
    assert Picture.of(dark, "perceptual", "a") != one


def test_every_change_of_a_document_has_another_revision():
    drawing = Drawing.blank(Page(10, 10))
    drawing.dots = Dots.round([(1, 1), (2, 2)], 0.2)
    document = Document(drawing)
    seen = [document.revision]
    document.begin("Move")
    document.move(np.array([0]), np.array([[3.0, 3.0]]))
    seen.append(document.revision)
    document.change("radius_mm", np.array([1]), np.array([0.3], np.float32))
    document.commit()
    seen.append(document.revision)
    document.undo()
    seen.append(document.revision)
    assert seen == sorted(set(seen))
    assert document.revision == seen[-1]


def test_a_history_with_nothing_undone_has_nothing_to_redo():
    history = History()
    assert history.redo() is None
    assert history.n_done == 0


@pytest.mark.parametrize("n", [4095, 4096, 9000])
def test_outlines_are_found_for_many_points_at_once(n):
    outlines = [shapely.box(2, 2, 3, 3), shapely.Point(6, 4).buffer(2.5), shapely.box(0, 0, 6, 8)]
    points = np.random.default_rng(n).random((n, 2)) * (10, 8)
    wanted = np.full(n, -1)
    for k, outline in reversed([*enumerate(outlines)]):  # the first is the uppermost
        wanted[shapely.contains_xy(outline, *points.T)] = k
    assert np.array_equal(OutlineGrid(outlines).find(points), wanted)


@pytest.mark.parametrize("values", ["abc", [[1, 2], [3]], [1 + 2j], [object()], ["1", "2"]])
def test_what_is_no_array_of_numbers_is_refused_by_its_name(values):
    with pytest.raises(ParameterError, match=r"places.*no array of numbers"):
        floats(values, "places")


def test_numbers_of_any_kind_become_an_array_of_ones_own():
    mine = np.arange(4.0)
    for values in (mine, [0, 1, 2, 3], (False, True, 2, 3), np.arange(4, dtype=np.uint8)):
        found = floats(values, "places")
        assert found.dtype == np.float64
        assert found.tolist() == [0.0, 1.0, 2.0, 3.0]
        assert found is not mine
        assert found.flags.writeable
    assert np.isnan(floats([math.nan], "places")).all()


def test_a_plain_drawing_is_the_page_alone():
    drawing = Drawing.blank(Page(10, 10))
    assert drawing.is_plain
    drawing.areas[3] = Area("ear", SQUARE)
    assert not drawing.is_plain
    drawing = Drawing.blank(Page(10, 10))
    drawing.lines[1] = None
    assert not drawing.is_plain
