import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import KDTree

from stippler.analysis.tone_error import draw_ink
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.postprocess import even_rim, part_close
from stippler.stippling.radii import solve_radii
from stippler.stippling.stipple import stages
from stippler.stippling.tessellation import made


def sheet_of(darkness, n):
    return PageRaster.of(Reference(darkness, float(darkness.shape[1])), n, None, bleeds=True)


def relaxed(darkness, n):
    """Return dots in pixels of the raster, relaxed on the bleed and trimmed, but not finished."""
    raster = sheet_of(darkness, n)
    *_, step = (p for p in stages(Reference(darkness, float(darkness.shape[1])), Style(n_dots=n))
                if p.stage == "relax")  # fmt: skip
    return raster, step.position_mm / raster.pixel_mm


def closeness(points):
    distance = KDTree(points).query(points, k=8)[0]
    return distance[:, 1] / distance[:, 7]


@pytest.mark.parametrize("darkness", [0.25, 0.7])
def test_no_pair_lies_much_closer_than_its_neighbours(darkness):
    raster, points = relaxed(np.full((200, 200), darkness, np.float32), 2000)
    parted = part_close(points, raster)
    assert np.percentile(closeness(parted), 1) > 0.47
    assert np.percentile(closeness(parted), 1) > np.percentile(closeness(points), 1) + 0.02
    moved = np.hypot(*(parted - points).T)
    assert np.median(moved) == 0.0  # only the few that are close


@settings(max_examples=20)
@given(st.integers(0, 10**6), st.integers(1, 300))
def test_parted_dots_stay_on_the_page_and_off_white(seed, n):
    rng = np.random.default_rng(seed)
    darkness = (rng.random((40, 60)) < 0.7).astype(np.float32) * np.float32(0.5)
    darkness[5, 5] = 1.0
    raster = sheet_of(darkness, 400)
    points = raster.onto_ink(rng.random((n, 2)) * raster.darkness.shape[::-1])
    parted = part_close(points, raster)
    assert (parted >= 0).all()
    assert (parted < raster.darkness.shape[::-1]).all()
    column, row = parted.astype(int).T
    assert (raster.darkness[row, column] > 0).all()


def test_dots_at_one_place_are_parted():
    raster = sheet_of(np.full((50, 50), 0.4, np.float32), 100)
    points = np.concatenate((np.full((2, 2), 30.0), np.mgrid[5:50:10, 5:50:10].reshape(2, -1).T))
    parted = part_close(points, raster)
    assert np.hypot(*(parted[0] - parted[1])) > 1.0


def test_the_ink_along_the_edge_meets_the_tone():
    x = np.linspace(0.15, 0.75, 400, dtype=np.float32)
    raster, points = relaxed(np.tile(x, (400, 1)), 3000)

    def error(dots):
        radii = solve_radii(made(raster.cells(dots)), raster.rule)
        ink = draw_ink(2 * dots, 2 * radii, (800, 800), zoom=4)  # in rows of half a pixel
        spacing = 800 / np.sqrt(3000)
        dark = np.repeat(raster.darkness[0], 2)
        off = [gaussian_filter1d(ink[k] - dark, 2 * spacing) for k in (0, -1)]
        return float(np.sqrt(np.mean(np.square(off))))

    before, dots = error(points), points
    for give in (0.6, 0.3, 0.2):
        dots = part_close(even_rim(dots, raster, give), raster)
    assert error(dots) < 0.5 * before
    inner = (np.abs(points - 200) < 180).all(axis=1)
    assert np.abs(dots - points)[inner].max() < 4.0


def test_a_white_edge_moves_no_dot():
    darkness = np.pad(np.full((80, 80), 0.5, np.float32), 20)
    raster = sheet_of(darkness, 500)
    points = raster.onto_ink(np.random.default_rng(3).random((500, 2)) * 120)
    assert np.array_equal(even_rim(points, raster, 0.6), points)
