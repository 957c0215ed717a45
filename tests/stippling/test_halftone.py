import itertools
import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import MultiPolygon, Point, Polygon, box

from stippler.analysis.spacing import measure_spacing
from stippler.analysis.spectrum import measure_spectrum
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import GeometryError, ParameterError
from stippler.kernels.machine import pool
from stippler.stippling.halftone import (
    DROPPED,
    ENLARGED,
    GROWTHS,
    REDUCED,
    STARTS,
    growth_orders,
    pulse_density,
    sizes_by_region,
    supersampling,
)
from stippler.stippling.halftone_area import pulses_inside
from stippler.stippling.initial_points import (
    floyd_steinberg,
    hexagonal,
    hexagonal_in,
    random_dots,
    random_in,
)
from stippler.stippling.tone import DotRule


def all_dots(density, *args, **kwargs):
    *_, (share, first) = pulse_density(density.astype(np.float32), *args, **kwargs)
    assert share == 1.0
    return first


@pytest.mark.parametrize("growth", GROWTHS)
@pytest.mark.parametrize("start", STARTS)
def test_constant_input_gives_even_dots_without_direction(growth, start):
    first = all_dots(np.full((200, 200), 0.05), growth, start=start)
    points = first.position_px
    assert abs(len(points) - 2000) <= 1
    spectrum = measure_spectrum(points, (0, 0, 200, 200))
    assert spectrum.low < 0.02  # random dots: 1
    assert spectrum.direction_db < (1.5 if growth == "circular" else 3.5)  # a grid: above 15
    spacing = measure_spacing(points)
    assert spacing.relative_cv < 0.14  # random dots: 0.47
    assert spacing.relative_min > 0.378
    assert np.std(first.region_px) / np.mean(first.region_px) < 0.12


def test_the_default_growth_has_the_better_spectrum():
    def low(growth):
        points = all_dots(np.full((300, 300), 0.06), growth).position_px
        return measure_spectrum(points, (0, 0, 300, 300)).low

    assert low(GROWTHS[0]) < low(GROWTHS[1])


def test_positions_are_finer_than_pixels():
    points = all_dots(np.full((40, 40), 0.3)).position_px
    assert len(np.unique(np.round((points % 1) * 20))) > 10
    assert supersampling(np.full((2, 2), 3.0, np.float32)) >= 6


@settings(max_examples=15)
@given(st.integers(0, 10**6), st.sampled_from(GROWTHS), st.sampled_from(STARTS))
def test_dots_follow_the_density(seed, growth, start):
    rng = np.random.default_rng(seed)
    density = np.kron(rng.random((3, 3)) ** 2, np.ones((20, 20))) * 0.3
    density[:20, 20:40] = 0.0
    points = all_dots(density, growth, start=start, seed=seed).position_px
    assert abs(len(points) - density.sum()) <= 1
    assert (density[points[:, 1].astype(int), points[:, 0].astype(int)] > 0).all()
    counts = np.histogram2d(points[:, 1], points[:, 0], bins=3, range=[[0, 60], [0, 60]])[0]
    asked = density.reshape(3, 20, 3, 20).sum(axis=(1, 3))
    assert (np.abs(counts - asked) <= 4 + 2.0 * np.sqrt(asked)).all()


def test_dots_come_progressively_and_grow_only():
    density = np.full((600, 600), 0.1, np.float32)
    seen = [first.position_px for _, first in pulse_density(density)]
    assert len(seen) > 5
    for before, after in itertools.pairwise(seen):
        assert np.array_equal(after[: len(before)], before)


def dots_in(area, n, side, start="top"):
    style = Style(n_dots=n, start=start)
    grey = Reference(np.full((side, side), 0.4, np.float32), side)
    return pulses_inside(grey, style, area).position_mm


@pytest.mark.parametrize("start", STARTS)
def test_only_the_inside_of_a_polygon_is_filled(start):
    ring = Point(60, 60).buffer(50).difference(Point(65, 58).buffer(20))
    area = MultiPolygon([ring, box(2, 2, 12, 14)])
    points = dots_in(area, 500, 120, start)
    assert len(points) == 500
    grown = area.buffer(0.5)  # half the diagonal of a cell
    assert shapely.contains_xy(grown, points[:, 0], points[:, 1]).all()


def test_an_area_beside_the_picture_is_left_empty():
    assert len(dots_in(box(14, 4, 15, 5), 5, 9)) == 0
    with pytest.raises(GeometryError):
        dots_in(Polygon(), 5, 9)


def test_border_start_lines_the_outermost_dots_up():
    disc = Point(100, 100).buffer(90, quad_segs=64)
    n = round(0.04 * disc.area)

    def scatter(start):
        depth = 90 - np.hypot(*(dots_in(disc, n, 200, start) - 100).T)
        outermost = depth[depth < 0.75 * math.sqrt(1 / 0.04)]
        return outermost.std()

    assert scatter("border") < 0.8 * scatter("top")


def test_sizes_follow_regions_at_the_thresholds():
    rule = DotRule(2.0 / math.sqrt(2), 2.0 * math.sqrt(2), even=True)
    small, large, omit = 1 / rule.density(np.array([ENLARGED, REDUCED, DROPPED]))
    region = np.array(
        [small / 9, 0.9 * small, 1.1 * small, large, 2 * large, 0.99 * omit, 1.01 * omit]
    )
    radius, keep = sizes_by_region(region.astype(np.float32), rule)
    assert radius[2:4] == pytest.approx(2.0)
    assert radius[0] > radius[1] > 2.0
    assert radius[0] == pytest.approx(2.0 * math.sqrt(2))
    assert radius[4] < 2.0
    assert radius.max() / radius.min() <= 2.0 + 1e-12
    assert keep.tolist() == [True] * 6 + [False]


def test_growth_orders_are_named_and_complete():
    with pytest.raises(ParameterError, match="growth"):
        growth_orders("square", 10)
    with pytest.raises(ParameterError, match="start"):
        next(pulse_density(np.ones((2, 2), np.float32), start="middle"))
    dy, dx = growth_orders("circular", 12)
    for row in range(len(dy)):
        assert (dy[row, 0], dx[row, 0]) == (0, 0)
        assert len(set(zip(dy[row], dx[row], strict=True))) == dy.shape[1]


@pytest.mark.parametrize("value", [0.0, 1e-12])
def test_white_has_no_dots(value):
    density = np.full((30, 30), value, np.float32)
    assert len(all_dots(density).position_px) == 0
    for points in (floyd_steinberg(density), random_dots(density, 1), hexagonal(density)):
        assert len(points) == 0


def baselines(density, seed):
    return {
        "floyd-steinberg": floyd_steinberg(density),
        "random": random_dots(density, seed),
        "hexagonal": hexagonal(density),
    }


@settings(max_examples=15)
@given(st.integers(0, 10**6))
def test_baselines_stand_on_ink_and_keep_the_number(seed):
    rng = np.random.default_rng(seed)
    density = (np.kron(rng.random((5, 5)), np.ones((16, 16))) * 0.3).astype(np.float32)
    density[rng.random(density.shape) < 0.2] = 0.0
    for name, points in baselines(density, seed).items():
        assert abs(len(points) - density.sum()) <= 1, name
        assert (density[points[:, 1].astype(int), points[:, 0].astype(int)] > 0).all(), name


def test_random_dots_follow_density_and_seed():
    density = np.repeat(np.linspace(0, 2, 50, dtype=np.float32)[None], 50, 0)
    points = random_dots(density, 3)
    assert points[:, 0].mean() == pytest.approx(100 / 3, rel=0.03)
    assert np.array_equal(points, random_dots(density, 3))
    assert not np.array_equal(points, random_dots(density, 4))


@given(st.integers(0, 10**6), st.integers(0, 400))
def test_dots_without_a_picture_fill_an_area(seed, n):
    area = Point(3, 4).buffer(5).difference(box(2, 2, 4, 9))
    points = random_in(area, n, seed)
    assert len(points) == n
    assert shapely.contains_xy(area, points[:, 0], points[:, 1]).all()
    grid = hexagonal_in(area, n)
    assert shapely.contains_xy(area, grid[:, 0], grid[:, 1]).all()
    if n >= 50:
        assert abs(len(grid) - n) <= 0.05 * n + 2


def test_a_hexagonal_grid_is_hexagonal():
    points = hexagonal_in(box(0, 0, 30, 20), 600)
    inner = points[(np.abs(points - (15, 10)) < (12, 7)).all(axis=1)]
    distance = np.sort(np.hypot(*(inner[:, None] - points[None]).T), axis=0)[1:8]
    assert np.allclose(distance[:6], distance[0, 0], rtol=1e-6)
    assert np.allclose(distance[6], math.sqrt(3) * distance[0, 0], rtol=1e-6)


def test_areas_that_are_none_are_refused():
    for area in (Polygon(), Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])):
        for call in (lambda a: random_in(a, 5, 1), lambda a: hexagonal_in(a, 5)):
            with pytest.raises(GeometryError, match="area"):
                call(area)
    with pytest.raises(ParameterError):
        random_in(box(0, 0, 1, 1), -1, 1)


@pytest.mark.parametrize("start", ["top", "border"])
def test_dots_and_snapshots_are_the_same_for_any_number_of_threads(start):
    """Seeds are listed ahead while regions grow: which are used up by then must not matter."""
    y, x = np.mgrid[:700, :700] / 700
    density = (0.03 + 0.12 * np.abs(np.sin(9 * x) * np.cos(7 * y))).astype(np.float32)
    runs = []
    for threads in (1, 2, 3):
        pool.set_threads(threads)
        try:
            runs.append([first for _, first in pulse_density(density, start=start)])
        finally:
            pool.set_threads(0)
    assert len(runs[0]) > 3
    for run in runs[1:]:
        for alone, together in zip(runs[0], run, strict=True):
            assert np.array_equal(alone.position_px, together.position_px)
            assert np.array_equal(alone.region_px, together.region_px)


def test_a_run_that_is_left_waits_for_the_seeds_it_has_asked_for():
    density = np.full((500, 500), 0.1, np.float32)
    run = pulse_density(density)
    next(run)
    run.close()
    assert next(pulse_density(density))[1].position_px.size
