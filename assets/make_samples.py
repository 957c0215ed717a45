"""Remake the scripted sample pictures: ``python assets/make_samples.py [NAME ...]``.

Without names it makes all three, and the program's icon. Nothing is random but by fixed seeds, so
they come out the same every time.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image
from sources import ammonite, icon, stone, wedge

SAMPLES = Path(__file__).resolve().parent / "samples"


def make_ammonite() -> None:
    """Write the specimen plate: 8-bit grey, white but for the shell and its shadow."""
    levels = np.round(ammonite.draw() * 255).astype(np.uint8)
    Image.fromarray(levels).save(SAMPLES / "ammonite.png", optimize=True)


def make_sandstone() -> None:
    """Write the wall of sandstone: 8-bit grey."""
    levels = np.round(stone.draw() * 255).astype(np.uint8)
    Image.fromarray(levels).save(SAMPLES / "sandstone.jpg", quality=90, optimize=True)


def make_wedge() -> None:
    """Write the ramp and step wedges: 16-bit grey, so that the ramp has no steps."""
    levels = np.round(wedge.draw() * 65535).astype(np.uint16)
    Image.fromarray(levels).save(SAMPLES / "step-wedge.png", optimize=True)


def make_icon() -> None:
    """Write the program's icon."""
    (SAMPLES.parent / "icons" / "stippler.svg").write_text(icon.draw())


MAKERS: dict[str, Callable[[], None]] = {
    "ammonite": make_ammonite,
    "sandstone": make_sandstone,
    "step-wedge": make_wedge,
    "icon": make_icon,
}


def main() -> None:
    """Make the samples named on the command line, or all."""
    parser = argparse.ArgumentParser(description="Remake the scripted sample pictures.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(MAKERS))
    names = parser.parse_args().names or list(MAKERS)
    for name in names:
        if name not in MAKERS:
            parser.error(f"there is no sample {name!r}; choose from {', '.join(MAKERS)}")
    SAMPLES.mkdir(exist_ok=True)
    for name in names:
        MAKERS[name]()


if __name__ == "__main__":
    main()
