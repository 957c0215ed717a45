"""One engine: command line, Python and window draw the same dots, to the last bit."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from PIL import Image

import stippler
from stippler import cli
from stippler.drawing.dots import ON_CURVE, Dots
from stippler.drawing.line import Line
from stippler.drawing.planar.path import Path as LinePath
from stippler.drawing.style import Style
from stippler.drawing.style_presets import preset, preset_keys
from stippler.editor import processing
from stippler.editor.session import Session
from stippler.files.write.table import columns_of
from stippler.jobs.stippling import stipple_picture
from stippler.jobs.work import Work
from stippler.jobs.worker import Update
from stippler.kernels.machine.pool import set_threads
from stippler.stippling.pipeline import run
from stippler.stippling.task import SETTLE, Standing, Task
from stippler.stippling.tasks import relaxing

WIDTH_MM, N_DOTS, N_STEPS = 60.0, 250, 4


class SteppedWorker:
    """Does a job's next piece whenever it is asked for news: no thread, nothing is left out."""

    def __init__(self) -> None:
        self.n_jobs = self.n_results = 0
        self._job: Iterator[Any] = iter(())
        self._is_running = False

    def start(self, job: Any) -> int:
        self._job, self._is_running = job(), True
        self.n_jobs, self.n_results = self.n_jobs + 1, 0
        return self.n_jobs

    def stop(self) -> None:
        self._is_running = False

    def pause(self, paused: bool = True) -> None:
        pass

    def poll(self) -> Update[Work] | None:
        if not self._is_running:
            return None
        work = next(self._job, None)
        self.n_results += 1
        self._is_running = work is not None
        ended = "" if self._is_running else "finished"
        return Update(self.n_jobs, work, ended, None, self.n_results)


@pytest.fixture(scope="module")
def picture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A shaded ball on white, with a dark square beside it."""
    y, x = np.mgrid[-1:1:90j, -1.3:1.3:117j]
    inside = np.clip(1 - (x * x + y * y) / 0.5, 0, None)
    light = np.where(inside > 0, 0.15 + 0.8 * np.sqrt(inside) * (0.6 - 0.3 * x - 0.3 * y), 1.0)
    light[70:84, 95:110] = 0.3
    path = tmp_path_factory.mktemp("picture") / "ball.png"
    Image.fromarray((255 * np.clip(light, 0, 1)).astype(np.uint8)).save(path)
    return path


def session_of(style: Style) -> Session:
    return Session(
        SteppedWorker(),  # type: ignore[arg-type]
        SteppedWorker(),  # type: ignore[arg-type]
        style,
        tone="illustration",
        width_mm=WIDTH_MM,
        stipple=partial(stipple_picture, is_warm=lambda: True),
    )


def by_window(picture: Path, style: Style) -> Dots:
    session = session_of(style)
    session.open(picture)
    while session.busy:
        session.poll()
    assert session.document is not None
    return session.document.dots


def by_python(picture: Path, style: str) -> Dots:
    return stippler.stipple(picture, N_DOTS, WIDTH_MM, style=style, iterations=N_STEPS).dots


def by_command_line(picture: Path, style: str, folder: Path) -> np.ndarray[Any, Any]:
    path = folder / f"{style}.csv"
    status = cli.run([
        "render", str(picture), "-o", str(path), "--style", style,
        "--dots", str(N_DOTS), "--iterations", str(N_STEPS), "--width", str(WIDTH_MM),
    ])  # fmt: skip
    assert status == 0
    return np.genfromtxt(path, delimiter=",", names=True, dtype=np.float64)


def same(one: Dots, other: Dots) -> bool:
    ours, theirs = columns_of(one), columns_of(other)
    return ours.keys() == theirs.keys() and all(np.array_equal(ours[k], theirs[k]) for k in ours)


@pytest.mark.parametrize("style", preset_keys())
def test_every_style_is_drawn_alike_from_everywhere(picture, style, tmp_path) -> None:
    made = by_python(picture, style)
    assert len(made) > 0
    wanted = Style.of(preset(style), dots=N_DOTS, iterations=N_STEPS)
    assert same(made, by_window(picture, wanted))
    table = by_command_line(picture, style, tmp_path)
    for name, column in columns_of(made).items():
        if name in (table.dtype.names or ()):
            assert np.array_equal(table[name].astype(column.dtype), column), name
    assert {"x_mm", "y_mm", "radius_mm", "angle_rad", "seed"} <= set(table.dtype.names or ())


def resumed(picture: Path, style: Style) -> tuple[Dots, Task]:
    """Stop a run in the window by taking its dots over; return them at the end, and the task."""
    session = session_of(style)
    session.open(picture)
    while not (session.stage == "relax" and session.activity.done == 2):  # type: ignore[union-attr]
        session.poll()
    assert session.take_over()
    document = session.document
    assert document is not None
    dots = document.dots
    standing = Standing(dots.position_mm.copy(), dots.radius_mm.copy(), dots.fixed.copy())
    task = Task(style, document.drawing.reference, SETTLE, standing=standing, n_done=2)
    while session.busy:
        session.poll()
    return document.dots, task


def test_a_run_that_was_taken_over_ends_as_one_that_begins_with_its_dots(picture) -> None:
    style = Style(n_dots=N_DOTS, iterations=6)
    dots, task = resumed(picture, style)
    *_, made = run(task)
    assert np.array_equal(dots.position_mm, made.position_mm)
    assert np.array_equal(dots.radius_mm, made.radius_mm)
    assert not np.array_equal(made.position_mm, task.standing.position_mm)  # type: ignore[union-attr]


@pytest.mark.parametrize("how", ["lloyd", "even"])
def test_one_thread_and_two_draw_the_same_dots(picture, how) -> None:
    style = replace(Style(), n_dots=6_000, iterations=2, spacing=how)
    made = []
    try:
        for n in (1, 2):
            set_threads(n)
            whole = by_window(picture, style)
            made.append((whole, resumed(picture, replace(style, iterations=4))[0]))
    finally:
        set_threads(0)
    (one, one_resumed), (two, two_resumed) = made
    assert len(one) == 6_000
    assert same(one, two)
    assert same(one_resumed, two_resumed)


def lined(picture: Path) -> stippler.Drawing:
    """Return a drawing of two lines that dots adhere to, and of one that they keep off."""
    drawing = stippler.stipple(picture, N_DOTS, WIDTH_MM, iterations=N_STEPS)
    paths = ([(5, 10), (40, 30), (58, 12)], [(8, 40), (50, 5)], [(2, 42), (58, 44)])
    meetings = ("adhere", "adhere", "distance")
    drawing.lines = {
        k: Line(f"line {k}", LinePath.polyline(path), meeting=meeting, reach_mm=3.0)
        for k, (path, meeting) in enumerate(zip(paths, meetings, strict=True))
    }
    return drawing


def ended(session: Session) -> Dots:
    while session.busy:
        session.poll()
    assert session.document is not None
    return session.document.dots.by_id()


def held(dots: Dots) -> list[bytes]:
    return [a.tobytes() for a in (dots.constraint, dots.curve, dots.parameter)]


def test_dots_line_up_alike_from_everywhere(picture, tmp_path) -> None:
    drawing = lined(picture)
    made = stippler.process(drawing, 0).dots
    assert (made.constraint == ON_CURVE).sum() > 5
    session = session_of(drawing.style_of(0))
    session.show(drawing.snapshot())
    assert processing.process(session, [0])
    ours = ended(session)
    assert same(made, ours)
    assert held(made) == held(ours)
    drawing.save(tmp_path / "lined.stipple")
    out = tmp_path / "again.stipple"
    told = ["process", str(tmp_path / "lined.stipple"), "-o", str(out), "--area", "0"]
    assert cli.run(told) == 0
    theirs = stippler.open(out).dots
    assert same(made, theirs)
    assert held(made) == held(theirs)


@pytest.mark.parametrize("weighted", [False, True])
def test_relaxing_with_lines_is_the_same_in_the_window_and_by_its_task(picture, weighted) -> None:
    drawing = lined(picture)
    session = session_of(replace(drawing.style_of(0), weighted=weighted))
    session.show(drawing.snapshot())
    session.relax(6, weighted=weighted)
    ours = ended(session)
    frozen = replace(drawing, dots=drawing.dots.by_id())
    task, rows, _ = relaxing(frozen, replace(session.style, weighted=weighted), 6)
    *_, made = run(task)
    assert np.array_equal(ours.position_mm[rows], made.position_mm)
    assert made.holding is not None
    on = made.holding.curve >= 0
    assert on.sum() > 5
    assert np.array_equal(ours.curve[rows][on], made.holding.curve[on])
    assert np.array_equal(ours.parameter[rows][on], made.holding.along_mm[on])
    assert (ours.constraint[rows][on] == ON_CURVE).all()


def test_starting_anew_meets_the_lines_that_were_drawn(picture) -> None:
    session = session_of(Style(n_dots=N_DOTS, iterations=N_STEPS))
    session.open(picture)
    ended(session)
    document = session.document
    assert document is not None
    document.begin("Lines")
    for line in lined(picture).lines.values():
        document.add("line", line)
    document.commit()
    session.start()
    dots = ended(session)
    assert session.document is document
    off = document.drawing.lines[2]
    away = shapely.distance(
        shapely.linestrings(off.path.points_mm),  # type: ignore[attr-defined]
        shapely.points(dots.position_mm),
    )
    assert away.min() >= 0.1 + 0.3 - 1e-6
    assert (dots.constraint == ON_CURVE).sum() > 5
