"""Make the pictures of `docs/areas.md`: the window with areas, the paper's Fig. 2, and borders.

``python docs/make_areas.py [--only window|eye|borders|pieces|row]``; without a display,
some minutes.

`docs/areas-eye.png` is what Fig. 2 of Deussen et al. (2000) shows: the eye and its surroundings
relaxed apart, so that the border between them is enhanced; left as one area, right as two.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from stippler.api import process
from stippler.app import App
from stippler.drawing.area_edits import edit_areas, map_of
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.path import Path as Outline
from stippler.drawing.planar.policies import with_policy
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.headless import render_image
from stippler.stippling.lines import border_lines, row_along
from stippler.ui.panels.layout import AREAS
from stippler.ui.window.scripted_host import Host

DOCS = Path(__file__).resolve().parent
SAMPLE = DOCS.parent / "assets" / "samples" / "ammonite.png"
SIDE_PX, SIDE_MM = 420, 70.0


def main() -> None:
    """Make the pictures asked for."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--only", choices=("window", "eye", "borders", "pieces", "row"))
    only = options.parse_args().only
    if only in (None, "window"):
        make_window(DOCS / "areas.png")
    if only in (None, "eye"):
        make_eye(DOCS / "areas-eye.png")
    if only in (None, "borders"):
        make_borders(DOCS / "areas-borders.png")
    if only in (None, "pieces"):
        make_pieces(DOCS / "areas-pieces.png")
    if only in (None, "row"):
        make_row(DOCS / "areas-row.png")


def make_row(out: Path) -> None:
    """Fill an area with a row inside its border: first dots from the top, and from the row."""
    drawing = Drawing.blank(Page(40.0, 34.0), Style(n_dots=500))
    drawing.reference = Reference(np.full((340, 400), 0.35, np.float32), 40.0)
    document = Document(drawing)
    t = np.linspace(0.0, 2 * np.pi, 200)[:-1]
    r = 13.0 + 2.2 * np.cos(3 * t) + 1.2 * np.sin(5 * t)
    ring = Outline.polyline(np.column_stack([20 + r * np.cos(t), 17 + r * np.sin(t)]), closed=True)
    edit_areas(document, "area", lambda areas: edits.add(areas, ring, edits.IS_CUT))
    (line,) = border_lines(document.drawing.areas[1].outline_mm, "inside", 0.9)
    document.begin("row")
    rows = document.insert(Dots.round(line.at(row_along(line, None, 0.95, None)), 0.25))
    document.change("constraint", rows, np.full(len(rows), FIXED, np.int8))
    document.commit()
    made = [
        process(document.drawing, 1, start=start, iterations=0, dots=500)
        for start in ("top", "border")
    ]
    panels = [render_image(one, px_per_mm=11.0, grey=True) for one in made]
    Image.fromarray(np.hstack(panels)).quantize(16).save(out, optimize=True)


def make_window(out: Path) -> None:
    """Open the sample, take proposals and dark parts, and show the list."""
    os.environ["STIPPLER_CONFIG_DIR"] = tempfile.mkdtemp()
    app = App(
        Style(n_dots=12_000, iterations=12), tone="illustration", width_mm=148.0,
        size=(1280, 800), offscreen=True,
    )  # fmt: skip
    host = Host(app.window, app.editor, app.step)
    try:
        host.drop(SAMPLE)
        host.until(lambda: app.session.phase == "done", "the drawing")
        acts = app.editor.area_acts
        acts.dark_level = 0.8
        acts.dark_parts()
        host.until(lambda: not acts.jobs.busy, "the dark parts")
        acts.process()
        host.until(lambda: not app.session.busy, "their dots")
        acts.choice.choose(acts.choice.ids[:2])
        app.editor.show_panel(AREAS)
        host.leave()
        host.settle()
        Image.fromarray(host.screenshot()).quantize(128).save(out, optimize=True)
    finally:
        app.close()


def eye() -> tuple[Reference, Outline]:
    """Return a picture of an eye, and the outline of its opening."""
    y, x = np.mgrid[0:SIDE_PX, 0:SIDE_PX] / SIDE_PX
    across = np.clip((x - 0.5) / 0.38, -1.0, 1.0)
    upper, lower = 0.5 - 0.2 * (1 - across**2), 0.5 + 0.13 * (1 - across**2)
    within = (y > upper) & (y < lower) & (np.abs(x - 0.5) < 0.38)
    far = np.hypot(x - 0.5, y - 0.47)
    ball = 0.06 + 0.25 * np.abs(x - 0.5) + 0.3 * np.clip((upper + 0.06 - y) / 0.06, 0, 1)
    ball = np.where(far < 0.15, 0.45 + 0.3 * (far / 0.15) ** 3, ball)
    ball = np.where(far < 0.065, 0.92, ball)
    ball = np.where(np.hypot(x - 0.53, y - 0.44) < 0.022, 0.0, ball)
    skin = 0.28 + 0.2 * np.exp(-(((y - upper + 0.05) / 0.05) ** 2)) + 0.08 * (y - 0.5)
    picture = np.clip(np.where(within, ball, skin), 0.0, 1.0).astype(np.float32)
    t = np.linspace(-1.0, 1.0, 25)
    top = np.column_stack([0.5 + 0.38 * t, 0.5 - 0.2 * (1 - t**2)])
    bottom = np.column_stack([0.5 + 0.38 * t, 0.5 + 0.13 * (1 - t**2)])[::-1]
    corners = np.concatenate([top, bottom[1:-1]]) * SIDE_MM
    return Reference(picture, SIDE_MM), moves.smooth_path(Outline.polyline(corners, closed=True))


def make_eye(out: Path) -> None:
    """Draw the eye as one area, and as two that are stippled apart."""
    reference, outline = eye()
    pictures = []
    for parted in (False, True):
        nothing = np.empty((0, 2)), np.empty(0, np.float32)
        style = Style(n_dots=6_000, iterations=25)
        document = Document(Drawing.from_reference(reference, *nothing, style))
        if parted:
            edit_areas(document, "Eye", lambda areas: edits.add(areas, outline))
        drawing = process(document.drawing, sorted(document.drawing.areas))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "eye.png"
            drawing.save(path, dpi=200)
            pictures.append(np.array(Image.open(path).convert("L")))
    gap = np.full((len(pictures[0]), 40), 255, np.uint8)
    Image.fromarray(np.hstack([pictures[0], gap, pictures[1]])).save(out, optimize=True)


def make_borders(out: Path) -> None:
    """Draw a piece of the ammonite as two areas, with walls, as is, and seen through."""
    drawn = [_halved(border) for border in ("wall", "automatic", "through")]
    gap = np.full((len(drawn[0]), 30), 255, np.uint8)
    Image.fromarray(np.hstack([drawn[0], gap, drawn[1], gap, drawn[2]])).save(out, optimize=True)


def make_pieces(out: Path) -> None:
    """Draw it with walls but for a piece that is seen through, and with that side made anew."""
    drawn = [_halved("wall", "through"), _halved("wall", "through", again=True)]
    gap = np.full((len(drawn[0]), 30), 255, np.uint8)
    Image.fromarray(np.hstack([drawn[0], gap, drawn[1]])).save(out, optimize=True)


def _halved(border: str, piece_is: str = "", *, again: bool = False) -> NDArray[np.uint8]:
    """Return a piece of the ammonite drawn as two areas that meet in a slanting line.

    The upper half of the line has a policy of its own; the left area may be made again, alone.
    """
    whole = 1.0 - np.array(Image.open(SAMPLE).convert("L"), np.float32) / 255.0
    h, w = whole.shape
    piece = np.ascontiguousarray(whole[2 * h // 5 : 4 * h // 5, w // 5 : w // 5 + 2 * h // 5])
    contrast = 0.3 if piece_is else 0.75  # walls are seen best in pale tones
    reference = Reference(0.15 + contrast * piece, SIDE_MM / 2)
    nothing = np.empty((0, 2)), np.empty(0, np.float32)
    style = Style(n_dots=2_400, border=border)
    document = Document(Drawing.from_reference(reference, *nothing, style))
    w, h = reference.width_mm, reference.height_mm
    corners = [(0, 0), (0.65 * w, 0), (0.5 * w, 0.5 * h), (0.35 * w, h), (0, h)]
    half = Outline.polyline(corners, closed=True)
    edit_areas(document, "Left", lambda areas: edits.add(areas, half))
    if piece_is:
        _say_of_upper(document, piece_is)
    drawing = process(document.drawing, sorted(document.drawing.areas))
    if again:
        drawing = process(drawing, 1)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "borders.png"
        drawing.save(path, dpi=350)
        return np.array(Image.open(path).convert("L"))


def _say_of_upper(document: Document, policy: str) -> None:
    """Give the upper piece of the border between the two areas a policy."""
    k, arc = next(
        (k, arc) for k, arc in map_of(document.drawing).arcs.items()
        if {arc.left, arc.right} == {0, 1}
    )  # fmt: skip
    first = 0 if arc.start[1] < arc.end[1] else 1
    runs = {k: [(first, first + 1, policy)]}
    edit_areas(document, "Border", lambda areas: edits.Outcome(with_policy(areas, runs)))


if __name__ == "__main__":
    main()
