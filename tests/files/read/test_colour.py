"""Lightness comes from the picture's profile: against ImageMagick's lcms, and by formula."""

import io
import struct
import subprocess
import zlib
from pathlib import Path

import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image, ImageCms

from stippler.files.read.picture import darkness_of_image, read_darkness

SRGB = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
D65, D50 = (0.3127, 0.3290), (0.3457, 0.3585)
PRIMARIES = {
    "srgb": (D65, (0.64, 0.33, 0.30, 0.60, 0.15, 0.06), 2.2),
    "adobe": (D65, (0.64, 0.33, 0.21, 0.71, 0.15, 0.06), 2.19921875),
    "p3": (D65, (0.68, 0.32, 0.265, 0.69, 0.15, 0.06), 2.2),
    "prophoto": (D50, (0.7347, 0.2653, 0.1596, 0.8404, 0.0366, 0.0001), 1.8),
    "linear": (D65, (0.64, 0.33, 0.30, 0.60, 0.15, 0.06), 1.0),
}


def rgb_profile(name):
    white, primaries, gamma = PRIMARIES[name]
    return imagecodecs.cms_profile("rgb", whitepoint=white, primaries=primaries, gamma=gamma)


def grey_profile(gamma):
    return imagecodecs.cms_profile("gray", gamma=gamma)


def to_linear(v):
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def colours(white=255):
    step = np.linspace(0, 1, 6)
    cube = np.stack(np.meshgrid(step, step, step, indexing="ij"), axis=-1).reshape(12, 18, 3)
    return np.rint(cube * white).astype(np.uint8 if white < 256 else np.uint16)


def light_by_magick(path, tmp_path):
    """Return the light of a picture's sRGB by ImageMagick, and where no colour was cut off."""
    (tmp_path / "srgb.icc").write_bytes(SRGB)
    with Image.open(path) as image:
        width, height = image.size
    done = subprocess.run(
        ["convert", path, "-black-point-compensation", "-intent", "Relative", "-profile",
         tmp_path / "srgb.icc", "-depth", "16", "-endian", "LSB", "rgb:-"],
        capture_output=True, check=True,
    )  # fmt: skip
    rgb = np.frombuffer(done.stdout, "<u2").reshape(height, width, 3) / 65535
    within = ((rgb > 0) & (rgb < 1)).all(axis=2)
    return to_linear(rgb) @ [0.2126, 0.7152, 0.0722], within


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
@pytest.mark.parametrize("ending", ["tif", "png"])
@pytest.mark.parametrize("gamma", [1.0, 1.8, 2.2, 2.6])
def test_grey_by_its_curve(tmp_path, gamma, ending, kind):
    white = np.iinfo(kind).max
    grey = np.linspace(0, white, 64).astype(kind).reshape(4, 16)
    path = tmp_path / f"grey.{ending}"
    Image.fromarray(grey).save(path, icc_profile=grey_profile(gamma))
    want = 1 - (grey / white) ** gamma
    np.testing.assert_allclose(read_darkness(path), want, atol=1e-4)
    encoded = (grey / white) ** gamma
    encoded = np.where(encoded <= 0.0031308, 12.92 * encoded, 1.055 * encoded ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(read_darkness(path, "perceptual"), 1 - encoded, atol=5e-4)
    assert read_darkness(path).min() == 0
    assert read_darkness(path).max() == 1


def test_half_the_light_is_half_the_ink_whatever_the_profile(tmp_path):
    """What issue reports measured: 0.78 with a linear profile and 0.71 with ProPhoto's."""
    for gamma in (1.0, 1.8, 2.2):
        value = round(0.5 ** (1 / gamma) * 65535)
        path = tmp_path / "half.png"
        Image.fromarray(np.full((3, 3), value, np.uint16)).save(
            path, icc_profile=grey_profile(gamma)
        )
        np.testing.assert_allclose(read_darkness(path), 0.5, atol=1e-3)


@pytest.mark.parametrize("name", PRIMARIES)
@pytest.mark.parametrize("ending", ["tif", "png", "jpg", "webp"])
def test_colours_by_their_primaries(tmp_path, name, ending):
    path = tmp_path / f"colours.{ending}"
    more = {"jpg": {"quality": 100, "subsampling": 0}, "webp": {"lossless": True}}.get(ending, {})
    Image.fromarray(colours()).save(path, icc_profile=rgb_profile(name), **more)
    ours = read_darkness(path)
    with Image.open(path) as image:
        lab = ImageCms.profileToProfile(
            image.convert("RGB"), ImageCms.ImageCmsProfile(io.BytesIO(rgb_profile(name))),
            ImageCms.createProfile("LAB"), renderingIntent=1, outputMode="LAB",
        )  # fmt: skip
    lightness = np.asarray(lab)[..., 0] / 255 * 100
    f = (lightness + 16) / 116
    light = np.where(f > 6 / 29, f**3, 3 * (6 / 29) ** 2 * (f - 4 / 29))
    # half a step of 8-bit lightness is 0.2 of L*, 0.006 of light; Bradford's shares differ by 0.01
    np.testing.assert_allclose(1 - ours, light, atol=0.016)
    judged, within = light_by_magick(path, tmp_path)
    assert within.sum() > 20
    np.testing.assert_allclose((1 - ours)[within], judged[within], atol=0.012)


@pytest.mark.parametrize("name", ["adobe", "prophoto", "linear"])
def test_sixteen_bits_of_colour(tmp_path, name):
    shallow, deep = tmp_path / "8.tif", tmp_path / "16.tif"
    profile = rgb_profile(name)
    tifffile.imwrite(shallow, colours(), photometric="rgb", iccprofile=profile)
    tifffile.imwrite(deep, colours(65535), photometric="rgb", iccprofile=profile)
    np.testing.assert_allclose(read_darkness(deep), read_darkness(shallow), atol=2e-5)
    floats = tmp_path / "float.tif"
    unit = (colours(65535) / 65535).astype(np.float32)
    tifffile.imwrite(floats, unit, photometric="rgb", iccprofile=profile)
    np.testing.assert_allclose(read_darkness(floats), read_darkness(deep), atol=2e-5)


def test_srgbs_own_profile_changes_nothing(tmp_path):
    for profile in (SRGB, imagecodecs.cms_profile("srgb")):
        Image.fromarray(colours()).save(tmp_path / "with.png", icc_profile=profile)
        Image.fromarray(colours()).save(tmp_path / "without.png")
        notes = []
        np.testing.assert_array_equal(
            read_darkness(tmp_path / "with.png", notes=notes),
            read_darkness(tmp_path / "without.png"),
        )
        assert notes == []


@pytest.mark.parametrize("name", ["adobe", "linear"])
def test_a_profile_that_changes_something_is_told(tmp_path, name):
    Image.fromarray(colours()).save(tmp_path / "with.png", icc_profile=rgb_profile(name))
    notes = []
    read_darkness(tmp_path / "with.png", notes=notes)
    assert len(notes) == 1
    assert notes[0].startswith("read by its colour profile")


def test_a_grey_picture_with_a_profile_of_rgb(tmp_path):
    grey = np.arange(256, dtype=np.uint8).reshape(16, 16)
    Image.fromarray(grey).save(
        tmp_path / "grey.jpg", quality=100, icc_profile=rgb_profile("linear")
    )
    Image.fromarray(grey).save(tmp_path / "flat.jpg", quality=100)
    with Image.open(tmp_path / "flat.jpg") as image:
        np.testing.assert_allclose(
            read_darkness(tmp_path / "grey.jpg"), 1 - np.asarray(image) / 255, atol=1e-4
        )


@pytest.mark.parametrize("profile", [b"junk" * 99, SRGB[:200], b"", rgb_profile("adobe")])
def test_a_profile_that_cannot_be_used_is_told(tmp_path, profile):
    ink = np.zeros((4, 4, 4), np.uint8)
    ink[..., 3] = 64
    path = tmp_path / "ink.tif"
    Image.fromarray(ink, "CMYK").save(path, icc_profile=profile or None)
    notes = []
    dark = read_darkness(path, notes=notes)
    np.testing.assert_allclose(dark, 1 - to_linear(np.float64(191 / 255)), atol=1e-3)
    assert len(notes) == bool(profile)
    if profile:
        assert "taken as sRGB" in notes[0]


CMYK = Path("/usr/share/color/icc/ghostscript/default_cmyk.icc")


@pytest.mark.skipif(not CMYK.exists(), reason="needs a profile of a press")
def test_ink_by_the_profile_of_its_press(tmp_path):
    step = np.linspace(0, 255, 4).astype(np.uint8)
    ink = np.stack(np.meshgrid(step, step, step, step, indexing="ij"), -1).reshape(16, 16, 4)
    path = tmp_path / "ink.tif"
    Image.frombytes("CMYK", (16, 16), np.ascontiguousarray(ink).tobytes()).save(
        path, icc_profile=CMYK.read_bytes()
    )
    ours = read_darkness(path)
    assert ours.reshape(-1)[0] == 0  # bare paper
    judged, within = light_by_magick(path, tmp_path)
    assert within.sum() > 20
    np.testing.assert_allclose((1 - ours)[within], judged[within], atol=0.02)


def chunk(name, body):
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))


@pytest.mark.parametrize(
    ("chunks", "power"),
    [
        ([(b"gAMA", struct.pack(">I", 100_000))], 1.0),
        ([(b"gAMA", struct.pack(">I", 55_556))], 1.8),
        ([(b"gAMA", struct.pack(">I", 45_455))], 0),  # what sRGB writes beside itself
        ([(b"gAMA", struct.pack(">I", 100_000)), (b"sRGB", b"\0")], 0),
        ([(b"gAMA", b"\0\0\0\0")], 0),
    ],
)
@pytest.mark.parametrize("depth", [8, 16])
def test_png_by_its_gamma(tmp_path, chunks, power, depth):
    grey = np.arange(256) / 255
    row = (np.arange(256) * (257 if depth == 16 else 1)).astype(f">u{depth // 8}").tobytes()
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", 256, 1, depth, 0, 0, 0, 0))
    body = [chunk(*one) for one in chunks] + [chunk(b"IDAT", zlib.compress(b"\0" + row))]
    (tmp_path / "grey.png").write_bytes(
        b"\x89PNG\r\n\x1a\n" + head + b"".join(body) + chunk(b"IEND", b"")
    )
    want = 1 - (grey**power if power else to_linear(grey))
    np.testing.assert_allclose(read_darkness(tmp_path / "grey.png")[0], want, atol=1e-4)


def test_a_pillow_image_by_its_profile():
    image = Image.fromarray(np.full((2, 2), 128, np.uint8))
    image.info["icc_profile"] = grey_profile(1.0)
    np.testing.assert_allclose(darkness_of_image(image), 1 - 128 / 255, atol=1e-4)
