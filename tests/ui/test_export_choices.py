"""What is chosen for an export: endings, options, publishers, and one line for what is wrong."""

from pathlib import Path

import pytest

from stippler.drawing.page import Page
from stippler.editor.export_choices import ENDINGS, OFFERED, Choices, profile_choices
from stippler.errors import ParameterError
from stippler.files.presses import Press, keep_press
from stippler.files.write.formats import options_of


def by_text(part: str):
    return next(one for one in profile_choices() if part in one.text)


@pytest.mark.parametrize("one", OFFERED, ids=lambda one: one.endings[0])
def test_every_format_is_chosen_by_its_ending_and_gives_one(one):
    choices = Choices("/home/a.b/fig 1.svg")
    choices.choose_format(one)
    assert choices.form is one
    assert choices.path == f"/home/a.b/fig 1{one.endings[0]}"
    assert set(choices.values()) == {option.name for option in options_of(one)}


@pytest.mark.parametrize(
    ("typed", "got"),
    [("fig", "fig.pdf"), ("fig.v2", "fig.v2.pdf"), ("a/", "a/drawing.pdf"), ("", "drawing.pdf")],
)
def test_endings_replace_only_endings(typed, got):
    choices = Choices(typed)
    choices.choose_format(next(one for one in OFFERED if one.name == "PDF"))
    assert choices.path == got


def test_options_of_another_format_wait_for_it():
    choices = Choices("a.tif")
    choices.set("bits", "8")
    choices.set("dpi", 600)
    choices.path = "a.svg"
    assert "bits" not in choices.options()
    choices.path = "a.tiff"
    assert (choices.values()["bits"], choices.values()["dpi"]) == ("8", 600)


@pytest.mark.parametrize(
    ("name", "value"), [("dpi", 5), ("dpi", "x"), ("bits", "4"), ("print_width", -3)]
)
def test_a_bad_value_leaves_the_one_before(name, value):
    choices = Choices("a.tif")
    choices.set("print_width", 86)
    with pytest.raises(ParameterError):
        choices.set(name, value)
    assert choices.given == {"print_width": 86}


def test_a_publisher_is_one_choice():
    choices = Choices("fig.svg")
    choices.set("print_width", 50)
    choices.set("caption", "stays")
    choices.choose_profile(by_text("Herpetological Review, column: 86 mm, 900 dpi, 1 bit"))
    assert choices.form.name == "TIFF"
    values = choices.values()
    assert (values["print_width"], values["dpi"], values["bits"]) == (86, 900, "1")
    assert values["caption"] == "stays"
    process = choices.process()
    assert (process.print_width_mm, process.dpi) == (86, 900)
    choices.set("print_width", 80)  # what is typed then wins
    assert choices.values()["print_width"] == 80
    choices.choose_profile(profile_choices()[0])
    assert choices.given == {"caption": "stays"}


def test_every_publishers_choice_can_be_written(tmp_path):
    for one in profile_choices():
        choices = Choices(str(tmp_path / "fig.csv"))
        choices.choose_profile(one)
        assert choices.profile == (one.profile, one.column)
        assert choices.problem((), Page(100, 80)) == ""


def test_a_press_is_solved_for_and_so_spreads_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    keep_press(Press("riso", 0.03, 0.2))
    choices = Choices("a.pdf")
    assert choices.process().gain_mm == 0.01
    choices.set("press", "riso")
    assert (choices.process().gain_mm, choices.process().least_dot_mm) == (0.0, 0.2)
    choices.least_dot_mm = 0.3
    assert choices.process().least_dot_mm == 0.3


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("", "Type a name"),
        ("{}/a.doc", ".doc is no ending; one of .svg"),
        ("{}/a", "An ending is missing"),
        ("{}/none/a.svg", "There is no folder"),
        ("{}", "is a folder"),
        ("{}/a.stipple", "no ending"),
    ],
)
def test_problems_are_one_line(tmp_path, path, told):
    found = Choices(path.format(tmp_path)).problem()
    assert told in found
    assert "\n" not in found


def test_the_picture_itself_and_too_many_pixels_are_refused(tmp_path):
    photo = tmp_path / "photo.png"
    photo.write_bytes(b"precious")
    assert "photo.png" in Choices(str(photo)).problem((photo,))
    choices = Choices(str(tmp_path / "a.png"))
    choices.set("dpi", 9600)
    assert choices.problem((), Page(100, 80)) == ""
    assert "dpi" in choices.problem((), Page(1000, 80))


def test_home_is_understood():
    assert Choices("~/a.svg").file == Path.home() / "a.svg"
    assert ".stipple" not in ENDINGS
