"""Programs that no one here wrote, each reading an exported file into the ink of its pixels."""

import io
import subprocess

import numpy as np
import resvg_py
from PIL import Image

Image.MAX_IMAGE_PIXELS = None
PAPER = "optimize_speed"  # a pixel as large as the page: smoothed, it takes longer than all dots
FINER = 4  # consumers draw so much finer, and are averaged: their edges are coarser than ours


def ink(image: Image.Image) -> np.ndarray:
    """Return the ink on white paper, 0 to 1."""
    if image.mode in ("RGBA", "LA"):
        paper = Image.new("RGBA", image.size, "white")
        image = Image.alpha_composite(paper, image.convert("RGBA"))
    return 1 - np.asarray(image.convert("L"), np.float32) / 255


def averaged(image: np.ndarray, by: int) -> np.ndarray:
    h, w = (side // by for side in image.shape)
    return image[: h * by, : w * by].reshape(h, by, w, by).mean(axis=(1, 3))


def resvg(path, dpi, by=FINER):
    found = resvg_py.svg_to_bytes(svg_path=str(path), dpi=round(dpi * by), image_rendering=PAPER)
    with Image.open(io.BytesIO(bytes(found))) as image:
        return averaged(ink(image), by)


def poppler(path, dpi, by=FINER):
    out = path.with_suffix("")
    command = ["pdftoppm", "-r", f"{dpi * by:g}", "-gray", "-singlefile", str(path), str(out)]
    subprocess.run(command, check=True, timeout=300)
    with Image.open(out.with_suffix(".pgm")) as image:
        return averaged(ink(image), by)


def ghostscript(path, dpi, by=FINER):
    """PostScript paints every pixel that is touched; a screen, those whose middle is."""
    out = path.with_suffix(".gs.png")
    subprocess.run(
        ["gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dDELAYBIND", "-dEPSCrop",
         "-sDEVICE=pnggray", f"-r{dpi * by:g}", f"-sOutputFile={out}",
         "-c", "0 0 .setfilladjust2", "-f", str(path)],
        check=True, timeout=300,
    )  # fmt: skip
    with Image.open(out) as image:
        return averaged(ink(image), by)


def pillow(path, dpi, by=1):
    with Image.open(path) as image:
        assert tuple(map(round, image.info["dpi"])) == (round(dpi * by), round(dpi * by))
        return averaged(ink(image), by)
