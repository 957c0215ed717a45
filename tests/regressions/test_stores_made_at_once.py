"""Two processes that made the kernels at once took each other's lists: one's store was empty."""

import json
import subprocess
import sys

import pytest

from stippler.kernels.machine import store

pytestmark = pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")

KERNELS = {"module:kernel": {"sources": "0", "entries": [f"stippler_{k}" for k in range(20)]}}

SCRIPT = """
import json, sys
from pathlib import Path
from stippler.kernels.machine import export

export._link = lambda objects, target: False  # copied one by one, which takes longest
folder, target = map(Path, sys.argv[1:3])
for _ in range(40):
    export.finish(folder, json.loads(sys.argv[3]), target)
"""


def test_each_of_two_leaves_a_whole_store(tmp_path):
    folder, target = tmp_path / "objects", tmp_path / "store"
    folder.mkdir()
    names = ["runtime", *KERNELS["module:kernel"]["entries"]]
    for name in names:
        (folder / f"{name}.o").write_bytes(b"code")
    command = [sys.executable, "-c", SCRIPT, str(folder), str(target), json.dumps(KERNELS)]
    both = [subprocess.Popen(command, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    for process in both:
        _, said = process.communicate(timeout=60)
        assert process.returncode == 0, said
    assert json.loads((target / store.LIST).read_text())["kernels"] == KERNELS
    assert sorted(path.stem for path in target.glob("*.o")) == sorted(names)
