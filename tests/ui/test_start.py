"""What a start imports: no more than the first frame needs."""

import json
import os
import subprocess
import sys

import pytest

_FIRST_FRAME = """
import json, sys
from stippler.app import App
from stippler.drawing.style import Style
app = App(Style(), tone="linear", width_mm=148.0, size=(1280, 800), offscreen=True)
app.step(0.0)
first = sorted(sys.modules)
app.editor.painting.toolbox.choose("knife")
json.dump([first, "stippler.editor.tools.knife_tool" in sys.modules], sys.stdout)
app.close()
"""
LATE = (
    "cffi", "cv2", "PIL", "scipy", "pypdf", "fontTools", "numpy.random", "importlib.metadata",
    "stippler.analysis", "stippler.export", "stippler.files.read", "stippler.jobs.export_look",
    "stippler.stippling.pipeline", "stippler.ui.canvas.pen_samples",
    "stippler.ui.popups.export_dialog", "stippler.ui.popups.palette", "stippler.ui.popups.recovery",
    "stippler.ui.popups.preferences_window",
)  # fmt: skip
TOOLS = "stippler.editor.tools."
USED = ("brush_shelf", "brush_tool", "cards", "line_choice", "picture_source", "selection", "tool")


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """Return the modules of a first frame, and whether a tool's came when it was taken."""
    folder = str(tmp_path_factory.mktemp("settings"))
    env = {"STIPPLER_CONFIG_DIR": folder, "STIPPLER_STATE_DIR": folder}
    told = subprocess.run(
        [sys.executable, "-c", _FIRST_FRAME],
        env={**os.environ, **env},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    first, is_taken = json.loads(told)
    return set(first), is_taken


def test_a_first_frame_imports_nothing_that_only_later_ones_need(imported) -> None:
    first, _ = imported
    assert "stippler.ui.editor_window" in first
    assert [name for name in LATE if name in first] == []


def test_a_tool_is_imported_when_it_is_first_taken(imported) -> None:
    first, is_taken = imported
    tools = {name.removeprefix(TOOLS) for name in first if name.startswith(TOOLS)}
    assert tools <= {*USED, "toolbox"}
    assert is_taken
