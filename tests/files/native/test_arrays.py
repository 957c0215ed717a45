import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from stippler.errors import DrawingFileError
from stippler.files.native import arrays, structure

DTYPES = st.sampled_from([np.dtype(kind) for kind in arrays.KINDS.values()])
SOME = hnp.arrays(DTYPES, hnp.array_shapes(min_dims=1, max_dims=3, min_side=0, max_side=5))


@given(st.dictionaries(st.text(max_size=8), SOME, max_size=4), st.integers(-9, 9))
def test_what_is_packed_comes_back_to_the_bit(named, number):
    head, found = arrays.unpack(arrays.pack({"n": number}, named), "here")
    assert head == {"n": number}
    assert list(found) == list(named)
    for name, array in named.items():
        assert found[name].dtype == array.dtype
        assert found[name].shape == array.shape
        assert found[name].tobytes() == array.tobytes()


def test_every_changed_byte_is_refused_or_gives_arrays():
    data = arrays.pack({"label": "x"}, {"a": np.arange(3.0), "b": np.array([True, False])})
    for at in range(len(data)):
        for value in (0, 0x7F, 0xFF, data[at] ^ 1):
            broken = data[:at] + bytes([value]) + data[at + 1 :]
            try:
                arrays.unpack(broken, "here")
            except DrawingFileError:
                continue


@given(st.binary(max_size=200))
def test_noise_is_refused(data):
    with pytest.raises(DrawingFileError):
        arrays.unpack(data + b"\0", "here")


@pytest.mark.parametrize(
    ("kind", "shape"),
    [
        ("f8", [3]),
        ("f8", [2, -1]),
        ("f8", [2**63]),
        ("c16", [1]),
        (None, [2]),
        ("f8", 2),
        ("f8", [True]),
    ],
)
def test_kinds_and_shapes_that_do_not_fit_are_refused(kind, shape):
    with pytest.raises(DrawingFileError):
        arrays.from_bytes(bytes([7] * 16), kind, shape, "here")


def test_an_array_of_objects_has_no_place_in_a_file():
    with pytest.raises(ValueError, match="no place"):
        arrays.pack({}, {"x": np.array([object()])})


@pytest.mark.parametrize(
    "text",
    [b"[" * 100_000, b'{"a":1,"a":2}', b"NaN", b"[1e999]", b"1" * 50, b"\xff", b"{", b""],
)
def test_json_is_read_strictly(text):
    with pytest.raises(DrawingFileError):
        structure.from_bytes(text, "here")


def test_names_that_are_no_utf8_survive():
    name = b"caf\xe9".decode("utf-8", "surrogateescape")
    assert structure.from_bytes(structure.to_bytes({"name": name}), "here") == {"name": name}
