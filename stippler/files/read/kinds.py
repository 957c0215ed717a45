"""What a file is, by its first bytes, and what to say of what is no picture."""

from __future__ import annotations

import re

FORMATS_TEXT = "PNG, JPEG, TIFF, WebP, BMP, GIF, JPEG 2000, HEIC or AVIF"
HEAD_BYTES = 4096

_HEIC = {b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1"}
_AVIF = {b"avif", b"avis"}
_RAW = "is a camera's raw file"
_DEVELOP = "develop it in your raw converter, and save that as a 16-bit TIFF or a JPEG"
_EXPORT = f"export it from its program as {FORMATS_TEXT}"
_NO_PICTURES: tuple[tuple[bytes, int, str, str], ...] = (
    (
        b"%PDF",
        0,
        "is a PDF, not a picture",
        "export its page as PNG",
    ),
    (b"%!PS", 0, "is PostScript, not a picture", "export it as PNG"),
    (b"\xc5\xd0\xd3\xc6", 0, "is PostScript, not a picture", "export it as PNG"),
    (b"8BPS", 0, "is a Photoshop file", _EXPORT),
    (b"gimp xcf", 0, "is a GIMP file", _EXPORT),
    (b"\x76\x2f\x31\x01", 0, "is an OpenEXR picture, whose light has no upper end", _EXPORT),
    (b"#?RADIANCE", 0, "is a Radiance picture, whose light has no upper end", _EXPORT),
    (b"\xff\x0a", 0, "is a JPEG XL picture, which is not read yet", _EXPORT),
    (b"JXL ", 4, "is a JPEG XL picture, which is not read yet", _EXPORT),
    (b"DICM", 128, "is a medical (DICOM) file", _EXPORT),
    (b"SIMPLE  =", 0, "is an astronomical (FITS) file", _EXPORT),
    (b"FUJIFILMCCD-RAW", 0, _RAW, _DEVELOP),
    (b"ftypcrx", 4, _RAW, _DEVELOP),
    (b"CR\x02", 8, _RAW, _DEVELOP),
    (b"IIRO", 0, _RAW, _DEVELOP),
    (b"IIRS", 0, _RAW, _DEVELOP),
    (b"IIU\0", 0, _RAW, _DEVELOP),
    (b"FOVb", 0, _RAW, _DEVELOP),
    (b"PK\x03\x04", 0, "is an archive, not a picture", "take the picture out of it"),
    (b"ftyp", 4, "is a film, not a picture", "save one of its frames as a picture"),
)
_SVG = re.compile(rb"<svg[\s>]", re.IGNORECASE)
_NUMBERS = re.compile(r"[-+\d.eE]+(?:[,;\t][ ]*[-+\d.,eE]+)+")
RAW = (_RAW, _DEVELOP)


def kind_of(head: bytes) -> str:
    """Return what reads a file that begins so: tiff, png, jpeg, heic, or nothing for any other."""
    if told_of(head):
        return ""
    if head[:4] in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"):
        return "tiff"
    if head[:8] == b"\x89PNG\r\n\x1a\n":
        return "png"
    if head[:3] == b"\xff\xd8\xff":
        return "jpeg"
    brands = _brands(head)
    return "heic" if brands & _HEIC and not brands & _AVIF else ""


def told_of(head: bytes) -> tuple[str, str] | None:
    """Return what to say of a file that is known to be no picture of ours, and what to do."""
    if _brands(head) & (_HEIC | _AVIF):
        return None
    for mark, place, what, do in _NO_PICTURES:
        if head[place : place + len(mark)] == mark:
            return what, do
    if _SVG.search(head):
        return "is an SVG drawing, not a picture", "export it as PNG, as large as it is to be drawn"
    if head[:2] == b"\x1f\x8b":
        return "is a compressed file, not a picture", "unpack it; export an SVG as PNG"
    if is_table(head):
        return (
            "is a table of numbers, not a picture",
            "name it .csv, and stippler render and stippler stats take it for dots",
        )
    return None


def is_table(head: bytes) -> bool:
    """Return whether a file begins as a table of dots does: names or numbers by commas."""
    if b"\0" in head and head[:2] not in (b"\xff\xfe", b"\xfe\xff"):
        return False
    text = head.decode("utf-16" if head[:2] in (b"\xff\xfe", b"\xfe\xff") else "latin-1", "ignore")
    lines = [line.strip().replace('"', "") for line in text.split("\n")[:12]]
    if any(line.lower().lstrip("ï»¿\ufeff").startswith("x_mm") for line in lines):
        return True
    rows = [line for line in lines[1:-1] if line]
    return len(rows) > 1 and all(_NUMBERS.fullmatch(row) for row in rows)


def _brands(head: bytes) -> set[bytes]:
    """Return the brands of an ISO media file."""
    if head[4:8] != b"ftyp":
        return set()
    end = min(int.from_bytes(head[:4], "big"), len(head))
    return {head[8:12], *(head[k : k + 4] for k in range(16, end - 3, 4))}
