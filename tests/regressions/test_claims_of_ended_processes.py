"""What a process was making when it was ended was waited for, up to a minute; now by nobody."""

import subprocess
import sys
import time

import pytest

from stippler.kernels.machine import export, store

pytestmark = pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")

SCRIPT = """
import sys, time
from pathlib import Path
from stippler.kernels.machine import export
path = Path(sys.argv[1])
with export._claimed(path):
    print("claimed", flush=True)
    time.sleep(float(sys.argv[2]))
    path.write_bytes(b"code")
"""


def maker(path, for_s):
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(path), str(for_s)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "claimed\n"
    return process


def test_a_process_that_was_ended_holds_nobody_up(tmp_path):
    path = tmp_path / "kernel.o"
    process = maker(path, 60)
    process.kill()
    process.communicate()
    began = time.perf_counter()
    with export._claimed(path):
        assert not path.exists()
    assert time.perf_counter() - began < 5


def test_one_that_runs_is_waited_for(tmp_path):
    path = tmp_path / "kernel.o"
    process = maker(path, 1)
    with export._claimed(path):
        assert path.exists()
    process.communicate()
