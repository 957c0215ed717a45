"""The tone of a frame is that of the vector drawing, at every zoom, for every shape."""

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree
from shapely import union_all
from shapely.geometry import Point, Polygon

from stippler.camera import Camera
from stippler.drawing.dots import Dots
from stippler.kernels.shapes.dot_shape import outlines
from stippler.kernels.tone.union_share import shares_of_union

SIDE = 40.0


def tone(renderer, ink, dots: Dots, mean_px: float) -> float:
    """Return the ink of a frame that shows the whole page, as a share of the page."""
    renderer.scene.set_page(SIDE, SIDE)
    renderer.scene.set_dots(dots)
    scale = mean_px / float(dots.radius_mm.mean())
    n = math.ceil(SIDE * scale) + 2
    return float(ink(Camera((SIDE / 2, SIDE / 2), scale), (n, n)).sum() / (SIDE * scale) ** 2)


def apart(shaped, elongation: float, roughness: float) -> Dots:
    """Return dots that do not touch, well inside the page, at no distance preferred by pixels."""
    rng = np.random.default_rng(11)
    n = 34
    step = (SIDE - 6) / n
    grid = np.stack(np.meshgrid(np.arange(n), np.arange(n)), -1).reshape(-1, 2) + 0.5
    position = 3 + (grid + rng.uniform(-0.3, 0.3, grid.shape)) * step
    reach = math.sqrt(elongation * (1 + 0.9 * roughness))
    radius = rng.uniform(0.12, 0.19, n * n) * step / max(reach / 1.05, 1)
    return shaped(
        position, radius, elongation=elongation, roughness=roughness,
        angle=rng.uniform(-4, 4, n * n), seed=rng.integers(0, 2**32, n * n, np.uint32),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("elongation", "roughness"), [(1, 0), (2, 0), (4, 0), (1, 0.4), (1, 1), (2.5, 0.7), (4, 1)]
)
def test_tone_is_kept_at_every_zoom(renderer, ink, shaped, elongation, roughness):
    dots = apart(shaped, elongation, roughness)
    truth = math.pi * float((dots.radius_mm.astype(float) ** 2).sum()) / SIDE**2
    for mean_px in (0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 5.0, 9.0):
        assert tone(renderer, ink, dots, mean_px) == pytest.approx(truth, rel=0.005), mean_px


def relaxed(n: int, margin: float = 2.0) -> np.ndarray:
    """Return evenly spread points: each of many samples pulls the nearest point to itself."""
    rng = np.random.default_rng(5)
    points = rng.uniform(margin, SIDE - margin, (n, 2))
    samples = rng.uniform(margin, SIDE - margin, (60 * n, 2))
    for _ in range(15):
        nearest = cKDTree(points).query(samples)[1]
        count = np.bincount(nearest, minlength=n)[:, None]
        total = np.column_stack([np.bincount(nearest, s, n) for s in samples.T])
        points = np.where(count > 0, total / np.maximum(count, 1), points)
    return points


def union_area(dots: Dots) -> float:
    discs = [Point(p).buffer(r, 32) for p, r in zip(dots.position_mm, dots.radius_mm, strict=True)]
    missing = math.pi / (64 * math.sin(2 * math.pi / 128))  # of a polygon with 128 corners
    return float(union_all(discs).area) * missing


ZOOMS = (0.2, 0.3, 0.45, 0.6, 0.8, 1.2, 2.0, 4.0)


def with_areas(points: np.ndarray, areas: np.ndarray) -> Dots:
    return Dots.round(points, np.sqrt(areas / math.pi))


def test_a_ramp_from_white_to_black_keeps_its_tone(renderer, ink):
    points = relaxed(2500)
    cell = (SIDE - 4) ** 2 / len(points)
    dots = with_areas(
        points, cell * np.linspace(0.02, 1.3, len(points))[points[:, 0].argsort().argsort()]
    )
    truth = union_area(dots) / SIDE**2
    for mean_px in ZOOMS:
        assert tone(renderer, ink, dots, mean_px) == pytest.approx(truth, rel=0.005), mean_px


@pytest.mark.parametrize(("dark", "tolerance"), [(0.5, 0.005), (0.9, 0.009), (1.2, 0.009)])
def test_the_tone_of_overlapping_dots_is_their_union(renderer, ink, dark, tolerance):
    """`dark` is the sum of the dots' areas; from 0.6 on evenly spread dots overlap."""
    points = relaxed(1200)
    weight = np.random.default_rng(1).uniform(0.8, 1.25, len(points)) ** 2
    dots = with_areas(points, dark * (SIDE - 4) ** 2 * weight / weight.sum())
    truth = union_area(dots) / SIDE**2
    for mean_px in ZOOMS:
        assert tone(renderer, ink, dots, mean_px) == pytest.approx(truth, rel=tolerance), mean_px


def test_settled_positions_have_the_tone_of_all_dots(renderer, ink):
    points = relaxed(900)
    dots = with_areas(points, np.full(len(points), 1.1 * (SIDE - 4) ** 2 / len(points)))
    expected = tone(renderer, ink, dots, 0.4)
    renderer.scene.set_dots(Dots.none())
    scale = 0.4 / float(dots.radius_mm.mean())
    n = math.ceil(SIDE * scale) + 2
    camera = Camera((SIDE / 2, SIDE / 2), scale)
    renderer.scene.set_positions(dots.position_mm, dots.radius_mm)
    passing = ink(camera, (n, n)).sum() / (SIDE * scale) ** 2
    renderer.scene.set_positions(dots.position_mm, dots.radius_mm, settled=True)
    settled = ink(camera, (n, n)).sum() / (SIDE * scale) ** 2
    assert settled == pytest.approx(expected, rel=1e-3)
    assert passing > 1.01 * expected  # what settling is for


def test_shares_add_up_to_the_union():
    rng = np.random.default_rng(2)
    for n, radius in ((300, 0.6), (300, 1.5), (40, 6.0), (1, 1.0), (2, 30.0)):
        dots = Dots.round(rng.uniform(0, SIDE, (n, 2)), rng.uniform(0.5, 1, n) * radius)
        discs = np.column_stack([dots.position_mm, dots.radius_mm]).astype(np.float32)
        shares = shares_of_union(discs)
        assert shares.min() >= 0
        assert shares.max() <= 1
        found = math.pi * float((shares * dots.radius_mm.astype(float) ** 2).sum())
        assert found == pytest.approx(union_area(dots), rel=0.01)


def test_dots_on_one_another_count_once():
    discs = np.array([[1, 1, 0.5], [1, 1, 0.5], [1, 1, 0.2], [9, 9, 1]], np.float32)
    assert shares_of_union(discs).tolist() == [1.0, 0.0, 0.0, 1.0]


def test_shares_do_not_depend_on_the_number_of_threads():
    from stippler.kernels.machine import pool

    rng = np.random.default_rng(3)
    discs = rng.random((20_000, 3)).astype(np.float32) * (50, 50, 0.4)
    discs = discs.astype(np.float32)
    both = []
    for n_threads in (1, 2):
        pool.set_threads(n_threads)
        both.append(shares_of_union(discs))
    pool.set_threads(0)
    assert (both[0] == both[1]).all()


def test_a_frame_agrees_with_the_polygons_of_its_dots(renderer, ink, many):
    """Pixel by pixel against exact areas: shapely's, of the kernel's outlines."""
    dots = many(8, 6)
    renderer.scene.set_page(40, 30)
    renderer.scene.set_dots(dots)
    size = (320, 240)
    seen = ink(Camera((20, 15), 8.0), size)
    truth = np.zeros(size[::-1])
    for ring in outlines(dots, 96) * 8.0:
        shape = Polygon(ring)
        left, top, right, bottom = (int(v) for v in shape.bounds)
        for y in range(top, bottom + 1):
            for x in range(left, right + 1):
                pixel = Polygon([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)])
                truth[y, x] += shape.intersection(pixel).area
    assert np.abs(seen - truth).max() < 0.35
    assert np.abs(seen - truth).mean() < 0.006
    assert seen.sum() == pytest.approx(truth.sum(), rel=0.005)
