"""Few small pictures, looked at once and kept: pens, zoom levels, both polarities.

The measure is the largest difference between 16-pixel tiles, so that one missing dot fails; a test
below proves it. To make new pictures, to be looked at and kept:
``STIPPLER_KEEP_GOLDEN=1 pytest tests/golden``.
What fails leaves result, reference and difference in tests/failed/.
"""

import os
from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image
from shapely.geometry import Point

from stippler import headless
from stippler.camera import Camera
from stippler.drawing.area import Area
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.pens import PENS, pen_named
from stippler.drawing.style import WHITE_ON_BLACK, Style
from stippler.render.frame import Frame
from stippler.render.renderer import Renderer
from stippler.render.state import release_target

HERE = Path(__file__).parent
FAILED = HERE.parent / "failed"
SIZE = (128, 96)
PAGE = Page(16, 12)
TILE = 16
BOUND = 0.004  # of a tile in full black; drivers differ by less
BLACK, WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
ZOOMS = {"tiny": 1.5, "small": 4.0, "large": 40.0, "huge": 160.0}


@pytest.fixture(scope="module")
def picture():
    """Return a function that draws dots as (h, w) uint8."""
    ctx = headless.open_context()
    renderer = Renderer(ctx)
    target = ctx.framebuffer([ctx.renderbuffer(SIZE, 1)])

    def drawn(dots: Dots, scale: float = 8.0, paper=WHITE, ink=BLACK, night=None) -> np.ndarray:
        drawing = Drawing.blank(PAGE)
        drawing.dots = dots
        if night is not None:
            drawing.styles[1] = Style(polarity=WHITE_ON_BLACK)
            drawing.areas[1] = Area("night", night, 1)
        renderer.scene.set_drawing(drawing)
        camera = Camera((8.0, 6.0), scale)
        renderer.draw(Frame(camera, SIZE, paper=paper, desk=paper, ink=ink), target)
        data = np.frombuffer(target.read(components=1, alignment=1), np.uint8)
        return data.reshape(SIZE[::-1])[::-1]

    yield drawn
    release_target(ctx, target)
    renderer.release()
    ctx.release()


def dots_of(pen_name: str) -> Dots:
    rng = np.random.default_rng(21)
    grid = np.stack(np.meshgrid(np.arange(14), np.arange(10)), -1).reshape(-1, 2)
    position = (grid + 0.5 + rng.uniform(-0.25, 0.25, grid.shape)) * (16 / 14, 12 / 10)
    dots = Dots.round(position, rng.uniform(0.2, 0.45, len(grid)))
    return pen_named(pen_name).drawn(dots)


def difference(a: np.ndarray, b: np.ndarray) -> float:
    """Return the largest of the tiles' mean absolute differences, 0 to 1."""
    away = np.abs(a.astype(float) - b) / 255
    h, w = (side // TILE for side in away.shape)
    return float(away.reshape(h, TILE, w, TILE).mean(axis=(1, 3)).max())


def compare(name: str, seen: np.ndarray) -> None:
    path = HERE / f"{name}.png"
    if os.environ.get("STIPPLER_KEEP_GOLDEN"):
        Image.fromarray(seen).save(path, optimize=True)
    with Image.open(path) as image:
        kept = np.asarray(image)
    away = difference(seen, kept)
    if away > BOUND:
        FAILED.mkdir(exist_ok=True)
        apart = np.abs(seen.astype(int) - kept).astype(np.uint8)
        for what, pixels in (("result", seen), ("reference", kept), ("difference", apart)):
            Image.fromarray(pixels).save(FAILED / f"{name}-{what}.png")
    assert away <= BOUND, f"{name}: {away:.4f}; look at {FAILED}"


@pytest.mark.parametrize("pen", [pen.name for pen in PENS])
def test_pens(picture, pen):
    compare(f"pen-{pen}", picture(dots_of(pen)))


@pytest.mark.parametrize("zoom", ZOOMS)
def test_zoom_levels(picture, zoom):
    compare(f"zoom-{zoom}", picture(dots_of("stick"), ZOOMS[zoom]))


def test_white_on_black(picture):
    seen = picture(dots_of("quill"), paper=BLACK, ink=WHITE)
    compare("polarity-white-on-black", seen)


@pytest.mark.parametrize("zoom", ["small", "large"])
def test_an_area_of_white_dots(picture, zoom):
    """A disc of white dots on black in a page of black ones; its ground is clean to its border."""
    dots = dots_of("quill")
    night = Point(8.0, 6.0).buffer(4.0 if zoom == "small" else 1.1)
    dots.area[:] = shapely.contains_xy(night, *dots.position_mm.T)
    compare(f"inverse-area-{zoom}", picture(dots, ZOOMS[zoom], night=night))


@pytest.mark.parametrize("pen", [pen.name for pen in PENS])
def test_any_missing_dot_fails(picture, pen):
    """Each dot in turn is left out: none goes unnoticed."""
    dots = dots_of(pen)
    whole = picture(dots)
    for k in range(len(dots)):
        fewer = dots.take(np.arange(len(dots)) != k)
        assert difference(picture(fewer), whole) > 2 * BOUND, k


def test_a_dot_moved_by_a_pixel_fails(picture):
    dots = dots_of("technical-pen")
    whole = picture(dots)
    dots.position_mm[70, 0] += 1 / 8
    assert difference(picture(dots), whole) > BOUND


def test_a_failure_leaves_pictures_to_look_at(picture, monkeypatch, tmp_path):
    monkeypatch.setattr("pathlib.Path.mkdir", lambda self, **k: None)
    monkeypatch.setitem(compare.__globals__, "FAILED", tmp_path)
    monkeypatch.delenv("STIPPLER_KEEP_GOLDEN", raising=False)
    dots = dots_of("quill").take(slice(5, None))
    with pytest.raises(AssertionError, match="pen-quill"):
        compare("pen-quill", picture(dots))
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == [f"pen-quill-{w}.png" for w in ("difference", "reference", "result")]


def test_nothing_kept_is_unused():
    used = {f"pen-{pen.name}" for pen in PENS}
    used |= {f"zoom-{zoom}" for zoom in ZOOMS} | {"polarity-white-on-black"}
    used |= {"inverse-area-small", "inverse-area-large"}
    assert {path.stem for path in HERE.glob("*.png")} == used
