"""Tables of dots, ours and those that spreadsheets make of them, in every dialect."""

import csv
import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.dots import Dots
from stippler.errors import TableError
from stippler.files.read.table import DEFAULT_RADIUS_MM, NAMES, read_csv
from stippler.files.write.table import FIRST_COLUMNS, csv_chunks


def dots_of(n, seed=6):
    rng = np.random.default_rng(seed)
    dots = Dots.round(rng.uniform(0, 200, (n, 2)), rng.uniform(0.05, 1, n), area=3)
    dots.elongation[:] = rng.uniform(1, 4, n)
    dots.angle_rad[:] = rng.uniform(-3, 3, n)
    dots.roughness[:] = rng.uniform(0, 1, n)
    dots.constraint[::7] = 1
    return dots


def test_what_is_written_is_read(tmp_path):
    text = b"".join(csv_chunks(dots_of(300)))
    (tmp_path / "dots.csv").write_bytes(text)
    assert b"".join(csv_chunks(read_csv(tmp_path / "dots.csv"))) == text
    (tmp_path / "none.csv").write_text(FIRST_COLUMNS + "\n")
    assert len(read_csv(tmp_path / "none.csv")) == 0
    assert tuple(FIRST_COLUMNS.split(",")[:9]) == NAMES


# --- dialects -----------------------------------------------------------------------------------

DOTS = dots_of(20)
TEXT = b"".join(csv_chunks(DOTS)).decode()
ROWS = list(csv.reader(io.StringIO(TEXT)))


def joined(rows, separator=",", end="\n"):
    return end.join(separator.join(row) for row in rows) + end


def commas(rows):
    return [[cell.replace(".", ",") for cell in row] for row in rows]


def quoted(rows, separator=","):
    return joined([[f'"{cell}"' for cell in row] for row in rows], separator)


def order(rows, columns):
    return [[row[k] for k in columns] for row in rows]


def floats(rows):
    return [rows[0], *([*row[:6], *(f"{float(v):.1f}" for v in row[6:])] for row in rows[1:])]


def exponents(rows):
    """As a spreadsheet writes large numbers; seeds are ones that survive it."""
    return [rows[0], *([*row[:6], "2.65E+09", *row[7:]] for row in rows[1:])]


TRUTH = {"0": "FALSE", "1": "TRUE"}
DIALECTS = {
    "a mark": b"\xef\xbb\xbf" + TEXT.encode(),
    "UTF-16": TEXT.encode("utf-16"),
    "UTF-16, big end first": b"\xfe\xff" + TEXT.encode("utf-16-be"),
    "UTF-16 without a mark": TEXT.encode("utf-16-le"),
    "UTF-16-BE without a mark": TEXT.encode("utf-16-be"),
    "ends of Windows": TEXT.replace("\n", "\r\n").encode(),
    "ends of an old Mac": TEXT.replace("\n", "\r").encode(),
    "no last end": TEXT.rstrip("\n").encode(),
    "semicolons": joined(ROWS, ";").encode(),
    "semicolons and decimal commas": joined(commas(ROWS), ";").encode(),
    "tabs": joined(ROWS, "\t").encode(),
    "tabs and decimal commas": joined(commas(ROWS), "\t").encode(),
    "blanks": joined(ROWS, "  ").encode(),
    "commas and blanks": joined(ROWS, ", ").encode(),
    "sep=;": b"sep=;\r\n" + joined(commas(ROWS), ";", "\r\n").encode(),
    '"sep=|"': b'"sep=|"\n' + joined(ROWS, "|").encode(),
    "quotes": quoted(ROWS).encode(),
    "quoted decimal commas": quoted(commas(ROWS)).encode(),
    "quotes and semicolons": quoted(commas(ROWS), ";").encode(),
    "blank lines": ("\n\n" + TEXT.replace("\n", "\n\n") + "\n \n").encode(),
    "empty last rows": (TEXT + ",,,,,,,,\n" * 3).encode(),
    "notes": ("# made by hand\n" + TEXT).encode(),
    "another order": joined(order(ROWS, [8, 3, 1, 0, 2, 7, 6, 5, 4])).encode(),
    "more columns": joined([[*row, "Ünïcode", ""] for row in ROWS]).encode(),
    "more columns in Latin-1": joined([[*row, "Größe"] for row in ROWS]).encode("latin-1"),
    "integers as 0.0": joined(floats(ROWS)).encode(),
    "capitals": (TEXT.split("\n")[0].upper() + "\n" + TEXT.split("\n", 1)[1]).encode(),
    "units": TEXT.replace("x_mm", "X (mm)", 1).replace("radius_mm", "Radius [mm]", 1).encode(),
    "truth": joined([ROWS[0], *([*r[:8], TRUTH[r[8]]] for r in ROWS[1:])]).encode(),
    "no names": TEXT.split("\n", 1)[1].encode(),
}  # fmt: skip


@pytest.mark.parametrize("name", DIALECTS)
def test_every_dialect_is_the_same_table(tmp_path, name):
    path = tmp_path / "dots.csv"
    path.write_bytes(DIALECTS[name])
    assert b"".join(csv_chunks(read_csv(path))).decode() == TEXT


def test_seeds_as_a_spreadsheet_writes_them(tmp_path):
    (tmp_path / "dots.csv").write_text(joined(exponents(ROWS)))
    assert set(read_csv(tmp_path / "dots.csv").seed.tolist()) == {2_650_000_000}


@pytest.mark.parametrize(
    ("text", "radius"),
    [
        ("x_mm,y_mm\n1,2\n3,4\n", DEFAULT_RADIUS_MM),
        ("x,y\n1,2\n3,4\n", DEFAULT_RADIUS_MM),
        ("y;x\n2;1\n4;3\n", DEFAULT_RADIUS_MM),
        ("1 2\n3 4\n", DEFAULT_RADIUS_MM),
        ("1,2,0.5\n3,4,0.5\n", 0.5),
        ("x,y,r\n1,2,0.5\n3,4,0.5\n", 0.5),
        ("label,x,y,diameter\na,1,2,1\nb,3,4,1\n", 0.5),
    ],
)
def test_places_alone_are_dots(tmp_path, text, radius):
    (tmp_path / "dots.csv").write_text(text)
    dots = read_csv(tmp_path / "dots.csv")
    assert dots.position_mm.tolist() == [[1, 2], [3, 4]]
    np.testing.assert_allclose(dots.radius_mm, radius)
    assert set(dots.elongation.tolist()) == {1.0}
    assert not dots.fixed.any()


@settings(max_examples=60, deadline=None)
@given(
    n=st.integers(0, 30),
    seed=st.integers(0, 99),
    columns=st.permutations(range(9)),
    separator=st.sampled_from([",", ";", "\t"]),
    quotes=st.booleans(),
    comma=st.booleans(),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]),
    end=st.sampled_from(["\n", "\r\n"]),
)
def test_any_mixture(tmp_path_factory, n, seed, columns, separator, quotes, comma, encoding, end):
    text = b"".join(csv_chunks(dots_of(n, seed))).decode()
    rows = order(list(csv.reader(io.StringIO(text))), columns)
    if comma and (separator != "," or quotes):
        rows = commas(rows)
    if quotes:
        rows = [[f'"{cell}"' for cell in row] for row in rows]
    path = tmp_path_factory.getbasetemp() / "mixture.csv"
    path.write_bytes(joined(rows, separator, end).encode(encoding))
    assert b"".join(csv_chunks(read_csv(path))).decode() == text


# --- what is no table ---------------------------------------------------------------------------

_GOOD = "1.0,2.0,0.5,1,0,0,7,0,0"


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("1.0,2.0,0.5", "has 3 values"),
        (_GOOD + ",1", "has 10 values"),
        ("1.0,two,0.5,1,0,0,7,0,0", "no number .two"),
        ("1.0,,0.5,1,0,0,7,0,0", "no number .nothing"),
        ("1.0,2.0,0.5,1,0,0,7.5,0,0", "seed"),
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
    path.write_bytes(f"{FIRST_COLUMNS}\n{_GOOD}\n{line}\n{_GOOD}\n".encode("latin-1"))
    with pytest.raises(TableError, match=f"dots.csv, line 3: .*{what}.*; save") as told:
        read_csv(path)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "holds no table"),
        (b"\n\n", "holds no table"),
        (b"a,b,c\n1,2,3\n", "line 1: does not begin with the columns"),
        (b"x,y,x_mm\n1,2,3\n", "line 1: names x_mm twice"),
        (b"1,2,3,4\n", "4 columns without names"),
        (b"\x89PNG\r\n\x1a\n" + bytes(99), "does not begin with the columns"),
    ],
)
def test_files_that_are_no_table(tmp_path, content, says):
    (tmp_path / "other.csv").write_bytes(content)
    with pytest.raises(TableError, match=says) as told:
        read_csv(tmp_path / "other.csv")
    assert "\n" not in str(told.value)


def test_missing_files_and_folders(tmp_path):
    with pytest.raises(TableError, match="no such file"):
        read_csv(tmp_path / "none.csv")
    with pytest.raises(TableError, match="is a folder"):
        read_csv(tmp_path)


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=200))
def test_no_bytes_crash_the_reader(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "any.csv"
    path.write_bytes(data)
    try:
        dots = read_csv(path)
    except TableError:
        return
    assert np.isfinite(dots.position_mm).all()
