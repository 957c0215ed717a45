"""PNG, BMP, JPEG and the rest in all their forms; TIFF compressed, paged and by palette."""

import io
import struct
import subprocess
import zlib

import imagecodecs
import numpy as np
import pillow_heif
import pytest
import tifffile
from PIL import Image

from stippler.errors import PictureError
from stippler.files.read.picture import check_picture, read_darkness, size_of_picture

H, W = 24, 32


def to_linear(v):
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def darkness(rgba):
    return (1 - to_linear(np.clip(rgba[..., :3], 0, 1)) @ [0.2126, 0.7152, 0.0722]) * rgba[..., 3]


def smooth(channels, white=255):
    """A smooth picture without symmetry, as integers."""
    y, x = np.mgrid[0 : 1 : H * 1j, 0 : 1 : W * 1j]
    planes = [x, 0.2 + 0.6 * y, 0.5 + 0.5 * x * y, np.clip(1.3 - x, 0, 1)]
    if channels == 2:
        planes = [planes[0], planes[3]]
    return np.rint(np.stack(planes[:channels], axis=2) * white).astype(
        np.uint8 if white < 256 else np.uint16
    )


def rgba_of(samples, white):
    unit = samples / white
    n = 1 if unit.shape[2] < 3 else 3
    alpha = unit[..., n:] if unit.shape[2] > n else np.ones_like(unit[..., :1])
    return np.concatenate([np.repeat(unit[..., :n], 3 // n, axis=2), alpha], axis=2)


def agrees(path, judges, want=None, atol=1e-3, only=None):
    """Compare ours with what was written, and with every judge that reads the file."""
    ours = read_darkness(path)
    assert size_of_picture(path) == (ours.shape[1], ours.shape[0])
    if want is not None:
        np.testing.assert_allclose(ours, want, atol=atol)
    n = 0
    for name in only or judges:
        seen = judges[name](path)
        if seen is not None:
            n += 1
            np.testing.assert_allclose(ours, darkness(seen), atol=atol, err_msg=name)
    return n


# --- PNG ----------------------------------------------------------------------------------------


def chunk(name, body):
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))


def png(rows, size, depth, kind, *extra, after=()):
    width, height = size
    head = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + row for row in rows))
    return b"".join(
        [b"\x89PNG\r\n\x1a\n", chunk(b"IHDR", head), *extra, chunk(b"IDAT", data), *after,
         chunk(b"IEND", b"")]
    )  # fmt: skip


def bits_of(row, depth):
    text = "".join(format(int(v), f"0{depth}b") for v in row)
    text += "0" * (-len(text) % 8)
    return bytes(int(text[k : k + 8], 2) for k in range(0, len(text), 8))


CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
DEPTHS = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}
PNGS = [
    (kind, depth, transparent)
    for kind, depths in DEPTHS.items()
    for depth in depths
    for transparent in ((False, True) if kind in (0, 2, 3) else (False,))
]  # fmt: skip


def png_case(kind, depth, transparent):
    """Return a file and the RGBA that it means."""
    white = 2**depth - 1
    if kind == 3:
        index = np.add.outer(np.arange(H), 3 * np.arange(W)) % 2**depth
        colours = np.random.default_rng(depth).integers(0, 256, (2**depth, 3), np.uint8)
        alphas = np.random.default_rng(1).integers(0, 256, 2**depth - 1, np.uint8)
        extra = [chunk(b"PLTE", colours.tobytes())]
        table = np.concatenate([colours, np.full((2**depth, 1), 255, np.uint8)], axis=1)
        if transparent:
            extra.append(chunk(b"tRNS", alphas.tobytes()))
            table[:-1, 3] = alphas
        return png([bits_of(r, depth) for r in index], (W, H), depth, 3, *extra), table[index] / 255
    samples = smooth(CHANNELS[kind], max(white, 255))
    samples = np.rint(samples * (white / max(white, 255))).astype(int)
    rgba, extra = rgba_of(samples, white), []
    if transparent:
        value = samples[5, 7]
        extra.append(chunk(b"tRNS", struct.pack(f">{len(value)}H", *value)))
        rgba[(samples == value).all(axis=2), 3] = 0
    rows = [bits_of(r.reshape(-1), depth) for r in samples]
    return png(rows, (W, H), depth, kind, *extra), rgba


INTERLACED = [(k, d, t, True) for k, d, t in PNGS if not t and k != 3]  # as convert keeps them


@pytest.mark.parametrize(
    ("kind", "depth", "transparent", "interlaced"), [(*p, False) for p in PNGS] + INTERLACED
)
def test_png(tmp_path, judges, kind, depth, transparent, interlaced):
    data, rgba = png_case(kind, depth, transparent)
    path = tmp_path / "picture.png"
    path.write_bytes(data)
    if interlaced:
        made = ["convert", path, "-interlace", "PNG", f"png{8 * CHANNELS[kind]}:{path}"]
        if kind in (0, 4) or depth == 16:
            made[-1] = path
        subprocess.run(made, check=True)
    assert agrees(path, judges, darkness(rgba)) == 2


DAMAGE = {
    "a chunk nobody knows": [chunk(b"juNk", b"?" * 50)],
    "text of megabytes": [chunk(b"tEXt", b"Comment\0" + b"x" * 5_000_000)],
    "packed text of megabytes": [chunk(b"zTXt", b"Comment\0\0" + zlib.compress(b"x" * 80_000_000))],
    "XMP of megabytes": [chunk(b"iTXt", b"XML:com.adobe.xmp\0\0\0\0\0" + b"<x/>" * 2_000_000)],
    "many texts": [chunk(b"zTXt", b"Comment\0\0" + zlib.compress(b"x" * 900_000))] * 90,
    "a wrong checksum": [chunk(b"tEXt", b"Comment\0x")[:-4] + b"abcd"],
    "a broken profile": [chunk(b"iCCP", b"name\0\0" + b"not deflated")],
    "a profile that is none": [chunk(b"iCCP", b"name\0\0" + zlib.compress(b"profile" * 100))],
    "a broken EXIF": [chunk(b"eXIf", b"MM\0*\0\0\xff\xff")],
    "a gamma of nothing": [chunk(b"gAMA", b"\0\0\0\0")],
    "a short gamma": [chunk(b"gAMA", b"\0")],
    "a palette for grey's background": [chunk(b"bKGD", b"\0")],
}


@pytest.mark.parametrize("depth", [8, 16])
@pytest.mark.parametrize("name", DAMAGE)
def test_png_with_harmless_damage(tmp_path, name, depth):
    path = tmp_path / "picture.png"
    grey = np.arange(0, 256, 8) / 255
    values = np.arange(0, 256, 8) * (257 if depth == 16 else 1)
    rows = [values.astype(f">u{depth // 8}").tobytes()]
    path.write_bytes(png(4 * rows, (32, 4), depth, 0, *DAMAGE[name]))
    check_picture(path)
    np.testing.assert_allclose(read_darkness(path)[0], 1 - to_linear(grey), atol=1e-4)


@pytest.mark.parametrize("keep", [0.3, 0.6, 0.9])
@pytest.mark.parametrize("depth", [8, 16])
def test_png_that_is_cut_off(tmp_path, keep, depth):
    noise = np.random.default_rng(0).integers(0, 256, (40, 80 * depth // 8), np.uint8)
    data = png([r.tobytes() for r in noise], (80, 40), depth, 0)
    (tmp_path / "cut.png").write_bytes(data[: int(keep * len(data))])
    with pytest.raises(PictureError, match="damaged or cut off"):
        read_darkness(tmp_path / "cut.png")


# --- BMP ----------------------------------------------------------------------------------------

BMPS = {
    "24": ["BMP3:"], "os2": ["BMP2:"], "32": ["BMP3:", "-alpha", "off"], "alpha": ["BMP:"],
    "1": ["BMP3:", "-monochrome"], "8": ["BMP3:", "-colors", "200", "-type", "Palette"],
    "rle": ["BMP3:", "-colors", "16", "-type", "Palette", "-compress", "RLE"],
    "grey": ["BMP3:", "-colorspace", "gray"],
    "555": ["BMP:", "-define", "bmp:subtype=RGB555"],
    "565": ["BMP:", "-define", "bmp:subtype=RGB565"],
}  # fmt: skip


@pytest.mark.parametrize("name", BMPS)
def test_bmp(tmp_path, judges, name):
    form, *options = BMPS[name]
    Image.fromarray(smooth(4 if name == "alpha" else 3)).save(tmp_path / "scene.png")
    path = tmp_path / "picture.bmp"
    subprocess.run(["convert", tmp_path / "scene.png", *options, f"{form}{path}"], check=True)
    assert agrees(path, judges, atol=1e-2 if name in ("555", "565") else 1e-3) >= 1


@pytest.mark.parametrize("masks", [(0xF800, 0x7E0, 0x1F), (0x7C00, 0x3E0, 0x1F)])
@pytest.mark.parametrize("top_down", [False, True])
def test_bmp_of_16_bits(tmp_path, judges, masks, top_down):
    samples = smooth(3)
    word = np.zeros((H, W), np.uint16)
    for k, mask in enumerate(masks):
        low = (mask & -mask).bit_length() - 1
        word |= (np.rint(samples[..., k] / 255 * (mask >> low)).astype(np.uint16) << low) & mask
    rows = word if top_down else word[::-1]
    body = rows.astype("<u2").tobytes()
    height = -H if top_down else H
    head = struct.pack("<IiiHHIIiiII", 40, W, height, 1, 16, 3, len(body), 0, 0, 0, 0)
    head += struct.pack("<III", *masks)
    start = 14 + len(head)
    path = tmp_path / "picture.bmp"
    path.write_bytes(b"BM" + struct.pack("<IHHI", start + len(body), 0, 0, start) + head + body)
    assert agrees(path, judges, atol=1.2e-2) >= 1


# --- JPEG ---------------------------------------------------------------------------------------

JPEGS = {
    "grey": (1, {}), "444": (3, {"subsampling": 0}), "422": (3, {"subsampling": 1}),
    "420": (3, {"subsampling": 2}), "progressive": (3, {"progressive": True}),
    "rgb": (3, {"keep_rgb": True}), "cmyk": (4, {}),
}  # fmt: skip


@pytest.mark.parametrize("name", JPEGS)
def test_jpeg(tmp_path, judges, name):
    channels, options = JPEGS[name]
    samples = smooth(channels)
    mode = {1: "L", 3: "RGB", 4: "CMYK"}[channels]
    image = Image.frombytes(mode, (W, H), samples.tobytes())
    path = tmp_path / "picture.jpg"
    image.save(path, quality=98, **options)
    want = None if channels == 4 else darkness(rgba_of(samples, 255))
    only = ["ImageMagick"] if channels == 4 else None  # libvips answers CMYK by its own profile
    assert agrees(path, judges, want, atol=4e-2, only=only) >= 1


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("ending", ["jpg", "webp", "tif", "png", "avif"])
def test_turned(tmp_path, judges, ending, orientation):
    exif = Image.Exif()
    exif[0x0112] = orientation
    path = tmp_path / f"picture.{ending}"
    Image.fromarray(smooth(3)).save(path, quality=98, exif=exif)
    only = ["libvips"] if ending != "tif" else None
    assert agrees(path, judges, atol=4e-2, only=only) >= 1


def test_jpeg_of_12_bits(tmp_path):
    samples = smooth(1, 4095)[..., 0]
    path = tmp_path / "deep.jpg"
    path.write_bytes(imagecodecs.jpeg_encode(samples, level=99, bitspersample=12))
    check_picture(path)
    np.testing.assert_allclose(read_darkness(path), 1 - to_linear(samples / 4095), atol=5e-3)


@pytest.mark.parametrize("bits", [8, 12, 16])
def test_jpeg_without_loss(tmp_path, bits):
    samples = smooth(1, 2**bits - 1)[..., 0]
    path = tmp_path / "lossless.jpg"
    path.write_bytes(imagecodecs.ljpeg_encode(samples, bitspersample=bits))
    np.testing.assert_allclose(
        read_darkness(path), 1 - to_linear(samples / (2**bits - 1)), atol=1e-4
    )


def test_jpeg_with_harmless_damage(tmp_path):
    stream = io.BytesIO()
    Image.fromarray(smooth(3)).save(stream, "JPEG", quality=95)
    data = stream.getvalue()
    whole = tmp_path / "whole.jpg"
    whole.write_bytes(data)
    path = tmp_path / "odd.jpg"
    for body in (
        b"Exif\0\0garbage",
        b"Exif\0\0MM\0*\0\0\xff\xff",
        b"ICC_PROFILE\0\1\1" + b"no" * 99,
        b"http://ns.adobe.com/xap/1.0/\0" + b"<" * 60_000,
    ):
        marker = b"\xff\xe2" if body.startswith(b"ICC") else b"\xff\xe1"
        path.write_bytes(data[:2] + marker + struct.pack(">H", len(body) + 2) + body + data[2:])
        np.testing.assert_array_equal(read_darkness(path), read_darkness(whole))
        assert size_of_picture(path) == (W, H)


# --- what telephones take, and the rest ---------------------------------------------------------


def saved(path, samples, name):
    image = Image.fromarray(samples)
    if name == "heic":
        pillow_heif.from_pillow(image).save(path, quality=-1)
    elif name == "jp2":
        image.save(path, irreversible=False)
    else:
        image.save(path, quality=98, **({"lossless": True} if name == "webp" else {}))


@pytest.mark.parametrize("channels", [3, 4])
@pytest.mark.parametrize("name", ["heic", "avif", "jp2", "webp"])
def test_other_kinds(tmp_path, judges, name, channels):
    path = tmp_path / f"picture.{name}"
    saved(path, smooth(channels), name)
    atol = 4e-2 if name in ("heic", "avif") else 2e-3
    # ImageMagick leaves the transparency of HEIC and AVIF out
    only = ["libvips"] if channels == 4 and name in ("heic", "avif") else None
    agrees(path, judges, darkness(rgba_of(smooth(channels), 255)), atol=atol, only=only)


def test_heic_of_10_bits_and_turned(tmp_path):
    samples = smooth(3, 65535)
    heif = pillow_heif.from_bytes(mode="RGB;16", size=(W, H), data=samples.tobytes())
    heif.save(tmp_path / "deep.heic", quality=-1)
    want = darkness(rgba_of(samples, 65535))
    np.testing.assert_allclose(read_darkness(tmp_path / "deep.heic"), want, atol=2e-2)
    exif = Image.Exif()
    exif[0x0112] = 6
    image = pillow_heif.from_pillow(Image.fromarray(smooth(3)))
    image.save(tmp_path / "turned.heic", quality=-1, exif=exif.tobytes())
    assert (
        size_of_picture(tmp_path / "turned.heic")
        == read_darkness(tmp_path / "turned.heic").shape[::-1]
    )


@pytest.mark.parametrize("bits", [8, 16])
def test_jpeg_2000_of_grey(tmp_path, bits):
    white = 2**bits - 1
    samples = smooth(1, white)[..., 0]
    Image.fromarray(samples).save(tmp_path / "grey.jp2", irreversible=False)
    np.testing.assert_allclose(
        read_darkness(tmp_path / "grey.jp2"), 1 - to_linear(samples / white), atol=1e-4
    )


# --- TIFF: compressions, pages, palettes ---------------------------------------------------------

COMPRESSIONS = [
    (name, kind, predictor)
    for name in ("none", "lzw", "zlib", "packbits", "zstd", "lzma")
    for kind in ("uint8", "uint16", "float32", "rgb8", "rgb16", "rgba16")
    for predictor in ((False, True) if name in ("lzw", "zlib", "zstd") else (False,))
]


@pytest.mark.parametrize(("name", "kind", "predictor"), COMPRESSIONS)
@pytest.mark.parametrize("tile", [None, (16, 16)])
def test_tiff_compressions(tmp_path, judges, name, kind, predictor, tile):
    channels = 4 if "rgba" in kind else 3 if "rgb" in kind else 1
    white = 65535 if "16" in kind else 255
    samples = smooth(channels, white)
    data = (samples / white).astype(np.float32) if kind == "float32" else samples
    path = tmp_path / "picture.tif"
    tifffile.imwrite(
        path, data.squeeze(), compression=None if name == "none" else name,
        predictor=predictor, tile=tile, photometric="rgb" if channels > 1 else "minisblack",
        extrasamples=["unassalpha"] if channels == 4 else None,
    )  # fmt: skip
    rare = name in ("zstd", "lzma")  # libvips' wheel was built without them, and reads zeros
    only = ["ImageMagick"] if rare else None
    assert agrees(path, judges, darkness(rgba_of(samples, white)), only=only) >= 1 or rare


@pytest.mark.parametrize("how", ["group3", "group4", "tiff_ccitt", "tiff_lzw", "packbits", "jpeg"])
def test_tiff_by_pillow(tmp_path, judges, how):
    picture = Image.fromarray(smooth(3))
    if how in ("group3", "group4", "tiff_ccitt"):
        picture = picture.convert("1")
    picture.save(tmp_path / "picture.tif", compression=how)
    assert agrees(tmp_path / "picture.tif", judges, atol=2e-2 if how == "jpeg" else 1e-3) == 2


@pytest.mark.parametrize("options", [
    ["-compress", "Group4", "-monochrome"], ["-compress", "Fax", "-monochrome"],
    ["-type", "Palette", "-colors", "16"], ["-type", "Palette", "-colors", "200"],
    ["-compress", "JPEG", "-quality", "98"], ["-compress", "Zip", "-depth", "16"],
    ["-interlace", "Plane"], ["-endian", "MSB", "-depth", "16"],
], ids=" ".join)  # fmt: skip
def test_tiff_by_imagemagick(tmp_path, judges, options):
    Image.fromarray(smooth(3)).save(tmp_path / "scene.png")
    path = tmp_path / "picture.tif"
    subprocess.run(["convert", tmp_path / "scene.png", *options, path], check=True)
    # libvips cuts palettes to 8 bits
    atol = 2e-2 if "JPEG" in options else 5e-3 if "Palette" in options else 1e-3
    assert agrees(path, judges, atol=atol) >= 1


@pytest.mark.parametrize("bits", [8, 16])
def test_tiff_of_lab(tmp_path, bits):
    y = smooth(1, 65535)[..., 0] / 65535
    white = 2**bits - 1
    lab = np.stack([np.rint(y * white), 0 * y, 0 * y], axis=2).astype(f"u{bits // 8}")
    path = tmp_path / "lab.tif"
    tifffile.imwrite(path, lab, photometric="cielab", compression="zlib")
    lightness = lab[..., 0] / white * 100
    f = (lightness + 16) / 116
    light = np.where(f > 6 / 29, f**3, 3 * (6 / 29) ** 2 * (f - 4 / 29))
    np.testing.assert_allclose(read_darkness(path), 1 - light, atol=1e-4)


@pytest.mark.parametrize("where", ["before", "after", "below", "mask"])
def test_the_full_page_is_drawn_and_not_its_thumbnail(tmp_path, where):
    full, small = smooth(1)[..., 0], smooth(1)[::4, ::4, 0]
    path = tmp_path / "paged.tif"
    with tifffile.TiffWriter(path) as tiff:
        if where == "before":
            tiff.write(small, subfiletype=1)
        elif where == "mask":
            tiff.write(small > 99, subfiletype=4)
        if where == "below":
            tiff.write(small, subfiletype=1, subifds=1)
            tiff.write(full, subfiletype=0)
        else:
            tiff.write(full)
        if where == "after":
            tiff.write(small, subfiletype=1)
    np.testing.assert_allclose(read_darkness(path), 1 - to_linear(full / 255), atol=1e-4)
    assert size_of_picture(path) == (W, H)


@pytest.mark.parametrize(("depth", "tags"), [(12, True), (12, False), (10, False), (14, True)])
def test_few_bits_in_sixteen(tmp_path, depth, tags):
    samples = smooth(1, 2**depth - 1)[..., 0].astype(np.uint16)
    path = tmp_path / "microscope.tif"
    extra = [(281, "H", 1, 2**depth - 1, True)] if tags else []
    tifffile.imwrite(path, samples, extratags=extra, photometric="minisblack")
    notes = []
    want = 1 - to_linear(samples / (2**depth - 1))
    np.testing.assert_allclose(read_darkness(path, notes=notes), want, atol=1e-4)
    assert tags or f"{depth} of its 16 bits" in notes[0]


REFUSED = {
    "complex": (np.ones((4, 4), np.complex64), {}, "complex numbers"),
    "negative": (np.full((4, 4), -3, np.int16), {}, "below 0"),
    "a float of 812": (np.full((4, 4), 812, np.float32), {}, "from 812 to 812"),
    "no number": (np.full((4, 4), np.nan, np.float32), {}, "NaN"),
    "a raw": (np.ones((4, 4), np.uint16), {"photometric": 32803}, "camera's raw"),
    "a mask": (np.ones((4, 4), np.uint8), {"photometric": 4}, "mask"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_tiff_refused_with_the_true_reason(tmp_path, name):
    samples, options, says = REFUSED[name]
    path = tmp_path / "odd.tif"
    tifffile.imwrite(path, samples, **options)
    with pytest.raises(PictureError, match=says) as told:
        read_darkness(path)
    assert str(path) in str(told.value)
    assert told.value.do


def test_tiff_with_a_broken_tag(tmp_path):
    path = tmp_path / "broken.tif"
    Image.fromarray(smooth(3)).save(path)
    data = bytearray(path.read_bytes())
    at = struct.unpack_from("<I", data, 4)[0]
    n = struct.unpack_from("<H", data, at)[0]
    want = read_darkness(path)
    for k in range(n):  # the resolution's address leads nowhere
        code = struct.unpack_from("<H", data, at + 2 + 12 * k)[0]
        if code in (282, 283, 305, 296):
            struct.pack_into("<HI", data, at + 4 + 12 * k, 5, 4_000_000)
            struct.pack_into("<I", data, at + 10 + 12 * k, 0x7FFFFFFF)
    path.write_bytes(data)
    np.testing.assert_array_equal(read_darkness(path), want)


@pytest.mark.parametrize("keep", [0.2, 0.5, 0.9])
def test_tiff_that_is_cut_off(tmp_path, keep):
    path = tmp_path / "cut.tif"
    noise = np.random.default_rng(0).integers(0, 256, (99, 80), np.uint8)
    tifffile.imwrite(path, noise, compression="zlib", rowsperstrip=8)
    data = path.read_bytes()
    path.write_bytes(data[: int(keep * len(data))])
    with pytest.raises(PictureError, match="damaged or cut off"):
        read_darkness(path)
