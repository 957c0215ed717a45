"""The table says every dot, to the micrometre."""

import csv
import io

import numpy as np
import pytest

from stippler.drawing.dots import FIXED, Dots
from stippler.errors import TableError
from stippler.files.table import COLUMNS, csv_chunks, read_csv


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


def test_what_is_written_is_read(tmp_path):
    rng = np.random.default_rng(6)
    n = 300
    dots = Dots.round(rng.uniform(0, 200, (n, 2)), rng.uniform(0.05, 1, n), area=3)
    dots.elongation[:] = rng.uniform(1, 4, n)
    dots.angle_rad[:] = rng.uniform(-3, 3, n)
    dots.roughness[:] = rng.uniform(0, 1, n)
    dots.constraint[::7] = FIXED
    text = b"".join(csv_chunks(dots))
    (tmp_path / "dots.csv").write_bytes(text)
    assert b"".join(csv_chunks(read_csv(tmp_path / "dots.csv"))) == text
    (tmp_path / "none.csv").write_text(COLUMNS + "\n")
    assert len(read_csv(tmp_path / "none.csv")) == 0


_GOOD = "1.0,2.0,0.5,1,0,0,7,0,0"


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("", "has 1 values"),
        ("1.0,2.0,0.5", "has 3 values"),
        (_GOOD + ",1", "has 10 values"),
        ("1.0,two,0.5,1,0,0,7,0,0", "no number"),
        ("1.0,2.0,0.5,1,0,0,7.5,0,0", "no number"),
        ("nan,2.0,0.5,1,0,0,7,0,0", "not finite"),
        ("1.0,inf,0.5,1,0,0,7,0,0", "not finite"),
        ("1.0,2.0,0.5,1,nan,0,7,0,0", "not finite"),
        ("1.0,2.0,0,1,0,0,7,0,0", "not above 0"),
        ("1.0,2.0,nan,1,0,0,7,0,0", "not above 0"),
        ("1.0,2.0,0.5,5,0,0,7,0,0", "shape"),
        ("1.0,2.0,0.5,1,0,-1,7,0,0", "shape"),
        ("1.0,2.0,0.5,1,0,0,-7,0,0", "seed"),
        ("1.0,2.0,0.5,1,0,0,7,-1,0", "area"),
        ("1.0,2.0,0.5,1,0,0,7,0,2", "fixed"),
        ("x" * 100_000, "has 1 values"),
        ("\x00\xff", "has 1 values"),
    ],
)
def test_a_bad_line_is_named(tmp_path, line, what):
    path = tmp_path / "dots.csv"
    path.write_bytes(f"{COLUMNS}\n{_GOOD}\n{line}\n{_GOOD}\n".encode("latin-1"))
    with pytest.raises(TableError, match=f"dots.csv, line 3: .*{what}.*; save") as told:
        read_csv(path)
    assert "\n" not in str(told.value)


def test_files_that_are_no_table(tmp_path):
    (tmp_path / "other.csv").write_text("x,y,r\n1,2,3\n")
    (tmp_path / "empty.csv").write_bytes(b"")
    for name in ("other.csv", "empty.csv"):
        with pytest.raises(TableError, match=r"line 1: does not begin with our columns"):
            read_csv(tmp_path / name)
    with pytest.raises(TableError, match="no such file"):
        read_csv(tmp_path / "none.csv")
    with pytest.raises(TableError, match="is a folder"):
        read_csv(tmp_path)
