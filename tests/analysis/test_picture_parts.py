"""Parts of a picture: whole, joined by tone, split and grown; outlines without gaps."""

import numpy as np
import pytest
import shapely

from stippler.analysis.picture_parts import parts_of
from stippler.analysis.region_outlines import outlines_of


@pytest.fixture(scope="module")
def darkness():
    """A dark disc and a grey bar on white, with some noise."""
    y, x = np.mgrid[0:180, 0:240]
    out = np.where(np.hypot(x - 80, y - 90) < 50, 0.8, 0.05)
    out[60:120, 160:220] = 0.4
    noise = np.random.default_rng(1).normal(0, 0.01, out.shape)
    return np.clip(out + noise, 0, 1).astype(np.float32)


@pytest.fixture(scope="module")
def parts(darkness):
    return parts_of(darkness, 300)


def test_parts_cover_the_picture_each_in_one_piece(parts, darkness):
    from scipy import ndimage

    assert parts.labels.shape == darkness.shape
    assert np.array_equal(np.unique(parts.labels), np.arange(parts.n))
    assert parts.size.sum() == darkness.size
    for k in range(parts.n):
        assert ndimage.label(parts.labels == k)[1] == 1
    for k in (0, parts.n // 2):
        assert parts.tone[k] == pytest.approx(darkness[parts.labels == k].mean(), abs=1e-5)


def test_three_regions_are_the_three_things(parts):
    region = parts.regions(3)[parts.labels]
    disc, bar, ground = region[90, 80], region[90, 190], region[5, 5]
    assert len({int(disc), int(bar), int(ground)}) == 3
    assert (region == disc).sum() == pytest.approx(np.pi * 2500, rel=0.04)
    assert (region == bar).sum() == pytest.approx(3600, rel=0.06)


def test_regions_are_merged_split_and_parted(parts):
    region = parts.regions(3)
    disc, bar = parts.at(80, 90), parts.at(190, 90)
    one = parts.merged(region, {disc, bar})
    assert one[disc] == one[bar]
    assert len(np.unique(one)) == 2
    two = parts.split(region, disc)
    assert len(np.unique(two)) == 4
    assert np.array_equal(two[region != region[disc]], region[region != region[disc]])
    off = parts.parted(region, {disc})
    assert (off == off[disc]).sum() == 1
    assert parts.at(-1, 5) is None
    assert parts.at(240, 5) is None


def test_a_scribble_grows_to_the_edge_of_its_thing(parts):
    grown = parts.grown({parts.at(80, 90)}, {parts.at(5, 5), parts.at(190, 90)})[parts.labels]
    y, x = np.mgrid[0:180, 0:240]
    disc = np.hypot(x - 80, y - 90) < 50
    assert (grown & disc).sum() / (grown | disc).sum() > 0.94
    alone = parts.grown({parts.at(80, 90)}, set())[parts.labels]
    assert (alone & disc).sum() / disc.sum() > 0.95


def test_a_large_picture_is_made_smaller():
    parts = parts_of(np.zeros((1200, 1500), np.float32), 100)
    assert parts.labels.size <= 1_010_000
    assert parts.scale == pytest.approx(np.sqrt(1.8), rel=0.01)


@pytest.mark.parametrize("curved", [False, True])
def test_outlines_share_their_borders_and_cover_the_picture(parts, curved):
    labels = parts.regions(12)[parts.labels]
    outlines = outlines_of(labels, 0.5, curved=curved)
    whole = 0.0
    for k in np.unique(labels):
        rings = [shapely.Polygon(path.points_mm) for path in outlines.rings(int(k))]
        rings.sort(key=lambda ring: -ring.area)
        area = rings[0].area + sum(
            -ring.area if rings[0].contains(ring.representative_point()) else ring.area
            for ring in rings[1:]
        )
        assert area == pytest.approx((labels == k).sum() * 0.25, rel=0.15, abs=3.0)
        whole += area
    assert whole == pytest.approx(120 * 90, rel=1e-6)


def test_a_smooth_outline_has_few_vertices_and_no_stairs():
    y, x = np.mgrid[0:200, 0:200]
    disc = (np.hypot(x - 100, y - 100) < 70).astype(np.int32)
    (ring,) = outlines_of(disc, 1.0).rings(1)
    assert len(ring) < 80
    away = np.hypot(*(ring.points_mm - 100.5).T) - 70
    assert np.abs(away).max() < 1.0
