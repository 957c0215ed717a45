"""Areas processed by a session: results in any order of polls, cancelled, late, locked."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely.geometry import box

from stippler.drawing.area import Area
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.editor import processing
from stippler.editor.session import Session
from stippler.jobs.work import Work
from tests.ui.test_session import Stage

FIELDS = ("id", "position_mm", "radius_mm", "area", "constraint")


@pytest.fixture
def stage() -> Stage:
    stage = Stage()
    drawing = Drawing.blank(Page(60.0, 40.0), Style(n_dots=300, iterations=2))
    drawing.reference = Reference(np.full((40, 60), 0.5, np.float32), 60.0)
    drawing.styles[1] = Style(n_dots=60, iterations=2)
    for k, x in ((1, 5), (2, 25), (3, 45)):
        drawing.areas[k] = Area(f"box {k}", box(x, 5, x + 12, 35), style=1)
    stage.session.show(drawing)
    document = stage.session.document
    assert document is not None
    document.begin("Fill")
    document.insert(Dots.round(np.random.default_rng(0).random((500, 2)) * (60, 40), 0.2))
    document.commit()
    return stage


def state(session: Session, areas: tuple[int, ...] | None = None) -> list[np.ndarray]:
    assert session.document is not None
    dots = session.document.dots.by_id()
    rows = slice(None) if areas is None else np.isin(dots.area, areas)
    return [getattr(dots, name)[rows].copy() for name in FIELDS]


def same(one: list[np.ndarray], two: list[np.ndarray]) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(one, two, strict=True))


def results(stage: Stage) -> list[Work]:
    return list(stage.worker.jobs[-1]())


def steps(session: Session) -> list[str]:
    assert session.document is not None
    return [step.label for step in session.document.history.steps]


@pytest.mark.parametrize("every", [1, 3, 7, 10_000])
def test_however_seldom_one_looks_the_same_areas_come_out(stage: Stage, every: int) -> None:
    session = stage.session
    start, others = state(session), state(session, (0, 2))
    assert processing.process(session, [3, 1])
    assert session.busy
    made = results(stage)
    for k, work in enumerate(made[:-1]):
        if k % every == 0:
            stage.tell(work)
            assert same(state(session, (2,)), state(session, (2,)))
    stage.tell(made[-1], "finished")
    assert not session.busy
    assert same(state(session, (0, 2)), others)
    last = dict(made[-1].finished)
    for area in (1, 3):
        rows = session.document.dots.area == area
        assert np.array_equal(session.document.dots.position_mm[rows], last[area].position_mm)
    assert steps(session) == ["Fill", "Process box 3", "Process box 1"]
    assert session.messages.log[-1].text == "2 of 2 areas drawn"
    session.undo()
    session.undo()
    assert same(state(session), start)


def test_stopping_keeps_what_is_done_and_leaves_the_rest_as_it_was(stage: Stage) -> None:
    session = stage.session
    start = state(session, (0, 2, 3))
    processing.process(session, [1, 2, 3])
    made = results(stage)
    in_second = next(w for w in made if w.area == 2 and w.stage == "relax")
    stage.tell(in_second)
    assert not same(state(session, (0, 2, 3)), start)  # the second one's dots are seen
    session.stop()
    assert session.phase == "stopped"
    assert same(state(session, (0, 2, 3)), start)
    assert steps(session) == ["Fill", "Process box 1"]
    assert session.messages.log[-1].text == "1 of 3 areas drawn"
    assert not stage.tell(made[-1], "finished", request=1)  # late
    assert same(state(session, (0, 2, 3)), start)


@pytest.fixture
def dark_halves(stage: Stage) -> Stage:
    """Two dark areas beside each other, whose dots reach over the wall between them."""
    drawing = Drawing.blank(Page(60.0, 40.0), Style(n_dots=300, iterations=4, border="wall"))
    drawing.reference = Reference(np.full((40, 60), 0.85, np.float32), 60.0)
    drawing.styles[1] = Style(n_dots=80, iterations=4, border="wall")
    drawing.areas[1] = Area("left", box(10, 10, 25, 25), style=1)
    drawing.areas[2] = Area("right", box(25, 10, 40, 25), style=1)
    stage.session.show(drawing)
    document = stage.session.document
    document.begin("Fill")
    document.insert(Dots.round(np.random.default_rng(0).random((50, 2)) * (60, 40), 0.2))
    document.commit()
    return stage


def radius_of(session: Session, area: int) -> np.ndarray:
    dots = session.document.dots.by_id()
    return dots.radius_mm[dots.area == area].copy()


def test_sizes_beside_an_area_that_is_made_are_a_part_of_its_step(dark_halves: Stage) -> None:
    stage, session = dark_halves, dark_halves.session
    processing.process(session, [1, 2])
    made = results(stage)
    first = next(work for work in made if work.finished)
    stage.tell(first)
    before = radius_of(session, 1)
    assert np.array_equal(before, first.finished[0][1].radius_mm)
    stage.tell(made[-1], "finished")
    after = radius_of(session, 1)
    assert np.array_equal(after, dict(made[-1].finished)[1].radius_mm)
    assert (after < before).all()
    assert steps(session) == ["Fill", "Process left", "Process right"]
    session.undo()
    assert np.array_equal(radius_of(session, 1), before)
    session.redo()
    assert np.array_equal(radius_of(session, 1), after)


def test_sizes_that_a_person_has_changed_meanwhile_stay(dark_halves: Stage) -> None:
    stage, session = dark_halves, dark_halves.session
    processing.process(session, [1, 2])
    made = results(stage)
    k = next(k for k, work in enumerate(made) if work.finished)
    stage.tell(replace(made[k], progress=None))  # nothing is shown of the second one yet
    document = session.document
    rows = np.flatnonzero(document.dots.area == 1)
    ids, gone = document.dots.id[rows[:3]].copy(), document.dots.id[rows[5]].copy()
    document.begin("Size")
    document.change("radius_mm", rows[:3], np.full(3, 0.3, np.float32))
    document.remove(rows[5:6])
    document.commit()
    stage.tell(made[-1], "finished")
    assert np.array_equal(document.dots.radius_mm[document.rows(ids)], np.full(3, 0.3, np.float32))
    assert document.rows(gone[None])[0] < 0
    others = np.delete(dict(made[-1].finished)[1].radius_mm, [0, 1, 2, 5])
    assert np.array_equal(np.sort(others), np.sort(radius_of(session, 1)[3:]))


def test_areas_that_are_locked_or_gone_are_left_alone(stage: Stage) -> None:
    session = stage.session
    drawing = session.document.drawing
    drawing.areas[1] = replace(drawing.areas[1], locked=True)
    assert not processing.process(session, [1, 99])
    assert "locked" in session.messages.log[-1].text
    assert processing.process(session, [1, 2, 99])
    assert session.activity.areas == (2,)


def test_a_drawing_without_a_picture_says_so(stage: Stage) -> None:
    session = stage.session
    session.document.drawing.reference = None
    assert not processing.process(session, [1])
    assert "no picture" in session.messages.log[-1].text


def test_clear_resize_fill_and_relax_touch_their_areas_only(stage: Stage) -> None:
    session = stage.session
    document = session.document
    start, others = state(session), state(session, (0, 2, 3))
    assert processing.resize(session, [1], 150.0)
    rows = document.dots.area == 1
    assert document.dots.radius_mm[rows] == pytest.approx(0.3)
    assert processing.clear(session, [1])
    assert not (document.dots.area == 1).any()
    session.filling = replace(session.filling, n_dots=40, arrangement="random")
    processing.fill(session, [1])
    stage.tell(results(stage)[-1], "finished")
    assert int((document.dots.area == 1).sum()) == 40
    processing.relax(session, [1], 3)
    made = results(stage)
    for work in made[:-1]:
        stage.tell(work)
    stage.tell(made[-1], "finished")
    assert same(state(session, (0, 2, 3)), others)
    assert steps(session) == ["Fill", "Resize areas", "Clear areas", "Fill", "Relax areas"]
    for _ in range(4):
        session.undo()
    assert same(state(session), start)
    assert not processing.resize(session, [1], 0.0)
    assert "give 1 to 1,000" in session.messages.log[-1].text


def test_start_on_a_drawing_of_areas_processes_them_all(stage: Stage) -> None:
    session = stage.session
    session._read = replace_source(session)
    session.edit_style(n_dots=200)
    session.start()
    made = results(stage)
    stage.tell(made[-1], "finished")
    dots = session.document.dots
    assert [area for area, _ in made[-1].finished] == [0, 1, 2, 3]
    assert np.array_equal(session.document.partition.area_at(dots.position_mm), dots.area)
    assert session.document.drawing.style_of(0).n_dots == 200


def replace_source(session: Session):
    from stippler.jobs.work import Source

    session.tone, session.width_mm = "linear", 60.0
    return Source(Path("shell.png"), "linear", 60.0)
