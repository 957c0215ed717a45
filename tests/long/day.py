"""A day of an illustrator's tasks, by mouse or by keyboard alone, in a real window under Xvfb.

``python tests/long/day.py OUT [--hand mouse|keyboard] [--short]`` leaves a picture of every step in
OUT, to be looked at, and ends with 1 at the first step that did not come true. Needs Xvfb, xdotool.
"""

from __future__ import annotations

import argparse
import itertools
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image, ImageGrab

ROOT = Path(__file__).resolve().parents[2]
SIZE = (900, 600)
CANVAS = (380, 40, 890, 560)
_PATIENCE_S = 60.0
EDITOR = "from stippler.start import main; main()"


class Day:
    """The window, the hands on it, and what is looked at."""

    def __init__(self, out: Path, hand: str) -> None:
        self.out, self.hand = out, hand
        self._n = 0
        out.mkdir(parents=True, exist_ok=True)
        reads, writes = os.pipe()
        self._server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writes), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24",
             "-nolisten", "tcp", "-noreset"],
            pass_fds=[writes], stderr=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(writes)
        with os.fdopen(reads) as told:
            self._display = f":{told.readline().strip()}"
        settings = out / "settings"
        settings.mkdir(exist_ok=True)
        self._env = {
            **os.environ,
            "DISPLAY": self._display,
            "STIPPLER_CONFIG_DIR": str(settings),
            "STIPPLER_STATE_DIR": str(settings),
            "PATH": os.environ["PATH"],
        }
        for name in ("WAYLAND_DISPLAY", "STIPPLER_SCALE"):
            self._env.pop(name, None)

    def start(self, *arguments: str) -> None:
        """Open the editor, and give it the keyboard."""
        self.process = subprocess.Popen(
            [sys.executable, "-c", EDITOR, *arguments],
            env=self._env, cwd=self.out, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        self.until("the window", lambda: bool(self._window()))
        self.xdotool("windowsize", "--sync", self._window(), *SIZE)
        self.xdotool("windowmove", self._window(), 0, 0)
        self.xdotool("windowfocus", self._window())

    def xdotool(self, *words: object) -> str:
        """Move the hands."""
        done = subprocess.run(
            ["xdotool", *map(str, words)],
            env=self._env,
            check=False,
            capture_output=True,
            text=True,
        )
        return done.stdout.strip()

    def _window(self) -> str:
        return self.xdotool("search", "--name", "Stippler").partition("\n")[0]

    def title(self) -> str:
        """Return the window's title."""
        assert self.process.poll() is None, f"it ended: {self.process.communicate()[1]}"
        return self.xdotool("getwindowname", self._window())

    def keys(self, *names: str) -> None:
        """Press keys, each by its name or a chord."""
        self.xdotool("key", "--delay", "25", *names)
        time.sleep(0.15)

    def type(self, text: str) -> None:
        """Type a text."""
        self.xdotool("type", "--delay", "15", text)
        time.sleep(0.1)

    def run(self, name: str) -> None:
        """Run a command by the palette."""
        self.keys("ctrl+shift+p")
        time.sleep(0.2)
        self.type(name)
        time.sleep(0.2)
        self.keys("Return")
        time.sleep(0.2)

    def drag(self, *places: tuple[float, float]) -> None:
        """Drag over places of the canvas."""
        self.xdotool("mousemove", *map(round, places[0]), "mousedown", 1)
        for (x0, y0), (x1, y1) in itertools.pairwise(places):
            for share in np.linspace(0.0, 1.0, 7)[1:]:
                at = (round(x0 + share * (x1 - x0)), round(y0 + share * (y1 - y0)))
                self.xdotool("mousemove", *at)
                time.sleep(0.015)
        self.xdotool("mouseup", 1)
        time.sleep(0.2)

    def shot(self) -> np.ndarray:
        """Return what the screen shows."""
        return np.asarray(ImageGrab.grab(xdisplay=self._display).convert("RGB"))

    def ink(self) -> int:
        """Return how many pixels of the canvas are dark."""
        x0, y0, x1, y1 = CANVAS
        return int((self.shot()[y0:y1, x0:x1].mean(axis=2) < 110).sum())

    def drawn(self) -> int:
        """Return how many pixels near the middle of the canvas are no white paper."""
        x, y = (CANVAS[0] + CANVAS[2]) // 2, (CANVAS[1] + CANVAS[3]) // 2
        return int((self.shot()[y - 100 : y + 100, x - 60 : x + 60].mean(axis=2) < 235).sum())

    def marked(self) -> int:
        """Return how many pixels of the canvas are in the colour of selected dots."""
        x0, y0, x1, y1 = CANVAS
        canvas = self.shot()[y0:y1, x0:x1].astype(int)
        return int((canvas[..., 2] - canvas[..., 0] > 90).sum())

    def step(self, name: str, is_true: Callable[[], bool]) -> None:
        """Wait until a step has come true, keep its picture, and tell."""
        self.until(name, is_true)
        self._n += 1
        file = self.out / f"{self._n:02d}-{name.replace(' ', '-')}.png"
        Image.fromarray(self.shot()).save(file)
        print(f"{name}: ok", flush=True)

    def until(self, name: str, is_true: Callable[[], bool]) -> None:
        """Wait until something is true; else keep a picture, and end."""
        deadline = time.monotonic() + _PATIENCE_S
        while not is_true():
            if time.monotonic() > deadline:
                Image.fromarray(self.shot()).save(self.out / "failed.png")
                raise SystemExit(f"{name}: did not come true")
            time.sleep(0.05)

    def steady(self) -> bool:
        """Return whether the picture stays as it is."""
        before = self.shot()
        time.sleep(0.4)
        return bool((self.shot() == before).all())

    def close(self) -> None:
        """End the editor and the display."""
        if getattr(self, "process", None) is not None and self.process.poll() is None:
            self.process.kill()
            self.process.communicate()
        self._server.terminate()
        self._server.wait()


def begin(day: Day) -> None:
    """From a photo to a drawing."""
    sample = ROOT / "assets" / "samples" / "honey-bee.jpg"
    picture = day.out / "bee.jpg"
    picture.write_bytes(sample.read_bytes())
    day.start(str(picture), "--dots", "3000", "--iterations", "5")
    day.until("the drawing", lambda: "bee.jpg" in day.title())
    day.step("photo", lambda: day.ink() > 2000 and day.steady())


def paint(day: Day, *, short: bool) -> None:
    """Highlights, hatching with the comb, a lasso, moved and scaled; undone again."""
    before = day.ink()
    middle = ((CANVAS[0] + CANVAS[2]) / 2, (CANVAS[1] + CANVAS[3]) / 2)
    if day.hand == "keyboard":
        day.keys("ctrl+a")
        day.run("enlarge the selection")  # the selection's dots, by name
        day.step("paint", lambda: "*" in day.title())
        for _ in range(3 if short else 12):
            day.keys("Right")
        day.step("nudged", day.steady)
    else:
        day.keys("e")
        day.drag(middle, (middle[0] + 60, middle[1] + 30))
        day.step("paint", lambda: "*" in day.title() and day.ink() < before)
        if not short:
            more_by_mouse(day, middle)
    for _ in range(4 if short else 30):
        day.keys("ctrl+z")
    day.keys("ctrl+shift+a")  # undo has brought the selection back, too
    if short:
        day.step("undo", lambda: "*" not in day.title())
    else:
        day.step("undo", lambda: abs(day.ink() - before) < 0.02 * before)


def more_by_mouse(day: Day, middle: tuple[float, float]) -> None:
    """What takes longer: comb, spray, and a selection that is moved and scaled."""
    x, y = middle
    day.keys("c")
    for k in range(4):
        day.drag((x - 90, y - 60 + 12 * k), (x + 60, y - 40 + 12 * k))
    day.step("comb", day.steady)
    day.keys("s")
    day.drag((x - 120, y + 90), (x - 60, y + 100), (x, y + 90))
    day.step("spray", day.steady)
    day.keys("m")
    day.run("outline lasso")
    day.drag((x - 60, y - 60), (x + 60, y - 50), (x + 60, y + 60), (x - 60, y + 60))
    day.step("lasso", lambda: day.marked() > 500)
    day.drag((x, y), (x + 90, y + 20))
    day.step("moved", lambda: day.marked() > 500 and day.steady())
    before = day.marked()
    day.run("enlarge the selection")
    day.run("enlarge the selection")
    day.step("resized", lambda: day.marked() > 1.2 * before)
    day.keys("Escape", "Escape", "v")


def keep(day: Day) -> None:
    """Save, export, and files that are none."""
    folder = day.out
    day.keys("ctrl+s")
    time.sleep(0.4)
    day.keys("ctrl+a")
    day.type(str(folder / "bee.stipple"))
    day.keys("Return")
    day.step("save", lambda: (folder / "bee.stipple").exists())
    (folder / "no-picture.jpg").write_text("this is no picture")
    day.keys("ctrl+o")
    time.sleep(0.4)
    day.keys("ctrl+a")
    day.type(str(folder / "no-picture.jpg"))
    before = day.ink()
    day.keys("Return")
    time.sleep(1.0)
    day.step("wrong file", lambda: day.process.poll() is None and day.ink() > 0.5 * before)


def export(day: Day) -> None:
    """The drawing as a file for print, by the dialog and the keyboard."""
    day.keys("ctrl+e")
    time.sleep(1.0)
    Image.fromarray(day.shot()).save(day.out / "dialog.png")
    day.keys("ctrl+a")
    day.type(str(day.out / "bee.svg"))
    day.keys("Return")
    day.step("export", lambda: (day.out / "bee.svg").exists() and day.steady())


def more_pages(day: Day) -> None:
    """A new page by the keyboard, dots filled in or sprayed on it, rulers, navigator."""
    day.keys("ctrl+n")
    time.sleep(0.3)
    day.keys("Return")
    day.step("new page", lambda: day.ink() < 200)
    if day.hand == "keyboard":
        day.run("fill the page")
    else:
        day.keys("s")
        x, y = (CANVAS[0] + CANVAS[2]) / 2, (CANVAS[1] + CANVAS[3]) / 2
        day.drag((x - 40, y - 80), (x + 40, y), (x - 40, y + 80))
    day.step("dots on the page", lambda: day.drawn() > 100 and "*" in day.title())
    day.run("rulers")
    day.run("navigator")
    day.step("rulers and navigator", day.steady)


def leave(day: Day) -> None:
    """Close the window; what is not saved is asked about."""
    day.keys("ctrl+q")
    time.sleep(1.5)
    if day.process.poll() is None:
        Image.fromarray(day.shot()).save(day.out / "question.png")
        day.keys("Tab", "space")  # from Save, which has the keyboard, round to Discard
    day.process.wait(timeout=_PATIENCE_S)
    assert day.process.returncode == 0
    print("quit: ok")


def main() -> None:
    """Live through the day."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("out", type=Path)
    options.add_argument("--hand", choices=("mouse", "keyboard"), default="mouse")
    options.add_argument("--short", action="store_true")
    chosen = options.parse_args()
    subprocess.run([sys.executable, "-m", "stippler.warm"], check=True, stdout=subprocess.DEVNULL)
    day = Day(chosen.out.resolve(), chosen.hand)
    try:
        begin(day)
        paint(day, short=chosen.short)
        keep(day)
        if not chosen.short:
            export(day)
            more_pages(day)
        leave(day)
    finally:
        day.close()


if __name__ == "__main__":
    main()
