"""The command line as a person meets it: whole processes, exit codes, one line for each fault."""

import csv
import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from stippler.cli import COMMANDS
from stippler.files.write.table import FIRST_COLUMNS
from stippler.start import main

WAIT_S = 120


def run(*args, **env):
    return subprocess.run(
        [sys.executable, "-m", "stippler", *map(str, args)],
        capture_output=True,
        text=True,
        timeout=WAIT_S,
        env={**os.environ, **env},
        check=False,
    )


def run_here(monkeypatch, capsys, *args):
    """The same without a process of its own, for what ends before any work."""
    monkeypatch.setattr(sys, "argv", ["stippler", *map(str, args)])
    numbers = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGALRM)
    handlers = [signal.getsignal(number) for number in numbers]
    hook = sys.unraisablehook
    with pytest.raises(SystemExit) as stopped:
        main()
    sys.unraisablehook = hook
    for number, handler in zip(numbers, handlers, strict=True):
        signal.signal(number, handler)
    out, err = capsys.readouterr()
    return subprocess.CompletedProcess(args, stopped.value.code, out, err)


def ball(size=160):
    y, x = np.mgrid[-1 : 1 : size * 1j, -1 : 1 : size * 1j]
    r2 = (x * x + y * y) / 0.64
    light = 0.1 + 0.9 * np.clip(0.8 * np.sqrt(np.clip(1 - r2, 0, 1)) - 0.4 * x - 0.4 * y, 0, 1)
    return (255 * np.where(r2 < 1, light, 1)).astype(np.uint8)


@pytest.fixture(scope="module")
def picture(tmp_path_factory):
    path = tmp_path_factory.mktemp("cli") / "ball.png"
    Image.fromarray(ball()).save(path)
    return path


def assert_one_line(result, status, *words):
    assert result.returncode == status, result.stderr
    assert result.stderr.count("\n") == 1, result.stderr
    assert result.stderr.startswith("stippler: ")
    assert "Traceback" not in result.stderr
    for word in words:
        assert word in result.stderr


def test_render_svg_is_repeatable_for_any_number_of_threads(picture, tmp_path):
    files = []
    for threads in (1, 2, 5):
        out = tmp_path / f"{threads}.svg"
        result = run("render", picture, "-o", out, "--dots", 1500, STIPPLER_THREADS=str(threads))
        assert result.returncode == 0, result.stderr
        assert result.stderr == ""  # no bars where stderr is no terminal
        files.append(out.read_bytes())
    assert files[0] == files[1] == files[2]
    assert files[0].count(b"<svg") == 1


def test_another_seed_is_another_drawing(picture, tmp_path):
    for seed in (1, 2):
        assert run("render", picture, "-o", tmp_path / f"{seed}.csv", "--dots", 500,
                   "--seed", seed).returncode == 0  # fmt: skip
    assert (tmp_path / "1.csv").read_bytes() != (tmp_path / "2.csv").read_bytes()


def test_every_way_of_making_is_another_drawing(picture, tmp_path):
    ways = [[], ["--growth", "triangular"], ["--start", "border"], ["--unweighted"],
            ["--sizes", "regions"],
            ["--first-dots", "floyd-steinberg"], ["--first-dots", "random"],
            ["--first-dots", "hexagonal"], ["--tone", "perceptual"],
            ["--pen", "brush"]]  # fmt: skip
    files = set()
    for k, way in enumerate(ways):
        out = tmp_path / f"{k}.csv"
        result = run("render", picture, "-o", out, "--dots", 600, "--iterations", 3, *way)
        assert result.returncode == 0, result.stderr
        files.add(out.read_bytes())
    assert len(files) == len(ways)


def test_render_csv_has_the_dots_asked_for_on_the_page(picture, tmp_path):
    out = tmp_path / "dots.csv"
    result = run("render", picture, "-o", out, "--dots", 2000, "--width", 80, "--iterations", 5)
    assert result.returncode == 0, result.stderr
    with out.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert list(rows[0]) == FIRST_COLUMNS.split(",")
    assert abs(len(rows) - 2000) <= 20
    xy = np.array([[float(row["x_mm"]), float(row["y_mm"])] for row in rows])
    assert xy.min() >= 0
    assert xy.max() <= 80
    # the paper around the ball is white, and stays so
    assert np.hypot(*(xy - 40).T).max() < 0.8 * 40 + 0.6


def test_render_png_has_its_size_and_resolution(picture, tmp_path):
    out = tmp_path / "dots.png"
    result = run("render", picture, "-o", out, "--dots", 800, "--width", 50.8, "--dpi", 100)
    assert result.returncode == 0, result.stderr
    with Image.open(out) as image:
        assert image.size == (200, 200)
        assert image.info["dpi"] == pytest.approx((100, 100), abs=0.1)
        grey = np.asarray(image.convert("L"), float) / 255
    dark = 1 - ball() / 255
    assert grey[:10, :10].min() == 1.0
    # linear tone puts down more ink than the encoded numbers say, and less than a black disc
    assert dark.mean() < 1 - grey.mean() < np.pi * 0.64 / 4


def test_stats_of_a_table_are_those_of_its_picture(picture, tmp_path, monkeypatch, capsys):
    made = ["--dots", 1500, "--width", 80, "--iterations", 5]
    out = tmp_path / "dots.csv"
    assert run("render", picture, "-o", out, *made).returncode == 0
    ask = ["--reference", picture, "--width", 80, "--json"]
    of_table = json.loads(run_here(monkeypatch, capsys, "stats", out, *ask).stdout)
    of_picture = json.loads(run_here(monkeypatch, capsys, "stats", picture, *made, "--json").stdout)
    turned = of_table.pop("direction_db") - of_picture.pop("direction_db")
    assert abs(turned) < 0.2  # decibels about 0; a dot on the rim of the middle square counts
    assert of_table == pytest.approx(of_picture, rel=0.02, abs=1e-4)
    assert len(of_table) > 15
    assert of_table["tone_rmse"] < 0.02
    assert abs(of_table["dots"] - 1500) <= 15
    white = [*made, "--polarity", "white-on-black", "--json"]
    white_dots = json.loads(run_here(monkeypatch, capsys, "stats", picture, *white).stdout)
    assert white_dots["tone_rmse"] < 0.05
    alone = run_here(monkeypatch, capsys, "stats", out)
    assert alone.stdout.startswith("dots ")
    assert "tone" not in alone.stdout


def test_stats_of_a_drawing_know_its_picture(picture, tmp_path, monkeypatch, capsys):
    made = ["--dots", 900, "--width", 80, "--iterations", 3]
    out = tmp_path / "dots.stipple"
    assert run("render", picture, "-o", out, *made).returncode == 0
    kept = json.loads(run_here(monkeypatch, capsys, "stats", out, "--json").stdout)
    drawn = json.loads(run_here(monkeypatch, capsys, "stats", picture, *made, "--json").stdout)
    assert kept == pytest.approx(drawn, rel=1e-6, abs=1e-9)
    given = run_here(monkeypatch, capsys, "stats", out, "--reference", picture, "--json").stdout
    assert json.loads(given) == pytest.approx(drawn, rel=1e-6, abs=1e-9)
    told = run_here(monkeypatch, capsys, "stats", out, "--dots", 5)
    assert_one_line(told, 2, "dots.stipple", "is drawn already")
    bad = tmp_path / "bad.stipple"
    bad.write_bytes(out.read_bytes()[:500])
    assert_one_line(run_here(monkeypatch, capsys, "stats", bad), 1, "bad.stipple")


@pytest.mark.parametrize(
    ("args", "status", "words"),
    [
        (["dots.csv", "--dots", "5"], 2, ["dots.csv", "is drawn already"]),
        (["dots.csv", "--reference", "{picture}", "--width", "5"], 1, ["dots.csv", "--width"]),
        (["dots.csv", "--reference", "none.png"], 1, ["none.png", "no such file"]),
        (["bad.csv"], 1, ["bad.csv, line 2", "9"]),
        (["none.csv"], 1, ["none.csv", "no such file"]),
        (["{picture}", "--reference", "{picture}"], 2, ["reference"]),
        (["{picture}", "--width", "nan"], 2, ["page"]),
    ],
)
def test_stats_of_what_cannot_be_measured(
    picture, tmp_path, monkeypatch, capsys, args, status, words
):
    monkeypatch.chdir(tmp_path)
    Path("dots.csv").write_text(f"{FIRST_COLUMNS}\n9,9,0.5,1,0,0,1,0,0\n")
    Path("bad.csv").write_text(f"{FIRST_COLUMNS}\n9,9\n")
    args = [part.format(picture=picture) for part in args]
    assert_one_line(run_here(monkeypatch, capsys, "stats", *args), status, *words)


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["--dots", "0"], ["dots", "1 to"]),
        (["--dots", "-5"], ["dots"]),
        (["--dots", "1000000000"], ["dots"]),
        (["--dots", "many"], ["--dots", "valid int", "render --help"]),
        (["--dots", "1.5"], ["--dots", "valid int"]),
        (["--width", "nan"], ["page", "nan"]),
        (["--width", "inf"], ["page", "inf"]),
        (["--width", "0"], ["page", "0.01 to"]),
        (["--width", "-3"], ["page"]),
        (["--iterations", "-1"], ["iterations"]),
        (["--seed", "-1"], ["seed"]),
        (["--dpi", "nan"], ["dpi"]),
        (["--dpi", "0"], ["dpi"]),
        (["--size-range", "big"], ["size range", "MIN:MAX"]),
        (["--size-range", "0.3:0.1"], ["size range"]),
        (["--size-range", "nan:1"], ["size range"]),
        (["--tone", "loud"], ["loud", "illustration, linear or perceptual"]),
        (["--first-dots", "magic"], ["magic", "pulse-density"]),
        (["--growth", "square"], ["square", "circular"]),
        (["--start", "middle"], ["middle", "border"]),
        (["--pen", "biro"], ["biro", "quill"]),
        (["--nonsense"], ["--nonsense"]),
    ],
)
def test_wrong_options_are_usage_errors(picture, tmp_path, monkeypatch, capsys, args, words):
    out = tmp_path / "out.png"
    result = run_here(monkeypatch, capsys, "render", picture, "-o", out, *args)
    assert_one_line(result, 2, *words)
    assert list(tmp_path.iterdir()) == []


def test_a_missing_argument(monkeypatch, capsys):
    assert_one_line(run_here(monkeypatch, capsys, "render"), 2, "file", "--help")


@pytest.mark.parametrize("command", [["render", "-o", "{out}"], ["edit"], []])
@pytest.mark.parametrize(
    ("name", "words"),
    [("none.png", ["no such file"]), ("folder", ["is a folder"]), ("empty.png", ["is empty"]),
     ("text.png", ["no picture"])],
)  # fmt: skip
def test_files_that_are_no_picture(tmp_path, monkeypatch, capsys, command, name, words):
    (tmp_path / "folder").mkdir()
    (tmp_path / "empty.png").write_bytes(b"")
    (tmp_path / "text.png").write_text("hello")
    command = [part.format(out=tmp_path / "out.svg") for part in command]
    result = run_here(monkeypatch, capsys, *command, tmp_path / name)
    assert_one_line(result, 1, name, *words)
    assert not (tmp_path / "out.svg").exists()


@pytest.mark.parametrize(
    ("out", "words"),
    [("none/out.svg", ["does not exist"]), ("out.doc", [".doc", ".dxf or .stipple"]),
     ("out", ["no ending"]), ("folder.svg", ["is a folder"])],
)  # fmt: skip
def test_outputs_that_cannot_be_written(picture, tmp_path, monkeypatch, capsys, out, words):
    (tmp_path / "folder.svg").mkdir()
    result = run_here(monkeypatch, capsys, "render", picture, "-o", tmp_path / out)
    assert_one_line(result, 1, *words)


def test_a_full_disk(picture, tmp_path):
    out = tmp_path / "out.csv"
    out.symlink_to("/dev/full")
    assert_one_line(run("render", picture, "-o", out, "--dots", 400), 1, "disk is full")


@pytest.mark.parametrize("ending", ["svg", "png", "csv"])
def test_a_white_picture_is_a_drawing_without_dots(tmp_path, ending):
    Image.new("L", (50, 40), 255).save(tmp_path / "white.png")
    out = tmp_path / f"out.{ending}"
    result = run("render", tmp_path / "white.png", "-o", out)
    assert_one_line(result, 0, "white", "no dots")
    assert out.stat().st_size > 0
    if ending == "csv":
        assert out.read_text() == FIRST_COLUMNS + "\n"


def test_an_interrupt_leaves_the_old_file(picture, tmp_path):
    out = tmp_path / "out.svg"
    out.write_bytes(b"before")
    process = subprocess.Popen(
        [sys.executable, "-m", "stippler", "render", picture, "-o", out, "--dots", "30000",
         "--iterations", "100000"],
        stderr=subprocess.PIPE, text=True,
        # a shell that puts the tests into the background has them ignore Ctrl-C, and all they start
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    # it would run for minutes; let it begin, then press Ctrl-C
    timer = threading.Timer(2.0, process.send_signal, [signal.SIGINT])
    timer.start()
    try:
        _, stderr = process.communicate(timeout=WAIT_S)
    finally:
        timer.cancel()
        process.kill()
    assert process.returncode == 130
    assert stderr == "stippler: stopped; nothing was written\n"
    assert out.read_bytes() == b"before"
    assert [p.name for p in tmp_path.iterdir()] == ["out.svg"]


def test_pictures_need_no_gl_driver(picture, tmp_path):
    env = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "EGL_PLATFORM": "none"}
    result = run("render", picture, "-o", tmp_path / "out.png", "--dots", 200, **env)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "out.png").stat().st_size > 1000


def test_no_display(picture):
    env = {k: "" for k in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR")}
    assert_one_line(run("edit", picture, **env), 1, "display")


def test_help_names_every_command(monkeypatch, capsys):
    result = run_here(monkeypatch, capsys, "--help")
    assert result.returncode == 0
    for command in COMMANDS:
        assert command in result.stdout
        assert run_here(monkeypatch, capsys, command, "--help").returncode == 0


def test_info_names_the_driver_and_the_folders():
    result = run("info")
    assert result.returncode == 0
    for word in ("OpenGL", "cores", "numba", str(Path("shaders"))):
        assert word in result.stdout


def test_help_imports_nothing_heavy():
    code = (
        "import sys; sys.argv = ['stippler', '--help']\n"
        "from stippler.start import main\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "print([m for m in ('numpy', 'numba', 'PIL', 'shapely', 'moderngl', 'glfw', 'rich')"
        " if m in sys.modules], file=sys.stderr)"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=WAIT_S, check=True
    )
    assert result.stderr.strip() == "[]"


def test_check_counts_and_repairs(tmp_path):
    table, out = tmp_path / "dots.csv", tmp_path / "mended.svg"
    table.write_text("x_mm,y_mm,radius_mm\n5,5,0.5\n6.02,5,0.5\n20,20,0.5\n12,12,0.02\n")
    result = run("check", table, "--least-gap", 0.1, "-o", out)
    assert result.returncode == 0, result.stderr
    assert "1 dots are smaller" in result.stdout
    assert "1 gaps between dots are narrower" in result.stdout
    assert "repaired; left: nothing" in result.stdout
    assert out.read_text().count("<circle") == 3


def test_calibrate_tells_the_gain(tmp_path):
    assert run("calibrate", "-o", tmp_path / "sheet.pdf").returncode == 0
    result = run("calibrate", "--measured", ".1,.2,.3,.4,.5,.6,.7")
    assert result.stdout.startswith("--gain ")
    assert abs(float(result.stdout.split()[1])) < 0.002
    assert_one_line(run("calibrate", "--measured", "1,2"), 2, "7 shares")
