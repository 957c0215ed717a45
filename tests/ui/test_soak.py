"""Random input for a few hundred frames: nothing fails, and the drawing stays whole."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("seed", [1, 2])
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
    soak = module.Soak(tmp_path, seed)
    left = iter(range(500))
    try:
        soak.run_round(lambda: next(left, None) is not None)
    finally:
        soak.close()
    assert soak.faults == []
    assert soak.hand.n_frames > 100
    assert soak.hand.acts.total() == 500
