"""PNG in strips: what Pillow reads back is what went in."""

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from stippler.errors import ParameterError
from stippler.files.write.png import png_chunks


@given(
    st.integers(1, 40),
    st.integers(1, 40),
    st.sampled_from([1, 3, 4]),
    st.integers(0, 2**32 - 1),
    st.data(),
)
def test_pixels_come_back_however_the_strips_are_cut(width, height, channels, seed, data):
    shape = (height, width, channels)[: 2 if channels == 1 else 3]
    picture = np.random.default_rng(seed).choice([0, 7, 255], shape).astype(np.uint8)
    cuts = sorted(data.draw(st.sets(st.integers(1, max(height - 1, 1)), max_size=4)))
    strips = [s for s in np.split(picture, cuts) if len(s)]
    encoded = b"".join(png_chunks(strips, (width, height), 300))
    assert encoded == b"".join(png_chunks([picture], (width, height), 300))
    with Image.open(io.BytesIO(encoded)) as image:
        image.verify()
    with Image.open(io.BytesIO(encoded)) as image:
        assert image.size == (width, height)
        assert (np.asarray(image) == picture).all()


@pytest.mark.parametrize("dpi", [72, 300, 1200, 2540])
def test_it_prints_at_the_right_size(dpi):
    encoded = b"".join(png_chunks([np.zeros((2, 2), np.uint8)], (2, 2), dpi))
    with Image.open(io.BytesIO(encoded)) as image:
        assert image.info["dpi"] == pytest.approx((dpi, dpi), rel=1e-3)


def test_strips_arrive_one_by_one():
    """The first bytes are out before the last strip exists: nothing is held whole."""
    made = []

    def strips():
        for k in range(50):
            made.append(k)
            yield np.random.default_rng(k).integers(0, 255, (64, 512), np.uint8)

    chunks = png_chunks(strips(), (512, 50 * 64), 300)
    for _ in range(4):
        next(chunks)
    assert len(made) < 10


@pytest.mark.parametrize(
    "strips",
    [
        [np.zeros((3, 5), np.uint8)],
        [np.zeros((2, 5), np.uint8), np.zeros((2, 4), np.uint8)],
        [np.zeros((4, 5, 5), np.uint8)],
        [np.zeros((4, 5), np.uint16)],
        [],
    ],
)
def test_strips_that_do_not_make_the_picture_are_refused(strips):
    with pytest.raises(ParameterError):
        list(png_chunks(strips, (5, 4), 300))
