"""Damage that no chance change makes: manifests, journals and folders that are whole and wrong."""

import hashlib
import io
import json
import struct
import zipfile
import zlib

import numpy as np
import pytest
from PIL import Image

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.edit import Edit
from stippler.drawing.log import ENDED, MADE, OPENED, PART, REDONE, STEP, UNDONE, Entry
from stippler.drawing.reference import Picture
from stippler.drawing.style import MAX_DOTS
from stippler.errors import DrawingFileError
from stippler.files.native import arrays, edit_log, journal, recovery, step_file, structure
from stippler.files.native.container import MANIFEST, read_container
from stippler.files.native.drawing_file import drawing_of, members_of
from stippler.files.native.edit_log import of_entry, replay
from stippler.files.native.limits import Limits
from stippler.files.native.recovery import Keeper, is_open_elsewhere, lost_drawings
from stippler.files.native.signature import MIME, is_container
from stippler.files.native.thumbnail import MEMBER, SIDE_PX, read_thumbnail
from stippler.files.read.picture import picture_of_bytes
from tests.corpus.contents import CONTENTS

DATA = b"{}"
GOOD = {
    "format": "stipple", "version": 1, "program": "one",
    "members": {"a.json": {"bytes": 2, "sha256": hashlib.sha256(DATA).hexdigest()}},
}  # fmt: skip


def archive(manifest=GOOD, mimetype=MIME, names=("mimetype", MANIFEST, "a.json")):
    stream = io.BytesIO()
    text = manifest if isinstance(manifest, bytes) else json.dumps(manifest).encode()
    parts = {"mimetype": mimetype.encode(), MANIFEST: text, "a.json": DATA}
    with zipfile.ZipFile(stream, "w") as made:
        for name in names:
            made.writestr(name, parts[name])
    return stream.getvalue()


def members(**changes):
    return {**GOOD, "members": {"a.json": {**GOOD["members"]["a.json"], **changes}}}


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (archive(names=(MANIFEST, "a.json")), "no drawing of this program"),
        (archive(names=("mimetype", "a.json")), "no drawing of this program"),
        (archive(mimetype=MIME.swapcase()), "no drawing of this program"),
        (archive(b" " * 600 + b"{}"), "too long a manifest"),
        (archive(b"[]"), "another format"),
        (archive({**GOOD, "format": "other"}), "another format"),
        (archive({**GOOD, "version": 0}), "names no version"),
        (archive({**GOOD, "version": True}), "names no version"),
        (archive({**GOOD, "version": 999}), "update Stippler"),
        (archive({**GOOD, "members": []}), "lists no members"),
        (archive({**GOOD, "members": {"b": {}}}), "which is missing"),
        (archive({**GOOD, "members": {MANIFEST: {}}}), "which is missing"),
        (archive({**GOOD, "members": {"a.json": 5}}), "says nothing of"),
        (archive(members(bytes=True)), "says nothing of"),
        (archive(members(sha256=5)), "says nothing of"),
        (archive(members(bytes=3)), "another size"),
        (archive(members(sha256="0" * 64)), "changed or damaged"),
    ],
)
def test_manifests_that_are_wrong(tmp_path, data, why):
    path = tmp_path / "one.stipple"
    path.write_bytes(archive())
    limits = Limits(structure_bytes=500)
    assert read_container(path, limits) == {"a.json": DATA}
    path.write_bytes(data)
    with pytest.raises(DrawingFileError, match=why):
        read_container(path, limits)


def test_a_drawing_is_known_by_its_begin(tmp_path):
    path = tmp_path / "one.stipple"
    path.write_bytes(archive())
    assert is_container(path)
    path.write_bytes(b"PK\3\4" + bytes(200))
    assert not is_container(path)
    path.write_bytes(b"XX" + archive()[2:])
    assert not is_container(path)
    assert not is_container(tmp_path)
    assert not is_container(tmp_path / "none")


def test_structure_beyond_its_limit_is_refused():
    limits = Limits(structure_bytes=4)
    assert structure.from_bytes(b"[12]", "here", limits) == [12]
    with pytest.raises(DrawingFileError, match="5 bytes"):
        structure.from_bytes(b"[123]", "here", limits)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda d: d.update(next_id=[]), "no list of ids"),
        (lambda d: d["next_id"].update(dot=-1), "is no id"),
        (lambda d: d["next_id"].update(dot=2**53 + 1), "is no id"),
        (lambda d: d["next_id"].update(dot=True), "is no id"),
        (lambda d: d.update(pictures=[]), "no list of pictures"),
        (lambda d: d.pop("dots"), "has no dots"),
        (lambda d: d["dots"].update(n=MAX_DOTS + 1), "is no number of dots"),
        (lambda d: d["dots"].update(n=-1), "is no number of dots"),
        (lambda d: d["dots"].update(n=True), "is no number of dots"),
        (lambda d: d["dots"]["arrays"].pop("radius_mm"), "radius_mm is missing"),
        (lambda d: d["dots"]["arrays"].update(id=["i8", [7]]), "id is not what it should be"),
        (lambda d: d.update(pictures={"x": 5}), "says nothing of it"),
        (lambda d: d.update(area=[]), "no table|areas"),
        (lambda d: d["area"].update({"01": d["area"]["0"]}), "is no id"),
        (lambda d: d["area"].update({"-1": d["area"]["0"]}), "is no id"),
        (lambda d: d["area"].update({"9" * 10: d["area"]["0"]}), "is no id"),
        (lambda d: d["area"].clear(), "area is not in the drawing|own area is missing"),
        (lambda d: d["area"]["0"].update(style=77), "its style is missing"),
        (lambda d: d["area"]["0"].update(outline_mm="POLYGON ((0"), "outline of an area"),
        (lambda d: d["area"]["0"].update(outline_mm="POINT (1 2)"), "is no polygon"),
        (lambda d: d["area"]["0"].update(colour="red"), "is no colour"),
    ],
)
def test_documents_that_are_wrong(change, why):
    found = dict(members_of(CONTENTS["areas"]()))
    document = json.loads(found["document.json"])
    change(document)
    found["document.json"] = json.dumps(document).encode()
    with pytest.raises(DrawingFileError, match=why):
        drawing_of(found, picture_of_bytes, "here")


# --- journals -----------------------------------------------------------------------------------


def head(magic=journal.MAGIC, version=journal.VERSION):
    begin = struct.pack(journal._HEAD.format, magic, version, b"d" * 16, 0)[:-4]
    return begin + struct.pack("<I", zlib.crc32(begin))


def test_journals_that_are_none(tmp_path):
    assert journal.parse_journal(head(), "here").records == []
    for data, why in (
        (head()[:-1], "no head"),
        (head(magic=b"X" * len(journal.MAGIC)), "no head"),
        (head(version=journal.VERSION + 1), "update Stippler"),
    ):
        with pytest.raises(DrawingFileError, match=why):
            journal.parse_journal(data, "here")
    path = tmp_path / "one.journal"
    path.write_bytes(head())
    assert journal.read_journal(path, Limits(file_bytes=len(head()))).records == []
    with pytest.raises(DrawingFileError, match="is no journal"):
        journal.read_journal(path, Limits(file_bytes=len(head()) - 1))
    with pytest.raises(DrawingFileError, match="cannot be read"):
        journal.read_journal(tmp_path / "none", Limits())
    with pytest.raises(ValueError, match="16 bytes"):
        journal.Journal(tmp_path / "two", b"short")


def test_a_journal_is_closed_once_or_twice(tmp_path):
    one = journal.Journal(tmp_path / "one", b"d" * 16)
    one.append(lambda: b"record")
    one.close()
    one.close()
    assert journal.read_journal(tmp_path / "one").records == [b"record"]


def document():
    return Document(CONTENTS["areas"]())


def moved(doc, by=0.5, rows=(0, 1)):
    """Return an edit that moves dots, without doing it."""
    other = Document(doc.drawing.snapshot())
    other.begin("Move")
    rows = np.array(rows)
    other.move(rows, other.dots.position_mm[rows] * (1 - by / 100))
    return other.commit()


def restyled(doc):
    other = Document(doc.drawing.snapshot())
    other.begin("Style")
    other.set("style", 0, other.drawing.styles[0].of(other.drawing.styles[0], dots=77))
    return other.commit()


def inserted(doc):
    other = Document(doc.drawing.snapshot())
    other.begin("More")
    other.insert(Dots.round([(5.0, 5.0)], 0.2))
    return other.commit()


OPEN = Entry(OPENED, Edit("Relax"))
OUT_OF_ORDER = {
    "of an unknown kind": (lambda d: [Entry("danced", moved(d))], 0, "unknown"),
    "begin within a run": (lambda d: [OPEN, OPEN], 1, "within another"),
    "begin without an edit": (lambda d: [Entry(OPENED)], 0, "within another"),
    "begin with a change": (lambda d: [Entry(OPENED, moved(d))], 0, "with a change"),
    "part of no run": (lambda d: [Entry(PART, moved(d))], 0, "part of no run"),
    "part after the end": (lambda d: [OPEN, Entry(ENDED), Entry(PART, moved(d))], 2, "no run"),
    "part without an edit": (lambda d: [OPEN, Entry(PART)], 1, "part of no run"),
    "part that sets a style": (lambda d: [OPEN, Entry(PART, restyled(d))], 1, "more than a run"),
    "part that makes dots": (lambda d: [OPEN, Entry(PART, inserted(d))], 1, "more than a run"),
    "undone within a run": (
        lambda d: [Entry(STEP, restyled(d), n_done=1), OPEN, Entry(UNDONE, restyled(d).inverse())],
        2, "within a run",
    ),
    "undone without an edit": (lambda d: [Entry(UNDONE)], 0, "another step"),
    "redone without an edit": (lambda d: [Entry(REDONE)], 0, "another step"),
    "another step undone": (
        lambda d: [Entry(STEP, moved(d), n_done=1), Entry(UNDONE, restyled(d))], 1, "another step",
    ),
    "dots after steps": (
        lambda d: [Entry(STEP, restyled(d), n_done=1), Entry(MADE, inserted(d))], 1, "already",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", OUT_OF_ORDER)
def test_entries_out_of_order_are_not_followed(name):
    make, n_followed, why = OUT_OF_ORDER[name]
    doc = document()
    records = [of_entry(entry) for entry in make(doc)]
    n, problem = replay(doc, records, picture_of_bytes)
    assert n == n_followed
    assert why in problem


def test_a_run_moves_none_but_the_dots_that_it_began_with():
    doc = document()
    made = inserted(doc)
    grown = Document(doc.drawing.snapshot())
    grown._apply(made)
    later = moved(grown, rows=(len(grown.dots) - 1,))
    records = [of_entry(e) for e in (OPEN, Entry(STEP, made, n_done=2), Entry(PART, later))]
    n, problem = replay(doc, records, picture_of_bytes)
    assert n == 2
    assert "does not know" in problem
    assert not doc.in_run


def test_records_that_tell_nothing_are_not_followed():
    doc = document()
    for head_of, why in (({"what": 5}, "tells nothing"), ({"what": STEP, "n_done": "x"}, "counts")):
        n, problem = replay(doc, [arrays.pack(head_of, {})], picture_of_bytes)
        assert n == 0
        assert why in problem


def test_pictures_come_as_their_file_or_as_darkness():
    darkness = np.linspace(0, 1, 12, dtype=np.float32).reshape(3, 4)
    stream = io.BytesIO()
    Image.fromarray(np.full((2, 3), 60, np.uint8)).save(stream, "png")
    for picture in (
        Picture.of(darkness, "linear", "plain"),
        picture_of_bytes(stream.getvalue(), "one.png", "linear"),
    ):
        known = {}
        record = edit_log.of_picture(picture)
        assert edit_log.entry_of(record, known, picture_of_bytes, "here", Limits()) is None
        (found,) = known.values()
        assert found == picture
        assert found.levels.darkness().tobytes() == picture.levels.darkness().tobytes()
        assert (found.name, found.tone, found.data) == (picture.name, picture.tone, picture.data)


# --- steps in a file ----------------------------------------------------------------------------


def pieces(*records):
    return b"".join(step_file._LENGTH.pack(len(r)) + r for r in records)


def head_of(doc, **changes):
    usual = {"what": step_file._HEAD, "of": step_file.state_of(doc.drawing), "n_done": 1}
    return arrays.pack({**usual, **changes}, {})


def test_histories_that_are_wrong_are_refused():
    doc = document()
    step = of_entry(Entry(STEP, moved(doc)))
    for data, why in (
        (pieces(head_of(doc, what="other"), step), "no head"),
        (pieces(head_of(doc, of=5), step), "no head"),
        (pieces(head_of(doc, n_done=-1), step), "counts no steps"),
        (pieces(head_of(doc, n_done=True), step), "counts no steps"),
        (pieces(head_of(doc), of_entry(Entry(ENDED))), "is no step"),
        (pieces(head_of(doc), of_entry(Entry(UNDONE, moved(doc)))), "is no step"),
        (pieces(head_of(doc), arrays.pack({"what": STEP, "edit": True}, {})), "is wrong"),
    ):
        with pytest.raises(DrawingFileError, match=why):
            step_file.give_steps(document(), data, picture_of_bytes, "here")


# --- recovery -----------------------------------------------------------------------------------


@pytest.fixture
def left(tmp_path):
    """A folder that a crash has left, by letting go of its lock alone."""
    keeper = Keeper(tmp_path)
    keeper.begin(lambda: {"a.json": DATA}, "ear", tmp_path / "ear.stipple", "stippler")
    keeper.append(lambda: b"one")
    assert keeper.wait()
    assert keeper.is_on_disk
    assert is_open_elsewhere(tmp_path, tmp_path / "ear.stipple")
    assert not is_open_elsewhere(tmp_path, tmp_path / "eye.stipple")
    keeper._lock.close()
    (folder,) = tmp_path.iterdir()
    return folder


def test_a_folder_that_nobody_holds_is_not_open(left):
    assert not is_open_elsewhere(left.parent, left.parent / "ear.stipple")
    assert not is_open_elsewhere(left.parent / "none", left)
    assert lost_drawings(left.parent / "none") == []


def test_a_journal_of_another_drawing_or_none_is_one_without_records(left):
    (lost,) = lost_drawings(left.parent)
    assert lost.read()[1].records == [b"one"]
    about = json.loads((left / "about.json").read_text())
    for mark in ("00" * 16, "no hex", "00", 5):
        (left / "about.json").write_text(json.dumps({**about, "mark": mark}))
        assert lost.read()[1].records == []
    (left / "about.json").write_text(json.dumps(about))
    (left / "edits-1.journal").write_bytes(b"none")
    assert lost.read() == ({"a.json": DATA}, journal.Replay(b"", [], 0))


def test_folders_that_tell_nothing_are_left_alone(left):
    about = json.loads((left / "about.json").read_text())
    (left / "about.json").write_text(json.dumps({**about, "path": "a\0b", "name": "x" * 300}))
    (lost,) = lost_drawings(left.parent)
    assert lost.path is None
    assert lost.name == "x" * 200
    for text in ("[]", "{", ""):
        (left / "about.json").write_text(text)
        assert lost_drawings(left.parent) == []
    (left / "about.json").unlink()
    assert lost_drawings(left.parent) == []


def test_a_lock_that_cannot_be_opened_counts_as_held(left):
    (left / "lock").unlink()
    (left / "lock").mkdir()
    assert lost_drawings(left.parent) == []


def test_a_keeper_without_a_folder_says_so(tmp_path):
    root = tmp_path / "file"
    root.write_text("in the way")
    keeper = Keeper(root)
    keeper.begin(lambda: {"a.json": DATA}, "ear", None, "stippler")
    assert keeper.problem is not None
    assert not keeper.is_on_disk
    assert not keeper.wait()
    keeper.forget()


def test_the_folder_of_recovery_can_be_moved(monkeypatch, tmp_path):
    monkeypatch.setenv("STIPPLER_STATE_DIR", str(tmp_path))
    assert recovery.recovery_root() == tmp_path / "recovery"
    monkeypatch.delenv("STIPPLER_STATE_DIR")
    assert recovery.recovery_root().parts[-2:] == ("stippler", "recovery")


# --- small pictures -----------------------------------------------------------------------------


def png(size, kind="png"):
    stream = io.BytesIO()
    Image.new("L", size, 90).save(stream, kind)
    return stream.getvalue()


def test_small_pictures_that_are_none_are_left_out(tmp_path):
    path = tmp_path / "one.stipple"

    def read(data, name=MEMBER):
        with zipfile.ZipFile(path, "w") as made:
            made.writestr(name, data)
        return read_thumbnail(path)

    assert np.array_equal(read(png((4, 3))), np.full((3, 4), 90))
    assert read(png((4 * SIDE_PX, 1))).shape == (1, 4 * SIDE_PX)
    assert read(png((4 * SIDE_PX + 1, 1))) is None
    assert read(b"no picture") is None
    assert read(png((4, 3), "bmp")) is None
    assert read(png((4, 3))[:30]) is None
    assert read(png((4, 3)), "other.png") is None
    assert read(png((4, 3)) + bytes(64 << 20)) is None
    path.write_bytes(b"no archive")
    assert read_thumbnail(path) is None
    assert read_thumbnail(tmp_path / "none") is None
