"""Make `docs/window.png`: the real window on a sample, under Xvfb.

``python docs/make_window.py [--size WxH] [--dots N] [OUT]``; needs Xvfb and xdotool.
``--lens`` makes `docs/lens.png` instead: the canvas alone, zoomed in, with the reduction lens.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from PIL import ImageGrab

ROOT = Path(__file__).resolve().parent.parent
LENS_INPUT = ("click", "--repeat", "7", "--delay", "30", "4", "key", "z")
EDITOR = "from stippler.start import main; main()"


def main() -> None:
    """Start a display, open the editor, wait until its work is over, take the picture."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("out", nargs="?", type=Path)
    options.add_argument("--lens", action="store_true")
    options.add_argument("--size", default="1280x800")
    options.add_argument("--dots", default="60000")
    chosen = options.parse_args()
    out = chosen.out or ROOT / "docs" / ("lens.png" if chosen.lens else "window.png")
    reads, writes = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writes), "-screen", "0", f"{chosen.size}x24"],
        pass_fds=[writes],
        stderr=subprocess.DEVNULL,
    )
    os.close(writes)
    with os.fdopen(reads) as told:
        display = f":{told.readline().strip()}"
    settings = tempfile.TemporaryDirectory()  # the editor as it is at first
    env = {
        **os.environ,
        "DISPLAY": display,
        "STIPPLER_CONFIG_DIR": settings.name,
        "STIPPLER_STATE_DIR": settings.name,
    }
    sample = ROOT / "assets" / "samples" / "ammonite.png"
    editor = subprocess.Popen(
        [sys.executable, "-c", EDITOR, str(sample), "--dots", chosen.dots],
        env=env,
        stderr=subprocess.DEVNULL,
    )
    try:
        wait_until_idle(editor.pid)
        width, height = (int(side) for side in chosen.size.split("x"))
        place = (str(width * 0.62), str(height * 0.47))
        subprocess.run(["xdotool", "mousemove", *place], env=env, check=True)
        if chosen.lens:
            subprocess.run(["xdotool", *LENS_INPUT], env=env, check=True)
            wait_until_idle(editor.pid)
        time.sleep(1.0)
        shot = ImageGrab.grab(xdisplay=display).convert("RGB")
        if chosen.lens:
            shot = shot.crop(canvas_of((width, height))).quantize(64)
        shot.save(out, optimize=True)
    finally:
        editor.terminate()
        editor.wait()
        server.terminate()
        server.wait()
        settings.cleanup()


def canvas_of(size: tuple[int, int]) -> tuple[int, int, int, int]:
    """Ask an editor of that size, without a display, where its canvas is."""
    from stippler.app import App
    from stippler.drawing.style import Style
    from stippler.ui.window.scripted_host import Host

    app = App(Style(), tone="linear", width_mm=148.0, size=size, offscreen=True)
    try:
        return Host(app.window, app.editor, app.step).canvas()
    finally:
        app.close()


def wait_until_idle(pid: int) -> None:
    """Wait until a process has taken no processor time to speak of for two seconds; Linux."""
    last, quiet_since = 0.0, time.monotonic()
    while time.monotonic() - quiet_since < 2.0:
        time.sleep(0.25)
        numbers = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        spent = (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")
        if spent - last > 0.03 or spent < 1.0:
            quiet_since = time.monotonic()
        last = spent


if __name__ == "__main__":
    main()
