"""After a rehearsal the window's thread loads no kernel, whatever a person does."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image

# in a process of its own, where no other test has loaded anything
SCRIPT = """
import json, sys, threading
from pathlib import Path
from numba.core.dispatcher import Dispatcher
from stippler.app import App
from stippler.brushes.kinds import KINDS
from stippler.drawing.style import Style
from stippler.ui.window.gui import Gui
from stippler.ui.window.scripted_host import Host
from stippler.ui.window.window import Window
from tests.unseen_frames import filled_when_seen

Gui.draw, Window.pixels = filled_when_seen()
loaded, at_work = [], []
compile_one = Dispatcher.compile

def compile_and_tell(self, signature):
    if at_work and threading.current_thread() is threading.main_thread():
        loaded.append(f"{at_work[-1]}: {self.py_func.__name__} {signature}")
    return compile_one(self, signature)

Dispatcher.compile = compile_and_tell
style = Style(n_dots=500, iterations=2)
app = App(style, tone="linear", width_mm=60, size=(1000, 700), offscreen=True)
host = Host(app.window, app.editor, app.step)
session, painting = app.session, app.editor.painting

def at(x_mm, y_mm):
    editor = app.editor
    x, y = editor.view.camera.page_to_screen((x_mm, y_mm), editor.view.size_px)
    left, top = editor.pointer.origin_px
    return float(x + left), float(y + top)

def variants(tool):
    for parameter in tool.parameters:
        for option in parameter.values or (True, False) * isinstance(parameter.default, bool):
            yield parameter.name, option

host.drop(Path(sys.argv[1]))
host.until(lambda: session.phase == "done", "the drawing")
at_work.append("first frames")
host.settle()
for card in painting.toolbox.cards:
    painting.toolbox.choose(card.name)
    tool = painting.toolbox.tool
    for name, option in [*variants(tool), (None, None)]:
        at_work.append(f"{tool.name} {name} {option}")
        if name:
            tool.set(name, option)
        host.drag(at(20, 20), at(30, 25), "left")
at_work.append("selection")
painting.select_all()
for act in (painting.relax, painting.jitter, painting.duplicate, painting.delete):
    act()
    host.settle()
at_work.append("undo")
painting.undo()
painting.redo()
host.scroll(3, at(20, 20))
at_work.append("relaxing")
painting.undo()
session.relax(1000, weighted=False)
host.until(lambda: session.done > 2, "some steps")
host.settle()
app.close()
print(json.dumps({"n_used": len(at_work), "loaded": loaded}))
"""


def test_no_kernel_loads_under_a_hand(tmp_path: Path) -> None:
    picture = tmp_path / "ramp.png"
    Image.fromarray(np.tile(np.linspace(0, 255, 90, dtype=np.uint8), (60, 1))).save(picture)
    result = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(picture)],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parents[2],
        env={**os.environ, "STIPPLER_CONFIG_DIR": str(tmp_path)},
    )
    assert result.returncode == 0, result.stderr
    found = json.loads(result.stdout.splitlines()[-1])
    assert found["n_used"] > 30
    assert found["loaded"] == []
