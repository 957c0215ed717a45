"""After `make run` has compiled the kernels, nothing a person does compiles another."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from stippler import warm
from stippler.kernels.machine import store

# in a process of its own, where no other test has compiled anything
SCRIPT = """
import json, sys, tempfile
import numpy as np
import stippler
from stippler.drawing.style import FIRST_DOTS

picture = np.random.default_rng(0).integers(0, 256, (50, 70, 3), np.uint8)
white = np.full((40, 40), 255, np.uint8)
late = []
with tempfile.TemporaryDirectory() as folder:
    for method in FIRST_DOTS:
        for tone in ("linear", "perceptual"):
            for image, options in [
                (picture, {}), (picture / 255, {"size_range": (0.2, 0.4)}), (white, {}),
            ]:
                drawing = stippler.stipple(
                    image, 200, 50, iterations=2, tone=tone, first_dots=method, **options
                )
                for ending in ("svg", "png", "csv"):
                    drawing.save(f"{folder}/d.{ending}", dpi=60)
                if "numba" in sys.modules:
                    late.append([method, tone, list(options)])
print(json.dumps(late))
"""


@pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")
def test_after_warming_drawing_imports_no_numba():
    for command in (["-m", "stippler.warm"], ["-c", SCRIPT]):
        done = subprocess.run(
            [sys.executable, *command], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == []


@pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")
def test_what_was_made_for_another_processor_is_not_compiled(monkeypatch):
    monkeypatch.setenv("NUMBA_CPU_NAME", "nehalem")
    store.stores.cache_clear()
    assert not warm.is_warm()
    monkeypatch.undo()
    store.stores.cache_clear()


def test_without_the_mark_it_is_cold(monkeypatch, tmp_path):
    monkeypatch.setenv("STIPPLER_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(store, "packed_stores", lambda: tmp_path / "none")
    store.stores.cache_clear()
    assert not warm.is_warm()
    assert list(Path(tmp_path).iterdir()) == []
    store.stores.cache_clear()
