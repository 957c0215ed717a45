"""The history in a drawing's file: undone to the start and done again, or left aside whole."""

import contextlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.foreign import Foreign
from stippler.drawing.reference import Picture, Reference
from stippler.drawing.style import Style
from stippler.errors import DrawingFileError
from stippler.files.native import step_file
from stippler.files.native.drawing_file import members_of, save_drawing
from stippler.files.native.step_file import MEMBER, give_steps, is_of, steps_to_bytes
from stippler.files.read.picture import picture_of_bytes
from stippler.opening import open_document, open_file
from tests.corpus.contents import CONTENTS


def worked_on(n_steps=6, seed=1, budget=1 << 28):
    """Return a document with steps of several kinds, the last one undone."""
    rng = np.random.default_rng(seed)
    document = Document(CONTENTS["areas"](), budget)
    for k in range(n_steps):
        document.begin(f"Step {k}")
        rows = np.sort(rng.choice(len(document.dots), 5, replace=False))
        document.move(rows, document.dots.position_mm[rows] + rng.normal(0, 0.3, (5, 2)))
        if k % 3 == 1:
            document.insert(Dots.round(rng.random((3, 2)) * (38, 28), 0.2))
        if k % 3 == 2:
            document.remove(rows[:2])
            document.set("style", 0, Style(n_dots=k + 1))
        document.commit()
    document.begin("Picture")
    darkness = rng.random((3, 4)).astype(np.float32)
    document.set("reference", 0, Reference.of(Picture.of(darkness), 40.0))
    document.commit()
    document.begin("Without")
    document.set("reference", 0, None)
    document.commit()
    document.undo()
    return document


def with_steps(document):
    drawing = document.drawing.snapshot()
    data = steps_to_bytes(document.steps(), document.history.n_done, drawing)
    drawing.foreign = Foreign(members={MEMBER: data, "strange/a": b"1"})
    return drawing


def states(document):
    """Return every state from now to the start, and to the end."""
    found = [members_of(document.drawing)]
    while document.undo():
        found.append(members_of(document.drawing))
    while document.redo():
        found.append(members_of(document.drawing))
    return found


def without_foreign(all_states):
    return [{k: v for k, v in one.items() if k not in (MEMBER, "strange/a")} for one in all_states]


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 8), st.integers(0, 2**32 - 1), st.sampled_from([1 << 28, 2000]))
def test_steps_come_back_and_lead_where_they_led(tmp_path_factory, n_steps, seed, budget):
    path = tmp_path_factory.mktemp("steps") / "one.stipple"
    document = worked_on(n_steps, seed, budget)
    save_drawing(with_steps(document), path)
    again, note = open_document(path)
    assert note == ""
    assert again.history.n_done == document.history.n_done
    assert [step.label for step in again.history.steps] == [
        step.label for step in document.history.steps
    ]
    assert without_foreign(states(again)) == without_foreign(states(document))


def test_a_run_that_goes_on_is_a_step_of_the_file(tmp_path):
    document = worked_on()
    moved = document.begin_run("Relax").position_mm + 0.01
    document.merge(moved)
    save_drawing(with_steps(document), tmp_path / "one.stipple")
    document.end_run()
    again, _ = open_document(tmp_path / "one.stipple")
    assert again.history.steps[-1].label == "Relax"
    assert again.history.steps[-1].of_job
    assert without_foreign(states(again)) == without_foreign(states(document))


def test_there_are_no_steps_within_a_stroke_or_a_draft():
    document = worked_on()
    document.begin("Stroke")
    assert document.steps() is None
    document.commit()
    document.begin_draft("Stipple", 0, Style())
    assert document.steps() is None


def test_a_drawing_changed_without_its_steps_loses_them(tmp_path):
    save_drawing(with_steps(worked_on()), tmp_path / "one.stipple")
    drawing = open_file(tmp_path / "one.stipple")
    save_drawing(drawing, tmp_path / "same.stipple")
    assert MEMBER in open_file(tmp_path / "same.stipple").foreign.members
    drawing.dots.radius_mm[0] *= 2
    document, steps = Document(drawing), drawing.foreign.members[MEMBER]
    assert not give_steps(document, steps, picture_of_bytes, "here")
    assert document.history.steps == []
    save_drawing(drawing, tmp_path / "two.stipple")
    assert set(open_file(tmp_path / "two.stipple").foreign.members) == {"strange/a"}


def test_steps_lost_on_disk_take_the_older_ones_with_them(tmp_path):
    document = worked_on(8, budget=1500)
    spilled = [step for step in document.history.steps if step.path is not None]
    assert len(spilled) > 1
    spilled[1].path.unlink()
    drawing = with_steps(document)
    save_drawing(drawing, tmp_path / "one.stipple")
    again, _ = open_document(tmp_path / "one.stipple")
    n_lost = document.history.steps.index(spilled[1]) + 1
    assert len(again.history.steps) == len(document.history.steps) - n_lost
    assert again.history.n_done == document.history.n_done - n_lost


@pytest.mark.parametrize("at", range(0, 3000, 37))
def test_changed_bytes_are_refused_or_harmless(at):
    document = worked_on(3)
    drawing = with_steps(document)
    data = bytearray(drawing.foreign.members[MEMBER])
    data[at % len(data)] ^= 0xFF
    fresh = Document(drawing)
    with contextlib.suppress(DrawingFileError):
        if give_steps(fresh, bytes(data), picture_of_bytes, "here"):
            assert fresh.history.steps
            return
    assert fresh.history.steps == []


@pytest.mark.parametrize(
    "data",
    [b"", b"abc", bytes(8), b"\xff" * 8, (5).to_bytes(8, "little") + b"abc", b"\x04" + bytes(11)],
)
def test_what_is_no_history_is_refused(data):
    document = worked_on(2)
    with pytest.raises(DrawingFileError):
        give_steps(document, data, picture_of_bytes, "here")
    assert not is_of(data, document.drawing)


@pytest.mark.parametrize("told", [b'"n_done":9', b'"n_done":[', b'"n_gone":3'])
def test_a_head_that_counts_wrongly_is_refused(told):
    document = worked_on(2)
    drawing = document.drawing.snapshot()
    data = steps_to_bytes(document.steps(), 3, drawing)
    assert data.count(b'"n_done":3') == 1
    with pytest.raises(DrawingFileError):
        give_steps(Document(drawing), data.replace(b'"n_done":3', told), picture_of_bytes, "here")


def test_damaged_steps_leave_the_drawing_and_say_so(tmp_path, monkeypatch):
    drawing = with_steps(worked_on())
    save_drawing(drawing, tmp_path / "one.stipple")
    pieces = step_file._pieces

    def torn(data, where):
        yield from list(pieces(data, where))[:2]
        yield b"nonsense"

    monkeypatch.setattr(step_file, "_pieces", torn)
    document, note = open_document(tmp_path / "one.stipple")
    assert "history" in note
    assert len(document.dots) == len(drawing.dots)
    assert document.history.steps == []
