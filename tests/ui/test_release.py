"""Whatever the editor made on the GPU is gone when it closes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import moderngl
import pytest

from stippler.app import App
from stippler.drawing.style import Style
from stippler.ui.panels.layout import SHAPE
from stippler.ui.window.scripted_host import Host

MAKERS = ("buffer", "texture", "renderbuffer", "framebuffer", "program", "vertex_array")


def test_closing_releases_every_gl_object(
    kernels: None, picture: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    made = []

    def watched(name: str) -> Callable:
        make = getattr(moderngl.Context, name)

        def wrapper(self, *args, **kwargs):
            made.append(make(self, *args, **kwargs))
            return made[-1]

        return wrapper

    for name in MAKERS:
        monkeypatch.setattr(moderngl.Context, name, watched(name))
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    style = Style(n_dots=300, iterations=2)
    app = App(style, tone="linear", width_mm=120.0, size=(900, 600), offscreen=True)
    monkeypatch.setattr(app.window.ctx, "release", lambda: None)  # would take all with it
    host = Host(app.window, app.editor, app.step)
    host.drop(picture)
    host.until(lambda: app.session.phase == "done", "the drawing")
    app.editor.show_panel(SHAPE)
    app.editor.look.reference_shown = True
    app.editor.look.lens = "reduce"
    toolbox = app.editor.painting.toolbox
    toolbox.choose("shape")
    toolbox.set_brush(replace(toolbox.brush, values={"along": "edge"}))
    host.settle()
    host.move(600, 300)
    host.settle()
    assert app.editor.canvas.patch.box is not None
    assert app.editor.canvas.n_lens_drawn
    assert len(made) > 20
    app.close()
    alive = [thing for thing in made if type(thing.mglo).__name__ != "InvalidObject"]
    assert not alive
