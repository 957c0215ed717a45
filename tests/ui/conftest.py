"""Pictures, and an editor in a window without a display."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from stippler.app import App
from stippler.drawing.style import Style
from stippler.ui.window.gui import Gui
from stippler.ui.window.scripted_host import Host
from stippler.ui.window.window import Window
from tests.unseen_frames import filled_when_seen


@dataclass(frozen=True)
class Desk:
    """An editor and the hands on it."""

    app: App
    host: Host


@pytest.fixture(scope="session")
def kernels() -> None:
    """Compiled kernels, so that no test waits for them where a person would be told."""
    subprocess.run([sys.executable, "-m", "stippler.warm"], check=True, capture_output=True)


@pytest.fixture(scope="session")
def picture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A dark disc on white, 120 x 90."""
    y, x = np.mgrid[0:90, 0:120]
    inside = np.hypot(x - 59.5, y - 44.5) < 30
    path = tmp_path_factory.mktemp("pictures") / "disc.png"
    Image.fromarray(np.where(inside, 90, 255).astype(np.uint8)).save(path)
    return path


@pytest.fixture(autouse=True)
def only_pixels_that_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let software GL fill in a frame's panels when its pixels are asked for."""
    draw, pixels = filled_when_seen()
    monkeypatch.setattr(Gui, "draw", draw)
    monkeypatch.setattr(Window, "pixels", pixels)


@pytest.fixture
def desk(kernels: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Desk]:
    """An empty editor of 1000 x 700, few dots planned, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("STIPPLER_SCALE", raising=False)
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    style = Style(n_dots=300, iterations=4)
    app = App(style, tone="linear", width_mm=120.0, size=(1000, 700), offscreen=True)
    try:
        yield Desk(app, Host(app.window, app.editor, app.step))
    finally:
        app.close()
