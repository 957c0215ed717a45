"""Areas of white dots on black, and hidden ones, on the screen: exact grounds, like the vectors."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
from shapely import affinity
from shapely.geometry import MultiPolygon, Point, Polygon, box

sys.path.insert(0, str(Path(__file__).parent))
from test_against_resvg import INK, LARGE, PAGE, SCALES, WORST_TILE, averaged, by_resvg, worst_tile

from stippler.camera import Camera
from stippler.drawing import records
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.preview import Preview
from stippler.drawing.shape_change import LinearChange, ShapeChange
from stippler.drawing.style import WHITE_ON_BLACK, Style
from stippler.files.write.svg import svg_chunks

NIGHT, DUSK, AWAY = 3, 7, 300_000_000


def night_drawing(dots: Dots) -> Drawing:
    """Two inverse areas side by side, one with a hole that is the page's, and a hidden one."""
    one = Drawing.blank(PAGE)
    hole = Point(11.3, 15.1).buffer(3.0)
    night = Polygon([(3.2, 4.1), (20.0, 2.3), (20.0, 26.7), (5.9, 28.2)]).difference(hole)
    dusk = Polygon([(20.0, 2.3), (31.7, 9.4), (24.1, 15.0), (33.3, 25.1), (20.0, 26.7)])
    one.styles[1] = Style(polarity=WHITE_ON_BLACK)
    one.areas[NIGHT], one.areas[DUSK] = Area("night", night, 1), Area("dusk", dusk, 1)
    one.areas[AWAY] = Area("away", box(34.5, 0, 40, 30), 1, hidden=True)
    dots.area[:] = 0
    for k in (NIGHT, DUSK, AWAY):
        dots.area[shapely.contains_xy(one.areas[k].outline_mm, *dots.position_mm.T)] = k
    one.dots = dots
    return one


def exact(area: Polygon, scale: float, angle: float, size: tuple[int, int]) -> np.ndarray:
    """Return how much of each pixel an area covers, by shapely."""
    w, h = size
    seen = affinity.translate(area, -20, -15)
    seen = affinity.scale(seen, scale, scale, origin=(0, 0))
    seen = affinity.translate(affinity.rotate(seen, angle, (0, 0), True), w / 2, h / 2)
    x, y = np.meshgrid(np.arange(w), np.arange(h))
    pixels = shapely.box(x, y, x + 1, y + 1)
    return shapely.area(shapely.intersection(pixels, seen))


@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0])
@pytest.mark.parametrize("scale", [0.6, 2.3, 9.0])
def test_grounds_are_exact(renderer, ink, scale, angle):
    """Pixel by pixel, with edges of any slope, a hole, and a seam between two areas."""
    one = night_drawing(Dots.none())
    renderer.scene.set_drawing(one)
    size = (36, 28)
    camera = Camera((20, 15), scale, angle)
    both = shapely.union_all([one.areas[k].outline_mm for k in (NIGHT, DUSK)])
    seen, right = ink(camera, size), exact(both, scale, _turn(camera), size)
    assert right.max() > 0.99 or scale < 1
    assert np.abs(seen - right).max() < 0.004


def _turn(camera: Camera) -> float:
    x, y = camera.linear() @ (1.0, 0.0)
    return float(np.arctan2(y, x))


def test_many_parts_and_touching_corners(renderer, ink):
    """A chequerboard of one area, zoomed so that most edges lie off the screen."""
    squares = [box(x, y, x + 2, y + 2) for x in range(0, 40, 4) for y in range(0, 30, 4)]
    squares += [affinity.translate(square, 2, 2) for square in squares if square.bounds[0] < 36]
    one = Drawing.blank(PAGE)
    one.styles[1] = Style(polarity=WHITE_ON_BLACK)
    one.areas[NIGHT] = Area("night", MultiPolygon(squares), 1)
    renderer.scene.set_drawing(one)
    seen = ink(Camera((20.5, 15.2), 21.7), (60, 40))
    right = exact(affinity.translate(MultiPolygon(squares), -0.5, -0.2), 21.7, 0.0, (60, 40))
    assert np.abs(seen - right).max() < 0.005


@pytest.mark.parametrize("kind", ["round", "rough"])
def test_screen_and_vector_agree(renderer, ink, many, kind):
    one = night_drawing(many(24, 18, kind))
    svg = b"".join(svg_chunks(one, decimals=5))
    renderer.scene.set_drawing(one)
    for scale in SCALES:
        ours = ink(Camera((20, 15), scale), (40 * scale, 30 * scale))
        theirs = averaged(by_resvg(svg), LARGE // scale) / 255.0
        assert ours.sum() == pytest.approx(theirs.sum(), rel=INK), scale
        white = theirs.size - theirs.sum()
        assert ours.size - ours.sum() == pytest.approx(white, rel=INK), scale
        assert worst_tile(ours, theirs) < WORST_TILE, scale


def test_white_dots_take_no_ink_from_black_ones(renderer, ink):
    """A black dot over the border stays whole, and white dots leave nothing beside their ground."""
    one = night_drawing(Dots.round([(20.0, 29.0), (2.0, 15.0), (20.0, 15.0)], [3.0, 1.5, 2.0]))
    one.dots.area[:] = 0, NIGHT, NIGHT
    renderer.scene.set_drawing(one)
    seen = ink(Camera((20, 15), 4.0), (160, 120))
    assert (seen[110:114, 76:84] == 1.0).all()
    assert seen[58:62, 2:10].max() == 0.0
    assert seen[56:64, 76:84].max() == 0.0


def test_hidden_dots_stay_hidden_under_a_brush(renderer, ink, many):
    one = night_drawing(many(24, 18, "round"))
    renderer.scene.set_drawing(one)
    grown = Preview(ShapeChange(radius=LinearChange(1.0, 0.3)))
    camera, size = Camera((37.5, 15), 8.0), (40, 240)
    assert ink(camera, size, preview=grown)[:, 4:-4].max() == 0.0
    assert ink(Camera((36, 15), 8.0), (160, 240), preview=grown).max() > 0.0


def test_a_style_turned_white_is_seen_at_once(renderer, ink, many):
    """In a document, and taken back; and pictures are the same as those of a fresh scene."""
    one = night_drawing(many(24, 18, "round"))
    one.styles[1] = Style()
    document, camera = Document(one), Camera((20, 15), 6.0)

    def seen():
        renderer.scene.sync(document)
        return ink(camera, (240, 180))

    black = seen()
    document.begin("White on black")
    document.set(records.STYLE, 1, Style(polarity=WHITE_ON_BLACK))
    document.commit()
    white = seen()
    assert white.mean() > 2 * black.mean()
    document.begin("Hide")
    document.set(records.AREA, NIGHT, replace(one.areas[NIGHT], hidden=True))
    document.commit()
    assert seen()[80:100, 30:40].max() == 0.0
    document.undo()
    assert (seen() == white).all()
    document.undo()
    assert (seen() == black).all()
    renderer.scene.set_drawing(document.drawing)
    assert (ink(camera, (240, 180)) == black).all()


def test_dots_left_out_take_their_ground_along(renderer, ink, many):
    renderer.scene.set_drawing(night_drawing(many(24, 18, "round")))
    assert ink(Camera((20, 15), 4.0), (160, 120), dots=False).max() == 0.0


def test_an_area_shown_alone_is_without_the_grounds_of_others(renderer, ink, many):
    """Solo hides areas on the screen alone; the ground of an inverse one was left behind."""
    document, camera = Document(night_drawing(many(24, 18, "round"))), Camera((20, 15), 6.0)
    renderer.scene.sync(document, hidden=frozenset({NIGHT}))
    alone = ink(camera, (240, 180))
    assert alone[80:100, 30:40].max() == 0.0
    renderer.scene.sync(document)
    whole = ink(camera, (240, 180))
    assert whole[80:100, 30:40].mean() > 0.3
    renderer.scene.sync(document, hidden=frozenset({NIGHT}))
    assert (ink(camera, (240, 180)) == alone).all()
