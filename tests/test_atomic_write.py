"""Files are written whole or not at all."""

import errno
import os
import shutil
import stat
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest

from stippler.atomic_write import check_writable, replacing
from stippler.errors import OutputError


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
    def refuse(*args, **kwargs):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(OutputError, match="read-only disk"):
        replacing(tmp_path / "a.svg").__enter__()


# --- what stood there keeps what it was ---------------------------------------------------------


def write(path, content=b"new"):
    with replacing(path) as stream:
        stream.write(content)


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o444, 0o755])
def test_the_mode_is_kept(tmp_path, mode):
    path = tmp_path / "a.svg"
    path.write_bytes(b"old")
    path.chmod(mode)
    if not os.access(path, os.W_OK):
        pytest.skip("may not be written")
    write(path)
    assert stat.S_IMODE(path.stat().st_mode) == mode


def test_a_new_file_has_the_mode_of_the_umask(tmp_path):
    before = os.umask(0o027)
    try:
        write(tmp_path / "a.svg")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a.svg").stat().st_mode) == 0o640


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may give files away")
def test_the_owner_is_kept(tmp_path):
    path = tmp_path / "a.svg"
    path.write_bytes(b"old")
    os.chown(path, 1234, 2345)
    write(path)
    assert (path.stat().st_uid, path.stat().st_gid) == (1234, 2345)
    assert path.read_bytes() == b"new"


def test_an_owner_that_cannot_be_given_is_kept(tmp_path, monkeypatch):
    def refuse(*args):
        raise PermissionError(errno.EPERM, "no")

    path = tmp_path / "a.svg"
    path.write_bytes(b"old and longer than the new one")
    number = path.stat().st_ino
    monkeypatch.setattr(os, "fchmod", refuse)
    write(path)
    assert path.stat().st_ino == number  # written into, not replaced
    assert path.read_bytes() == b"new"
    assert names(tmp_path) == ["a.svg"]


@pytest.mark.parametrize("content", [b"", b"n", b"x" * 3_000_000])
def test_hard_links_are_kept(tmp_path, content):
    (tmp_path / "a.svg").write_bytes(b"old")
    (tmp_path / "b.svg").hardlink_to(tmp_path / "a.svg")
    write(tmp_path / "a.svg", content)
    assert (tmp_path / "b.svg").read_bytes() == content
    assert names(tmp_path) == ["a.svg", "b.svg"]


def test_a_hard_link_survives_a_full_disk(tmp_path, monkeypatch):
    def full(*args):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "posix_fallocate", full)
    (tmp_path / "a.svg").write_bytes(b"old")
    (tmp_path / "b.svg").hardlink_to(tmp_path / "a.svg")
    with pytest.raises(OutputError, match="disk is full"):
        write(tmp_path / "a.svg", b"much longer")
    assert (tmp_path / "a.svg").read_bytes() == b"old"
    assert names(tmp_path) == ["a.svg", "b.svg"]


def test_an_interrupt_while_a_hard_link_is_written_into(tmp_path, monkeypatch):
    copy, calls = shutil.copyfileobj, []

    def interrupted(*args):
        calls.append(1)
        if len(calls) == 1:
            raise KeyboardInterrupt
        copy(*args)

    monkeypatch.setattr(shutil, "copyfileobj", interrupted)
    (tmp_path / "a.svg").write_bytes(b"old")
    (tmp_path / "b.svg").hardlink_to(tmp_path / "a.svg")
    with pytest.raises(KeyboardInterrupt):
        write(tmp_path / "a.svg")
    assert (tmp_path / "b.svg").read_bytes() == b"new"


@pytest.mark.parametrize("name", ["線" * 82 + ".svg", "x" * 251 + ".svg"])
def test_the_longest_names(tmp_path, name):
    assert len(os.fsencode(name)) in (250, 255)
    write(tmp_path / name)
    assert names(tmp_path) == [name]


def test_a_name_that_is_not_utf8(tmp_path):
    path = Path(os.fsdecode(os.fsencode(tmp_path) + b"/caf\xe9.svg"))
    write(path)
    assert os.listdir(os.fsencode(tmp_path)) == [b"caf\xe9.svg"]


@pytest.mark.parametrize("check", [check_writable, write])
def test_a_loop_of_links(tmp_path, check):
    (tmp_path / "a.svg").symlink_to("b.svg")
    (tmp_path / "b.svg").symlink_to("a.svg")
    with pytest.raises(OutputError, match="leads back to itself"):
        check(tmp_path / "a.svg")


# --- many writers, and those that were killed ---------------------------------------------------


def test_two_threads_that_write_one_file_both_succeed(tmp_path):
    path = tmp_path / "a.svg"
    contents = [bytes([65 + k]) * 200_000 for k in range(8)]
    with ThreadPoolExecutor(8) as pool:
        for _ in range(10):
            list(pool.map(partial(write, path), contents))
            assert path.read_bytes() in contents
    assert names(tmp_path) == ["a.svg"]


def test_what_a_killed_process_left_is_removed(tmp_path):
    path = tmp_path / "a.svg"
    code = (
        "import os, signal, sys; from stippler.atomic_write import replacing\n"
        "with replacing(sys.argv[1]) as stream:\n"
        "    stream.write(b'half'); stream.flush(); os.kill(os.getpid(), signal.SIGKILL)"
    )
    for _ in range(2):
        subprocess.run([sys.executable, "-c", code, path], check=False)
    assert len(names(tmp_path)) == 1  # the second removed the first's
    (tmp_path / ".a.svg.4321.part").write_bytes(b"of an older version")
    (tmp_path / ".b.svg.4321.part").write_bytes(b"of another file")
    (tmp_path / ".a.svg.notes.part").write_bytes(b"nobody's")
    write(path)
    assert names(tmp_path) == [".a.svg.notes.part", ".b.svg.4321.part", "a.svg"]


def test_what_is_being_written_is_not_removed(tmp_path):
    with replacing(tmp_path / "a.svg") as first:
        first.write(b"first")
        write(tmp_path / "a.svg", b"second")
        assert len(names(tmp_path)) == 2
    assert (tmp_path / "a.svg").read_bytes() == b"first"


# --- inputs and outputs -------------------------------------------------------------------------


def test_no_input_is_written_over(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    picture = tmp_path / "photo.png"
    picture.write_bytes(b"picture")
    (tmp_path / "soft.png").symlink_to("photo.png")
    (tmp_path / "hard.png").hardlink_to(picture)
    (tmp_path / "folder").symlink_to(tmp_path)
    (tmp_path / "copy.png").write_bytes(b"picture")
    for name in ("photo.png", picture, "soft.png", "hard.png", "folder/photo.png"):
        with pytest.raises(OutputError, match="the very file that is read") as told:
            check_writable(name, [picture])
        assert str(name) in str(told.value)
    for name in ("copy.png", "new.png", "-", "/dev/null"):
        check_writable(name, [picture])
    check_writable("new.png", ["missing.png"])


@pytest.mark.parametrize("name", ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_standard_output_is_written_to_and_not_replaced(tmp_path, name):
    code = (
        "import sys; from stippler.atomic_write import replacing\n"
        "with replacing(sys.argv[1]) as stream: stream.write(b'whole')"
    )
    out = tmp_path / "out"
    with out.open("wb") as stream:
        stream.write(b"before, ")
        stream.flush()
        subprocess.run([sys.executable, "-c", code, name], stdout=stream, check=True)
    assert out.read_bytes() == b"before, whole"
    assert names(tmp_path) == ["out"]


def test_a_pipe_with_a_name(tmp_path):
    os.mkfifo(tmp_path / "pipe.svg")
    read = []
    reader = threading.Thread(target=lambda: read.append((tmp_path / "pipe.svg").read_bytes()))
    reader.start()
    write(tmp_path / "pipe.svg")
    reader.join()
    assert read == [b"new"]


def test_a_file_on_a_disk_that_became_read_only_is_told_as_such(tmp_path, monkeypatch):
    path = tmp_path / "a.txt"
    path.write_text("before")
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(OutputError, match="may not be written"), replacing(path):
        pass
    status = SimpleNamespace(f_flag=os.ST_RDONLY)
    monkeypatch.setattr(os, "statvfs", lambda _: status)
    with pytest.raises(OutputError, match="read-only disk; choose a folder"), replacing(path):
        pass
    assert path.read_text() == "before"
