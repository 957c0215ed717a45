"""Files are written whole or not at all."""

import errno
import os
from pathlib import Path

import pytest

from stippler.errors import OutputError
from stippler.files.atomic_write import check_writable, replacing


def names(folder):
    return sorted(p.name for p in folder.iterdir())


def test_a_new_file(tmp_path):
    with replacing(tmp_path / "a.svg") as stream:
        stream.write(b"whole")
        assert not (tmp_path / "a.svg").exists()
    assert (tmp_path / "a.svg").read_bytes() == b"whole"
    assert names(tmp_path) == ["a.svg"]


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError, MemoryError])
def test_what_stood_there_survives(tmp_path, error):
    path = tmp_path / "a.svg"
    path.write_bytes(b"before")

    def fail():
        with replacing(path) as stream:
            stream.write(b"half")
            raise error

    with pytest.raises(error):
        fail()
    assert path.read_bytes() == b"before"
    assert names(tmp_path) == ["a.svg"]


def test_a_full_disk(tmp_path):
    link = tmp_path / "full.svg"
    link.symlink_to("/dev/full")

    def fill():
        with replacing(link) as stream:
            stream.write(b"x" * 100_000)

    with pytest.raises(OutputError, match="disk is full") as caught:
        fill()
    assert str(link) in str(caught.value)


def test_a_full_disk_leaves_nothing(tmp_path, monkeypatch):
    def full(fd):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)

    def fill():
        with replacing(tmp_path / "a.svg") as stream:
            stream.write(b"x")

    with pytest.raises(OutputError, match="disk is full"):
        fill()
    assert names(tmp_path) == []


def test_a_link_is_followed(tmp_path):
    (tmp_path / "real.svg").write_bytes(b"old")
    (tmp_path / "link.svg").symlink_to("real.svg")
    with replacing(tmp_path / "link.svg") as stream:
        stream.write(b"new")
    assert (tmp_path / "link.svg").is_symlink()
    assert (tmp_path / "real.svg").read_bytes() == b"new"


@pytest.mark.parametrize("check", [check_writable, lambda path: replacing(path).__enter__()])
def test_names_that_cannot_be_written(tmp_path, check):
    (tmp_path / "file").write_bytes(b"")
    for path, says in [
        (tmp_path / "none" / "a.svg", "does not exist"),
        (tmp_path, "is a folder"),
        (tmp_path / "file" / "a.svg", "is a file"),
        (tmp_path / ("x" * 300 + ".svg"), "too long"),
    ]:
        with pytest.raises(OutputError, match=says):
            check(path)


def test_a_read_only_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != tmp_path)  # root may write
    with pytest.raises(OutputError, match="may not be written"):
        check_writable(tmp_path / "a.svg")


def test_a_read_only_disk(tmp_path, monkeypatch):
    def refuse(self, *args, **kwargs):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(OutputError, match="read-only disk"):
        replacing(tmp_path / "a.svg").__enter__()
