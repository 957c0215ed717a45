import itertools
import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from stippler.analysis.tone_error import draw_ink, measure_tone
from stippler.drawing.reference import Reference
from stippler.drawing.style import FIRST_DOTS, Style
from stippler.errors import GeometryError, ParameterError
from stippler.kernels.machine.pool import n_threads, set_threads
from stippler.stippling.stipple import notes_on, pulse_density, stages


def finished(darkness, style, width_mm=None, **options):
    field = np.asarray(darkness, np.float32)
    *_, last = stages(Reference(field, width_mm or float(field.shape[1])), style, **options)
    assert last.stage == "done"
    return last


def pixels_under(result, darkness):
    x, y = result.position_mm.T.astype(int)
    return np.asarray(darkness)[
        np.minimum(y, len(darkness) - 1), np.minimum(x, darkness.shape[1] - 1)
    ]


def ramp(h=120, w=160):
    return np.repeat(np.linspace(0, 1, w, dtype=np.float32)[None], h, 0)


@pytest.mark.parametrize(
    ("option", "value", "name"),
    [
        ("n_dots", 0, "dots"), ("n_dots", -5, "dots"), ("n_dots", 10**9, "dots"),
        ("size_range_mm", (0.2, 0.1), "size range"), ("size_range_mm", (0.0, 0.1), "size range"),
        ("size_range_mm", (math.nan, 1.0), "size range"),
        ("size_range_mm", (0.1, math.inf), "size range"),
        ("iterations", -1, "iterations"), ("seed", -1, "seed"),
        ("first_dots", "magic", "first dots"), ("growth", "oval", "growth"),
        ("start", "middle", "start"), ("sizes", "huge", "sizes"),
    ],
)  # fmt: skip
def test_plans_that_make_no_sense_are_refused_by_name(option, value, name):
    with pytest.raises(ParameterError) as caught:
        Style(**{option: value})
    assert str(caught.value).startswith(name)


def test_stages_come_in_order_and_snapshots_are_frozen():
    seen = []
    for progress in stages(Reference(ramp(), 80.0), Style(n_dots=900, iterations=4)):
        seen.append(progress.stage)
        assert 0 <= progress.done <= progress.total
        assert len(progress.position_mm) == len(progress.radius_mm)
        assert math.isfinite(progress.movement_mm) == (progress.stage == "relax")
        for array in (progress.position_mm, progress.radius_mm):
            assert not array.flags.writeable
        assert (progress.shortfall is not None) == (progress.stage == "done")
    order = ["first dots", "relax", "tone", "done"]
    assert [order.index(s) for s in seen] == sorted(order.index(s) for s in seen)
    assert set(seen) == set(order)
    assert seen.count("relax") == 4


def test_dots_come_while_pulses_are_still_counted():
    field = np.full((700, 700), 0.5, np.float32)
    shown = [len(p.position_mm) for p in stages(Reference(field, 70.0), Style(n_dots=30_000))
             if p.stage == "first dots" and p.done < p.total]  # fmt: skip
    assert sorted(shown) == shown
    assert any(0 < n < 25_000 for n in shown)


def test_without_snapshots_only_the_last_has_dots():
    style = Style(n_dots=900, iterations=2)
    quiet = list(stages(Reference(ramp(), 80.0), style, snapshots=False))
    assert all(len(p.position_mm) == 0 for p in quiet[:-1])
    *_, loud = stages(Reference(ramp(), 80.0), style)
    assert np.array_equal(quiet[-1].position_mm, loud.position_mm)
    assert np.array_equal(quiet[-1].radius_mm, loud.radius_mm)


@pytest.mark.parametrize("method", FIRST_DOTS)
@pytest.mark.parametrize("spacing", ["even", "lloyd"])
def test_the_seed_and_nothing_else_decides(method, spacing):
    def run(threads, seed):
        set_threads(threads)
        style = Style(n_dots=3000, iterations=3, seed=seed, first_dots=method, spacing=spacing)
        result = finished(ramp(), style)
        return result.position_mm.tobytes() + result.radius_mm.tobytes()

    before = n_threads()
    first, again, other = run(1, 5), run(3, 5), run(2, 6)
    set_threads(before)
    assert first == again
    # without rows, the order of the first dots is broken by chance
    assert (first != other) == (spacing == "even" or method in ("pulse-density", "random"))


def test_a_closed_iterator_stops():
    work = stages(Reference(ramp(), 80.0), Style(n_dots=2000, iterations=50))
    for progress in work:
        if progress.stage == "relax":
            break
    work.close()
    assert list(work) == []


@settings(max_examples=10)
@given(st.integers(0, 10**6), st.integers(300, 4000))
def test_the_number_is_met_within_one_percent(seed, n):
    rng = np.random.default_rng(seed)
    picture = np.kron(rng.random((4, 5)), np.ones((30, 30)))
    result = finished(picture, Style(n_dots=n, iterations=3))
    assert abs(len(result.position_mm) - n) <= max(0.01 * n, 1)
    assert result.radius_mm.max() <= 2.0 * result.radius_mm.min() * (1 + 1e-5)


def test_sizes_alone_set_the_number():
    small = finished(ramp(), Style(size_range_mm=(0.6, 1.2), iterations=3))
    large = finished(ramp(), Style(size_range_mm=(1.2, 2.4), iterations=3))
    assert len(small.position_mm) == pytest.approx(4 * len(large.position_mm), rel=0.1)
    for result, low in ((small, 0.6), (large, 1.2)):
        assert result.radius_mm.min() >= np.float32(low)
        assert result.radius_mm.max() <= np.float32(2 * low)


def test_sizes_and_number_together_report_what_is_missing():
    few = finished(ramp(), Style(n_dots=300, size_range_mm=(0.5, 1.0), iterations=3))
    assert abs(len(few.position_mm) - 300) <= 3
    assert few.shortfall.share > 0.3
    assert few.shortfall.box_mm[0] < few.shortfall.box_mm[2] <= 160.0
    many = finished(ramp(), Style(n_dots=20_000, size_range_mm=(0.8, 1.6), iterations=3))
    assert len(many.position_mm) < 10_000
    assert "fit" in many.shortfall.notes[0]
    assert measure_tone(
        many.position_mm, many.radius_mm.astype(float), ramp()
    ).bias == pytest.approx(0.0, abs=0.01)


@settings(max_examples=12)
@given(st.integers(0, 10**6), st.booleans())
def test_no_dot_stands_on_white(seed, weighted):
    rng = np.random.default_rng(seed)
    picture = np.zeros((100, 120), np.float32)
    for _ in range(6):
        x, y = rng.integers(0, 110), rng.integers(0, 95)
        picture[y : y + rng.integers(1, 40), x : x + rng.integers(1, 40)] = rng.random()
    if not picture.any():
        return
    result = finished(picture, Style(n_dots=800, iterations=6, weighted=weighted))
    assert (pixels_under(result, picture) > 0).all()


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.9])
def test_an_edge_is_placed_within_half_a_dot_spacing(angle):
    y, x = np.mgrid[0:200, 0:200] + 0.5
    dark = (x - 100) * math.cos(angle) + (y - 100) * math.sin(angle) > 0
    picture = np.where(dark, 0.6, 0.0)
    result = finished(picture, Style(n_dots=2000))
    spacing = math.sqrt(dark.sum() / 2000)
    depth = (result.position_mm[:, 0] - 100) * math.cos(angle) + (
        result.position_mm[:, 1] - 100
    ) * math.sin(angle)
    along = (result.position_mm[:, 1] - 100) * math.cos(angle) - (
        result.position_mm[:, 0] - 100
    ) * math.sin(angle)
    assert depth.min() > -0.2  # dots keep off the white side
    inner = np.abs(along) < 80
    rows = np.histogram(along[inner], bins=40, range=(-80, 80))[1]
    nearest = [
        depth[inner & (along >= a) & (along < b + spacing)].min()
        for a, b in itertools.pairwise(rows)
    ]
    assert np.mean(nearest) < spacing  # and reach the edge all along it
    ink = draw_ink(result.position_mm, result.radius_mm.astype(float), (200, 200), 4)
    order = np.argsort(((x - 100) * math.cos(angle) + (y - 100) * math.sin(angle)).ravel())
    signed = ((x - 100) * math.cos(angle) + (y - 100) * math.sin(angle)).ravel()[order]
    near = np.abs(signed) < 30
    total = ink.ravel()[order][near].mean() / 0.6
    place = 30 - 60 * total  # where a step of that height would have to be
    assert abs(place) < 0.5 * spacing
    swollen = result.radius_mm[depth < spacing].mean() / result.radius_mm.mean()
    assert 0.85 < swollen < 1.15


def test_the_paper_s_relaxation_evens_out_and_the_default_keeps_tone():
    picture = ramp(150, 150)

    def density_in_dark(weighted):
        result = finished(picture, Style(n_dots=1500, iterations=20, weighted=weighted))
        return np.count_nonzero(result.position_mm[:, 0] > 75) / len(result.position_mm)

    assert density_in_dark(True) > density_in_dark(False) > 0.5


@pytest.mark.parametrize("single", [False, True])
def test_tone_is_met(single):
    picture = np.zeros((240, 240), np.float32)
    y, x = np.mgrid[0:200, 0:200] / 199.0
    picture[20:220, 20:220] = 0.5 + 0.45 * np.sin(3 * x) * np.cos(4 * y)
    size = (1.0, 1.0) if single else None
    result = finished(picture, Style(n_dots=None if single else 6000, size_range_mm=size))
    error = measure_tone(result.position_mm, result.radius_mm.astype(float), picture)
    assert error.tone_rmse < (0.02 if single else 0.005)
    assert abs(error.bias) < (0.01 if single else 0.002)
    assert error.gain == pytest.approx(1.0, abs=0.05 if single else 0.01)


PICTURES = {
    "white": np.zeros((50, 60)),
    "black": np.ones((50, 60)),
    "grey": np.full((50, 60), 0.5),
    "one pixel": np.full((1, 1), 0.5),
    "one row": np.linspace(0, 1, 90)[None],
    "one column": np.linspace(1, 0, 90)[:, None],
    "thin lines": np.eye(80),
    "one dark pixel": np.pad([[1.0]], 30),
    "faint": np.full((40, 40), 1e-6),
    "noise": np.random.default_rng(0).random((70, 70)),
    "salt": (np.random.default_rng(1).random((90, 90)) > 0.99).astype(float),
}


@pytest.mark.parametrize("name", PICTURES)
@pytest.mark.parametrize("method", FIRST_DOTS)
def test_strange_pictures_give_a_valid_drawing(name, method):
    picture = PICTURES[name].astype(np.float32)
    result = finished(picture, Style(n_dots=700, iterations=3, first_dots=method), 100.0)
    height = 100.0 * picture.shape[0] / picture.shape[1]
    assert np.isfinite(result.position_mm).all()
    assert ((result.position_mm >= 0) & (result.position_mm <= (100.0, height))).all()
    assert (result.radius_mm > 0).all()
    if name == "white":
        assert len(result.position_mm) == 0
        assert "white" in result.shortfall.notes[0]
    elif method == "pulse-density":
        assert abs(len(result.position_mm) - 700) <= 7


def test_one_dot_is_a_drawing():
    result = finished(np.full((30, 30), 0.2), Style(n_dots=1, iterations=2))
    assert len(result.position_mm) == 1
    assert math.pi * result.radius_mm[0] ** 2 == pytest.approx(0.2 * 900, rel=0.35)


@pytest.mark.parametrize("bad", [math.nan, -0.1, 1.1, math.inf])
def test_darkness_out_of_range_is_refused(bad):
    picture = np.full((5, 5), 0.5)
    picture[2, 2] = bad
    with pytest.raises(ParameterError, match="darkness"):
        finished(picture, Style(n_dots=10))


def test_pulses_alone_come_in_pixels():
    points, radii = pulse_density(ramp(), 1234)
    assert abs(len(points) - 1234) <= 12
    assert ((points >= 0) & (points <= (160, 120))).all()
    assert measure_tone(points, radii, ramp()).bias == pytest.approx(0.0, abs=0.02)
    border, _ = pulse_density(ramp(), 1234, start="border", growth="triangular")
    assert not np.array_equal(points[:50], border[:50])


@pytest.mark.parametrize("iterations", [0, 6])
def test_sizes_by_region_are_the_paper_s(iterations):
    darkness = ramp(200, 300)
    style = Style(n_dots=3000, iterations=iterations, sizes="regions")
    result = finished(darkness, style)
    assert abs(len(result.position_mm) - 3000) <= 60
    radius, under = result.radius_mm, pixels_under(result, darkness)
    middle = radius[(under > 0.4) & (under < 0.6)]
    ordinary = np.median(radius)
    assert np.mean(np.abs(middle / ordinary - 1) < 1e-5) > 0.9
    assert radius.max() / radius.min() <= 2.0 + 1e-5
    assert np.median(radius[under > 0.9]) > ordinary > np.median(radius[under < 0.15])
    if not iterations:
        assert under.min() > 0.005  # what is fainter is dropped


def test_sizes_by_region_need_pulses():
    with pytest.raises(ParameterError, match=r"^sizes: random has no regions"):
        Style(sizes="regions", first_dots="random")


@pytest.mark.parametrize("start", ["top", "border"])
def test_pulses_in_an_area_alone(start):
    triangle = Polygon([(10, 10), (90, 20), (40, 95)])
    points, radii = pulse_density(np.full((100, 100), 0.3, np.float32), 500, start=start,
                                  area=triangle)  # fmt: skip
    assert abs(len(points) - 500) <= 10
    assert shapely.distance(triangle, shapely.points(points)).max() < 0.5
    assert np.pi * (radii**2).sum() == pytest.approx(0.3 * triangle.area, rel=0.05)


def test_an_area_smaller_than_a_dot_or_white():
    darkness = np.full((50, 50), 0.3, np.float32)
    small = Polygon([(20.1, 20.1), (20.3, 20.1), (20.2, 20.3)])
    points, _ = pulse_density(darkness, 5, area=small)
    assert len(points) <= 5
    points, radii = pulse_density(darkness * 0, 5, area=Polygon([(5, 5), (40, 5), (20, 40)]))
    assert len(points) == len(radii) == 0
    with pytest.raises(GeometryError, match="area: is not valid"):
        pulse_density(darkness, 5, area=Polygon([(0, 0), (9, 9), (9, 0), (0, 9)]))


def test_what_is_missing_is_said_with_how_much_and_where():
    darkness = np.zeros((100, 100), np.float32)
    darkness[40:80, 10:30] = 1.0
    result = finished(darkness, Style(n_dots=40, size_range_mm=(0.5, 1.0), iterations=2), 50.0)
    (note,) = notes_on(result)
    assert note.startswith("8.0 % of the page is too dark")
    assert "between 5.0, 20.0 and 15.0, 40.0 mm" in note
