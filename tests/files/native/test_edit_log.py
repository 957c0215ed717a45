"""A drawing made anew from its journal equals the one that was lost, to the bit."""

import importlib.util
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.document import Document
from stippler.files.native.drawing_file import drawing_of, members_of
from stippler.files.native.edit_log import EditLog, replay
from stippler.files.native.recovery import lost_drawings
from stippler.files.read.picture import picture_of_bytes

SCRIPT = Path(__file__).parents[2] / "long" / "painting.py"
spec = importlib.util.spec_from_file_location("painting", SCRIPT)
painting = importlib.util.module_from_spec(spec)
spec.loader.exec_module(painting)


def document_of(members):
    drawing, _ = drawing_of(members, picture_of_bytes, "here")
    return Document(drawing)


def kept(seed, n_steps):
    """Paint; return the document, the members that the journal begins with, and its records."""
    document = Document(painting.first_drawing())
    members, made = members_of(document.drawing), []
    document.follow(EditLog(made.append, document).take)
    for k, _ in enumerate(painting.paint(document, seed)):
        if k == n_steps:
            break
    return document, members, [make() for make in made]


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.integers(0, 40))
def test_replaying_a_journal_gives_the_drawing_and_its_history(seed, n_steps):
    document, members, records = kept(seed, n_steps)
    document.end_run()
    again = document_of(members)
    n_done, problem = replay(again, records, picture_of_bytes)
    assert (n_done, problem) == (len(records), "")
    assert painting.digest(again.drawing) == painting.digest(document.drawing)
    assert again.history.n_done == document.history.n_done
    assert again.drawing.first_free("dot") <= document.drawing.first_free("dot")
    assert [s.label for s in again.history.steps] == [s.label for s in document.history.steps]
    while document.undo():
        assert again.undo()
        assert painting.digest(again.drawing) == painting.digest(document.drawing)
    assert not again.undo()
    while document.redo():
        assert again.redo()
    assert painting.digest(again.drawing) == painting.digest(document.drawing)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_journal_cut_anywhere_gives_the_drawing_of_then(seed):
    document = Document(painting.first_drawing())
    members, made, then = members_of(document.drawing), [], [painting.digest(document.drawing)]
    document.follow(EditLog(made.append, document).take)
    counts = [0]
    for k, _ in enumerate(painting.paint(document, seed)):
        counts.append(len(made))
        then.append(painting.digest(document.drawing))
        if k == 30:
            break
    records = [make() for make in made]
    for count, wanted in zip(counts, then, strict=True):
        again = document_of(members)
        assert replay(again, records[:count], picture_of_bytes) == (count, "")
        assert painting.digest(again.drawing) == wanted


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.integers(0, 25), st.integers(0, 40))
def test_a_journal_that_begins_later_follows_steps_undone_from_before(seed, n_before, n_after):
    document = Document(painting.first_drawing())
    made = []
    for k, _ in enumerate(painting.paint(document, seed)):
        if k == n_before:
            document.end_run()
            members = members_of(document.drawing)
            document.follow(EditLog(made.append, document).take)
        if k == n_before + n_after:
            break
    document.end_run()
    again = document_of(members)
    records = [make() for make in made]
    assert replay(again, records, picture_of_bytes) == (len(records), "")
    assert painting.digest(again.drawing) == painting.digest(document.drawing)
    while again.undo():
        assert document.undo()
        assert painting.digest(again.drawing) == painting.digest(document.drawing)
    while again.redo():
        assert document.redo()
        assert painting.digest(again.drawing) == painting.digest(document.drawing)


def test_a_record_that_makes_no_sense_ends_the_replay_and_is_told():
    _, members, records = kept(3, 20)
    again = document_of(members)
    n_done, problem = replay(again, [*records[:5], b"nonsense", *records[5:]], picture_of_bytes)
    assert n_done == 5
    assert problem.startswith("record 5")


def recovered(root):
    (lost,) = lost_drawings(root)
    members, torn = lost.read()
    document = document_of(members)
    n_done, problem = replay(document, torn.records, picture_of_bytes)
    assert (n_done, problem) == (len(torn.records), "")
    lost.discard()
    return painting.digest(document.drawing)


@pytest.mark.parametrize("seed", range(3))
def test_a_painter_killed_at_any_moment_loses_the_last_step_at_most(tmp_path, seed):
    process = subprocess.Popen(
        [sys.executable, str(SCRIPT), str(tmp_path), str(seed)], stdout=subprocess.PIPE, text=True
    )
    first = process.stdout.readline()
    time.sleep(0.2 + 0.13 * seed)
    process.send_signal(signal.SIGKILL)
    lines = [first, *process.stdout.read().splitlines(keepends=True)]
    process.wait()
    said = [line.split() for line in lines if line.endswith("\n") or line is not lines[-1]]
    n_said = int(said[-1][0])
    on_disk = max((int(words[0]) for words in said if words[-1] == "flushed"), default=0)
    assert n_said > 3
    document = Document(painting.first_drawing())
    wanted = [painting.digest(document.drawing)]
    for _ in painting.paint(document, seed):
        wanted.append(painting.digest(document.drawing))
        if len(wanted) == n_said + 2:  # one step may have been done and not said
            break
    assert wanted[n_said] == said[-1][1]
    assert recovered(tmp_path) in wanted[on_disk:]
