"""A day at the desk: a real window under Xvfb, a real mouse, a real keyboard.

The short form of `tests/long/day.py`, which looks at every step's picture.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.window
SCRIPT = Path(__file__).parents[1] / "long" / "day.py"


@pytest.mark.parametrize("hand", ["mouse", "keyboard"])
def test_a_day(kernels: None, hand: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, str(SCRIPT), str(tmp_path), "--short", "--hand", hand],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        env={**os.environ, "PYTHONPATH": str(SCRIPT.parents[2])},
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    told = done.stdout
    for step in ("photo", "paint", "undo", "save", "wrong file", "quit"):
        assert f"{step}: ok" in told, told
