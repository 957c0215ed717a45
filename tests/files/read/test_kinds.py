"""What is no picture of ours is told what it is, and what to do."""

import gzip

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.errors import PictureError
from stippler.files.read.kinds import kind_of, told_of
from stippler.files.read.picture import check_picture, read_darkness

SVG = b'<svg xmlns="http://www.w3.org/2000/svg"><circle r="1"/></svg>'
FILES = {
    "svg": (SVG, "is an SVG drawing", "export it as PNG"),
    "svg with a head": (b'<?xml version="1.0"?>\n<!-- made -->\n' + SVG, "is an SVG", "PNG"),
    "svgz": (gzip.compress(SVG), "compressed", "unpack"),
    "our table": (b"x_mm,y_mm,radius_mm\n1,2,3\n", "table of numbers", "stippler stats"),
    "a table": (b"1,2\n3,4\n5,6\n7,8\n", "table of numbers", "stippler stats"),
    "a table of Excel": ("x_mm;y_mm\n1,5;2\n".encode("utf-16"), "table", "stippler stats"),
    "pdf": (b"%PDF-1.7\n%\xe2\xe3", "is a PDF", "export its page"),
    "eps": (b"%!PS-Adobe-3.0 EPSF-3.0\n", "PostScript", "PNG"),
    "psd": (b"8BPS\0\1" + bytes(20), "Photoshop", "export it"),
    "xcf": (b"gimp xcf v011\0", "GIMP", "export it"),
    "exr": (b"\x76\x2f\x31\x01" + bytes(9), "OpenEXR", "export it"),
    "jxl": (b"\xff\x0a" + bytes(30), "JPEG XL", "export it"),
    "dicom": (bytes(128) + b"DICM", "DICOM", "export it"),
    "canon raw": (b"II*\0\x10\0\0\0CR\x02\0", "camera's raw", "develop it"),
    "canon raw 3": (b"\0\0\0\x18ftypcrx \0\0\0\1crx isom", "camera's raw", "develop it"),
    "fuji raw": (b"FUJIFILMCCD-RAW 0201", "camera's raw", "develop it"),
    "olympus raw": (b"IIRO\x08\0\0\0", "camera's raw", "develop it"),
    "film": (b"\0\0\0\x18ftypmp42\0\0\0\0mp42isom", "film", "frames"),
    "zip": (b"PK\x03\x04" + bytes(30), "archive", "take the picture out"),
    "text": (b"hello, I am no picture\n", "is no picture we read", "give a PNG"),
    "elf": (b"\x7fELF" + bytes(60), "is no picture we read", "give a PNG"),
}


@pytest.mark.parametrize("name", FILES)
def test_files_of_other_kinds(tmp_path, name):
    content, what, do = FILES[name]
    path = tmp_path / "photo.png"
    path.write_bytes(content)
    for read in (check_picture, read_darkness):
        with pytest.raises(PictureError) as told:
            read(path)
        assert what in told.value.what
        assert do in told.value.do
        assert "\n" not in str(told.value)


@pytest.mark.parametrize("brand", [b"heic", b"heix", b"mif1", b"avif"])
def test_pictures_among_films(brand):
    head = b"\0\0\0\x1cftyp" + brand + b"\0\0\0\0mif1" + brand + b"miaf"
    assert told_of(head) is None
    assert kind_of(head) == ("" if brand == b"avif" else "heic")


@given(st.binary(max_size=300))
def test_no_bytes_crash_it(head):
    assert kind_of(head) in ("tiff", "png", "jpeg", "heic", "")
