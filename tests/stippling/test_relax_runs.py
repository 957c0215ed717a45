"""Whole runs: against the engine from nothing, the paper's figures, and what a run promises."""

import threading

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay
from shapely import affinity
from shapely.geometry import LineString, MultiPoint, MultiPolygon, Point, Polygon, box

from stippler.errors import GeometryError, ParameterError
from stippler.stippling import cells, relax_local
from stippler.stippling.relax import DensityField, Relaxation, relax
from tests.stippling.shapes import comb, spiked, star_polygon

HOLED = (
    Polygon([(0, 0), (10, 0), (10, 10), (6, 10), (6, 3), (5, 3), (5, 10), (0, 10)])
    .difference(Point(2.5, 5).buffer(1.2))
    .difference(Point(8, 6).buffer(0.8, quad_segs=2))
)


def points_in(polygon, n, seed):
    rng = np.random.default_rng(seed)
    x0, y0, x1, y1 = polygon.bounds
    xy = rng.random((8 * n + 200, 2)) * [x1 - x0, y1 - y0] + [x0, y0]
    return xy[shapely.contains_xy(polygon, xy[:, 0], xy[:, 1])][:n]


def from_nothing(monkeypatch, *args, steps, **options):
    """Positions after each step of an engine that never keeps a star."""
    with monkeypatch.context() as patch:
        patch.setattr(cells, "KEEP_BELOW", 0.0)
        engine = Relaxation(*args, **options)
        out = []
        for _ in range(steps):
            engine.step()
            assert not engine._cells.keeps_stars
            out.append(engine.points)
        return out


@pytest.mark.parametrize("polygon", [box(0, 0, 10, 10), HOLED], ids=["square", "holed"])
@pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])
@pytest.mark.parametrize("over", [1.0, 1.7])
def test_kept_stars_give_what_cells_from_nothing_give(monkeypatch, polygon, weighted, over):
    points = points_in(polygon, 1500, 2)
    fixed = np.random.default_rng(3).random(len(points)) < 0.05
    density = None
    if weighted:
        x, y = np.meshgrid(np.arange(64) / 64, np.arange(64) / 64)
        density = DensityField(0.2 + x * y, 10 / 64)
    args = (points, polygon, fixed, None, density, over)
    engine = Relaxation(*args)
    n_kept = 0
    for want in from_nothing(monkeypatch, *args, steps=40):
        n_kept += engine._cells.keeps_stars
        engine.step()
        gap = np.abs(engine.points - want).max()
        assert gap <= 1e-9 * engine._cells.spacing
    assert n_kept > 25, "the kept stars were not in use"


def subdivision(n, seed):
    """A square cut into convex polygons with corners all along their sides."""
    seeds = np.random.default_rng(seed).random((n, 2))
    square = box(0, 0, 1, 1)
    cells = shapely.get_parts(shapely.voronoi_polygons(MultiPoint(seeds), extend_to=square))
    cells = shapely.intersection(cells, square)
    return [shapely.segmentize(g, 0.02) for g in cells if g.area > 0]


@given(
    seed=st.integers(0, 10**6), n=st.integers(1, 250), n_parts=st.sampled_from([1, 4, 20]),
    over=st.sampled_from([1.0, 1.5, 0.7]), weighted=st.booleans(),
    shape=st.sampled_from(["parts", "round", "concave", "spiked", "comb", "holed", "slit"]),
)  # fmt: skip
@settings(max_examples=150, deadline=None)
def test_stars_with_edges_equal_cells_from_nothing(seed, n, n_parts, over, weighted, shape):
    """Cells at borders, kept over whole runs, convex and concave, cut apart and not."""
    parts = subdivision(n_parts, seed)
    if shape == "round":
        a = np.arange(17) * np.pi / 8.5
        parts = [Polygon(0.5 + 0.4 * np.c_[np.cos(a), np.sin(a)])]
    elif shape == "concave":
        parts = [star_polygon(seed, 3 + seed % 40)]
    elif shape == "spiked":
        parts = [spiked()]
    elif shape == "comb":
        parts = [affinity.scale(comb(4), 0.25, 1.0, origin=(0, 0))]
    elif shape == "holed":
        parts = [affinity.scale(HOLED, 0.1, 0.1, origin=(0, 0))]
    elif shape == "slit":
        parts = [box(0, 0, 1, 1).difference(box(0.5, 0.1, 0.5 + 10.0 ** -(seed % 8), 1))]
    rng = np.random.default_rng(seed)
    points = 3 * rng.random((3 * n, 2)) - 1 if shape == "concave" else rng.random((n, 2))
    points = points[shapely.intersects_xy(shapely.unary_union(parts), *points.T)]
    density = DensityField(rng.random((9, 9)) + 0.05, 1 / 9) if weighted else None
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cells, "MOST_TODO", 2.0)
        patch.setattr(cells, "KEEP_BELOW", 10.0)
        engine = Relaxation(points, parts, None, None, density, over)
        owner = engine.tessellation().compartment_of_dot
        for _ in range(25):
            fresh = Relaxation(engine.points, parts, None, owner, density, over)
            fresh.step()
            engine.step()
            gap = np.abs(engine.points - fresh.points).max(initial=0.0)
            assert gap <= 1e-10 * engine._cells.spacing


def test_stars_survive_dots_that_run(monkeypatch):
    """Dots drawn to a corner: moves of many spacings, many stars fail in every step."""
    points = points_in(box(0, 0, 10, 10), 1200, 4)
    x, y = np.meshgrid(np.arange(200) / 200, np.arange(200) / 200)
    density = DensityField(np.exp(-40 * ((x - 0.8) ** 2 + (y - 0.7) ** 2)) + 1e-4, 10 / 200)
    monkeypatch.setattr(cells, "MOST_TODO", 2.0)
    monkeypatch.setattr(cells, "KEEP_BELOW", 10.0)
    args = (points, box(0, 0, 10, 10), None, None, density)
    engine = Relaxation(*args)
    for want in from_nothing(monkeypatch, *args, steps=30):
        engine.step()
        assert np.abs(engine.points - want).max() <= 1e-9 * engine._cells.spacing


def clusters(n, spread, seed=0):
    """Dots in five tight clusters, and a few far from all of them."""
    rng = np.random.default_rng(seed)
    centres = rng.uniform(1, 9, (5, 2))
    tight = centres[rng.integers(0, 5, n)] + spread * rng.standard_normal((n, 2))
    xy = np.vstack([tight, rng.uniform(0, 10, (20, 2))])
    return xy[shapely.contains_xy(HOLED, xy[:, 0], xy[:, 1])]


def test_stars_survive_clusters_that_spread(monkeypatch):
    """Crowded grid cells whose dots have gone on since they were sorted into them."""
    points = clusters(1500, 0.1)
    monkeypatch.setattr(cells, "MOST_TODO", 2.0)
    monkeypatch.setattr(cells, "KEEP_BELOW", 10.0)
    monkeypatch.setattr(cells, "SLACK", 3.0)
    engine = Relaxation(points, HOLED)
    n_old = 0
    for want in from_nothing(monkeypatch, points, HOLED, steps=12):
        engine.step()
        n_old += (
            len(engine._cells._crowds.cell) > 0 and engine._cells._slack > engine._cells.spacing
        )
        assert np.abs(engine.points - want).max() <= 1e-9 * engine._cells.spacing
    assert n_old >= 2, "no crowd was old"


@given(seed=st.integers(0, 10**6), n=st.integers(1, 300))
@settings(max_examples=25)
def test_energy_never_rises(seed, n):
    engine = Relaxation(points_in(box(0, 0, 7, 5), n, seed), box(0, 0, 7, 5))
    before = engine.energy()
    for _ in range(12):
        engine.step()
        after = engine.energy()
        assert after <= before * (1 + 1e-12)
        before = after


@given(seed=st.integers(0, 10**6), n=st.integers(1, 80), over=st.sampled_from([0.5, 1.0, 1.9]))
@settings(max_examples=40)
def test_no_dot_leaves_by_any_measure(seed, n, over):
    """By shapely's exact predicates, in shapes whose centroids lie outside themselves."""
    rng = np.random.default_rng(seed)
    bend = LineString(np.cumsum(rng.uniform(-1, 1, (6, 2)), axis=0)).buffer(0.05 + rng.random() / 5)
    polygon = bend if bend.geom_type == "Polygon" else box(0, 0, 1, 1)
    points = points_in(polygon, n, seed)
    engine = Relaxation(points, polygon, over_relaxation=over)
    for _ in range(8):
        engine.step()
        assert shapely.intersects_xy(polygon, *engine.points.T).all()


def test_a_centroid_behind_a_wall_is_approached_not_reached():
    ring = Point(0, 0).buffer(1.0).difference(Point(0, 0).buffer(0.8))
    engine = Relaxation([[0.9, 0.0]], ring)
    np.testing.assert_allclose(engine.centroids(), 0, atol=1e-12)
    engine.run(60)
    ((x, y),) = engine.points
    assert 0.79 < np.hypot(x, y) < 0.9
    assert shapely.contains_xy(ring, x, y)


def test_dots_on_the_border_itself():
    polygon = Polygon([(0, 0), (4, 0), (4, 4), (2, 2), (0, 4)])
    points = np.array([[0, 0], [2, 0], [4, 4], [2, 2], [3, 3], [0, 4], [1, 0], [0, 2], [1, 1]])
    engine = Relaxation(points, polygon)
    assert engine.cell_areas().sum() == pytest.approx(polygon.area, rel=1e-9)
    engine.run(20)
    assert shapely.contains_xy(polygon, *engine.points.T).all()


def test_fixed_dots_never_move_but_shape_cells():
    points = points_in(HOLED, 400, 1)
    fixed = np.arange(400) % 3 == 0
    engine = Relaxation(points, HOLED, fixed)
    engine.run(30)
    np.testing.assert_array_equal(engine.points[fixed], points[fixed])
    assert engine.cell_areas().sum() <= HOLED.area * (1 + 1e-12)
    gaps = shapely.STRtree(shapely.points(engine.points)).query_nearest(
        shapely.points(engine.points[~fixed]), exclusive=True, return_distance=True
    )[1]
    assert gaps.min() > 0.25 * engine._cells.spacing
    everything = Relaxation(points, HOLED, np.ones(400, bool)).step()
    assert (everything.mean_mm, everything.largest_mm, everything.n_moved) == (0.0, 0.0, 0)


@pytest.mark.parametrize("n_fixed", [0, 1, 3])
def test_coinciding_dots_are_parted_alike_every_time(n_fixed):
    points = np.vstack([np.full((12, 2), 0.25), points_in(box(0, 0, 1, 1), 30, 0)])
    fixed = np.arange(42) < n_fixed
    runs = [Relaxation(points, box(0, 0, 1, 1), fixed) for _ in range(2)]
    for engine in runs:
        engine.run(15)
    np.testing.assert_array_equal(runs[0].points, runs[1].points)
    free = runs[0].points[~fixed]
    assert len(np.unique(free.round(6), axis=0)) == len(free)
    np.testing.assert_array_equal(runs[0].points[fixed], points[fixed])


def test_reports_and_reasons():
    points = points_in(box(0, 0, 1, 1), 200, 0)
    engine = Relaxation(points, box(0, 0, 1, 1))
    seen = []
    report = engine.run(5, progress=lambda i, step: seen.append((i, step)))
    assert report.reason == "iterations"
    assert report.n_steps == 5
    assert [i for i, _ in seen] == [1, 2, 3, 4, 5]
    assert tuple(step for _, step in seen) == report.steps
    fresh = Relaxation(points, box(0, 0, 1, 1))
    step = fresh.step()
    gone = np.hypot(*(fresh.points - points).T)
    assert step.mean_mm == pytest.approx(gone.mean(), rel=1e-9)
    assert step.largest_mm == pytest.approx(gone.max(), rel=1e-9)
    assert step.n_moved == 200
    report = engine.run(5000, tolerance_mm=1e-4)
    assert report.reason == "tolerance"
    assert report.steps[-1].largest_mm <= 1e-4 < report.steps[-2].largest_mm


def test_cancel_drops_the_step_under_way():
    points = points_in(box(0, 0, 1, 1), 30_000, 0)
    engine = Relaxation(points, box(0, 0, 1, 1))
    asked = []
    report = engine.run(3, cancel=lambda: asked.append(0) or len(asked) > 2)
    assert report.reason == "cancelled"
    assert report.n_steps == 0
    np.testing.assert_array_equal(engine.points, points)
    assert engine.run(2, cancel=threading.Event()).reason == "iterations"
    stopped, middle = threading.Event(), engine.points
    stopped.set()
    assert engine.run(2, cancel=stopped).reason == "cancelled"
    np.testing.assert_array_equal(engine.points, middle)
    engine.run(1)  # and goes on from there
    same = Relaxation(points, box(0, 0, 1, 1))
    same.run(3)
    np.testing.assert_allclose(engine.points, same.points, rtol=0, atol=1e-12)


def test_two_threads_at_once():
    points = points_in(HOLED, 20_000, 0)
    alone = Relaxation(points, HOLED)
    alone.run(6)
    engines = [Relaxation(points, HOLED) for _ in range(4)]
    threads = [threading.Thread(target=engine.run, args=(6,)) for engine in engines]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for engine in engines:
        np.testing.assert_array_equal(engine.points, alone.points)


@pytest.mark.parametrize("n", [150, 1200, 12_000])
def test_variance_of_edge_lengths_falls_as_in_the_paper(n):
    """Appendix, figure 6: under 10 % of the start after 10 steps, 6 % after 20.

    Edges near the border are left out: there the triangulation joins dots far apart along it.
    150 dots are averaged over 12 sets.
    """
    ratios = []
    for seed in range(12 if n == 150 else 1):
        engine = Relaxation(np.random.default_rng(seed).random((n, 2)), box(0, 0, 1, 1))
        variance = [edge_variance(engine.points)]
        for _ in range(2):
            engine.run(10)
            variance.append(edge_variance(engine.points))
        ratios.append(np.array(variance[1:]) / variance[0])
    after_ten, after_twenty = np.mean(ratios, axis=0)
    assert after_ten < 0.10
    assert after_twenty < 0.07
    assert after_twenty < after_ten


def edge_variance(points):
    """Variance of the Delaunay edges between dots two spacings or more from the border."""
    margin = 2 / np.sqrt(len(points))
    inner = ((points > margin) & (points < 1 - margin)).all(axis=1)
    a, b = Delaunay(points).simplices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).T
    both = inner[a] & inner[b]
    return np.hypot(*(points[a[both]] - points[b[both]]).T).var() * len(points)


def test_spectrum_is_blue_noise_without_direction():
    power = np.zeros((81, 81))
    frequency = np.arange(-40, 41)
    for seed in range(6):
        points = relax(np.random.default_rng(seed).random((900, 2)), box(0, 0, 1, 1))
        inner = points[(np.abs(points - 0.5) < 0.42).all(axis=1)]
        window = np.prod(np.cos(np.pi * (inner - 0.5) / 0.84) ** 2, axis=1)
        x = np.exp(-2j * np.pi * np.outer(frequency, inner[:, 0]))
        y = np.exp(-2j * np.pi * np.outer(inner[:, 1], frequency))
        power += np.abs((x * window) @ y) ** 2 / (window**2).sum()
    power /= 6
    fx, fy = np.meshgrid(frequency, frequency)
    radius, angle = np.hypot(fx, fy), np.arctan2(fy, fx)
    low = power[(radius > 5) & (radius < 18)].mean()
    band = (radius > 27) & (radius < 37)
    assert low < 0.08  # random dots have 1 everywhere
    assert power[band].mean() > 1.5
    by_angle = [power[band & (np.abs(angle - a) < np.pi / 12)].mean()
                for a in np.linspace(-np.pi + np.pi / 12, np.pi - np.pi / 12, 12)]  # fmt: skip
    assert np.std(by_angle) < 0.25 * np.mean(by_angle)


def test_over_relaxation_needs_fewer_steps():
    points = np.random.default_rng(0).random((4000, 2))
    energies = {}
    for over in (1.0, 1.5):
        engine = Relaxation(points, box(0, 0, 1, 1), over_relaxation=over)
        engine.run(12)
        energies[over] = engine.energy()
        if over == 1.0:
            engine.run(4)
            energies["four more"] = engine.energy()
    assert energies[1.5] < energies["four more"] < energies[1.0]


@pytest.mark.parametrize("method", ["delaunay-mean", "springs"])
def test_methods_for_comparison(method):
    points = points_in(HOLED, 300, 0)
    fixed = np.arange(300) % 10 == 0
    moved = relax(points, HOLED, 10, fixed, method=method)
    assert shapely.intersects_xy(HOLED, *moved.T).all()
    np.testing.assert_array_equal(moved[fixed], points[fixed])
    dots = np.random.default_rng(0).random((1000, 2))
    evened = relax(dots, box(0, 0, 1, 1), 10, method=method)
    assert edge_variance(evened) < 0.5 * edge_variance(dots)
    np.testing.assert_array_equal(relax([[1.0, 1.0], [2.0, 1.0]], HOLED, 3, method=method),
                                  [[1.0, 1.0], [2.0, 1.0]])  # fmt: skip
    with pytest.raises(ParameterError, match="method"):
        relax(points, HOLED, method="lloyds")


def test_public_relax():
    points = np.random.default_rng(0).random((500, 2))
    kept = points.copy()
    corner = [(0, 0), (1, 0), (1, 1), (0, 1)]
    plain = relax(points, np.array(corner))
    np.testing.assert_array_equal(points, kept)
    np.testing.assert_array_equal(plain, relax(points, box(0, 0, 1, 1)))
    x = (np.arange(160) + 0.5) / 160
    by_array = relax(points, corner, density=np.tile(x, (90, 1)))
    by_function = relax(points, corner, density=lambda x, y: x + 0 * y)
    assert np.abs(by_array - by_function).max() < 0.02
    settled = relax(points[:100], corner, 1000, density=np.tile(x, (90, 1)))
    assert settled[:, 0].mean() == pytest.approx(0.6, abs=0.01)  # dots as the root of weight
    assert by_array[:, 0].mean() > plain[:, 0].mean()
    parts = MultiPolygon([box(0, 0, 0.45, 1), box(0.55, 0, 1, 1)])
    inside = points[shapely.intersects_xy(parts, *points.T)]
    assert shapely.intersects_xy(parts, *relax(inside, parts).T).all()


with np.errstate(invalid="ignore"):
    NOT_FINITE = Polygon([(0, 0), (1, 0), (np.nan, 1)])

BAD = [
    (Polygon(), "compartment 0: is empty"),
    (Polygon([(0, 0), (1, 1), (1, 0), (0, 1)]), "compartment 0: is not valid .Self-intersection"),
    (np.array([(0, 0), (1, 0), (np.nan, 1)]), "compartment 0: .*not finite"),
    (NOT_FINITE, "compartment 0: .*not finite"),
    (np.array([(0, 0), (1, 0)]), "compartment 0: .*three points"),
    (Polygon([(0, 0), (1, 0), (2, 0)]), "compartment 0: (is not valid|has no area)"),
    ([box(0, 0, 1, 1), Polygon()], "compartment 1: is empty"),
    ([box(0, 0, 1, 1), Polygon([(2, 0), (3, 1), (3, 0), (2, 1)])], "compartment 1: is not valid"),
    ([], "no compartment"),
    ("square", "no polygon"),
]


@pytest.mark.parametrize(("polygon", "message"), BAD)
def test_bad_polygons(polygon, message):
    with pytest.raises(GeometryError, match=message):
        Relaxation([[0.5, 0.5]], polygon)


def test_compartments_without_dots():
    squares = [box(0, 0, 1, 1), box(5, 5, 6, 6)]
    engine = Relaxation([[0.2, 0.5]], squares)
    engine.step()
    np.testing.assert_allclose(engine.points, [[0.5, 0.5]])
    assert len(relax(np.empty((0, 2)), squares)) == 0


def test_bad_dots():
    square = box(0, 0, 1, 1)
    with pytest.raises(GeometryError, match=r"compartment 0: dot 1 at \(2, 0\.5\) lies outside"):
        Relaxation([[0.5, 0.5], [2, 0.5]], square)
    with pytest.raises(GeometryError, match="compartment 1: dot 0"):
        Relaxation([[0.5, 0.5], [5.5, 5.5]], [square, box(5, 5, 6, 6)], compartment_of_dot=[1, 1])
    with pytest.raises(GeometryError, match=r"dot 0.*not finite"):
        Relaxation([[np.nan, 0.5]], square)
    with pytest.raises(ParameterError, match="fixed"):
        Relaxation([[0.5, 0.5]], square, fixed=[True, False])
    with pytest.raises(ParameterError, match="over-relaxation"):
        Relaxation([[0.5, 0.5]], square, over_relaxation=2.0)
    with pytest.raises(ParameterError, match="density"):
        Relaxation([[0.5, 0.5]], square, density=DensityField(np.full((2, 2), np.nan), 1.0))
    with pytest.raises(ParameterError, match="iterations"):
        relax([[0.5, 0.5]], square, -1)


def test_a_few_dots_among_many():
    """A brush's dots go where they would if all others were fixed, dot by dot the same bits."""
    points = points_in(HOLED, 3000, 0)
    brush = relax_local.LocalRelaxation(points, HOLED)
    here = points.copy()
    for centre in ([2, 3], [5.5, 1], [9.5, 9.5]):
        dots = np.flatnonzero(np.hypot(*(here - centre).T) <= 1.3).astype(np.int32)
        fixed = np.ones(3000, bool)
        fixed[dots] = False
        engine = Relaxation(here, HOLED, fixed)
        engine.run(6)
        np.testing.assert_allclose(brush.relax(dots, 6), engine.points[dots], rtol=0, atol=1e-12)
        here = brush.positions(np.arange(3000))
        np.testing.assert_array_equal(here[fixed], engine.points[fixed])


def test_a_brush_refuses_places_outside_and_moves_nothing():
    points = points_in(HOLED, 200, 0)
    brush = relax_local.LocalRelaxation(points, HOLED)
    for change in (lambda xy: brush.move([3, 4], xy), brush.add):
        with pytest.raises(GeometryError, match=r"dot 1 at \(5\.5, 9\) lies outside"):
            change([[5.5, 1.0], [5.5, 9.0]])
        np.testing.assert_array_equal(brush.positions(np.arange(200)), points)
        assert len(brush) == 200


@given(seed=st.integers(0, 10**6))
@settings(max_examples=15)
def test_the_brushs_grid_follows_every_change(seed):
    rng = np.random.default_rng(seed)
    points = points_in(HOLED, 200, seed)
    brush = relax_local.LocalRelaxation(points, HOLED)
    here = {i: p for i, p in enumerate(points)}
    for _ in range(25):
        ids = np.array(sorted(here), np.int32)
        some = rng.choice(ids, min(len(ids), 20), replace=False)
        match rng.integers(4):
            case 0:
                crowd = [3.0, 1.0] + 0.2 * rng.random((rng.integers(1, 40), 2))
                here.update(zip(brush.add(crowd).tolist(), crowd, strict=True))
            case 1:
                brush.remove(some)
                for i in some.tolist():
                    del here[i]
            case 2:
                places = [7.0, 1.0] + 1.5 * rng.random((len(some), 2))
                brush.move(some, places)
                here.update(zip(some.tolist(), places, strict=True))
            case 3:
                here.update(zip(some.tolist(), brush.relax(some), strict=True))
        ids = np.array(sorted(here), np.int32)
        assert len(brush) == len(here)
        xy = np.array([here[i] for i in ids.tolist()]).reshape(-1, 2)
        np.testing.assert_array_equal(brush.positions(ids), xy)


@pytest.mark.parametrize("polygon", [box(0, 0, 10, 10), HOLED], ids=["square", "holed"])
def test_others_may_redirect_moves(polygon):
    """Dots bound to a line, dots sent out of the compartment, and what is left to relaxation."""
    points = points_in(polygon, 600, 1)
    fixed = np.arange(600) % 7 == 0
    bound = np.arange(600) % 5 == 1
    engine, given_back = Relaxation(points, polygon, fixed), []

    def along_x(before, wanted):
        np.testing.assert_array_equal(before, engine.points)
        wanted[bound, 1] = points[bound, 1]
        wanted[::5] += 1000.0
        given_back.append(wanted)
        return wanted

    for _ in range(12):
        before = engine.points
        fresh = Relaxation(before, polygon, fixed)
        fresh.step()
        engine.step(redirect=along_x)
        after = engine.points
        np.testing.assert_array_equal(after[fixed], points[fixed])
        np.testing.assert_array_equal(after[::5], points[::5])
        assert shapely.intersects_xy(polygon, *after.T).all()
        sent = bound & ~fixed
        stayed = (after[sent] == before[sent]).all(axis=1)
        np.testing.assert_array_equal(after[sent][~stayed], given_back[-1][sent][~stayed])
        others = ~sent & (np.arange(600) % 5 != 0)
        np.testing.assert_allclose(after[others], fresh.points[others], atol=1e-9)
    with pytest.raises(ParameterError, match="redirect"):
        engine.step(redirect=lambda _before, wanted: wanted[:3])
