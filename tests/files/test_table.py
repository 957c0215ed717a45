"""The table says every dot, to the micrometre."""

import csv
import io

import numpy as np

from stippler.drawing.dots import FIXED, Dots
from stippler.files.table import COLUMNS, csv_chunks


def test_every_value_comes_back():
    rng = np.random.default_rng(5)
    n = 25_001  # more than one piece
    dots = Dots.round(rng.uniform(0, 200, (n, 2)), rng.uniform(0.05, 1, n), area=3)
    dots.elongation[:] = rng.uniform(1, 4, n)
    dots.angle_rad[:] = rng.uniform(-3, 3, n)
    dots.roughness[:] = rng.uniform(0, 1, n)
    dots.constraint[::7] = FIXED
    text = b"".join(csv_chunks(dots)).decode()
    assert text.splitlines()[0] == COLUMNS
    rows = np.array([[float(v) for v in row] for row in list(csv.reader(io.StringIO(text)))[1:]])
    np.testing.assert_allclose(rows[:, :2], dots.position_mm, atol=5.1e-7)
    np.testing.assert_allclose(rows[:, 2], dots.radius_mm, atol=5.1e-7)
    np.testing.assert_allclose(rows[:, 3], dots.elongation, rtol=1e-5)
    np.testing.assert_allclose(rows[:, 4], dots.angle_rad, rtol=1e-5)
    np.testing.assert_allclose(rows[:, 5], dots.roughness, rtol=1e-5)
    np.testing.assert_array_equal(rows[:, 6].astype(np.uint32), dots.seed)
    np.testing.assert_array_equal(rows[:, 7], 3)
    np.testing.assert_array_equal(rows[:, 8].astype(bool), dots.fixed)


def test_no_dots_is_a_header():
    assert b"".join(csv_chunks(Dots.none())).decode() == COLUMNS + "\n"
