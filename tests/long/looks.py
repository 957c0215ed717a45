"""Pictures of every panel and window of the editor, at a size and a scale: to be looked at.

``python tests/long/looks.py OUT [--size 900x600] [--scale 1.0] [--only NAME]``
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "assets" / "samples" / "ammonite.png"


def main() -> None:
    """Open the editor without a display, and take its picture in every state of the list."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("out", type=Path)
    options.add_argument("--size", default="900x600")
    options.add_argument("--scale", default="1.0")
    options.add_argument("--only", default="")
    chosen = options.parse_args()
    chosen.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        os.environ["STIPPLER_CONFIG_DIR"] = os.environ["STIPPLER_STATE_DIR"] = folder
        os.environ["STIPPLER_SCALE"] = chosen.scale
        width, height = (int(side) for side in chosen.size.split("x"))
        take((width, height), chosen.out, chosen.only)


def take(size: tuple[int, int], out: Path, only: str) -> None:
    """Take all pictures, and tell which labels had to be cut."""
    from stippler.app import App
    from stippler.drawing.style import Style
    from stippler.ui.window.scripted_host import Host

    app = App(Style(n_dots=3000, iterations=3), tone="linear", width_mm=148.0, size=size,
              offscreen=True)  # fmt: skip
    try:
        host = Host(app.window, app.editor, app.step)
        for name, show in states(host, app).items():
            if only and only not in name:
                show()
                continue
            show()
            host.settle()
            Image.fromarray(host.screenshot()).save(out / f"{name}.png")
            cut = getattr(app.editor.widgets, "cut", ())
            print(name, "cut:" if cut else "", ", ".join(cut))
    finally:
        app.close()


def states(host: object, app: object) -> dict[str, Callable[[], None]]:
    """Return what is to be looked at, by name, each from the one before."""
    from stippler.drawing.drawing import Page

    hands, editor, session = host, app.editor, app.session  # type: ignore[attr-defined]
    found: dict[str, Callable[[], None]] = {}

    def escape() -> None:
        for _ in range(3):
            hands.key("escape")

    def run(name: str) -> Callable[[], None]:
        def act() -> None:
            escape()
            editor.commands[name].run()
            hands.leave()
            hands.settle()

        return act

    def open_sample() -> None:
        session.open(SAMPLE)
        hands.until(lambda: session.phase == "done", "the drawing")
        hands.settle()

    def panel(name: str) -> Callable[[], None]:
        def act() -> None:
            escape()
            editor.show_panel(name)
            hands.leave()
            hands.settle()

        return act

    def tool(name: str) -> Callable[[], None]:
        def act() -> None:
            escape()
            editor.painting.toolbox.choose(name)
            editor.show_panel("Tool")
            hands.settle()

        return act

    def blank() -> None:
        escape()
        session.new(Page(148.0, 105.0))
        hands.until(lambda: session.phase == "done" and session.source is None, "the page")
        editor.show_panel("Drawing")
        hands.settle()

    def context() -> None:
        escape()
        width, height = app.window.size_px  # type: ignore[attr-defined]
        hands.move(width * 0.7, height * 0.4)
        hands.press("right")
        hands.release("right")
        hands.settle()

    found["00-empty"] = lambda: hands.settle()
    found["01-sample"] = open_sample
    for name in editor.panels.names:
        found[f"10-panel-{name.lower()}"] = panel(name)
    for one in editor.painting.toolbox.cards:
        found[f"20-tool-{one.name}"] = tool(one.name)
    for name in ("help.palette", "help.keys", "edit.preferences", "file.new", "file.open",
                 "file.save_as", "file.export_as"):  # fmt: skip
        found[f"30-{name}"] = run(name)
    for tab in ("Panels", "Keys"):
        found[f"31-preferences-{tab.lower()}"] = lambda tab=tab: (
            run("edit.preferences")(), hands.click(f"tab {tab}"))  # type: ignore[misc]  # fmt: skip
    found["32-context"] = context
    for menu in ("File", "Edit", "Select", "Dots", "Tool", "View", "Panels", "Help"):
        found[f"40-menu-{menu.lower()}"] = lambda menu=menu: (
            escape(), hands.click(f"menu {menu}"))  # type: ignore[misc]  # fmt: skip
    found["50-blank"] = blank
    return found


if __name__ == "__main__":
    main()
