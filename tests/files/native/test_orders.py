"""Steps undone and redone around a journal's beginning, dots that one begins with, pictures."""

import re

import numpy as np
import pytest

from stippler.drawing import records
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.log import REDONE, UNDONE, Entry
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import DrawingFileError
from stippler.files.native import step_file
from stippler.files.native.drawing_file import drawing_of, members_of
from stippler.files.native.edit_log import EditLog, of_entry, replay
from stippler.files.read.picture import picture_of_bytes


def document():
    drawing = Drawing.blank(Page(40.0, 30.0))
    drawing.dots = Dots.round(np.random.default_rng(1).random((20, 2)) * (40, 30), 0.2)
    return Document(drawing)


def resized(doc, radius):
    doc.begin(f"Size {radius}")
    doc.change("radius_mm", np.arange(5), np.full(5, radius, np.float32))
    return doc.commit()


@pytest.fixture
def begun_later():
    """Three steps, then a journal's beginning; the document, the members, and the edits."""
    doc = document()
    edits = [resized(doc, radius) for radius in (0.3, 0.4, 0.5)]
    return doc, members_of(doc.drawing), edits


def again_of(members):
    return Document(drawing_of(members, picture_of_bytes, "here")[0])


@pytest.mark.parametrize("n_undone", [1, 2, 3])
@pytest.mark.parametrize("n_redone", [0, 1, 2, 3])
def test_steps_from_before_a_journal_are_undone_and_redone_in_their_order(
    begun_later, n_undone, n_redone
):
    doc, members, _ = begun_later
    made = []
    doc.follow(EditLog(made.append, doc).take)
    for _ in range(n_undone):
        doc.undo()
    for _ in range(n_redone):
        doc.redo()
    again = again_of(members)
    assert replay(again, [make() for make in made], picture_of_bytes) == (len(made), "")
    assert members_of(again.drawing) == members_of(doc.drawing)


def test_a_step_from_before_a_journal_is_not_redone_before_one_that_was_undone_later(begun_later):
    _, members, (_, second, third) = begun_later
    undone = [Entry(UNDONE, edit.inverse(), n_done=0) for edit in (third, second)]
    wrong, right = (Entry(REDONE, edit, n_done=0) for edit in (third, second))
    again = again_of(members)
    n, why = replay(again, map(of_entry, [*undone, wrong]), picture_of_bytes)
    assert (n, "another step than the last that was undone" in why) == (2, True)
    again = again_of(members)
    assert replay(again, map(of_entry, [*undone, right]), picture_of_bytes) == (3, "")
    assert again.dots.radius_mm[0] == np.float32(0.4)


def test_a_new_step_forgets_what_was_undone_before_it(begun_later):
    doc, members, (_, _, third) = begun_later
    made = []
    doc.follow(EditLog(made.append, doc).take)
    doc.undo()
    resized(doc, 0.7)
    again = again_of(members)
    records_ = [make() for make in made]
    n, why = replay(again, [*records_, of_entry(Entry(REDONE, third, n_done=2))], picture_of_bytes)
    assert n == len(records_)
    assert "not undone" in why
    assert members_of(again.drawing) == members_of(doc.drawing)


def test_dots_that_a_drawing_begins_with_are_no_step_after_a_crash_either():
    doc = Document(Drawing.blank(Page(40.0, 30.0)))
    members, made = members_of(doc.drawing), []
    doc.follow(EditLog(made.append, doc).take)
    doc.begin_draft("Stipple", 0, Style(seed=5), Reference(np.full((3, 4), 0.5, np.float32), 40.0))
    doc.draft(np.random.default_rng(1).random((30, 2)) * (40, 30), np.full(30, 0.2, np.float32))
    doc.end_draft()
    resized(doc, 0.3)
    again = again_of(members)
    assert replay(again, [make() for make in made], picture_of_bytes) == (len(made), "")
    assert members_of(again.drawing) == members_of(doc.drawing)
    assert again.drawing.reference == doc.drawing.reference
    assert again.undo()
    assert not again.undo()
    assert len(again.dots) == 30


def test_steps_that_change_the_picture_keep_each_picture_once():
    doc = document()
    dark = [np.full((40, 50), k / 4, np.float32) for k in range(4)]
    for k in (1, 2, 1, 3):
        doc.begin("Picture")
        doc.set(records.REFERENCE, 0, Reference(dark[k], 40.0))
        doc.commit()
    data = step_file.steps_to_bytes(doc.steps(), doc.history.n_done, doc.drawing)
    assert 2 * dark[0].nbytes < len(data) < 3 * dark[0].nbytes  # the drawing has the last itself
    again = again_of(members_of(doc.drawing))
    assert step_file.give_steps(again, data, picture_of_bytes, "here")
    for _ in range(4):
        assert again.undo()
        assert doc.undo()
        assert again.drawing.reference == doc.drawing.reference
    assert again.drawing.reference is None


def test_a_step_that_changes_nothing_is_left_out():
    doc = document()
    doc.begin("Nothing")
    nothing = doc.commit()
    step = resized(doc, 0.3)
    pieces = [
        step_file.arrays.pack(
            {"what": step_file._HEAD, "of": step_file.state_of(doc.drawing), "n_done": 1}, {}
        ),
        *(of_entry(Entry("step", edit)) for edit in (nothing, step)),
    ]
    data = b"".join(step_file._LENGTH.pack(len(piece)) + piece for piece in pieces)
    again = again_of(members_of(doc.drawing))
    assert step_file.give_steps(again, data, picture_of_bytes, "here")
    assert [one.label for one in again.history.steps] == ["Size 0.3"]


@pytest.mark.parametrize("data", [b"[]", b"5", b'"page"', b"null"])
def test_structure_that_is_no_document_is_refused(data):
    members = members_of(document().drawing)
    with pytest.raises(DrawingFileError, match="holds no drawing"):
        drawing_of({**members, "document.json": data}, picture_of_bytes, "here")


def test_a_document_without_any_area_is_refused():
    members = members_of(Drawing.blank(Page(40.0, 30.0)))
    text = re.sub(rb'"area":{"0":{.*?}},', b'"area":{},', members["document.json"])
    assert text != members["document.json"]
    with pytest.raises(DrawingFileError, match="own area is missing"):
        drawing_of({**members, "document.json": text}, picture_of_bytes, "here")


def test_another_step_than_the_one_undone_is_not_redone():
    doc = document()
    members = members_of(doc.drawing)
    first = resized(doc, 0.3)
    other = Document(again_of(members).drawing)
    second = resized(other, 0.4)
    entries = [Entry("step", first, n_done=1), Entry(UNDONE, first.inverse(), n_done=0)]
    again = again_of(members)
    n, why = replay(
        again, map(of_entry, [*entries, Entry(REDONE, second, n_done=1)]), picture_of_bytes
    )
    assert n == 2
    assert "another step than the last that was undone" in why
    again = again_of(members)
    right = [*entries, Entry(REDONE, first, n_done=1)]
    assert replay(again, map(of_entry, right), picture_of_bytes) == (3, "")


def test_steps_of_a_journal_are_undone_past_its_beginning_and_redone(begun_later):
    doc, members, _ = begun_later
    made = []
    doc.follow(EditLog(made.append, doc).take)
    resized(doc, 0.6)
    for act in (doc.undo, doc.undo, doc.redo, doc.redo):
        assert act()
    again = again_of(members)
    assert replay(again, [make() for make in made], picture_of_bytes) == (len(made), "")
    assert members_of(again.drawing) == members_of(doc.drawing)
    assert (again.history.n_done, len(again.history.steps)) == (1, 1)


def test_steps_undone_past_a_journals_beginning_leave_none_in_effect(begun_later):
    doc, members, _ = begun_later
    made = []
    doc.follow(EditLog(made.append, doc).take)
    resized(doc, 0.6)
    assert doc.undo()
    assert doc.undo()
    again = again_of(members)
    assert replay(again, [make() for make in made], picture_of_bytes) == (len(made), "")
    assert members_of(again.drawing) == members_of(doc.drawing)
    assert (again.history.n_done, len(again.history.steps)) == (0, 1)
