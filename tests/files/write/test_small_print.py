"""What stands around a drawing and at the edges of formats: letters, marks, bars, names, sizes."""

import itertools
import math
import re
from dataclasses import replace

import numpy as np
import pytest

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import OutputError, ParameterError
from stippler.files.checks import SHEET_STEPS, Process, check, gain_of
from stippler.files.presses import Press
from stippler.files.write import course, dxf, eps, estimate, pen_paths, plate, raster, svg, tiff
from stippler.files.write.formats import FORMATS, TIFF
from stippler.files.write.lettering import text_lines
from stippler.files.write.names import one_line, plain, unique
from stippler.files.write.proof import _averaged, _pixels
from stippler.files.write.sheet import Layer, Line, Sheet
from stippler.files.write.table import csv_chunks


def some(n=40, seed=1):
    rng = np.random.default_rng(seed)
    return Dots.round(rng.random((n, 2)) * (40, 20), rng.uniform(0.1, 0.4, n))


def sheet(*layers, size=(40.0, 20.0)):
    return Sheet(*size, layers or (Layer("dots", some()),))


# --- letters ------------------------------------------------------------------------------------

MARKS = {  # for a capital of 21: where a mark over a letter begins and ends, as it is drawn
    "À": [(-3, -5), (2, -1)], "Á": [(3, -5), (-2, -1)], "Â": [(-4, -1), (0, -5), (4, -1)],
    "Ã": [(-5, -2), (-2.5, -4), (2.5, -2), (5, -4)],
    "Å": [(0, -1), (-2, -3), (0, -5), (2, -3), (0, -1)], "Ě": [(-4, -5), (0, -1), (4, -5)],
    "Ç": [(0, 0), (1, 2), (0, 5), (-3, 5)],
}  # fmt: skip


@pytest.mark.parametrize("letter", MARKS)
def test_a_mark_stands_over_or_under_the_middle_of_its_letter(letter):
    import unicodedata

    base = unicodedata.normalize("NFD", letter)[0]
    plain_lines = [line.points_mm for line in text_lines(base, (0.0, 0.0), 21.0)]
    lines = [line.points_mm for line in text_lines(letter, (0.0, 0.0), 21.0)]
    assert len(lines) == len(plain_lines) + 1
    (mark,) = (line for line in lines if not any(np.array_equal(line, p) for p in plain_lines))
    wanted = np.array(MARKS[letter], float)
    scale = np.ptp(mark, axis=0).max() / np.ptp(wanted, axis=0).max()
    shift = mark[0] - wanted[0] * scale
    assert mark == pytest.approx(wanted * scale + shift, abs=1e-6)
    body = np.concatenate(plain_lines)
    middle = (body[:, 0].min() + body[:, 0].max()) / 2
    assert shift[0] == pytest.approx(middle, abs=1.5)
    below = letter == "Ç"
    assert bool(mark[:, 1].mean() > 0) is below
    if not below:
        assert mark[:, 1].max() < body[:, 1].min() + 0.1


# --- what stands under a plate ------------------------------------------------------------------


def lines_under(**values):
    usual = {"magnification": None, "caption": ""}
    return plate._under(sheet(), {**usual, **values}, 1.0)


def test_a_plate_without_a_letter_has_none_and_one_with_has_it_in_its_corner():
    assert plate._letter("") == []
    at = np.concatenate([line.points_mm for line in plate._letter("A")])
    assert at.min() >= 3.0 - 1e-6
    assert at[:, 1].max() == pytest.approx(3.0 + 4.4)  # on its foot, two lines of text high
    assert np.ptp(at[:, 1]) == pytest.approx(4.4)


def test_nothing_under_a_drawing_takes_no_room_and_each_row_of_words_the_same():
    assert lines_under() == ([], 0.0)
    rows = [lines_under(caption=" ".join(["word"] * n)) for n in (1, 12)]
    heights = [height for _, height in rows]
    assert heights[0] == pytest.approx(3.0 + 1.8 * 2.2)
    n_rows = round((heights[1] - 3.0) / (1.8 * 2.2))
    assert n_rows > 1
    assert heights[1] == pytest.approx(3.0 + n_rows * 1.8 * 2.2)
    for lines, height in rows:
        at = np.concatenate([line.points_mm for line in lines])
        assert at[:, 1].min() > 20.0
        assert at[:, 1].max() < 20.0 + height + 0.5


@pytest.mark.parametrize(("times", "text_mm"), [(2.0, 2.0), (100.0, 0.05)])
def test_a_scale_bar_is_as_long_as_it_says(times, text_mm):
    lines, height = lines_under(magnification=times)
    bar = max(lines, key=lambda line: line.width_mm)
    drawn = np.ptp(bar.points_mm[:, 0]) + bar.width_mm  # round ends
    assert drawn == pytest.approx(text_mm * times)
    assert bar.points_mm[:, 0].max() + bar.width_mm / 2 == pytest.approx(40.0)
    assert height == pytest.approx(3.0 + 3.2 * 2.2 + 3.0)
    words = np.concatenate([line.points_mm for line in lines if line is not bar])
    assert words[:, 1].max() < 20.0 + height
    assert abs((words[:, 0].min() + words[:, 0].max()) / 2 - (40 - max(drawn, 0) / 2)) < 4.0


@pytest.mark.parametrize(
    ("mm", "text"),
    [(2000, "2 m"), (1000, "1 m"), (500, "50 cm"), (100, "10 cm"), (50, "50 mm"), (1, "1 mm"),
     (0.5, "500 µm"), (0.001, "1 µm"), (0.0005, "500 nm")],
)  # fmt: skip
def test_lengths_are_told_in_small_whole_numbers(mm, text):
    assert plate.length_text(mm) == text


def test_marks_have_their_places_to_the_millimetre():
    found = plate._marked(sheet(), "all")
    assert (found.width_mm, found.height_mm) == (64.0, 44.0)
    lines = found.layers[-1].lines
    corners = np.concatenate([line.points_mm for line in lines[:8]])
    away = np.minimum(np.abs(corners - [12, 12]), np.abs(corners - [52, 32]))
    assert sorted(set(np.round(away.max(axis=1), 6))) == [3.0, 8.0]
    rings = [line for line in lines if line.closed]
    middles = sorted(tuple(np.round(line.points_mm.mean(axis=0), 6).tolist()) for line in rings)
    assert middles == [(6, 22), (32, 6), (32, 38), (58, 22)]
    for ring in rings:
        away = np.hypot(*(ring.points_mm - ring.points_mm.mean(axis=0)).T)
        assert away == pytest.approx(np.full(32, 1.5))
        steps = np.hypot(*np.diff(ring.points_mm, axis=0, append=ring.points_mm[:1]).T)
        assert steps == pytest.approx(np.full(32, steps[0]))


# --- names and sizes ----------------------------------------------------------------------------


def test_names_that_are_the_same_are_counted_from_two():
    assert unique(["a", "A", "a", "b"]) == ["a", "A-2", "a-3", "b"]
    long = "x" * 31
    assert unique([long, long]) == [long, "x" * 29 + "-2"]
    assert [plain("Ä ö/ü"), plain("線"), one_line("a\n\x00b")] == ["A-o-u", "layer", "a b"]


def test_a_ground_in_a_dxf_has_a_name_that_fits():
    import shapely

    from stippler.files.write.sheet import shape_of

    night = Layer("n" * 40, some(), inverse=True, ground=(shape_of(shapely.box(1, 1, 9, 9)),))
    text = b"".join(dxf.chunks(sheet(night), {"dots_as": "circles"})).decode()
    names = re.findall(r"\nLAYER\n2\n(\S+)\n", text)
    assert names[-1] == "n" * 24 + "-ground"
    assert max(map(len, names)) <= 37


@pytest.mark.parametrize(("width", "points"), [(25.4, 72), (25.4000001, 72), (25.5, 73)])
def test_the_box_of_an_eps_is_whole_and_no_larger_than_it_must_be(width, points):
    text = b"".join(eps.chunks(sheet(size=(width, 25.4)), {})).decode()
    assert f"%%BoundingBox: 0 0 {points} 72\n" in text


def test_characters_that_xml_may_hold_are_kept():
    kept = "a\t\n\r \ud7ff\ue000\ufffd\U00010000\U0010ffff"
    assert Layer("\x00\x1f" + kept + "\ud800\udfff\ufffe\uffff").name_for_xml == kept


def test_pictures_are_of_sizes_that_there_are():
    assert raster.size_px(sheet(size=(25.4, 25.4)), 200_000).width == 200_000
    least = raster.size_px(sheet(size=(25.4, 0.001)), 1.0)
    assert (least.width, least.height) == (1, 1)
    for dpi in (200_000.5, 0.49, math.nan, -5.0):
        with pytest.raises(ParameterError, match="no picture"):
            raster.size_px(sheet(size=(25.4, 25.4)), dpi)


def test_a_tiff_may_be_as_large_as_its_numbers_reach(monkeypatch):
    def written():
        return b"".join(tiff.chunks(sheet(), {"dpi": 100, "bits": 8}))

    assert tiff._MOST_BYTES == 2**32 - 1
    n = len(written())
    for most, fits in ((n, True), (n - 1, False)):
        monkeypatch.setattr(tiff, "_MOST_BYTES", most)
        if fits:
            assert len(written()) == n
        else:
            with pytest.raises(OutputError, match="larger than a TIFF"):
                written()


def test_formats_of_pictures_are_none_of_data():
    data = {ending for one in FORMATS if one.is_data for ending in one.endings}
    assert data == {".csv", ".json", ".npz", ".stipple"} & data
    assert {".csv", ".json", ".npz"} <= data


@pytest.mark.parametrize("same", [True, False])
def test_columns_of_a_table_keep_every_bit(same):
    dots = some(7)
    if same:
        dots.radius_mm[:] = np.float32(0.1) + np.float32(1e-8)
    text = b"".join(csv_chunks(dots)).decode().splitlines()
    rows = [line.split(",") for line in text[1:]]
    assert np.array_equal(np.array([row[2] for row in rows], np.float32), dots.radius_mm)
    assert np.array_equal(np.array([float(row[0]) for row in rows]), dots.position_mm[:, 0])


def test_an_estimate_of_bands_takes_the_time_of_all(monkeypatch):
    values = {option.name: option.default for option in TIFF.options} | {"dpi": 600.0, "bits": 8}
    monkeypatch.setattr(estimate, "_WHOLE_PX", 0)
    monkeypatch.setattr(estimate, "_BANDS", 4)
    monkeypatch.setattr(estimate, "_BAND_PX", 10)
    monkeypatch.setattr(estimate, "_written", lambda _: estimate.Estimate(100, 0.5))
    found = estimate.estimate(TIFF, sheet(), values)
    height = raster.size_px(sheet(), 600.0).height
    assert found.n_bytes == pytest.approx(400 * height / 40, abs=1)
    assert found.seconds == pytest.approx(2.0 * height / 40)


# --- pens ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(("width", "n"), [(0.3, 1), (0.5, 2), (2.0, 5)])
def test_a_line_is_drawn_once_or_side_by_side_until_it_is_filled(width, n):
    import shapely

    line = Line(np.array([(2.0, 5.0), (30.0, 5.0)]), width)
    ways = list(pen_paths._passes(line, 0.3))
    assert len(ways) >= n
    drawn = shapely.union_all([shapely.LineString(way).buffer(0.15) for way in ways])
    whole = shapely.LineString(line.points_mm).buffer(max(width, 0.3) / 2)
    assert drawn.area == pytest.approx(whole.area, rel=0.02)
    dot = Line(np.array([(2.0, 5.0)]), width)
    assert len(list(pen_paths._passes(dot, 0.3))) == 1


def test_paths_are_ordered_by_where_they_are_and_turned_to_where_the_pen_is():
    rng = np.random.default_rng(3)
    starts = rng.random((60, 2)) * 100
    parts = [np.array([at, at + rng.normal(0, 2, 2)]) for at in starts]

    def travel(paths):
        return sum(np.hypot(*(b[0] - a[-1])) for a, b in itertools.pairwise(paths))

    ordered = pen_paths._sorted(parts)
    assert {tuple(map(tuple, np.sort(p, axis=0))) for p in ordered} == {
        tuple(map(tuple, np.sort(p, axis=0))) for p in parts
    }
    assert travel(ordered) < 0.3 * travel(parts)
    turned = pen_paths._sorted([p + 1000 for p in parts])  # far from the page's corner
    assert travel(turned) == pytest.approx(travel(ordered), rel=0.02)


def test_a_way_of_the_pen_is_drawn_pixel_by_pixel_and_what_is_far_away_is_not_tried():
    xy = np.array([(0.0, 0.0), (9.0, 0.0), (9.0, 6.0), (500.0, 6.0), (500.0, 9.0), (-7.5, 3.0)])
    at_s = np.arange(6.0)
    points, times = course._samples(xy, at_s, np.array([False, *[True] * 5]), (10, 30))
    assert np.all(np.diff(times[times <= 3]) >= 0)
    first = (times > 0) & (times <= 1)
    assert points[first][-1].tolist() == [9.0, 0.0]
    assert np.abs(np.diff(points[first][:, 0], prepend=0.0)).max() <= 1.0
    assert not ((times > 3) & (times <= 4)).any()  # beside the picture
    assert ((times > 4) & (times <= 5)).any()


# --- proofs -------------------------------------------------------------------------------------


def test_pixels_of_a_window_are_within_the_file_and_at_least_one():
    assert _pixels(0.0, 1.0, 10.0, 100) == (0, 10)
    assert _pixels(0.55, 0.1, 10.0, 100) == (5, 7)
    assert _pixels(0.5, 0.0, 10.0, 100) == (5, 6)
    assert _pixels(-5.0, 1.0, 10.0, 100) == (0, 1)
    assert _pixels(99.0, 1.0, 10.0, 100) == (99, 100)


@pytest.mark.parametrize(
    ("edges", "wanted"),
    [
        ([0.0, 2.0, 4.0], [0.5, 2.5]), ([0.0, 1.5, 3.0], [(0 + 0.5) / 1.5, (0.5 + 2) / 1.5]),
        ([0.0, 0.5, 1.0, 1.5], [0, 0, 1]), ([1.25, 1.75, 2.25], [1, 2]),
        ([0.0, 1.5], [1 / 3]), ([3.0, 4.0], [3]), ([1.0, 2.0, 3.0, 4.0], [1, 2, 3]),
    ],
)  # fmt: skip
def test_rows_are_averaged_by_area_or_shown_as_they_are(edges, wanted):
    rows = np.arange(4, dtype=np.float32)[:, None]
    assert _averaged(rows, np.array(edges))[:, 0] == pytest.approx(wanted)


# --- checks -------------------------------------------------------------------------------------


def pair(gap, scale=1.0):
    one = Drawing.blank(Page(40.0 / scale, 30.0 / scale))
    one.dots = Dots.round(np.array([(10.0, 10.0), (11.0 + gap, 10.0)]) / scale, 0.5 / scale)
    return one


@pytest.mark.parametrize("print_width", [None, 20.0])
def test_gaps_are_those_of_the_print_and_touching_dots_have_none(print_width):
    process = Process(print_width, 0.0, 0.2, 0.05)
    scale = 2.0 if print_width else 1.0
    for gap, close, bleeds in ((0.3, 0, 0), (0.15, 1, 0), (0.08, 1, 1), (-0.1, 0, 0)):
        found = check(pair(gap * scale), process)
        if print_width is None or gap != -0.1:
            assert (len(found.too_close), len(found.bleeding)) == (close, bleeds), gap
    touching = pair(0.0)
    touching.dots = replace(
        touching.dots, position_mm=np.array([(10.0, 10.0), (11.0, 10.0)]),
        radius_mm=np.array([0.5, 0.5], np.float32),
    )  # fmt: skip
    assert len(check(touching, Process(None, 0.0, 0.2, 0.05)).too_close) == 0


def test_gaps_as_wide_as_a_process_holds_are_no_fault():
    one = pair(0.25)
    assert len(check(one, Process(None, 0.0, 0.25, 0.0)).too_close) == 0
    assert len(check(one, Process(None, 0.0, 0.2501, 0.0)).too_close) == 1
    assert len(check(one, Process(None, 1.0, 0.0, 0.0)).too_small) == 0
    assert len(check(one, Process(None, 1.01, 0.0, 0.0)).too_small) == 2


def test_patches_may_be_bare_or_full_and_no_more():
    n = len(SHEET_STEPS)
    for edge in (0.0, 1.0):
        assert math.isfinite(gain_of([edge] * n))
    for wrong in ([-0.01] * n, [1.01] * n, [0.5] * (n - 1), [math.nan] * n):
        with pytest.raises(ParameterError, match="not what a sheet measures"):
            gain_of(wrong)


def test_rows_of_a_patch_are_moved_by_half_a_step_to_the_right():
    from stippler.files.checks import _hexagonal

    at = _hexagonal(0.3)
    rows = [np.sort(at[at[:, 1] == y][:, 0]) for y in np.unique(at[:, 1])]
    step = rows[0][1] - rows[0][0]
    assert rows[1] - rows[0] == pytest.approx(np.full(len(rows[0]), step / 2))
    assert rows[2] == pytest.approx(rows[0])


def test_a_press_loses_nothing_unless_it_says_so():
    assert Press("newspaper", 0.02).least_dot_mm == 0.0


@pytest.mark.parametrize(
    "roughness", [0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
)
def test_every_dot_is_drawn_once_in_an_svg_however_rough(roughness):
    dots = some(5)
    dots.roughness[:] = roughness
    for edge, _ in svg.SEGMENTS:
        dots.roughness[0] = max(min(edge, 1.0), 0.0)
        text = b"".join(svg.chunks(sheet(Layer("dots", dots)), {"paper": False})).decode()
        n = text.count("<circle") + sum(d.count("M") for d in re.findall(r' d="([^"]*)"', text))
        assert n == 5


def test_a_scaled_sheet_begins_where_it_began():
    found = sheet().scaled(2.5)
    assert (found.width_mm, found.height_mm) == (100.0, 50.0)
    dots = found.layers[0].dots
    assert dots.position_mm == pytest.approx(some().position_mm * 2.5)
    assert dots.radius_mm == pytest.approx(some().radius_mm * 2.5)


def test_taps_of_a_plotter_stand_in_the_middle_of_their_dots_and_have_their_ink():
    dots = some(9)
    text = b"".join(svg.chunks(sheet(Layer("dots", dots)), {"round_dots": "taps"})).decode()
    found = re.findall(r'stroke-width="([\d.]+)" d="M([-\d.]+) ([-\d.]+)h([\d.]+)"', text)
    wide, x, y, length = np.array(found, float).T
    assert np.column_stack([x + length / 2, y]) == pytest.approx(dots.position_mm, abs=2e-3)
    ink = math.pi * (wide / 2) ** 2 + wide * length
    assert ink == pytest.approx(math.pi * dots.radius_mm.astype(float) ** 2, rel=5e-3)


def test_plotters_are_set_as_most_people_want_them():
    (gcode,) = (one for one in FORMATS if ".gcode" in one.endings)
    usual = {option.name: option.default for option in gcode.options}
    assert (usual["pen_width"], usual["sort"], usual["lift_time"]) == (0.3, True, 0.15)
    lift = next(option for option in gcode.options if option.name == "lift_time")
    assert (lift.low, lift.high) == (0, 60)
