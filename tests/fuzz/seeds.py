"""Whole inputs for fuzzing to begin with."""

from __future__ import annotations

import io
import json
import tempfile
from dataclasses import asdict
from pathlib import Path

import numpy as np

from stippler.drawing.style import Style
from stippler.files.native import arrays, container, drawing_file, edit_log, journal, structure
from tests.corpus.contents import CONTENTS
from tests.fuzz.readers import _COLUMNS


def seeds(name: str) -> list[bytes]:
    """Return whole inputs of a reader."""
    return _SEEDS[name]()


def _structure() -> list[bytes]:
    return [structure.to_bytes({"a": [1, 2.5, None, True, "\u00e9"], "b": {"c": {}}, "d": -1e300})]


def _arrays() -> list[bytes]:
    return [arrays.pack({"label": "x"}, {"a": np.arange(3.0), "b": np.array([True, False])})]


def _container() -> list[bytes]:
    found = []
    for members in ({"document.json": b"{}", "dots/a.f8": bytes(400)}, {"document.json": b"[1]"}):
        stream = io.BytesIO()
        container.write_container(stream, members, "s 1")
        found.append(stream.getvalue())
    return found


def _journal() -> list[bytes]:
    found = []
    for records in ((_arrays()[0], bytes(5000)), (b"a", b"bc")):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "one"
            one = journal.Journal(path, bytes(16))
            for record in records:
                one.append(lambda record=record: record)
            one.flush()
            one.close()
            found.append(path.read_bytes())
            found.append(found[-1] + b"\1")  # its sums are mended by the reader here
    return found


def _drawing() -> list[bytes]:
    """Documents, and the bytes of their arrays in the order that the reader here takes them."""
    found = []
    for make in CONTENTS.values():
        drawing = make()
        drawing.dots = drawing.dots.take(slice(5))
        members = drawing_file.members_of(drawing)
        document = json.loads(members[drawing_file.STRUCTURE])
        for column in _COLUMNS:  # small: fewer bytes to change in vain
            document["dots"]["arrays"].setdefault(
                column[0], [column[1], [5, 2] if column[0] == "position_mm" else [5]]
            )
        raw = b"".join(arrays.to_bytes(getattr(drawing.dots, column)) for column, _, _ in _COLUMNS)
        found.append(structure.to_bytes(document) + b"\0" + raw)
    return found


def _replay() -> list[bytes]:
    """Journals of strokes, areas and undone steps, each record with its length before it."""
    from stippler.drawing.document import Document
    from stippler.drawing.dots import Dots
    from tests.fuzz.readers import _few_dots

    taken: list[bytes] = []
    document = Document(_few_dots())
    document.follow(lambda entry: taken.append(edit_log.of_entry(entry)))
    document.begin("Move")
    document.move(np.array([0, 2]), np.array([[2.0, 2.0], [8.0, 3.0]]))
    document.commit()
    document.begin("Add and erase")
    document.insert(Dots.round([[3.0, 3.0], [4.0, 4.0]], 0.1))
    document.remove(np.array([0]))
    document.commit()
    document.undo()
    document.redo()
    document.begin("Style")
    document.set("style", 0, Style(n_dots=9))
    document.add("area", document.drawing.areas[0])
    document.commit()
    document.begin_run("Relax")
    document.merge(document.dots.by_id().position_mm + 0.1)
    document.tell_run()
    document.end_run()
    pieces = [len(record).to_bytes(2, "little") + record for record in taken]
    return [b"".join(pieces), *(piece for piece in pieces), b"".join(pieces[:2])]


def _style() -> list[bytes]:
    return [structure.to_bytes(value.to_json()) for value in (Style(), Style(9, (0.1, 0.2)))]


def _table() -> list[bytes]:
    ours = (
        b"x_mm,y_mm,radius_mm,elongation,angle_rad,roughness,seed,area,fixed\n"
        b"1.5,2,0.3,1,0,0,7,0,0\n4,5,0.25,1.5,-0.5,0.2,4294967295,1,1\n"
    )
    return [
        ours, b"x;y;d\n1,5;2,5;0,3\n4;5;1\n", b"1 2\n3 4\n", b"sep=|\nx|y\n1|2\n",
        "x,y\n1,2\n".encode("utf-16"), b'"x_mm","y_mm"\r\n"1.0","2"\r\n', b"\xef\xbb\xbfx\ty\n1\t2",
        b"x [mm],y [mm],fixed\n1,2,true\n# note\n3,4,no\n",
    ]  # fmt: skip


_SVG = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
 width="40mm" height="3cm" viewBox="0 0 40 30" preserveAspectRatio="xMinYMax slice">
<defs><path id="p" d="M0 0 L5,5 H9 V2 h-1 v-.5 l1e0 2 z m1 1 C1 2 3 4 5 6 S2 2 3 3 Q1 1 2 2 T4 4
 A5 3 20 1 0 9 9Z"/></defs><g transform="translate(1,2) scale(2) rotate(30 1 1) skewX(5)"
 style="fill-rule: evenodd; display: inline"><use href="#p" x="2" y="3"/><use xlink:href="#p"/>
<rect x="1" y="1" width="5" height="4" rx="1"/><circle cx="3" cy="3" r="2"/><ellipse cx="5" cy="5"
 rx="2" ry="1"/><line x1="0" y1="0" x2="3" y2="4"/><polyline points="0,0 1,1 2,0"/><polygon
 points="0 0 3 0 3 3" transform="matrix(1 0 0 1 5 5)"/><symbol id="s"><rect width="1" height="1"/>
</symbol><svg x="1" viewBox="0 0 2 2" width="4" height="4"><path
 d="M0,0 1,1 2,0"/></svg></g></svg>"""


def _svg() -> list[bytes]:
    return [
        _SVG.encode(),
        b'<svg viewBox="0 0 9 9"><path d="M1 1 2 2 3 1z"/></svg>',
        b'<!DOCTYPE svg [<!ENTITY a "b">]><svg>&a;</svg>',
    ]


def _geojson() -> list[bytes]:
    square = [[[0, 0], [5, 0], [5, 5], [0, 0]], [[1, 1], [2, 1], [2, 2], [1, 1]]]
    geometry = {"type": "Polygon", "coordinates": square}
    feature = {"type": "Feature", "id": 7, "properties": {"name": "ear"}, "geometry": geometry}
    several = [
        {"type": "MultiPolygon", "coordinates": [square]},
        {"type": "LineString", "coordinates": [[0, 0], [1.5, 2]]},
        {"type": "MultiLineString", "coordinates": [[[0, 0], [1, 2]]]},
    ]
    collection = {"type": "GeometryCollection", "geometries": several}
    features = {"type": "FeatureCollection", "features": [feature]}
    return [json.dumps(value).encode() for value in (features, collection, geometry)]


def _picture() -> list[bytes]:
    """Pictures of six by five pixels, of every kind that is read."""
    from PIL import Image

    grey = np.arange(30, dtype=np.uint8).reshape(5, 6) * 8
    of_mode = {mode: Image.fromarray(grey).convert(mode) for mode in ("L", "RGB", "RGBA", "1", "P")}
    of_mode["I;16"] = Image.fromarray(grey.astype(np.uint16) * 200)
    kept = (
        ("png", ("L", "RGBA", "1", "P", "I;16"), {}), ("jpeg", ("L", "RGB"), {}),
        ("tiff", ("L", "RGB", "1", "I;16"), {}), ("tiff", ("L",), {"compression": "tiff_lzw"}),
        ("tiff", ("RGB",), {"compression": "tiff_deflate"}), ("webp", ("RGB",), {"lossless": True}),
        ("bmp", ("L", "RGB"), {}), ("gif", ("P",), {}), ("jpeg2000", ("L",), {}),
    )  # fmt: skip
    found = []
    for kind, modes, options in kept:
        for mode in modes:
            stream = io.BytesIO()
            of_mode[mode].save(stream, kind, **options)
            found.append(stream.getvalue())
    return found + _heif(of_mode["RGB"])


def _heif(image: object) -> list[bytes]:
    import pillow_heif

    found = []
    for kind in ("HEIF",):
        stream = io.BytesIO()
        pillow_heif.from_pillow(image).save(stream, format=kind)
        found.append(stream.getvalue())
    return found


def _brushes() -> list[bytes]:
    from stippler.brushes.brush import first_brushes

    kept = first_brushes()
    found = [{"version": 1, "brushes": [brush.as_dict() for brush in kept]}]
    found += [{"version": 1, "brushes": [brush.as_dict()]} for brush in kept]
    return [json.dumps(document).encode() for document in found]


def _preferences() -> list[bytes]:
    from stippler.ui.preferences import Preferences

    kept = Preferences()
    values = {key: value for key, value in asdict(Style()).items() if key != "seed"}
    kept.values = {"tone": "linear", "width_mm": 100.0, **values}
    kept.note_opened(Path("/a/b.png"))
    return [json.dumps(kept._document()).encode()]


_SEEDS = {
    "structure": _structure, "arrays": _arrays, "container": _container, "journal": _journal,
    "drawing": _drawing, "replay": _replay, "style": _style, "table": _table, "svg": _svg,
    "geojson": _geojson, "picture": _picture, "brushes": _brushes, "preferences": _preferences,
}  # fmt: skip
