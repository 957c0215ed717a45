"""What of a drawing becomes a layer: areas, dots of none, printed lines."""

import subprocess
import sys
from pathlib import Path as File

import numpy as np
import pytest
from shapely.geometry import Point, Polygon, box

sys.path.insert(0, str(File(__file__).parent))
import consumers

import stippler
from stippler import headless
from stippler.drawing.area import Area
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.partition import Partition
from stippler.drawing.planar.path import Path
from stippler.drawing.style import WHITE_ON_BLACK, Style
from stippler.errors import OutputError, ParameterError
from stippler.export import check_size, save
from stippler.files.write.sheet import sheet_of

PAGE = Page(50.8, 25.4)
OPTIONS = {"png": {"dpi": 300}, "tif": {"dpi": 300, "bits": 8}}


def drawing() -> Drawing:
    areas = {0: Area("page", box(0, 0, 50, 25)), 4: Area("wing", box(0, 0, 20, 25))}
    dots = Dots.round([(5, 5), (30, 5), (6, 6), (40, 20)], [1.0, 0.5, 0.75, 0.6])
    dots.area[:] = [4, 0, 4, 9]
    return Drawing(PAGE, areas, dots)


def test_dots_of_areas_that_are_not_listed_are_written(tmp_path):
    """One of two dots was missing from the file."""
    layers = sheet_of(drawing()).layers
    assert [(layer.name, len(layer.dots)) for layer in layers] == [
        ("page", 1), ("wing", 2), ("no area", 1),
    ]  # fmt: skip
    save(drawing(), tmp_path / "a.svg")
    assert (tmp_path / "a.svg").read_text().count("<circle") == 4


def test_hidden_areas_are_left_out():
    one = drawing()
    one.areas[4] = Area("wing", one.areas[4].outline_mm, hidden=True)
    assert [layer.name for layer in sheet_of(one).layers] == ["page", "no area"]


def test_areas_of_white_dots_come_first_and_those_that_touch_are_one():
    """So no seam shows between their grounds, and black dots stay whole at their borders."""
    one = drawing()
    one.styles[2] = Style(polarity=WHITE_ON_BLACK)
    outlines = [box(0, 0, 5, 5), box(5, 0, 10, 5), box(30, 0, 40, 10), box(35, 8, 50, 25)]
    for k, outline in zip((11, 12, 13, 14), outlines, strict=True):
        one.areas[k] = Area(f"a{k}", outline, 0 if k == 14 else 2)
    one.dots.area[:] = 12, 13, 4, 14
    layers = sheet_of(one).layers
    shown = [(layer.name, len(layer.dots), layer.inverse) for layer in layers]
    assert shown == [
        ("a11, a12", 1, True), ("a13", 1, True), ("wing", 1, False), ("a14", 1, False),
    ]  # fmt: skip
    (rings,), (cut,) = (shape.rings_mm for layer in layers[:2] for shape in layer.ground)
    assert Polygon(rings).equals(box(0, 0, 10, 5))
    assert Polygon(cut).equals(box(30, 0, 40, 10).difference(outlines[3]))


@pytest.mark.parametrize("ending", ["svg", "pdf", "eps", "png", "tif"])
def test_every_picture_of_white_dots_on_black_is_what_the_screen_shows(tmp_path, ending):
    one = Drawing.blank(PAGE)
    one.styles[1] = Style(polarity=WHITE_ON_BLACK)
    one.areas[1] = Area("left", Point(14, 12).buffer(10), 1)
    one.areas[2] = Area("right", box(20, 4, 40, 20), 1)
    rng = np.random.default_rng(5)
    one.dots = Dots.round(rng.uniform((2, 2), (48, 23), (300, 2)), rng.uniform(0.2, 0.5, 300))
    one.dots.elongation[::2] = rng.uniform(1, 3, 150)
    one.dots.area[:] = Partition(one.outlines()).area_at(one.dots.position_mm)
    path = tmp_path / f"a.{ending}"
    save(one, path, **OPTIONS.get(ending, {}))
    read = {"svg": consumers.resvg, "pdf": consumers.poppler, "eps": consumers.ghostscript}
    theirs = read.get(ending, consumers.pillow)(path, 300)
    screen = 1 - headless.render_image(one, px_per_mm=300 / 25.4, grey=True) / 255
    h, w = (min(a, b) for a, b in zip(theirs.shape, screen.shape, strict=True))
    theirs, screen = theirs[:h, :w], screen[:h, :w]
    assert screen.sum() == pytest.approx(theirs.sum(), rel=0.005)
    assert np.abs(consumers.averaged(screen - theirs, 16)).max() < 0.02


@pytest.mark.parametrize("ending", ["svg", "pdf"])
def test_printed_lines_are_drawn(tmp_path, ending):
    one = Drawing.blank(PAGE)
    square = Path.polyline([(4, 4), (20, 4), (20, 20), (4, 20)], closed=True)
    curve = Path.polyline([(26, 4), (46, 12), (30, 22)])
    one.lines = {
        1: Line("frame", square, (0.8, 0.8)),
        2: Line("hair", curve, (0.2, 2.0)),
        3: Line("guide", square, (5.0, 5.0), printed=False),
    }
    path = tmp_path / f"a.{ending}"
    save(one, path)
    read = {"svg": consumers.resvg, "pdf": consumers.poppler}[ending](path, 300)
    truth = sum(one.lines[k].outline().area for k in (1, 2)) * (300 / 25.4) ** 2
    assert read.sum() == pytest.approx(truth, rel=0.005)


def test_a_pen_has_a_file_of_its_own(tmp_path):
    files = save(drawing(), tmp_path / "plot.gcode")
    names = [file.name for file in files]
    assert names == ["plot-1-page.gcode", "plot-2-wing.gcode", "plot-3-no-area.gcode"]
    assert all(file.read_text().startswith("; Stippler") for file in files)


def test_print_width_and_profile(tmp_path):
    save(drawing(), tmp_path / "a.tif", profile="elsevier", column="column")
    told = subprocess.run(["tiffinfo", tmp_path / "a.tif"], capture_output=True, text=True)
    assert f"Image Width: {round(90 / 25.4 * 1000)}" in told.stdout
    assert "Resolution: 1000, 1000" in told.stdout
    save(drawing(), tmp_path / "a.tif", profile="elsevier", dpi=300, print_width=25.4)
    told = subprocess.run(["tiffinfo", tmp_path / "a.tif"], capture_output=True, text=True)
    assert "Image Width: 300 Image Length: 150" in told.stdout


def test_profiles_have_sources():
    from stippler.files.write.profiles import profiles

    assert len(profiles()) >= 12
    assert all(one.source and one.read for one in profiles().values())


def test_a_plate_has_bar_marks_caption_and_letter(tmp_path):
    from stippler.export import values_for
    from stippler.files.write.formats import SVG
    from stippler.files.write.plate import plate_of

    values = values_for(SVG, {"magnification": 10, "print_width": 101.6, "letter": "A",
                              "caption": "Fig. 1. Élytre, × 10; 5 µm", "marks": "all"})  # fmt: skip
    plate = plate_of(drawing(), values)
    assert plate.width_mm == pytest.approx(101.6 + 24)
    assert plate.height_mm > 50.8 + 24 + 5
    assert [layer.name for layer in plate.layers][-2:] == ["plate", "marks"]
    (bar,) = [line for line in plate.layers[-2].lines if line.width_mm == 0.5]
    drawn = np.ptp(bar.points_mm[:, 0]) + bar.width_mm  # its round ends lie within its length
    assert drawn == pytest.approx(20)  # 1 mm, drawn 10 times as large and printed twice
    every = np.concatenate([line.points_mm for line in plate.layers[-2].lines])
    assert (every >= 12).all()
    assert (every <= (12 + 101.6, plate.height_mm - 12)).all()


@pytest.mark.parametrize(
    ("path", "options", "says"),
    [
        ("a.svg", {"dots_as": "points"}, "no option of this format"),
        ("a.tif", {"bits": 4}, "one of 1, 8"),
        ("a.tif", {"dpi": "many"}, "dpi"),
        ("a.png", {"dpi": float("nan")}, "dpi"),
        ("a.svg", {"decimals": 2.5}, "whole number"),
        ("a.svg", {"paper": 1}, "True or False"),
        ("a.svg", {"profile": "nobody"}, "unknown"),
        ("a.svg", {"profile": "elsevier", "column": "third"}, "column"),
        ("a.svg", {"column": "page"}, "name a profile"),
        ("a.svg", {"caption": "骨"}, "lettered"),
    ],
)
def test_wrong_options_are_told(tmp_path, path, options, says):
    with pytest.raises(ParameterError, match=says):
        save(drawing(), tmp_path / path, **options)
    assert list(tmp_path.iterdir()) == []


def test_a_picture_too_large_is_told_before_the_work():
    with pytest.raises(ParameterError, match="dpi"):
        check_size("a.png", Page(2000, 100), dpi=9600)


def test_giving_up_keeps_what_stood_there(tmp_path):
    (tmp_path / "a.svg").write_text("mine")

    def show(n: int) -> None:
        raise OutputError("was given up", "a.svg", "")

    with pytest.raises(OutputError):
        save(drawing(), tmp_path / "a.svg", show=show)
    assert (tmp_path / "a.svg").read_text() == "mine"
    assert len(list(tmp_path.iterdir())) == 1


def test_json_and_npz_read_back(tmp_path):
    import json

    one = drawing()
    one.dots.id[:] = [3, 9, 4, 100]
    save(one, tmp_path / "a.json")
    save(one, tmp_path / "a.npz")
    told = json.loads((tmp_path / "a.json").read_text())
    assert told["page"] == {"width_mm": 50.8, "height_mm": 25.4}
    assert told["areas"] == {"0": "page", "4": "wing"}
    np.testing.assert_array_equal(told["dots"]["id"], one.dots.id)
    np.testing.assert_array_equal(told["dots"]["x_mm"], one.dots.position_mm[:, 0])
    with np.load(tmp_path / "a.npz") as held:
        for name in ("position_mm", "radius_mm", "id", "constraint", "seed"):
            np.testing.assert_array_equal(held[name], getattr(one.dots, name))


def test_the_api_tells_the_files(tmp_path):
    made = stippler.stipple(np.linspace(0, 1, 400).reshape(20, 20), dots=60, iterations=1, width=20)
    assert made.save(tmp_path / "a.pdf") == [tmp_path / "a.pdf"]


def test_layers_by_polarity_are_ink_and_paper(tmp_path):
    """One file for a plotter's one pen, whatever the areas; dots of a white layer stay white."""
    from sheets_tried import SHEETS, SIZE, dots

    from stippler.files.write.plate import by_polarity
    from stippler.files.write.raster import grey_strips
    from stippler.files.write.sheet import Layer, Sheet

    sheet = Sheet(
        *SIZE, (*SHEETS["round"], Layer("wing", dots(20, seed=8)), *SHEETS["inverse"][1:])
    )
    made = by_polarity(sheet)
    assert [(layer.name, len(layer.dots)) for layer in made.layers] == [
        ("ink", 320),
        ("paper", 150),
    ]
    pictures = [np.concatenate(list(grey_strips(one, 200))) for one in (sheet, made)]
    np.testing.assert_array_equal(*pictures)
    one = drawing()
    assert len(save(one, tmp_path / "a.gcode")) == 3
    assert len(save(one, tmp_path / "b.gcode", layers="polarity")) == 1


def test_layers_by_pen_join_areas_whose_styles_have_one_pen(tmp_path):
    """Three areas, two pens and a line: a plotter is handed two pens, and one for the line."""
    from sheets_tried import SHEETS, SIZE, dots

    from stippler.files.write.plate import by_pen
    from stippler.files.write.raster import grey_strips
    from stippler.files.write.sheet import Layer, Sheet

    ink = [
        Layer("ear", dots(30, seed=1), pen="quill"),
        Layer("eye", dots(40, seed=2), pen="brush"),
        Layer("wing", dots(20, seed=3), pen="quill"),
    ]
    sheet = Sheet(*SIZE, (*SHEETS["inverse"][1:], *ink, *SHEETS["lined"][-1:]))
    made = by_pen(sheet)
    n_white = sum(layer.inverse for layer in sheet.layers)
    assert [(layer.name, len(layer.dots)) for layer in made.layers[n_white : n_white + 2]] == [
        ("quill", 50),
        ("brush", 40),
    ]
    assert made.layers[-1].lines or made.layers[-1].shapes
    pictures = [np.concatenate(list(grey_strips(one, 200))) for one in (sheet, made)]
    np.testing.assert_array_equal(*pictures)
    assert len(save(drawing(), tmp_path / "a.gcode", layers="pens")) < 3


def test_files_of_several_pens_are_written_all_or_none(tmp_path):
    """The first took its name, and the second was given up."""
    (tmp_path / "a-1-page.gcode").write_text("precious")
    told = []

    def show(n_bytes):
        told.append(n_bytes)
        if n_bytes > 1500:  # the first is there
            raise OutputError("was given up", "a")

    with pytest.raises(OutputError, match="given up"):
        save(drawing(), tmp_path / "a.gcode", show=show)
    assert len(told) > 3
    assert [path.name for path in tmp_path.iterdir()] == ["a-1-page.gcode"]
    assert (tmp_path / "a-1-page.gcode").read_text() == "precious"
    assert len(save(drawing(), tmp_path / "a.gcode")) == 3


def test_a_tiff_can_be_given_up_before_its_first_byte(tmp_path):
    """All of it was packed first, and nobody asked meanwhile."""

    def show(n_bytes):
        assert n_bytes == 0
        raise OutputError("was given up", "a")

    (tmp_path / "a.tif").write_text("precious")
    with pytest.raises(OutputError, match="given up"):
        save(drawing(), tmp_path / "a.tif", dpi=2400, show=show)
    assert (tmp_path / "a.tif").read_text() == "precious"


def test_a_line_that_is_sought_can_be_given_up(tmp_path):
    one = Drawing.blank(PAGE)
    one.dots = Dots.round(np.random.default_rng(0).uniform(1, 24, (20_000, 2)), 0.05)
    asked = []

    def show(n_bytes):
        asked.append(n_bytes)
        if len(asked) > 2:
            raise OutputError("was given up", "a")

    with pytest.raises(OutputError, match="given up"):
        save(one, tmp_path / "a.svg", one_line="open", show=show)
    assert list(tmp_path.iterdir()) == []


def test_hidden_areas_are_no_part_of_the_preview_nor_of_faults():
    from stippler.editor.export_choices import Choices
    from stippler.jobs.export_look import Asked, Look, Sight, look

    one = drawing()
    choices = Choices("a.svg")
    choices.least_dot_mm = 5.0
    found = []
    for hidden in (False, True):
        one.areas[4] = Area("wing", one.areas[4].outline_mm, hidden=hidden)
        asked = Asked(
            one, hidden, choices.form, choices.values(), choices.process(), Sight(200, 100)
        )
        *_, seen = look(asked, Look(), lambda: False)
        found.append((len(seen.findings.too_small), int((255 - seen.picture).sum())))
    assert [n for n, _ in found] == [4, 2]
    assert found[1][1] < 0.6 * found[0][1]
