"""What Python and the command line tell of memory and of files that were mended."""

import warnings

import numpy as np
import pytest
from PIL import Image
from shapely.geometry import Polygon

import stippler
from stippler import cli, cli_ends
from stippler.drawing.area import Area
from stippler.errors import StipplerWarning
from stippler.jobs import preflight

RAMP = np.tile(np.linspace(0, 255, 40, dtype=np.uint8), (30, 1))


@pytest.fixture
def little(monkeypatch, tmp_path):
    """A machine that has a megabyte left."""
    (tmp_path / "meminfo").write_text("MemAvailable: 1024 kB\n")
    monkeypatch.setattr(preflight, "_MEMINFO", tmp_path / "meminfo")


@pytest.fixture(scope="module")
def drawing():
    return stippler.stipple(RAMP, dots=100, iterations=1)


def saved_picture(folder):
    path = folder / "ramp.png"
    Image.fromarray(RAMP).save(path)
    return path


def calls(drawing, folder):
    """Yield what is called, and what its warning says to do."""
    path = saved_picture(folder)
    few = {"dots": 50, "iterations": 1}
    square = np.array([(0, 0), (9, 0), (9, 9), (0, 9)], float)
    yield lambda: stippler.stipple(path, **few), "fewer dots"
    yield lambda: stippler.stipple(RAMP, **few), "fewer dots"
    yield lambda: stippler.stipple(Image.fromarray(RAMP), **few), "fewer dots"
    yield lambda: stippler.pulse_density(RAMP, 50), "fewer dots"
    yield lambda: stippler.process(drawing, 0, **few), "fewer areas"
    yield lambda: stippler.fill(square, 20), "fewer dots"
    yield lambda: stippler.relax([(1.0, 2.0), (5.0, 5.0)], square, 1), "an area at a time"
    yield lambda: drawing.save(folder / "out.png", dpi=50), "dots per inch"
    yield lambda: drawing.save(folder / "out.svg"), "dots per inch"
    yield lambda: drawing.save(folder / "out.stipple"), "close other programs"


@pytest.mark.parametrize("k", range(10))
def test_a_job_that_will_hardly_fit_is_warned_of_where_it_is_asked_for(
    little, drawing, tmp_path, k
):
    call, do = list(calls(drawing, tmp_path))[k]
    with pytest.warns(StipplerWarning, match=f"this may need .* are free; .*{do}") as told:
        call()
    assert [one.filename for one in told if one.category is StipplerWarning] == [__file__]


def test_nothing_is_said_of_jobs_that_fit(drawing, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error", StipplerWarning)
        for call, _ in calls(drawing, tmp_path):
            call()


def test_a_large_picture_is_counted_without_being_read(little, drawing):
    with pytest.warns(StipplerWarning) as small:
        stippler.pulse_density(RAMP, 50)
    with pytest.warns(StipplerWarning) as large:
        stippler.pulse_density(np.tile(RAMP, (40, 30)), 50)
    assert str(small[0].message).split()[3] != str(large[0].message).split()[3]


@pytest.fixture
def lines(monkeypatch):
    """What the command line says, of a process that asks for no warnings of Python's."""
    said = []
    monkeypatch.setattr(cli.sys, "warnoptions", [])
    monkeypatch.setattr(cli_ends, "fail", lambda text, code=0, do="": said.append(text) or code)
    with warnings.catch_warnings():
        yield said


def test_the_command_line_tells_them_in_a_line_each(little, tmp_path, lines):
    path, out = saved_picture(tmp_path), tmp_path / "out.stipple"
    assert cli.run(["render", str(path), "-o", str(out), "--dots", "50"]) == 0
    assert [line.rpartition("; ")[2] for line in lines] == [
        "ask for fewer dots, or a smaller picture",
        "close other programs first",
    ]
    lines.clear()
    again = str(tmp_path / "again.stipple")
    assert cli.run(["process", str(out), "--area", "0", "-o", again, "--dots", "40"]) == 0
    assert "fewer areas at a time" in lines[0]


def test_it_tells_what_was_mended_in_a_file(tmp_path, drawing, lines):
    broken = drawing.snapshot()
    broken.areas[3] = Area("bow", Polygon([(20, 20), (30, 30), (30, 20), (20, 30)]))
    path = tmp_path / "bow.stipple"
    broken.save(path)
    assert cli.run(["render", str(path), "-o", str(tmp_path / "out.svg")]) == 0
    assert [line for line in lines if "made anew" in line and "bow.stipple" in line]
    lines.clear()
    assert cli.run(["stats", str(path)]) == 0
    assert [line for line in lines if "made anew" in line]
