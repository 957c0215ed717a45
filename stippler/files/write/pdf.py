"""PDF 1.5: one page of exact size, black as DeviceGray, a layer for each area, no fonts needed.

Round dots are lines of no length with round ends, grouped by width: a tenth of the bytes that
circles of Bezier curves take.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator

from stippler.files.write.format import Values
from stippler.files.write.names import one_line
from stippler.files.write.painting import PDF_WORDS, PLACES, painted
from stippler.files.write.sheet import Layer, Sheet, smallest_mm
from stippler.units import MM_PER_INCH

_PT = 72 / MM_PER_INCH
_CATALOG, _PAGES, _PAGE, _CONTENT, _LENGTH, _FIRST_LAYER = 1, 2, 3, 4, 5, 6


def chunks(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield a sheet as PDF, piece by piece; the same sheet gives the same bytes."""
    layers = [layer for layer in sheet.layers if not layer.is_empty]
    file = _File()
    yield file.put(b"%PDF-1.5\n%\xe2\xe3\xcf\xd3\n")
    yield from _structure(file, sheet, layers)
    head = f"<< /Length {_LENGTH} 0 R /Filter /FlateDecode >>\nstream\n".encode()
    yield file.begin(_CONTENT) + file.put(head)
    deflate, n_packed = zlib.compressobj(4), 0
    for part in _content(sheet, layers):
        if packed := deflate.compress(part):
            n_packed += len(packed)
            yield file.put(packed)
    packed = deflate.flush()
    n_packed += len(packed)
    yield file.put(packed + b"\nendstream\nendobj\n")
    yield file.object(_LENGTH, str(n_packed).encode())
    yield file.end()


class _File:
    """Where each object begins."""

    def __init__(self) -> None:
        self._at = 0
        self._starts: dict[int, int] = {}

    def put(self, data: bytes) -> bytes:
        self._at += len(data)
        return data

    def begin(self, index: int) -> bytes:
        self._starts[index] = self._at
        return self.put(f"{index} 0 obj\n".encode())

    def object(self, index: int, value: bytes) -> bytes:
        return self.begin(index) + self.put(value + b"\nendobj\n")

    def end(self) -> bytes:
        n = len(self._starts) + 1
        rows = b"".join(b"%010d 00000 n \n" % self._starts[k] for k in range(1, n))
        trailer = f"trailer\n<< /Size {n} /Root {_CATALOG} 0 R >>\nstartxref\n{self._at}\n%%EOF\n"
        return f"xref\n0 {n}\n".encode() + b"0000000000 65535 f \n" + rows + trailer.encode()


def _structure(file: _File, sheet: Sheet, layers: list[Layer]) -> Iterator[bytes]:
    groups = [f"{_FIRST_LAYER + k} 0 R" for k in range(len(layers))]
    listed = " ".join(groups)
    properties = f" /OCProperties << /OCGs [{listed}] /D << /Order [{listed}] >> >>"
    pages = f"<< /Type /Pages /Kids [{_PAGE} 0 R] /Count 1 >>"
    box = f"[0 0 {sheet.width_mm * _PT:.4f} {sheet.height_mm * _PT:.4f}]"
    names = " ".join(f"/L{k} {group}" for k, group in enumerate(groups))
    page = (
        f"<< /Type /Page /Parent {_PAGES} 0 R /MediaBox {box} /TrimBox {box} "
        f"/Contents {_CONTENT} 0 R /Resources << /Properties << {names} >> >> >>"
    )
    catalog = f"<< /Type /Catalog /Pages {_PAGES} 0 R{properties if groups else ''} >>"
    yield file.object(_CATALOG, catalog.encode())
    yield file.object(_PAGES, pages.encode())
    yield file.object(_PAGE, page.encode())
    for k, layer in enumerate(layers):
        name = "FEFF" + one_line(layer.name).encode("utf-16-be").hex().upper()
        yield file.object(_FIRST_LAYER + k, f"<< /Type /OCG /Name <{name}> >>".encode())


def _content(sheet: Sheet, layers: list[Layer]) -> Iterator[bytes]:
    # millimetres from the top left corner, y down; round ends and corners; curves to 0.2 pixels
    yield f"{_PT:.9f} 0 0 {-_PT:.9f} 0 {sheet.height_mm * _PT:.6f} cm 1 J 1 j 0.2 i\n".encode()
    decimals = places_for(smallest_mm(sheet))
    for k, layer in enumerate(layers):
        color = b"1 G\n" if layer.inverse else b"0 G\n"
        yield f"/OC /L{k} BDC\n".encode() + color
        yield from painted(layer, PDF_WORDS, decimals)
        yield b"EMC\n"


def places_for(smallest: float) -> int:
    """Return the decimals in mm of which the last is at most a tenth of the smallest radius."""
    decimals = PLACES
    while decimals < 6 and 10.0**-decimals > 0.1 * smallest:
        decimals += 1
    return decimals
