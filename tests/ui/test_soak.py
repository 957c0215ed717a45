"""Random input for a few hundred frames: nothing fails, and the drawing stays whole."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import EXAMPLES

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("seed", range(1, 1 + EXAMPLES))
def test_random_input_does_no_harm(
    kernels: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, seed: int
) -> None:
    spec = importlib.util.spec_from_file_location("soak", ROOT / "benchmarks/soak.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "config"))
    soak = module.Soak(tmp_path, seed, n_dots=5000)
    try:
        for n in (500, 400):
            left = iter(range(n))
            soak.run_round(lambda left=left: next(left, None) is not None)
        for act in (soak.hand._save, soak.hand._load, soak.hand._export, soak.hand._edit_areas):
            act()  # each at least once, whatever chance has chosen
        soak.run_round(iter([True] * 50 + [False]).__next__)
    finally:
        soak.close()
    assert soak.faults == []
    assert soak.hand.n_frames > 100
    assert soak.hand.acts.total() == 950
    assert soak.memory_mb[-1] - soak.memory_mb[0] < module.MOST_MB


def test_the_soak_runs_as_a_program(kernels: None, tmp_path: Path) -> None:
    """As `make soak` does: in a process where nothing else has loaded the window's libraries."""
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.soak", "0.001"],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
        env={**os.environ, "STIPPLER_STATE_DIR": str(tmp_path)},
    )
    assert done.returncode == 0, done.stderr[-500:]
    assert "random input: faults" in done.stdout
