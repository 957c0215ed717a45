"""Two readers that no one here wrote, to judge ours by: ImageMagick and libvips."""

import subprocess

import numpy as np
import pytest


def magick(path):
    """Return a picture upright as RGBA in 0..1 by ImageMagick, or None if it cannot."""
    frame = f"{path}[0]"
    size = subprocess.run(
        ["identify", "-quiet", "-format", "%w %h %[orientation]", frame],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if size.returncode or not size.stdout:
        return None
    width, height, turned = size.stdout.split()
    if turned in ("LeftTop", "RightTop", "RightBottom", "LeftBottom"):
        width, height = height, width
    made = subprocess.run(
        ["convert", "-quiet", frame, "-auto-orient", "-colorspace", "sRGB", "-depth", "16",
         "-endian", "LSB", "rgba:-"],
        capture_output=True, check=False,
    )  # fmt: skip
    n = int(width) * int(height) * 4
    if made.returncode or len(made.stdout) != 2 * n:
        return None
    return np.frombuffer(made.stdout, "<u2").reshape(int(height), int(width), 4) / 65535


def vips(path):
    """Return a picture upright as RGBA in 0..1 by libvips, or None if it cannot."""
    import pyvips

    white = {"uchar": 255, "ushort": 65535, "uint": 2**32 - 1, "char": 127, "short": 32767,
             "int": 2**31 - 1, "float": 1.0, "double": 1.0}  # fmt: skip
    try:
        image = pyvips.Image.new_from_file(str(path), fail_on="error").autorot()
        if image.interpretation in ("cmyk", "lab", "labs", "lch"):
            return None  # it answers by a profile of its own
        samples = image.numpy()
    except pyvips.Error:
        return None
    unit = samples.reshape(image.height, image.width, -1) / white[image.format]
    n = 3 if image.interpretation in ("srgb", "rgb", "rgb16", "scrgb") else 1
    alpha = unit[..., n : n + 1] if unit.shape[2] > n else np.ones_like(unit[..., :1])
    colours = np.repeat(unit[..., :n], 3 // n, axis=2)
    return np.concatenate([colours, alpha], axis=2)


@pytest.fixture(scope="session")
def judges():
    return {"ImageMagick": magick, "libvips": vips}
