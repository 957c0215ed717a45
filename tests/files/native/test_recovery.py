import subprocess
import sys

import pytest

from stippler.errors import DrawingFileError
from stippler.files.native import recovery
from stippler.files.native.recovery import Keeper, lost_drawings

MEMBERS = {"document.json": b"{}"}


def kept(root, records, name="ear"):
    """Keep a drawing and some edits in a process that is killed; return nothing."""
    script = (
        "import os, signal, sys\n"
        "from pathlib import Path\n"
        "from stippler.files.native.recovery import Keeper\n"
        f"keeper = Keeper(Path({str(root)!r}))\n"
        f"keeper.begin(lambda: {MEMBERS!r}, {name!r}, Path('/somewhere/ear.stipple'), 'stippler')\n"
        f"for record in {records!r}: keeper.append(lambda record=record: record)\n"
        "assert keeper.wait()\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    process = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert process.returncode == -9, process.stderr


def test_what_a_killed_process_kept_is_found_and_read(tmp_path):
    kept(tmp_path, [b"one", b"two"])
    (lost,) = lost_drawings(tmp_path)
    assert (lost.name, str(lost.path)) == ("ear", "/somewhere/ear.stipple")
    members, replay = lost.read()
    assert members == MEMBERS
    assert replay.records == [b"one", b"two"]
    lost.discard()
    assert lost_drawings(tmp_path) == []


def test_a_drawing_that_is_open_is_not_lost_and_one_that_was_closed_leaves_nothing(tmp_path):
    keeper = Keeper(tmp_path)
    keeper.begin(lambda: MEMBERS, "ear", None, "stippler")
    keeper.append(lambda: b"one")
    assert keeper.wait()
    assert lost_drawings(tmp_path) == []
    keeper.forget()
    assert list(tmp_path.iterdir()) == []


def test_beginning_again_takes_the_place_of_what_was_kept(tmp_path):
    keeper = Keeper(tmp_path)
    keeper.begin(lambda: MEMBERS, "ear", None, "stippler")
    keeper.append(lambda: b"old")
    keeper.begin(lambda: {"document.json": b"{2}"}, "ear", None, "stippler")
    keeper.append(lambda: b"new")
    assert keeper.wait()
    (folder,) = tmp_path.iterdir()
    assert sorted(f.name for f in folder.iterdir()) == [
        "about.json", "base-2.stipple", "edits-2.journal", "lock",
    ]  # fmt: skip
    lost = recovery.Lost(folder, "ear", None, 0.0)
    members, replay = lost.read()
    assert members == {"document.json": b"{2}"}
    assert replay.records == [b"new"]
    keeper.forget()


def test_edits_made_while_a_new_base_is_written_are_in_both_journals(tmp_path):
    keeper = Keeper(tmp_path)
    keeper.begin(lambda: MEMBERS, "ear", None, "stippler")
    assert keeper.wait()

    def fail():
        raise MemoryError

    keeper.begin(fail, "ear", None, "stippler")
    keeper.append(lambda: b"meanwhile")
    assert not keeper.wait()
    assert "cannot be kept" in str(keeper.problem)
    (folder,) = tmp_path.iterdir()
    members, replay = recovery.Lost(folder, "ear", None, 0.0).read()
    assert members == MEMBERS
    assert replay.records == [b"meanwhile"]
    keeper.begin(lambda: MEMBERS, "ear", None, "stippler")
    assert keeper.wait()
    assert keeper.problem is None
    keeper.forget()


@pytest.mark.parametrize("about", [b"", b"{", b"[]", b'{"turn":-1}', b'{"turn":"x","mark":7}'])
def test_a_broken_page_about_it_harms_nobody(tmp_path, about):
    kept(tmp_path, [b"one"])
    (folder,) = tmp_path.iterdir()
    (folder / "about.json").write_bytes(about)
    for lost in lost_drawings(tmp_path):
        with pytest.raises(DrawingFileError):
            lost.read()
