"""Saving is all or nothing, whatever call fails and whenever the process is killed."""

import errno
import importlib.util
import os
import stat
import sys
from pathlib import Path

import pytest

from stippler import atomic_write
from stippler.errors import OutputError
from stippler.files.native import recovery
from stippler.files.native.container import read_container

spec = importlib.util.spec_from_file_location(
    "kills", Path(__file__).parents[2] / "long" / "kills.py"
)
kills = importlib.util.module_from_spec(spec)
spec.loader.exec_module(kills)

CALLS = ("open", "fsync", "replace", "fchmod", "fchown", "fstat")


class Failing:
    """`os` with the k-th of some calls failing."""

    def __init__(self, names, at, error):
        self.names, self.left, self.error = names, at, error

    def __getattr__(self, name):
        real = getattr(os, name)
        if name not in self.names:
            return real

        def call(*args, **kwargs):
            self.left -= 1
            if self.left == 0:
                raise OSError(self.error, os.strerror(self.error))
            return real(*args, **kwargs)

        return call


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EIO, errno.EACCES])
def test_whatever_call_fails_the_old_file_or_the_new_one_opens(tmp_path, monkeypatch, error):
    path = tmp_path / "one.stipple"
    kills.save(path, 1)
    failed = 0
    for at in range(1, 40):
        monkeypatch.setattr(atomic_write, "os", Failing(CALLS, at, error))
        told = ""
        try:
            kills.save(path, 2)
        except OutputError as problem:
            told = str(problem)
            failed += 1
        monkeypatch.undo()
        assert not told or told.startswith(str(path))
        found = read_container(path)
        assert found in (kills.members(1), kills.members(2))
        if not told:
            assert found == kills.members(2), "a save that was not done went untold"
        assert [f.name for f in tmp_path.iterdir()] == ["one.stipple"]
        kills.save(path, 1)
    assert failed >= 4


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EIO])
def test_a_write_that_fails_midway_leaves_the_old_file(tmp_path, error):
    path = tmp_path / "one.stipple"
    kills.save(path, 1)

    def save_half():
        with atomic_write.replacing(path) as stream:
            stream.write(b"half of it")
            raise OSError(error, os.strerror(error))

    with pytest.raises(OutputError):
        save_half()
    assert read_container(path) == kills.members(1)
    assert [f.name for f in tmp_path.iterdir()] == ["one.stipple"]


class Recording:
    """`os` that takes note of what is synced and renamed, and of how much was there by then."""

    def __init__(self):
        self.done = []

    def __getattr__(self, name):
        return getattr(os, name)

    def fsync(self, descriptor):
        status = os.fstat(descriptor)
        what = "folder" if stat.S_ISDIR(status.st_mode) else status.st_size
        self.done.append(("fsync", what))
        os.fsync(descriptor)

    def replace(self, one, other):
        self.done.append(("replace", os.path.getsize(one)))
        os.replace(one, other)


@pytest.mark.parametrize("before", [False, True])
def test_all_bytes_are_on_disk_before_the_name_is_taken_and_the_name_after_it(
    tmp_path, monkeypatch, before
):
    path = tmp_path / "one.stipple"
    if before:
        kills.save(path, 1)
    system = Recording()
    monkeypatch.setattr(atomic_write, "os", system)
    kills.save(path, 2)
    monkeypatch.undo()
    n = path.stat().st_size
    assert system.done == [("fsync", n), ("replace", n), ("fsync", "folder")]


def test_a_recovery_base_is_on_disk_before_the_page_that_names_it(tmp_path, monkeypatch):
    system = Recording()
    monkeypatch.setattr(recovery, "os", system)
    keeper = recovery.Keeper(tmp_path)
    keeper.begin(lambda: kills.members(1), "ear", None, "stippler")
    assert keeper.wait()
    monkeypatch.undo()
    (folder,) = tmp_path.iterdir()
    base = (folder / "base-1.stipple").stat().st_size
    about = (folder / "about.json").stat().st_size
    assert system.done == [("fsync", base), ("fsync", about), ("replace", about)]
    keeper.forget()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_process_killed_while_it_saves_leaves_a_whole_file():
    seen = kills.kill_saves(40)
    assert sum(seen.values()) == 40
    assert seen["new"], sys.version
