"""What is left of numba's cache never stops a program: cut files, threads, no folder at all."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

SCRIPT = """
from stippler.kernels.machine.jit import kernel
import sys
sys.path.insert(0, {folder!r})
import small
print(kernel(small.twice)(21))
"""


@pytest.fixture
def call(tmp_path):
    """Compile a small kernel in a process of its own."""
    (tmp_path / "small.py").write_text("def twice(n):\n    return 2 * n\n")

    def run(**environment):
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT.format(folder=str(tmp_path))],
            capture_output=True, text=True, check=False,
            env={**os.environ, "STIPPLER_CACHE_DIR": str(tmp_path / "cache"), **environment},
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert done.stdout == "42\n"

    return run


@pytest.mark.parametrize("ending", ["nbi", "nbc"])
@pytest.mark.parametrize("size", [0, 20])
def test_a_cut_file_is_made_again(call, tmp_path, ending, size):
    call()
    (file,) = (tmp_path / "cache").rglob(f"*.{ending}")
    file.write_bytes(file.read_bytes()[:size])
    call()
    (file,) = (tmp_path / "cache").rglob(f"*.{ending}")
    assert file.stat().st_size > 20
    call()


def test_without_a_folder_to_write_to_kernels_still_run(call, tmp_path):
    (tmp_path / "file").write_text("")
    call(STIPPLER_CACHE_DIR=str(tmp_path / "file" / "below"))


def test_a_user_without_a_home_has_a_folder(monkeypatch, tmp_path):
    from stippler.kernels.machine import cache

    monkeypatch.delenv("STIPPLER_CACHE_DIR", raising=False)
    monkeypatch.setattr(cache, "user_cache_path", lambda name: Path("/nonexistent/.cache") / name)
    monkeypatch.setattr(cache.os, "access", lambda path, mode: False)
    monkeypatch.setattr(cache.tempfile, "gettempdir", lambda: str(tmp_path))
    cache._usual_root.cache_clear()
    root = cache.cache_root()
    assert root == tmp_path / f"stippler-{os.getuid()}"
    root.mkdir()
    monkeypatch.setattr(cache.os, "getuid", lambda: 12345)
    (tmp_path / "stippler-12345").mkdir()  # not that user's own
    cache._usual_root.cache_clear()
    assert cache.cache_root().name == f"stippler-12345-{os.getpid()}"
    cache._usual_root.cache_clear()


def test_two_threads_compile_one_after_the_other(monkeypatch, tmp_path):
    # The window and the worker compile kernels at the same time; one put numba's setting back
    # while the other used it, and machine code landed in the folder the program was started in.
    from stippler.kernels.machine import jit
    from stippler.kernels.machine.cache import module_folder

    monkeypatch.setenv("STIPPLER_CACHE_DIR", str(tmp_path))
    seen = []

    def keep(dispatcher):
        import numba.core.config

        seen.append(numba.core.config.CACHE_DIR)

    monkeypatch.setattr("stippler.kernels.machine.numba_cache.keep_on_disk", keep)

    def function(x):
        return x

    threads = [threading.Thread(target=lambda: jit.Kernel(function, {}).dispatcher) for _ in "ab"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert seen == [str(module_folder(__file__))] * 2
