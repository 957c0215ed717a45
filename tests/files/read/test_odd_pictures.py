"""Pictures of rare kinds: blocks between a JPEG's segments, profiles without a white, odd TIFFs."""

import io
import struct

import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image, ImageCms

from stippler.errors import ParameterError, PictureError
from stippler.files.read import jpeg, light, pillow
from stippler.files.read.light import Light, light_of
from stippler.files.read.picture import picture_of_bytes, read_picture
from stippler.files.read.pixels import of_array


def to_linear(v):
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


# --- JPEG of 12 bits ----------------------------------------------------------------------------

RAMP = (np.arange(16 * 24).reshape(16, 24) * 10).astype(np.uint16)
GREY = imagecodecs.cms_profile("gray", gamma=1.0)


def deep_jpeg(*segments):
    """Return a JPEG of 12 bits with segments after its first marker."""
    data = imagecodecs.jpeg_encode(RAMP, level=99, bitspersample=12)
    assert data[:2] == b"\xff\xd8"
    added = (
        b"\xff" + bytes([marker]) + struct.pack(">H", len(body) + 2) + body
        for marker, body in segments
    )
    return data[:2] + b"".join(added) + data[2:]


def turned(orientation):
    tags = Image.Exif()
    tags[0x0112] = orientation
    data = tags.tobytes()
    return data if data.startswith(b"Exif\0\0") else b"Exif\0\0" + data


def dark(data):
    return picture_of_bytes(data, "a.jpg", "linear").levels.darkness()


def test_a_deep_jpeg_is_turned_as_its_exif_says():
    plain = dark(deep_jpeg())
    assert np.allclose(plain, 1 - to_linear(RAMP / 4095), atol=5e-3)
    assert np.array_equal(dark(deep_jpeg((0xE1, turned(3)))), plain[::-1, ::-1])
    assert dark(deep_jpeg((0xE1, turned(6)))).shape == (24, 16)
    for other in ((0xE1, b"http://ns.adobe.com/xap"), (0xE4, turned(3)), (0xFE, turned(3))):
        assert np.array_equal(dark(deep_jpeg(other)), plain)


@pytest.mark.parametrize("value", [0, 9])
def test_an_orientation_that_is_none_leaves_a_deep_jpeg_upright(value):
    assert np.array_equal(dark(deep_jpeg((0xE1, turned(value)))), dark(deep_jpeg()))


def test_a_block_of_exif_that_is_none_leaves_a_deep_jpeg_upright():
    assert jpeg._orientation(b"Exif\0\0neither order") == 1
    assert np.array_equal(dark(deep_jpeg((0xE1, b"Exif\0\0junk"))), dark(deep_jpeg()))


def test_a_deep_jpeg_is_read_by_its_profile_in_one_piece_or_more():
    want = 1 - RAMP / 4095
    head = b"ICC_PROFILE\0"
    whole = deep_jpeg((0xE2, head + b"\1\1" + GREY))
    half = len(GREY) // 2
    parts = deep_jpeg((0xE2, head + b"\1\2" + GREY[:half]), (0xE2, head + b"\2\2" + GREY[half:]))
    for data in (whole, parts):
        assert np.allclose(dark(data), want, atol=5e-3)
    other = deep_jpeg((0xE2, b"MPF\0" + GREY))
    assert np.array_equal(dark(other), dark(deep_jpeg()))


def test_a_deep_jpeg_of_another_size_than_it_tells_is_refused(monkeypatch):
    data = deep_jpeg()
    monkeypatch.setattr(imagecodecs, "jpeg_decode", lambda _: RAMP[:8])
    with pytest.raises(PictureError, match="not of the size that it tells"):
        dark(data)


# --- profiles -----------------------------------------------------------------------------------


def lit(monkeypatch, transform, colour, white=255, channels=3):
    """Return the light of pixels whose profile does what a function does."""
    space = {1: b"GRAY", 3: b"RGB ", 4: b"CMYK"}[channels]
    profile = bytes(16) + space + bytes(100)
    monkeypatch.setattr(light, "_transformed", lambda samples, _: transform(samples))
    values = np.zeros((1, 1, channels), np.uint8)
    return light_of(of_array(values, colour, white, profile=profile))


def test_a_profile_whose_white_is_dark_is_not_used_and_told(monkeypatch):
    found = lit(monkeypatch, lambda s: s[..., 0] * 0.4, "grey", channels=1)
    assert "white is not white in it); taken as sRGB" in found.note
    assert np.allclose(found.tables[0], 1 - to_linear(np.arange(256) / 255), atol=1e-4)
    for white in (0.51, 1.99):
        fine = lit(monkeypatch, lambda s, white=white: s[..., 0] * white, "grey", channels=1)
        assert fine.note == light.BY_PROFILE
        assert np.allclose(fine.tables[0], 1 - np.arange(256) / 255, atol=1e-4)


def test_a_profile_that_lcms_refuses_is_told(monkeypatch):
    def refuse(_):
        raise RuntimeError("lcms: no way")

    for colour, channels in (("rgb", 3), ("cmyk", 4), ("grey", 1)):
        found = lit(monkeypatch, refuse, colour, channels=channels)
        assert "cannot be used (lcms: no way); taken as sRGB" in found.note


def test_colours_that_do_not_add_up_are_asked_of_the_profile_pixel_by_pixel(monkeypatch):
    def product(samples):
        return (samples[..., 0] * samples[..., 1] * samples[..., 2]).astype(np.float64)

    found = lit(monkeypatch, product, "rgb")
    assert found.tables == ()
    assert (found.profile[16:20], found.white_light) == (b"RGB ", 1.0)
    sums = lit(monkeypatch, lambda s: s.astype(float) @ [0.5, 0.25, 0.25], "rgb")
    assert [round(float(table[0]), 4) for table in sums.tables] == [0.5, 0.25, 0.25]


@pytest.mark.parametrize("white", [255, 4095, 65535])
def test_a_profile_is_asked_over_the_whole_range_of_samples(monkeypatch, white):
    asked = []

    def half(samples):
        asked.append(samples)
        return samples[..., 0] / np.iinfo(samples.dtype).max / 2

    monkeypatch.setattr(light, "_transformed", lambda samples, _: half(samples))
    samples = np.array([[[0, 0, 0], [white, 0, 0]]], np.uint8 if white < 256 else np.uint16)
    found = Light((), b"profile", 0.5).darkness(samples, white)
    assert found.tolist() == [[1.0, 0.0]]
    assert asked[0].max() == np.iinfo(asked[0].dtype).max


def test_a_profile_without_a_name_has_none(monkeypatch):
    assert light._name(b"junk") == ""
    named = imagecodecs.cms_profile("srgb")
    assert light._name(named)

    def fails(_):
        raise ImageCms.PyCMSError("no")

    monkeypatch.setattr(ImageCms, "getProfileDescription", fails)
    assert light._name(named) == ""


# --- what Pillow has ----------------------------------------------------------------------------


def test_a_transparent_value_of_another_kind_than_the_colours_is_none():
    image = Image.fromarray(np.full((2, 3, 3), 9, np.uint8))
    for value, has_alpha in (((9, 9, 9), True), ((9, 9), False), (9, False), (b"\t\t\t", False)):
        image.info["transparency"] = value
        assert bool(pillow.decode(image).alpha) is has_alpha
    grey = Image.fromarray(np.full((2, 3), 9, np.uint8))
    for value, has_alpha in ((9, True), ((9, 9, 9), False), ("9", False)):
        grey.info["transparency"] = value
        assert bool(pillow.decode(grey).alpha) is has_alpha


def test_a_block_of_exif_that_leads_pillow_astray_leaves_a_picture_upright(monkeypatch):
    image = Image.new("L", (2, 2))

    def fails():
        raise struct.error("unpack requires a buffer")

    monkeypatch.setattr(image, "getexif", fails)
    assert pillow.orientation_of(image) == 1


# --- TIFF ---------------------------------------------------------------------------------------


def written(samples, **options):
    stream = io.BytesIO()
    tifffile.imwrite(stream, samples, **options)
    return stream.getvalue()


def tiff_dark(data):
    return picture_of_bytes(data, "a.tif", "linear").levels.darkness()


def test_a_tiff_of_thumbnails_alone_shows_the_first():
    stream = io.BytesIO()
    with tifffile.TiffWriter(stream) as made:
        for value in (40, 200):
            made.write(np.full((4, 4), value, np.uint8), subfiletype=1, photometric="minisblack")
    assert np.allclose(tiff_dark(stream.getvalue()), 1 - to_linear(40 / 255), atol=1e-4)


def test_a_tiff_is_looked_through_for_its_picture_so_far_and_no_further():
    stream = io.BytesIO()
    with tifffile.TiffWriter(stream) as made:
        for k in range(66):
            kind = {"subfiletype": int(k != 64)}
            made.write(np.full((4, 4), k, np.uint8), photometric="minisblack", **kind)
    assert np.allclose(tiff_dark(stream.getvalue()), 1.0)  # the first: the 65th is too far


def test_a_palette_that_is_lost_is_told(monkeypatch):
    data = written(
        np.zeros((4, 4), np.uint8), photometric="palette",
        colormap=np.zeros((3, 256), np.uint16),
    )  # fmt: skip
    assert np.allclose(tiff_dark(data), 1.0)
    monkeypatch.setattr(tifffile.TiffPage, "colormap", None)
    with pytest.raises(PictureError, match="has lost its palette"):
        tiff_dark(data)


def test_complex_numbers_in_a_page_that_says_otherwise_are_refused(monkeypatch):
    data = written(np.zeros((4, 4), np.float32), photometric="minisblack")
    odd = np.zeros((4, 4), np.complex64)
    monkeypatch.setattr(tifffile.TiffPage, "asarray", lambda *_, **__: odd)
    with pytest.raises(PictureError, match="complex numbers"):
        tiff_dark(data)


def test_lightness_of_an_unusual_depth_is_refused():
    lab = np.zeros((4, 4, 3), np.uint32)
    with pytest.raises(PictureError, match=r"L\*a\*b\* of an unusual depth"):
        tiff_dark(written(lab, photometric="cielab"))


@pytest.mark.parametrize(("kind", "top"), [("icclab", 65280), ("cielab", 65535)])
def test_the_lightest_of_sixteen_bits_is_white_in_both_kinds_of_lab(kind, top):
    lab = np.zeros((1, 3, 3), np.uint16)
    lab[0, :, 0] = (0, top // 2, top)
    dark = tiff_dark(written(lab, photometric=kind))[0]
    assert dark[[0, 2]].tolist() == [1.0, 0.0]
    assert dark[1] == pytest.approx(1 - ((50 + 16) / 116) ** 3, abs=1e-3)


def test_what_a_caller_asks_amiss_is_no_fault_of_the_file(tmp_path):
    path = tmp_path / "one.png"
    Image.new("L", (4, 3)).save(path)
    with pytest.raises(ParameterError, match="tone"):
        read_picture(path, tone="louder", width_mm=9.0)
    with pytest.raises(ParameterError, match="tone"):
        picture_of_bytes(path.read_bytes(), "one.png", "louder")


def test_colours_beyond_the_alpha_they_were_multiplied_by_are_white():
    samples = np.zeros((1, 3, 4), np.uint8)
    samples[0] = [(100, 100, 100, 100), (150, 150, 150, 100), (50, 50, 50, 100)]
    data = written(samples, photometric="rgb", extrasamples=["assocalpha"])
    found = tiff_dark(data)[0]
    assert found[:2].tolist() == [0.0, 0.0]
    assert found[2] == pytest.approx((1 - to_linear(0.5)) * 100 / 255, abs=2e-3)


def test_a_picture_keeps_the_bytes_of_its_file(tmp_path):
    path = tmp_path / "one.png"
    Image.new("L", (4, 3), 90).save(path)
    found = read_picture(path, tone="linear", width_mm=9.0).source
    assert found.data == path.read_bytes()
    assert picture_of_bytes(path.read_bytes(), "one.png", "linear").data == path.read_bytes()
