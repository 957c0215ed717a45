"""The session with workers played by hand: no threads, no GL, a clock that is set."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stippler.drawing.adjustment import NEUTRAL, Adjustment
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.editor.messages import ERROR, INFO, WARNING
from stippler.editor.session import Session
from stippler.errors import OutputError, PictureError
from stippler.jobs.work import Source, Work
from stippler.jobs.worker import Update
from stippler.stippling.stipple import Progress
from stippler.stippling.tone import Shortfall


class HandWorker:
    """Records what it is asked; hands back the updates that a test puts in."""

    def __init__(self) -> None:
        self.jobs: list[Callable[[], Iterator[Any]]] = []
        self.calls: list[str] = []
        self.update: Update[Any] | None = None

    def start(self, run: Callable[[], Iterator[Any]]) -> int:
        self.jobs.append(run)
        self.update = None
        return len(self.jobs)

    def stop(self) -> None:
        self.calls.append("stop")

    def pause(self, paused: bool = True) -> None:
        self.calls.append("pause" if paused else "resume")

    def poll(self) -> Update[Any] | None:
        update, self.update = self.update, None
        return update


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


class Stage:
    """A session and everything around it."""

    def __init__(self) -> None:
        self.worker, self.exporter, self.clock = HandWorker(), HandWorker(), Clock()
        self.asked: list[tuple[Source, Style, Reference | None]] = []
        self.session = Session(
            self.worker,  # type: ignore[arg-type]
            self.exporter,  # type: ignore[arg-type]
            Style(n_dots=10),
            tone="linear",
            width_mm=100.0,
            stipple=self._stipple,
            clock=self.clock,
        )

    def _stipple(self, source: Source, style: Style, reference: Reference | None) -> Iterator[Work]:
        self.asked.append((source, style, reference))
        return iter(())

    def tell(self, work: Work | None, ended: str = "", request: int | None = None, **more: Any):
        request = len(self.worker.jobs) if request is None else request
        self.worker.update = Update(request, work, ended, more.get("failure"), 1)
        return self.session.poll()

    def last_job(self) -> tuple[Source, Style, Reference | None]:
        list(self.worker.jobs[-1]())
        return self.asked[-1]


@pytest.fixture
def stage() -> Stage:
    return Stage()


def reference(width_mm: float = 100.0) -> Reference:
    return Reference(np.full((20, 40), 0.5, np.float32), width_mm)


def dots(n: int, stage: str = "relax", done: int = 1, shift: float = 0.0) -> Progress:
    place = np.stack([np.linspace(1, 90, n), np.full(n, 10.0 + shift)], axis=1)
    return Progress(stage, done, 20, place, np.full(n, 0.2, np.float32))


def opened(stage: Stage, n: int = 5) -> Reference:
    """Open a picture and finish it."""
    picture = reference()
    stage.session.open(Path("shell.png"))
    stage.tell(Work("read", 1, 1, picture))
    stage.tell(Work("done", 1, 1, picture, dots(n, "done")), "finished")
    return picture


def test_a_picture_is_opened_stippled_and_becomes_a_drawing(stage: Stage) -> None:
    session = stage.session
    assert (session.phase, session.drawing, session.n_dots) == ("empty", None, 0)
    session.open(Path("shell.png"))
    assert (session.phase, session.stage, session.name) == ("running", "read", "shell.png")
    assert stage.last_job() == (Source(Path("shell.png"), "linear", 100.0), Style(n_dots=10), None)
    picture = reference()
    stage.tell(Work("read", 1, 1, picture))
    assert session.drawing is not None
    assert (session.drawing.page.width_mm, session.drawing.page.height_mm) == (100.0, 50.0)
    assert session.reference is picture
    before = session.document.revision
    stage.tell(Work("relax", 3, 20, picture, dots(5)))
    assert session.document.revision > before
    assert (session.n_dots, session.stage, session.done, session.total) == (5, "relax", 3, 20)
    assert len(session.drawing.dots) == 5  # a draft is in the drawing like all dots
    assert not session.paintable
    stage.tell(Work("done", 1, 1, picture, dots(7, "done")), "finished")
    assert (session.phase, session.busy, len(session.drawing.dots)) == ("done", False, 7)
    assert session.messages.log[-1].text == "7 dots drawn"


def test_an_adjusted_picture_makes_new_dots_as_a_step_that_can_be_undone(stage: Stage) -> None:
    session = stage.session
    picture = opened(stage, 5)
    document, lighter = session.document, Adjustment(brightness=0.2)
    assert not session.outdated
    session.adjustment = lighter
    assert session.outdated
    session.start()
    source, _, known = stage.last_job()
    assert source == Source(Path("shell.png"), "linear", 100.0, lighter)
    assert known is picture  # not read again
    adjusted = picture.adjusted(lighter)
    stage.tell(Work("done", 1, 1, adjusted, dots(7, "done")), "finished")
    assert session.document is document
    assert document is not None
    assert document.drawing.reference is session.reference is adjusted  # as brushes see it
    assert not session.outdated
    assert session.n_dots == 7
    session.undo()
    assert session.n_dots == 5
    assert session.reference == picture  # undoing all gives what was there at first
    assert session.outdated


def test_adjustments_belong_to_their_picture(stage: Stage) -> None:
    session = stage.session
    opened(stage)
    session.adjustment = Adjustment(invert=True)
    session.open(Path("missing.png"))
    assert stage.last_job()[0].adjustment == NEUTRAL
    failure = PictureError("no such file", "missing.png")
    stage.tell(None, "failed", failure=failure)
    assert session.adjustment.invert
    session.open(Path("shell.png"))
    assert stage.last_job()[0].adjustment.invert
    session.open(Path("other.png"))
    stage.tell(Work("read", 1, 1, reference(50.0)))
    assert session.adjustment == NEUTRAL


def test_results_of_an_old_request_change_nothing(stage: Stage) -> None:
    session = stage.session
    session.open(Path("old.png"))
    session.open(Path("new.png"))
    revision = session.revision
    assert not stage.tell(Work("done", 1, 1, reference(), dots(9)), "finished", request=1)
    assert (session.phase, session.name, session.n_dots) == ("running", "new.png", 0)
    assert session.revision == revision
    stage.tell(Work("done", 1, 1, reference(), dots(3)), "finished", request=2)
    assert (session.phase, session.n_dots) == ("done", 3)


def test_stop_keeps_the_dots_and_ignores_what_comes_later(stage: Stage) -> None:
    session = stage.session
    session.open(Path("shell.png"))
    picture = reference()
    stage.tell(Work("relax", 1, 20, picture, dots(5)))
    # one more result waits when stop is pressed: it is not lost
    stage.worker.update = Update(1, Work("relax", 2, 20, picture, dots(6, shift=1.0)), "", None, 2)
    session.stop()
    assert stage.worker.calls == ["stop"]
    assert (session.phase, session.busy, session.n_dots) == ("stopped", False, 6)
    assert session.drawing is not None
    np.testing.assert_array_equal(session.drawing.dots.position_mm[:, 1], 11.0)
    assert not stage.tell(Work("relax", 3, 20, picture, dots(8)), request=1)
    assert len(session.drawing.dots) == 6


def test_stop_before_the_first_dots_keeps_those_of_the_last_job(stage: Stage) -> None:
    opened(stage, 5)
    stage.session.start()
    stage.session.stop()
    assert stage.session.drawing is not None
    assert (stage.session.phase, len(stage.session.drawing.dots)) == ("stopped", 5)


def test_stop_at_the_very_end_is_no_stop(stage: Stage) -> None:
    stage.session.open(Path("shell.png"))
    stage.worker.update = Update(1, Work("done", 1, 1, reference(), dots(4)), "finished", None, 9)
    stage.session.stop()
    assert stage.session.phase == "done"
    assert stage.worker.calls == []


def test_pause_and_resume(stage: Stage) -> None:
    session = stage.session
    session.pause()  # nothing runs: nothing happens
    session.open(Path("shell.png"))
    session.resume()
    session.pause()
    assert (session.phase, session.busy) == ("paused", True)
    stage.tell(Work("relax", 1, 20, reference(), dots(5)))  # one was on its way
    assert (session.phase, session.n_dots) == ("paused", 5)
    session.resume()
    assert session.phase == "running"
    assert stage.worker.calls == ["pause", "resume"]


def test_start_uses_the_plan_and_what_has_been_read(stage: Stage) -> None:
    picture = opened(stage)
    session = stage.session
    assert not session.outdated
    assert session.edit_style(n_dots=99, seed=7)
    assert session.outdated
    session.start()
    source, style, known = stage.last_job()
    assert (style.n_dots, style.seed) == (99, 7)
    assert known is picture
    assert not session.outdated
    session.tone = "perceptual"
    assert session.outdated
    session.start()  # another tone is another reference
    source, style, known = stage.last_job()
    assert (source.tone, known) == ("perceptual", None)


def test_start_with_nothing_open_says_so(stage: Stage) -> None:
    stage.session.start()
    assert stage.worker.jobs == []
    assert stage.session.messages.log[-1].level == WARNING


def test_restart_while_it_runs_takes_the_same_picture(stage: Stage) -> None:
    stage.session.open(Path("shell.png"))
    stage.session.edit_style(iterations=3)
    stage.session.start()
    source, style, _ = stage.last_job()
    assert (source.path.name, style.iterations) == ("shell.png", 3)


@pytest.mark.parametrize(
    "changes",
    [
        {"n_dots": 0},
        {"n_dots": 10**9},
        {"iterations": -1},
        {"seed": -1},
        {"size_range_mm": (0.4, 0.2)},
        {"size_range_mm": (float("nan"), 1.0)},
        {"first_dots": "sneeze"},
    ],
)
def test_a_bad_value_is_refused_with_a_line(stage: Stage, changes: dict[str, Any]) -> None:
    style = stage.session.style
    assert not stage.session.edit_style(**changes)
    assert stage.session.style is style
    line = stage.session.messages.current
    assert line is not None
    assert line.level == WARNING
    assert "\n" not in line.text


def test_a_picture_that_cannot_be_read_leaves_the_open_one(stage: Stage) -> None:
    opened(stage, 5)
    session = stage.session
    session.open(Path("notes.txt"))
    failure = PictureError("is no picture we read", "notes.txt", "give a PNG")
    stage.tell(None, "failed", failure=failure)
    assert (session.phase, session.name, session.n_dots) == ("failed", "shell.png", 5)
    line = session.messages.current
    assert line is not None
    assert (line.level, line.text) == (ERROR, str(failure))
    session.start()
    assert stage.last_job()[0].path.name == "shell.png"


def test_a_first_picture_that_cannot_be_read_leaves_the_desk_empty(stage: Stage) -> None:
    stage.session.open(Path("notes.txt"))
    stage.tell(None, "failed", failure=PictureError("is no picture"))
    assert (stage.session.phase, stage.session.drawing) == ("empty", None)


def test_an_all_white_picture_is_a_drawing_without_dots(stage: Stage) -> None:
    stage.session.open(Path("snow.png"))
    stage.tell(Work("done", 1, 1, reference(), dots(0, "done")), "finished")
    assert stage.session.phase == "done"
    assert stage.session.drawing is not None
    assert "all white" in stage.session.messages.log[-1].text


def test_what_a_drawing_falls_short_of_is_said(stage: Stage) -> None:
    stage.session.open(Path("night.png"))
    lack = Shortfall(share=0.25, missing=0.1)
    last = replace(dots(4, "done"), shortfall=lack)
    stage.tell(Work("done", 1, 1, reference(), last), "finished")
    line = stage.session.messages.log[-1]
    assert line.level == WARNING
    assert "25.0 % of the page" in line.text


def test_steps_a_second_come_from_the_clock(stage: Stage) -> None:
    stage.session.open(Path("shell.png"))
    for done in range(0, 61, 2):  # 2 steps every 50 ms
        stage.tell(Work("relax", done, 100, reference(), dots(3)))
        stage.clock.now += 0.05
    assert stage.session.steps_per_s == pytest.approx(40.0)
    for done in range(61, 101):  # then 10 steps a second: the last second counts
        stage.clock.now += 0.05
        stage.tell(Work("relax", 60 + (done - 60) // 2, 100, reference(), dots(3)))
    assert stage.session.steps_per_s == pytest.approx(10.0, rel=0.1)


def test_export_writes_a_copy_beside_the_job(stage: Stage, tmp_path: Path) -> None:
    session = stage.session
    session.export(tmp_path / "early.csv", 300.0)
    assert stage.exporter.jobs == []
    opened(stage, 5)
    session.start()
    path = tmp_path / "out.csv"
    session.export(path, 300.0)
    assert session.exporting
    assert session.busy
    session.export(tmp_path / "other.csv", 300.0)  # one at a time
    assert len(stage.exporter.jobs) == 1
    stage.tell(Work("relax", 1, 20, reference(), dots(9)))  # the job goes on
    assert list(stage.exporter.jobs[0]()) == [path]
    assert len(path.read_text().splitlines()) == 1 + 5
    stage.exporter.update = Update(1, path, "finished", None, 1)
    assert session.poll()
    assert not session.exporting
    assert session.messages.log[-1].level == INFO
    assert str(path) in session.messages.log[-1].text


def test_an_export_in_the_midst_of_a_job_holds_the_dots_that_are_shown(
    stage: Stage, tmp_path: Path
) -> None:
    stage.session.open(Path("shell.png"))
    stage.tell(Work("relax", 1, 20, reference(), dots(9)))
    stage.session.export(tmp_path / "out.csv", 300.0)
    list(stage.exporter.jobs[0]())
    assert len((tmp_path / "out.csv").read_text().splitlines()) == 1 + 9


@pytest.mark.parametrize("name", ["shell.svg", "soft.svg", "hard.svg"])
def test_an_export_never_writes_over_the_picture(
    stage: Stage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("shell.svg").write_bytes(b"a picture, whatever its name")
    Path("soft.svg").symlink_to("shell.svg")
    Path("hard.svg").hardlink_to("shell.svg")
    stage.session.open(Path("shell.svg"))
    stage.tell(Work("relax", 1, 20, reference(), dots(9)))
    stage.session.export(tmp_path / name, 300.0)
    with pytest.raises(OutputError, match="the very file that is read"):
        list(stage.exporter.jobs[0]())
    assert Path("shell.svg").read_bytes() == b"a picture, whatever its name"


def test_an_export_that_fails_says_why(stage: Stage, tmp_path: Path) -> None:
    opened(stage)
    stage.session.export(tmp_path / "out.csv", 300.0)
    failure = PictureError("the disk is full", tmp_path / "out.csv")
    stage.exporter.update = Update(1, None, "failed", failure, 0)
    stage.session.poll()
    assert stage.session.messages.log[-1].level == ERROR
    assert not stage.session.exporting


# --- what no file holds yet ----------------------------------------------------------------


def written(stage: Stage, path: Path) -> None:
    """Let an export or a save, by the file's ending, end well."""
    n = len(stage.exporter.jobs)
    if path.suffix == ".stipple":
        stage.session.save(path)
    else:
        stage.session.export(path, 300.0)
    stage.exporter.update = Update(n + 1, path, "finished", None, 1)
    stage.session.poll()


def erased(stage: Stage, *rows: int) -> None:
    document = stage.session.document
    assert document is not None
    document.begin("Erase")
    document.remove(np.array(rows))
    document.commit()


def test_work_of_a_hand_is_unsaved_until_a_file_holds_it(stage: Stage, tmp_path: Path) -> None:
    opened(stage, 5)
    session, path = stage.session, tmp_path / "out.stipple"
    assert not session.unsaved
    erased(stage, 0)
    assert session.unsaved
    written(stage, tmp_path / "out.csv")
    assert session.unsaved  # an export holds the dots alone
    written(stage, path)
    assert not session.unsaved
    assert session.exports.file == path
    session.undo()
    assert not session.unsaved  # nothing of a hand is in the drawing
    session.redo()
    erased(stage, 0)
    assert session.unsaved
    session.undo()
    assert not session.unsaved  # as the file has it


def test_a_relaxation_after_the_export_is_unsaved_only_with_a_hands_work(
    stage: Stage, tmp_path: Path
) -> None:
    opened(stage, 5)
    session = stage.session
    session.relax(1, weighted=True)
    stage.tell(Work("relax", 1, 1, moved_mm=session.document.dots.position_mm + 0.01), "finished")
    assert session.document.history.n_done == 1
    assert not session.unsaved
    erased(stage, 1)
    written(stage, tmp_path / "out.stipple")
    assert not session.unsaved
    session.relax(1, weighted=True)
    assert session.unsaved  # the file's dots are not those that move now


def test_a_stroke_under_way_is_unsaved(stage: Stage) -> None:
    opened(stage, 5)
    stage.session.document.begin("Erase")
    assert stage.session.unsaved


def test_an_export_that_ends_when_another_drawing_is_open_is_not_that_drawings(
    stage: Stage, tmp_path: Path
) -> None:
    opened(stage, 5)
    session, path = stage.session, tmp_path / "out.csv"
    session.export(path, 300.0)
    session.open(Path("other.png"))
    stage.tell(Work("done", 1, 1, reference(), dots(4, "done")), "finished")
    erased(stage, 0)
    stage.exporter.update = Update(1, path, "finished", None, 1)
    session.poll()
    assert session.exports.path is None
    assert session.unsaved


# --- results that cannot be taken, restarts, and the end of a run ---------------------------


def test_a_result_that_cannot_be_taken_ends_the_work_and_the_drawing_lives(stage: Stage) -> None:
    opened(stage, 5)
    session = stage.session
    before = session.document.dots.position_mm.copy()
    session.relax(9, weighted=True)
    stage.tell(Work("relax", 1, 9, moved_mm=before + 0.5))
    assert stage.tell(Work("relax", 2, 9, moved_mm=np.zeros((99, 2))))  # of no run of ours
    assert (session.busy, session.phase) == (False, "failed")
    assert "a result could not be taken" in session.messages.log[-1].text
    assert session.messages.log[-1].level == ERROR
    assert session.paintable
    assert np.array_equal(session.document.dots.position_mm, before + 0.5)  # what came before stays
    session.undo()
    assert np.array_equal(session.document.dots.position_mm, before)


def test_a_restart_shows_other_dots_at_once_and_leaves_one_step(stage: Stage) -> None:
    opened(stage, 5)
    session, document = stage.session, stage.session.document
    document.begin("Fix")
    document.change("constraint", np.arange(5), np.ones(5, np.int8))
    document.commit()
    for shift in (1.0, 2.0):  # begun, and begun again before the end
        session.edit_style(seed=int(shift))
        session.start()
        cursor = document.changes.now
        stage.tell(Work("relax", 4, 20, session.reference, dots(5, shift=shift)))
        assert document.changes.since(cursor).rows is None  # all of them, as many as before
        assert not document.dots.fixed.any()
    stage.tell(Work("done", 1, 1, session.reference, dots(5, "done", shift=3.0)), "finished")
    assert [step.label for step in document.history.steps] == ["Fix", "Stipple"]
    session.undo()
    assert document.dots.fixed.all()
    assert session.drawing.style_of(0) == Style(n_dots=10)


def test_a_picture_that_fails_while_dots_are_made_keeps_those(stage: Stage) -> None:
    opened(stage, 5)
    session = stage.session
    session.start()
    stage.tell(Work("relax", 4, 20, session.reference, dots(7)))
    session.open(Path("bad.png"))
    assert session.n_dots == 7
    stage.tell(None, "failed", failure=PictureError("is no picture"))
    assert (session.n_dots, session.name, session.paintable) == (7, "shell.png", True)
    assert not session.document.in_draft


def test_all_dots_are_looked_at_again_when_a_run_ends(stage: Stage) -> None:
    opened(stage, 5)
    session = stage.session
    session.relax(1, weighted=True)
    moved = session.document.dots.position_mm + 0.01
    stage.tell(Work("relax", 1, 1, moved_mm=moved))
    cursor = session.document.changes.now
    stage.tell(None, "finished")
    assert session.document.changes.since(cursor).rows is None
