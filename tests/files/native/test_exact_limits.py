"""What is just allowed and what just not: sizes, shapes, numbers; what is kept of strange parts."""

import io
import json

import numpy as np
import pytest

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Picture, Reference
from stippler.drawing.style import Style
from stippler.errors import DrawingFileError
from stippler.files.native import arrays
from stippler.files.native.container import read_container, write_container
from stippler.files.native.drawing_file import drawing_of, members_of
from stippler.files.native.edit_log import EditLog, entry_of
from stippler.files.native.limits import Limits
from stippler.files.native.recovery import Keeper, Lost
from stippler.files.read.picture import picture_of_bytes

PARTS = {"a": bytes(1000), "b": bytes(range(250)) * 4}


@pytest.mark.parametrize("name", ["member_bytes", "total_bytes", "file_bytes", "members"])
def test_a_file_may_have_as_much_as_its_limit_and_no_more(tmp_path, name):
    path = tmp_path / "one.stipple"
    with path.open("wb") as stream:
        write_container(stream, PARTS, "stippler 9.9")
    import zipfile

    with zipfile.ZipFile(path) as archive:
        sizes = [entry.file_size for entry in archive.infolist()]
    most = {
        "member_bytes": max(sizes), "total_bytes": sum(sizes), "file_bytes": path.stat().st_size,
        "members": len(sizes),
    }[name]  # fmt: skip
    assert read_container(path, Limits(**{name: most})) == PARTS
    with pytest.raises(DrawingFileError):
        read_container(path, Limits(**{name: most - 1}))


@pytest.mark.parametrize(
    "shape", [[-2, -4], [-8], [2**40, 0], [True, 8], [8.0], [1] * 5, "8", None]
)
def test_shapes_that_are_none_are_refused_and_not_met_by_numpy(shape):
    with pytest.raises(DrawingFileError, match="is no shape"):
        arrays.from_bytes(bytes(64), "f8", shape, "here")
    piece = io.BytesIO()
    text = json.dumps({"head": {}, "arrays": [["a", "f8", shape]]}).encode()
    piece.write(len(text).to_bytes(4, "little") + text + bytes(64))
    with pytest.raises(DrawingFileError):
        arrays.unpack(piece.getvalue(), "here")


def test_shapes_that_are_some_are_taken():
    for shape in ([8], [2, 4], [2, 2, 1, 2], [8, 1]):
        assert arrays.from_bytes(bytes(64), "f8", shape, "here").shape == tuple(shape)
    assert arrays.from_bytes(b"", "f8", [2**40 - 1, 0], "here").shape == (2**40 - 1, 0)
    assert not arrays.from_bytes(bytes(8), "f8", [1], "here").flags.writeable


def test_a_later_programs_fields_of_each_kind_of_value_survive():
    drawing = Drawing.blank(Page(40.0, 30.0))
    drawing.dots = Dots.round([(1, 1)], 0.2)
    drawing.reference = Reference.of(Picture.of(np.zeros((3, 4), np.float32), "linear", "a"), 40.0)
    members = members_of(drawing)
    document = json.loads(members["document.json"])
    document["reference"]["mood"] = "calm"
    document["page"]["scent"] = "moss"
    document["style"]["0"]["tempo"] = 3
    document["area"]["0"]["weight"] = [1, 2]
    document["weather"] = {"rain": None}
    members["document.json"] = json.dumps(document).encode()
    again, _ = drawing_of(members, picture_of_bytes, "here")
    kept = json.loads(members_of(again)["document.json"])
    assert kept["reference"]["mood"] == "calm"
    assert kept["page"]["scent"] == "moss"
    assert kept["style"]["0"]["tempo"] == 3
    assert kept["area"]["0"]["weight"] == [1, 2]
    assert kept["weather"] == {"rain": None}
    assert "mood" not in kept["page"]
    assert "mood" not in kept["area"]["0"]


@pytest.mark.parametrize("name", ["scent of moss", "ä" * 60, "0", "-1", "1.0", "１"])
def test_ids_that_are_none_are_named_and_not_at_any_length(name):
    members = members_of(Drawing.blank(Page(40.0, 30.0)))
    document = json.loads(members["document.json"])
    document["style"][name] = document["style"]["0"]
    text = json.dumps(document)
    if name == "0":
        text = text.replace('"style": {"0":', '"style": {"00":')
    with pytest.raises(DrawingFileError, match="is no id") as told:
        drawing_of({**members, "document.json": text.encode()}, picture_of_bytes, "here")
    assert len(str(told.value)) < 150


def test_edits_are_kept_in_folders_that_are_made(tmp_path):
    root = tmp_path / "a" / "b" / "recovery"
    keeper = Keeper(root)
    keeper.begin(lambda: {"document.json": b"{}"}, "ear", None, "stippler")
    assert keeper.wait()
    (folder,) = root.iterdir()
    assert folder.stat().st_mode & 0o777 == 0o700
    assert Lost(folder, "ear", None, 0.0).read()[0] == {"document.json": b"{}"}
    keeper.forget()


def test_a_journal_counts_its_own_steps():
    """Those of before it are none of its: undone, they leave nothing in effect."""
    drawing = Drawing.blank(Page(40.0, 30.0))
    drawing.dots = Dots.round([(1, 1), (5, 5)], 0.2)
    document = Document(drawing)

    def step(k):
        document.begin(f"Step {k}")
        document.change("radius_mm", np.array([0]), np.array([0.1 + k / 10], np.float32))
        document.commit()

    for k in range(3):
        step(k)
    made = []
    document.follow(EditLog(made.append, document).take)
    step(3)
    step(4)
    for act in (document.undo, document.undo, document.undo, document.redo, document.redo):
        act()
    entries = [entry_of(make(), {}, picture_of_bytes, "here", Limits()) for make in made]
    told = [(entry.what, entry.n_done) for entry in entries]
    assert told == [
        ("step", 1), ("step", 2), ("undone", 1), ("undone", 0), ("undone", 0), ("redone", 0),
        ("redone", 1),
    ]  # fmt: skip


def test_the_limits_are_those_that_are_told():
    assert Limits() == Limits(4 << 30, 2 << 30, 4 << 30, 4096, 1100.0, 256 << 20)


def test_a_draft_takes_the_place_of_one_that_was_being_made():
    document = Document(Drawing.blank(Page(40.0, 30.0)))
    document.begin_draft("Stipple", 0, Style())
    document.draft(np.full((7, 2), 5.0), np.full(7, 0.2, np.float32))
    document.draft(np.full((7, 2), 6.0), np.full(7, 0.2, np.float32))
    document.begin_draft("Stipple", 0, Style(seed=2))
    assert len(document.dots) == 0
    document.draft(np.full((3, 2), 5.0), np.full(3, 0.2, np.float32))
    document.end_draft()
    assert len(document.dots) == 3
