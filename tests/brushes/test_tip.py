"""Tips: where they reach, how they fall off, how they spread dots."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from stippler.brushes.tip import Tip
from stippler.errors import ParameterError

STAR = ((1.0, 0.0), (0.3, 0.3), (0.0, 1.0), (-0.3, 0.3), (-1.0, 0.0), (0.0, -0.4))

TIPS = st.builds(
    Tip,
    shape=st.sampled_from(["circle", "ellipse", "square", "polygon"]),
    hardness=st.floats(0, 1),
    aspect=st.floats(0.1, 1),
    angle_rad=st.floats(-4, 4),
    corners=st.just(STAR),
)


@given(TIPS, st.floats(0.1, 50), st.integers(0, 99))
def test_weight_is_above_zero_only_within_the_outline(tip, radius, seed):
    points = np.random.default_rng(seed).uniform(-1.5, 1.5, (200, 2)) * radius
    outline = shapely.Polygon(tip.outline(radius, 720))
    weight = tip.weight(points, radius)
    assert ((weight >= 0) & (weight <= 1)).all()
    far = shapely.distance(outline.exterior, shapely.points(points)) > 1e-3 * radius
    inside = shapely.contains_xy(outline, points[:, 0], points[:, 1])
    assert not weight[~inside & far].any()
    if tip.hardness > 0.99:
        return
    assert (weight[inside & far] > 0).all()
    assert np.hypot(*tip.outline(radius).T).max() <= tip.reach(radius) * (1 + 1e-12)


@given(TIPS, st.floats(0.1, 50), st.integers(0, 99))
def test_spread_lies_within_the_tip_and_is_even(tip, radius, seed):
    points = tip.spread(600, radius, np.random.default_rng(seed))
    assert len(points) == 600
    outline = shapely.Polygon(tip.outline(radius, 720)).buffer(1e-3 * radius)
    assert shapely.contains_xy(outline, points[:, 0], points[:, 1]).all()
    # cut the tip in two by a line through its centre of area: as many on either side
    cut = outline.intersection(shapely.box(-1e4, -1e4, outline.centroid.x, 1e4))
    share = cut.area / outline.area
    left = int((points[:, 0] < outline.centroid.x).sum())
    assert abs(left - 600 * share) < 5 * math.sqrt(600 * share * (1 - share))


def test_a_circle_is_not_denser_in_the_middle():
    points = Tip().spread(20_000, 1.0, np.random.default_rng(1))
    inner = (np.hypot(*points.T) < 0.5).mean()
    assert inner == pytest.approx(0.25, abs=0.01)


def test_a_hard_tip_is_all_or_nothing_and_a_soft_one_falls_off():
    x = np.linspace(0, 1.2, 200)
    line = np.column_stack([x, np.zeros(200)])
    assert set(Tip(hardness=1.0).weight(line, 1.0)) == {0.0, 1.0}
    soft = Tip(hardness=0.25).weight(line, 1.0)
    assert (soft[x <= 0.25] == 1).all()
    assert (np.diff(soft) <= 0).all()
    assert soft[x > 1].max() == 0
    assert 0.45 < soft[np.argmin(abs(x - 0.625))] < 0.55


@pytest.mark.parametrize(
    "wrong",
    [
        {"shape": "heart"},
        {"hardness": 1.1},
        {"aspect": 0.0},
        {"angle_rad": math.nan},
        {"shape": "polygon", "corners": ((0, 0), (1, 1))},
        {"shape": "polygon", "corners": ((0, 0), (1, 1), (2, 0))},
    ],
)
def test_what_is_no_tip_is_refused(wrong):
    with pytest.raises(ParameterError):
        Tip(**wrong)
