"""Reading pictures: every mode gives the darkness its pixels mean; bad files give one line."""

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst
from PIL import Image, ImageOps

from stippler.errors import ParameterError, PictureError
from stippler.files.read import darkness, picture
from stippler.files.read.picture import (
    check_picture,
    darkness_of_array,
    darkness_of_image,
    read_darkness,
    read_picture,
)

GREYS = np.arange(256, dtype=np.uint8).reshape(16, 16)


def srgb_to_linear(v):
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def linear_to_srgb(v):
    return np.where(v <= 0.0031308, v * 12.92, 1.055 * v ** (1 / 2.4) - 0.055)


def expected(rgb, tone):
    """Darkness of encoded RGB in 0..1, in float64 and written out."""
    luminance = srgb_to_linear(rgb) @ [0.2126, 0.7152, 0.0722]
    return 1 - (luminance if tone == "linear" else linear_to_srgb(luminance))


@pytest.mark.parametrize("tone", ["linear", "perceptual"])
@pytest.mark.parametrize("ending", ["png", "tif", "bmp", "gif", "webp"])
def test_grey_files(tmp_path, ending, tone):
    path = tmp_path / f"grey.{ending}"
    Image.fromarray(GREYS).save(path, **({"lossless": True} if ending == "webp" else {}))
    want = 1 - GREYS / 255 if tone == "perceptual" else 1 - srgb_to_linear(GREYS / 255)
    np.testing.assert_allclose(read_darkness(path, tone), want, atol=2e-4)


@settings(max_examples=30, deadline=None)
@given(
    npst.arrays(np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 9), st.just(3))),
    st.sampled_from(["linear", "perceptual"]),
)
def test_colour_is_luminance(rgb, tone):
    np.testing.assert_allclose(
        darkness_of_image(Image.fromarray(rgb), tone), expected(rgb / 255, tone), atol=3e-4
    )


@pytest.mark.parametrize(
    "mode", ["RGB", "RGBA", "L", "LA", "P", "PA", "1", "CMYK", "I;16", "I", "F"]
)
@pytest.mark.parametrize("tone", ["linear", "perceptual"])
def test_white_is_exactly_zero_and_black_exactly_one(mode, tone):
    whites = {"I;16": 65535, "I": 65535, "F": 1.0}
    pixels = np.array([[1, 0, 1]], np.uint8) * 255
    if mode in whites:
        kind = {"I;16": np.uint16, "I": np.int32, "F": np.float32}[mode]
        image = Image.fromarray((pixels / 255 * whites[mode]).astype(kind))
    else:
        image = Image.fromarray(pixels).convert("RGB").convert(mode)
    assert image.mode == mode
    assert darkness_of_image(image, tone).tolist() == [[0.0, 1.0, 0.0]]


@pytest.mark.parametrize("tone", ["linear", "perceptual"])
def test_transparent_parts_are_white(tone):
    rgba = np.zeros((1, 3, 4), np.uint8)
    rgba[0, :, 3] = [0, 255, 51]
    want = [[0.0, 1.0, 0.2]]
    np.testing.assert_allclose(darkness_of_image(Image.fromarray(rgba), tone), want, atol=1e-6)
    np.testing.assert_allclose(
        darkness_of_image(Image.fromarray(rgba).convert("LA"), tone), want, atol=1e-6
    )
    assert darkness_of_image(Image.fromarray(rgba), tone)[0, 0] == 0.0


def test_a_palette_with_a_transparent_colour(tmp_path):
    image = Image.new("P", (2, 1))
    image.putpalette([0, 0, 0, 0, 0, 0])
    image.putdata([0, 1])
    image.save(tmp_path / "p.gif", transparency=1)
    assert read_darkness(tmp_path / "p.gif").tolist() == [[1.0, 0.0]]


def test_sixteen_bits_keep_their_steps(tmp_path):
    values = np.arange(60000, 60016, dtype=np.uint16).reshape(4, 4)
    Image.fromarray(values).save(tmp_path / "deep.png")
    dark = read_darkness(tmp_path / "deep.png", "perceptual")
    np.testing.assert_allclose(dark, 1 - values / 65535, atol=1e-6)
    assert len(np.unique(dark)) == 16


@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_orientation(tmp_path, orientation):
    image = Image.fromarray(np.arange(15, dtype=np.uint8).reshape(3, 5) * 17)
    exif = Image.Exif()
    exif[0x0112] = orientation
    image.save(tmp_path / "turned.png", exif=exif)
    upright = np.asarray(ImageOps.exif_transpose(Image.open(tmp_path / "turned.png")))
    dark = read_darkness(tmp_path / "turned.png", "perceptual")
    np.testing.assert_allclose(dark, 1 - upright / 255, atol=1e-6)


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (640, 1), (101, 33)])
def test_large_pictures_are_averaged_in_bands(monkeypatch, size):
    monkeypatch.setattr(darkness, "MAX_FIELD_PIXELS", 100)
    monkeypatch.setattr(darkness, "_BAND_PIXELS", 64)
    pixels = np.random.default_rng(1).integers(0, 256, (size[1], size[0]), np.uint8)
    dark = darkness_of_image(Image.fromarray(pixels), "perceptual")
    k = min(max(int(np.ceil(np.sqrt(pixels.size / 100))), 1), *size)
    whole = pixels[: size[1] // k * k, : size[0] // k * k]
    want = 1 - whole.reshape(size[1] // k, k, size[0] // k, k).mean(axis=(1, 3)) / 255
    np.testing.assert_allclose(dark, want, atol=1e-6)


def test_a_mislabelled_picture_is_read_by_its_content(tmp_path):
    Image.fromarray(GREYS).save(tmp_path / "really.png")
    (tmp_path / "really.png").rename(tmp_path / "named.jpg")
    assert read_darkness(tmp_path / "named.jpg").shape == (16, 16)


def jpeg_bytes():
    stream = io.BytesIO()
    noise = np.random.default_rng(0).integers(0, 256, (64, 64, 3), np.uint8)
    Image.fromarray(noise).save(stream, "JPEG")
    return stream.getvalue()


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is empty"),
        (b"hello, I am no picture", "no picture"),
        (jpeg_bytes()[:700], "cut off"),
        (jpeg_bytes()[:2000], "cut off"),
        (b"\x89PNG\r\n\x1a\n" + b"\0" * 40, "no picture"),
        (b"%PDF-1.7\n", "is a PDF"),
    ],
)
def test_files_that_are_no_picture(tmp_path, content, says):
    path = tmp_path / "bad.png"
    path.write_bytes(content)
    with pytest.raises(PictureError, match=says) as caught:
        read_darkness(path)
    line = str(caught.value)
    assert str(path) in line
    assert caught.value.do
    assert "\n" not in line


def test_missing_files_and_folders(tmp_path):
    for check in (read_darkness, check_picture):
        with pytest.raises(PictureError, match="no such file"):
            check(tmp_path / "none.png")
        with pytest.raises(PictureError, match="is a folder"):
            check(tmp_path)


def test_the_cap_is_checked_before_decoding(tmp_path, monkeypatch):
    Image.new("L", (200, 100)).save(tmp_path / "big.png")
    monkeypatch.setattr(picture, "MAX_PIXELS", 19_999)
    monkeypatch.setattr(Image.Image, "load", lambda self: pytest.fail("decoded"))
    for check in (read_darkness, check_picture):
        with pytest.raises(PictureError, match="200 × 100"):
            check(tmp_path / "big.png")


@settings(max_examples=25, deadline=None)
@given(data=st.binary(max_size=300), cut=st.integers(0, 3000))
def test_no_bytes_crash_the_reader(tmp_path_factory, data, cut):
    path = tmp_path_factory.getbasetemp() / "fuzz.bin"
    path.write_bytes(jpeg_bytes()[:cut] + data)
    try:
        dark = read_darkness(path)
    except PictureError:
        return
    assert dark.min() >= 0
    assert dark.max() <= 1


@pytest.mark.parametrize(
    ("values", "error"),
    [
        (np.array([[0.5, np.nan]]), "finite"),
        (np.array([[0.5, np.inf]]), "finite"),
        (np.array([[0.5, 1.1]]), "0 \\(black\\) to 1"),
        (np.array([[-0.1]]), "0 \\(black\\) to 1"),
        (np.zeros((0, 5)), "no picture"),
        (np.zeros(7), "no picture"),
        (np.zeros((2, 2, 5)), "no picture"),
        (np.array([["a"]]), "type"),
        (np.array([[-1]]), "negative"),
    ],
)
def test_arrays_that_are_no_picture(values, error):
    with pytest.raises(ParameterError, match=error):
        darkness_of_array(values)


@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.float32, np.float64, bool])
def test_arrays_of_every_kind(kind):
    white = 1 if kind in (np.float32, np.float64, bool) else np.iinfo(kind).max
    array = (np.array([[1, 0]]) * white).astype(kind)
    assert darkness_of_array(array, "linear").tolist() == [[0.0, 1.0]]
    rgba = np.stack([array, array, array, array], axis=-1)
    assert darkness_of_array(rgba, "perceptual").tolist() == [[0.0, 0.0]]  # black is transparent


def test_an_array_and_its_picture_agree():
    rgb = np.random.default_rng(3).integers(0, 256, (9, 8, 3), np.uint8)
    for tone in picture.TONES:
        np.testing.assert_allclose(
            darkness_of_array(rgb, tone), darkness_of_image(Image.fromarray(rgb), tone), atol=1e-5
        )


def test_an_unknown_tone():
    with pytest.raises(ParameterError, match="'loud' is no tone"):
        darkness_of_array(GREYS, "loud")


def test_a_reference_has_the_page_width(tmp_path):
    Image.new("L", (30, 20)).save(tmp_path / "p.png")
    reference = read_picture(tmp_path / "p.png", tone="linear", width_mm=60.0)
    assert (reference.width_mm, reference.height_mm, reference.pixel_mm) == (60.0, 40.0, 2.0)
    assert not reference.darkness.flags.writeable
