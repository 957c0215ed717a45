"""The table says every dot, to the last bit."""

import csv
import io

import numpy as np

from stippler.drawing.dots import FIXED, Dots
from stippler.files.write.table import FIRST_COLUMNS, csv_chunks


def test_every_value_comes_back():
    rng = np.random.default_rng(5)
    n = 25_001  # more than one piece
    dots = Dots.round(rng.uniform(0, 200, (n, 2)), rng.uniform(0.05, 1, n), area=3)
    dots.elongation[:] = rng.uniform(1, 4, n)
    dots.angle_rad[:] = rng.uniform(-3, 3, n)
    dots.roughness[:] = rng.uniform(0, 1, n)
    dots.constraint[::7] = FIXED
    text = b"".join(csv_chunks(dots)).decode()
    assert text.splitlines()[0] == FIRST_COLUMNS
    rows = np.array([[float(v) for v in row] for row in list(csv.reader(io.StringIO(text)))[1:]])
    np.testing.assert_array_equal(rows[:, :2], dots.position_mm)
    for k, name in enumerate(("radius_mm", "elongation", "angle_rad", "roughness"), 2):
        np.testing.assert_array_equal(rows[:, k].astype(np.float32), getattr(dots, name))
    np.testing.assert_array_equal(rows[:, 6].astype(np.uint32), dots.seed)
    np.testing.assert_array_equal(rows[:, 7], 3)
    np.testing.assert_array_equal(rows[:, 8].astype(bool), dots.fixed)


def test_no_dots_is_a_header():
    assert b"".join(csv_chunks(Dots.none())).decode() == FIRST_COLUMNS + "\n"
