"""The jobs themselves: kernels prepared in a process of their own, pictures read once."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from stippler.drawing.adjustment import Adjustment
from stippler.drawing.style import Style
from stippler.errors import PictureError, StipplerError
from stippler.jobs import preparing
from stippler.jobs.stippling import stipple_picture
from stippler.jobs.work import Source

STYLE = Style(n_dots=100, iterations=2, spacing="lloyd")


def fake_compiler(monkeypatch: pytest.MonkeyPatch, program: str) -> list[subprocess.Popen[str]]:
    """Run a program of ours where the kernels would be compiled."""
    begun: list[subprocess.Popen[str]] = []
    real = subprocess.Popen

    def popen(_: list[str], **options: Any) -> subprocess.Popen[str]:
        begun.append(real([sys.executable, "-c", program], **options))
        return begun[-1]

    monkeypatch.setattr(preparing.subprocess, "Popen", popen)
    return begun


def test_stages_come_in_order_and_the_picture_is_read_once(picture: Path) -> None:
    source = Source(picture, "linear", 60.0)
    steps = list(stipple_picture(source, STYLE, None, is_warm=lambda: True))
    stages = list(dict.fromkeys(step.stage for step in steps))
    assert stages == ["read", "first dots", "relax", "tone", "done"]
    assert steps[0].reference is None
    reference = steps[1].reference
    assert reference is not None
    assert all(step.reference is reference for step in steps[1:])
    again = list(stipple_picture(source, STYLE, reference, is_warm=lambda: True))
    assert again[0].stage == "first dots"
    assert again[-1].progress is not None
    assert steps[-1].progress is not None
    assert (again[-1].progress.position_mm == steps[-1].progress.position_mm).all()


def test_adjustments_change_the_dots_and_not_the_picture(picture: Path) -> None:
    plain = Source(picture, "linear", 60.0)
    lighter = replace(plain, adjustment=Adjustment(brightness=0.4))
    first = list(stipple_picture(plain, STYLE, None, is_warm=lambda: True))[-1]
    known = first.reference
    assert known is not None
    picture.touch()
    again = list(stipple_picture(lighter, STYLE, known, is_warm=lambda: True))
    assert again[0].stage == "first dots"  # not read again
    last = again[-1]
    assert last.reference is not None
    assert last.reference.picture is known
    assert last.progress is not None
    assert first.progress is not None
    ink = [float((work.progress.radius_mm**2).sum()) for work in (first, last) if work.progress]
    share = known.adjusted(lighter.adjustment).darkness.mean() / known.darkness.mean()
    assert ink[1] / ink[0] == pytest.approx(share, abs=0.05)
    back = list(stipple_picture(plain, STYLE, last.reference, is_warm=lambda: True))[-1]
    assert back.reference is known
    assert back.progress is not None
    assert (back.progress.position_mm == first.progress.position_mm).all()


def test_a_missing_picture_fails_before_anything_is_compiled(tmp_path: Path) -> None:
    jobs = stipple_picture(Source(tmp_path / "no.png", "linear", 60.0), STYLE, None, is_warm=_never)
    with pytest.raises(PictureError, match="no such file"):
        list(jobs)


def _never() -> bool:
    raise AssertionError("asked for kernels")


def test_kernels_are_prepared_first(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = fake_compiler(monkeypatch, "print('Compiling: 3/7 tone')")
    source = Source(picture, "linear", 60.0)
    stages = [step.stage for step in stipple_picture(source, STYLE, None, is_warm=lambda: False)]
    assert stages.index("prepare") < stages.index("first dots")
    assert [process.returncode for process in begun] == [0]


def test_preparing_ends_when_the_job_does(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = fake_compiler(
        monkeypatch,
        "import time; print('Compiling: 3/7 tone', flush=True); time.sleep(1000)",
    )
    source = Source(picture, "linear", 60.0)
    jobs = stipple_picture(source, STYLE, None, is_warm=lambda: False)
    for step in jobs:
        if (step.done, step.total) == (3, 7):
            break
    assert begun[0].poll() is None
    jobs.close()  # type: ignore[attr-defined]
    assert begun[0].returncode is not None


def test_a_compiler_that_fails_is_told(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fake_compiler(monkeypatch, "import sys; sys.exit('no compiler at all')")
    source = Source(picture, "linear", 60.0)
    with pytest.raises(StipplerError, match="no compiler at all"):
        list(stipple_picture(source, STYLE, None, is_warm=lambda: False))
