import io
import random
import zipfile

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.errors import DrawingFileError
from stippler.files.native import container
from stippler.files.native.container import MANIFEST, read_container, write_container
from stippler.files.native.limits import Limits
from stippler.files.native.signature import MIME

MEMBERS = {"document.json": b'{"a":1}', "dots/x.f8": bytes(range(256)) * 40, "empty": b""}


def written(members=MEMBERS):
    stream = io.BytesIO()
    write_container(stream, members, "stippler 9.9")
    return stream.getvalue()


def read(tmp_path, data, **limits):
    path = tmp_path / "one.stipple"
    path.write_bytes(data)
    return read_container(path, Limits(**limits))


def test_members_come_back_in_order_and_whole(tmp_path):
    found = read(tmp_path, written())
    assert found == MEMBERS
    assert list(found) == list(MEMBERS)


def test_the_same_members_give_the_same_bytes():
    assert written() == written()


def test_it_is_a_zip_that_others_open_with_its_type_first():
    with zipfile.ZipFile(io.BytesIO(written())) as archive:
        assert archive.testzip() is None
        assert archive.infolist()[0].filename == "mimetype"
        assert archive.read("mimetype") == MIME.encode()
    assert written()[38 : 38 + len(MIME)] == MIME.encode()  # where `file` looks for it


@given(st.dictionaries(st.from_regex(r"[a-z]{1,8}(/[a-z]{1,8})?", fullmatch=True), st.binary()))
def test_any_members_come_back(tmp_path_factory, members):
    members = {k: v for k, v in members.items() if k != "mimetype"}
    assert read(tmp_path_factory.mktemp("any"), written(members)) == members


def test_what_another_program_put_in_is_kept(tmp_path):
    stream = io.BytesIO(written())
    with zipfile.ZipFile(stream, "a") as archive:
        archive.writestr("other/notes.txt", b"hello")
    assert read(tmp_path, stream.getvalue()) == {**MEMBERS, "other/notes.txt": b"hello"}


def test_every_changed_byte_is_noticed_or_does_no_harm(tmp_path):
    small = {"document.json": b'{"a":1}', "dots/x": b"0123456789"}
    data = written(small)
    for at in range(len(data)):
        for flip in (0x01, 0x80, 0xFF):
            broken = bytearray(data)
            broken[at] ^= flip
            try:
                found = read(tmp_path, bytes(broken))
            except DrawingFileError:
                continue
            assert {name: found.get(name) for name in small} == small, at


def test_every_cut_is_noticed(tmp_path):
    data = written()
    for end in range(0, len(data), 7):
        with pytest.raises(DrawingFileError):
            read(tmp_path, data[:end])


def test_noise_is_refused(tmp_path):
    dice = random.Random(5)
    for n in (0, 1, 22, 100, 5000):
        with pytest.raises(DrawingFileError):
            read(tmp_path, dice.randbytes(n))


def test_a_later_version_is_refused_with_what_to_do(tmp_path, monkeypatch):
    monkeypatch.setattr(container, "VERSION", 2)
    data = written()
    monkeypatch.undo()
    with pytest.raises(DrawingFileError, match=r"stippler 9\.9, in version 2.*update Stippler"):
        read(tmp_path, data)


@pytest.mark.parametrize(
    "name", ["../up", "/abs", "a//b", "a/../b", "a\\b", "", "nul\0", "a/" * 20 + "b", "x" * 300]
)
def test_names_that_lead_elsewhere_are_refused(tmp_path, name):
    with pytest.raises(DrawingFileError):
        written({name: b""})
    stream = io.BytesIO(written())
    with zipfile.ZipFile(stream, "a") as archive:
        entry = zipfile.ZipInfo("placeholder")
        entry.filename = name
        archive.writestr(entry, b"")
    with pytest.raises(DrawingFileError):
        read(tmp_path, stream.getvalue())


def test_a_name_that_stands_twice_is_refused(tmp_path):
    stream = io.BytesIO(written())
    with zipfile.ZipFile(stream, "a") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("document.json", b"{}")
    with pytest.raises(DrawingFileError, match=r"lists 'document\.json' twice"):
        read(tmp_path, stream.getvalue())


@pytest.mark.parametrize(
    "limits",
    [
        {"file_bytes": 100},
        {"member_bytes": 1000},
        {"total_bytes": 5000},
        {"members": 2},
        {"ratio": 2.0},
    ],
)
def test_limits_are_kept_by_what_is_declared(tmp_path, limits):
    with pytest.raises(DrawingFileError):
        read(tmp_path, written({**MEMBERS, "zeros": bytes(100_000)}), **limits)


def test_a_bomb_is_refused_by_what_it_declares_or_by_its_bytes(tmp_path):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("mimetype", MIME)
        archive.writestr(MANIFEST, b'{"format":"stipple","version":1,"members":{}}')
        archive.writestr("bomb", bytes(50_000_000))
    data = stream.getvalue()
    with pytest.raises(DrawingFileError):
        read(tmp_path, data, member_bytes=1_000_000)
    lying = data.replace((50_000_000).to_bytes(4, "little"), (5_000).to_bytes(4, "little"))
    assert lying != data
    with pytest.raises(DrawingFileError):
        read(tmp_path, lying, member_bytes=1_000_000)


def test_no_file_and_a_folder_are_told_apart(tmp_path):
    with pytest.raises(DrawingFileError, match="no such file"):
        read_container(tmp_path / "none.stipple")
    with pytest.raises(DrawingFileError, match="is a folder"):
        read_container(tmp_path)


@pytest.mark.parametrize("version", ["0", "-1", '"1"', "true", "null", "1.0"])
def test_a_version_that_is_none_is_refused(tmp_path, version):
    path = tmp_path / "one.stipple"
    manifest = f'{{"format":"stipple","version":{version},"members":{{}}}}'
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", MIME)
        archive.writestr(MANIFEST, manifest)
    with pytest.raises(DrawingFileError, match="names no version"):
        read_container(path)
