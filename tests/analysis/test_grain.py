"""The measure of rows, and that stippled greys have none."""

import numpy as np
import pytest

from stippler.analysis.grain import measure_grain
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import ParameterError
from stippler.stippling.stipple import stages


def hexagonal(n=60):
    x, y = np.meshgrid(np.arange(n, dtype=float), np.arange(n, dtype=float))
    x[1::2] += 0.5
    return np.stack([x, y * np.sqrt(0.75)], -1).reshape(-1, 2)


def test_a_hexagonal_grid_is_all_rows():
    grain = measure_grain(hexagonal())
    assert grain.rows_at_4 > 0.95
    assert grain.order > 0.99
    assert grain.least_distance == pytest.approx(1.0, abs=0.02)
    assert grain.distance_cv < 1e-9
    assert grain.largest_hole == pytest.approx(1.0, abs=0.02)


def test_a_square_grid_counts_too():
    x, y = np.meshgrid(np.arange(60.0), np.arange(60.0))
    assert measure_grain(np.stack([x, y], -1).reshape(-1, 2)).rows_at_4 > 0.95


def test_chance_has_no_rows_and_all_clouds():
    grain = measure_grain(np.random.default_rng(1).random((6000, 2)))
    assert abs(grain.rows_at_4) < 0.01
    assert grain.order == pytest.approx(0.36, abs=0.01)
    assert grain.clouds == pytest.approx(1.0, abs=0.15)
    assert grain.distance_cv == pytest.approx(0.52, abs=0.03)


def test_few_dots_are_refused():
    with pytest.raises(ParameterError):
        measure_grain(np.zeros((5, 2)))


@pytest.mark.parametrize("darkness", [0.15, 0.4, 0.73])
def test_a_stippled_grey_has_no_rows(darkness):
    reference = Reference(np.full((600, 600), darkness, np.float32), 60.0)
    found = {}
    for spacing in ("even", "lloyd"):
        *_, last = stages(reference, Style(n_dots=5000, spacing=spacing), snapshots=False)
        found[spacing] = measure_grain(np.array(last.position_mm))
    even = found["even"]
    assert even.rows_at_4 < 0.015 < 0.04 < found["lloyd"].rows_at_4
    assert even.clouds < 0.002
    assert even.least_distance > 0.73
    assert even.distance_cv < 0.045
    assert even.largest_hole < 1.3
