"""A drawing as the members of a container, and back to the bit; `docs/format.md` has the list.

What a later program has put into a file, members and fields alike, is kept in `Drawing.foreign`
and given back when the drawing is saved.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from stippler.atomic_write import replacing
from stippler.drawing import records
from stippler.drawing.dot_rules import LARGEST_ID, first_fault
from stippler.drawing.dots import FREE, NO_CURVE, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.foreign import Foreign
from stippler.drawing.reference import Picture
from stippler.drawing.style import MAX_DOTS
from stippler.errors import DrawingFileError, GeometryError, StipplerError
from stippler.files.native import arrays, structure
from stippler.files.native.container import Members, read_container, write_container
from stippler.files.native.limits import DEFAULT_LIMITS, Limits
from stippler.files.native.page_area import with_page_area
from stippler.files.native.thumbnail import MEMBER, thumbnail_png
from stippler.version import VERSION

PROGRAM = f"stippler {VERSION}"
STRUCTURE = "document.json"

ReadPicture = Callable[[bytes, str, str], Picture]
"""From a picture file's bytes, its name and a tone to the picture."""

_DO = "open a backup of the drawing"
_TABLES = (records.STYLE, records.AREA, records.LINE, records.PATTERN, records.BORDER)
_OURS = {"page", "reference", "next_id", "dots", "pictures", *_TABLES}
_DEFAULTS: dict[str, Any] = {
    "elongation": 1.0, "angle_rad": 0.0, "roughness": 0.0, "area": 0, "constraint": FREE,
    "curve": NO_CURVE, "parameter": 0.0,
}  # fmt: skip


def save_drawing(drawing: Drawing, path: str | Path, more: Members | None = None) -> None:
    """Write a drawing to its own kind of file, whole or not at all.

    Parameters
    ----------
    more : mapping of name to bytes, optional
        Members beside the drawing's.

    Raises
    ------
    OutputError
        If the file cannot be written; what stood there stays.
    """
    data = file_bytes(drawing, more)
    with replacing(path) as stream:
        stream.write(data)


def file_bytes(drawing: Drawing, more: Members | None = None) -> bytes:
    """Return a drawing's file, with its thumbnail; steps to another state are left out."""
    from stippler.files.native import step_file

    stream = io.BytesIO()
    kept = drawing.foreign
    steps = kept.members.get(step_file.MEMBER)
    if steps is not None and not step_file.is_of(steps, drawing):
        others = {name: data for name, data in kept.members.items() if name != step_file.MEMBER}
        drawing = replace(drawing, foreign=replace(kept, members=others))
    thumbnail = {MEMBER: thumbnail_png(drawing)}
    write_container(stream, {**members_of(drawing, more), **thumbnail}, PROGRAM)
    return stream.getvalue()


def open_drawing(
    path: str | Path, read_picture: ReadPicture, limits: Limits = DEFAULT_LIMITS
) -> tuple[Drawing, dict[str, bytes]]:
    """Read a drawing; return it, and the members that are none of the drawing's.

    Raises
    ------
    DrawingFileError
        If the file is none, damaged or of a later version; names the place.
    """
    return drawing_of(read_container(path, limits), read_picture, str(path), limits)


# --- from a drawing to members --------------------------------------------------------------------


def members_of(drawing: Drawing, more: Members | None = None) -> dict[str, bytes]:
    """Return what a drawing's file holds, by name."""
    members: dict[str, bytes] = {STRUCTURE: b""}
    pictures = _write_pictures(drawing, members)
    foreign = drawing.foreign
    document: dict[str, Any] = {
        "page": _value(records.PAGE, 0, drawing.page, foreign),
        "reference": None,
        "next_id": {kind: drawing.first_free(kind) for kind in (records.DOT, *_TABLES)},
        "dots": _write_dots(drawing.dots, members),
        "pictures": pictures,
    }
    if drawing.reference is not None:
        document["reference"] = _value(records.REFERENCE, 0, drawing.reference, foreign)
    for kind in _TABLES:
        table = drawing.table(kind)
        document[kind] = {str(i): _value(kind, i, table[i], foreign) for i in sorted(table)}
    members[STRUCTURE] = structure.to_bytes({**foreign.document, **document})
    return {**members, **foreign.members, **(more or {})}


def _value(kind: str, i: int, value: records.Record, foreign: Foreign) -> dict[str, Any]:
    return {**foreign.fields.get((kind, i), {}), **value.to_json()}


def _write_dots(dots: Dots, members: dict[str, bytes]) -> dict[str, Any]:
    """Add the arrays of dots; those that are all as usual are left out."""
    listed: dict[str, Any] = {}
    for f in fields(Dots):
        values = getattr(dots, f.name)
        if f.name in _DEFAULTS and (values == values.dtype.type(_DEFAULTS[f.name])).all():
            continue
        kind = arrays.kind_of(values)
        listed[f.name] = [kind, list(values.shape)]
        members[f"dots/{f.name}.{kind}"] = arrays.to_bytes(values)
    return {"n": len(dots), "arrays": listed}


def _write_pictures(drawing: Drawing, members: dict[str, bytes]) -> dict[str, Any]:
    listed: dict[str, Any] = {}
    if drawing.reference is None:
        return listed
    picture = drawing.reference.source
    about: dict[str, Any] = {"name": picture.name, "tone": picture.tone}
    if picture.data is not None:
        about["file"] = f"pictures/{picture.digest}"
        members[about["file"]] = picture.data
    else:
        about |= {
            "darkness": f"pictures/{picture.digest}.f4",
            "shape": list(picture.levels.shape),
        }
        members[about["darkness"]] = arrays.to_bytes(picture.levels.darkness())
    listed[picture.digest] = about
    return listed


# --- from members to a drawing --------------------------------------------------------------------


def drawing_of(
    members: Members, read_picture: ReadPicture, where: str, limits: Limits = DEFAULT_LIMITS
) -> tuple[Drawing, dict[str, bytes]]:
    """Return the drawing that members hold, and the members that are none of a drawing's.

    Raises
    ------
    DrawingFileError
        If something is missing, or is not what it should be; names the place.
    """
    if STRUCTURE not in members:
        raise DrawingFileError("holds no drawing", where, "open another file")
    place = f"{where}, {STRUCTURE}"
    document = structure.from_bytes(members[STRUCTURE], place, limits)
    if not isinstance(document, dict):
        raise DrawingFileError("holds no drawing", place, "open another file")
    used = {STRUCTURE}
    strange: dict[tuple[str, int], dict[str, Any]] = {}
    pictures = _read_pictures(document, members, used, read_picture, place)
    page = _read_value(records.PAGE, 0, document.get("page"), pictures, strange, place)
    reference = document.get("reference")
    if reference is not None:
        reference = _read_value(records.REFERENCE, 0, reference, pictures, strange, place)
    tables = {
        kind: _read_table(kind, document.get(kind, {}), pictures, strange, place)
        for kind in _TABLES
    }
    try:
        tables[records.AREA] = with_page_area(tables[records.AREA], page)
    except GeometryError as error:
        raise DrawingFileError(f"has areas that are wrong ({error})", place, _DO) from None
    dots = _read_dots(document.get("dots"), members, used, tables, place)
    drawing = Drawing(
        page,
        tables[records.AREA],
        dots,
        reference,
        tables[records.STYLE],
        tables[records.LINE],
        tables[records.PATTERN],
        tables[records.BORDER],
        _read_next_ids(document.get("next_id", {}), place),
    )
    _check_styles(drawing, place)
    for kind in (records.DOT, *_TABLES):
        drawing.next_id[kind] = drawing.first_free(kind)
    drawing.foreign = Foreign(
        {name: value for name, value in document.items() if name not in _OURS}, strange
    )
    return drawing, {name: data for name, data in members.items() if name not in used}


def _read_value(
    kind: str,
    i: int,
    data: object,
    pictures: Mapping[str, Picture],
    strange: dict[tuple[str, int], dict[str, Any]],
    where: str,
) -> Any:
    """Make a value; fields that it does not know go to `strange`."""
    place = f"{where}, {kind} {i}"
    if not isinstance(data, dict):
        raise DrawingFileError("is missing", place, _DO)
    known = records.fields_of(kind)
    mine = {name: value for name, value in data.items() if name in known}
    if len(mine) < len(data):
        strange[kind, i] = {name: v for name, v in data.items() if name not in known}
    try:
        return records.value_from_json(kind, mine, pictures)
    except StipplerError as error:
        raise DrawingFileError(f"is wrong ({error})", place, _DO) from None
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        why = f"{type(error).__name__}: {error}"[:120]
        raise DrawingFileError(f"is wrong ({why})", place, _DO) from None


def _read_table(
    kind: str,
    data: object,
    pictures: Mapping[str, Picture],
    strange: dict[tuple[str, int], dict[str, Any]],
    where: str,
) -> dict[int, Any]:
    if not isinstance(data, dict):
        raise DrawingFileError(f"has no table of the kind {kind}", where, _DO)
    table: dict[int, Any] = {}
    for name, value in data.items():
        if not (name.isascii() and name.isdigit() and len(name) < 10 and str(int(name)) == name):
            raise DrawingFileError(f"{name[:40]!r} is no id", f"{where}, {kind}", _DO)
        table[int(name)] = _read_value(kind, int(name), value, pictures, strange, where)
    return table


def _read_next_ids(data: object, where: str) -> dict[str, int]:
    if not isinstance(data, dict):
        raise DrawingFileError("is no list of ids", f"{where}, next_id", _DO)
    for kind, i in data.items():
        if type(i) is not int or not 0 <= i <= LARGEST_ID:
            raise DrawingFileError(f"{str(i)[:40]} is no id", f"{where}, next_id {kind[:40]}", _DO)
    return dict(data)


def _read_pictures(
    document: Mapping[str, Any],
    members: Members,
    used: set[str],
    read_picture: ReadPicture,
    where: str,
) -> dict[str, Picture]:
    listed = document.get("pictures", {})
    if not isinstance(listed, dict):
        raise DrawingFileError("is no list of pictures", f"{where}, pictures", _DO)
    found: dict[str, Picture] = {}
    for digest, about in listed.items():
        place = f"{where}, picture {digest[:40]}"
        if not isinstance(about, dict):
            raise DrawingFileError("says nothing of it", place, _DO)
        name, tone = str(about.get("name", ""))[:1000], str(about.get("tone", ""))[:40]
        member = about.get("file", about.get("darkness"))
        if not isinstance(member, str) or member not in members:
            raise DrawingFileError("is missing", place, _DO)
        used.add(member)
        try:
            if "file" in about:
                found[digest] = read_picture(members[member], name, tone)
            else:
                darkness = arrays.from_bytes(members[member], "f4", about.get("shape"), place)
                found[digest] = Picture.of(darkness, tone, name, digest)
        except StipplerError as error:
            raise DrawingFileError(f"cannot be read ({error})", place, _DO) from None
    return found


def _read_dots(
    about: object,
    members: Members,
    used: set[str],
    tables: Mapping[str, Mapping[int, Any]],
    where: str,
) -> Dots:
    place = f"{where}, dots"
    if not isinstance(about, dict) or not isinstance(about.get("arrays"), dict):
        raise DrawingFileError("has no dots", place, _DO)
    n, listed = about.get("n"), about["arrays"]
    if type(n) is not int or not 0 <= n <= MAX_DOTS:
        raise DrawingFileError(f"{str(n)[:40]} is no number of dots", place, _DO)
    like = Dots.none()
    values: dict[str, Any] = {}
    for f in fields(Dots):
        usual = getattr(like, f.name)
        if f.name not in listed:
            if f.name not in _DEFAULTS:
                raise DrawingFileError(f"{f.name} is missing", place, _DO)
            values[f.name] = np.full(n, _DEFAULTS[f.name], usual.dtype)
            continue
        kind = arrays.kind_of(usual)
        member = f"dots/{f.name}.{kind}"
        if listed[f.name] != [kind, [n, *usual.shape[1:]]] or member not in members:
            raise DrawingFileError(f"{f.name} is not what it should be", place, _DO)
        used.add(member)
        read = arrays.from_bytes(members[member], kind, listed[f.name][1], f"{where}, {member}")
        values[f.name] = np.array(read)  # a drawing changes its own
    dots = Dots(**values)
    _check_dots(dots, tables, place)
    return dots


def _check_dots(dots: Dots, tables: Mapping[str, Mapping[int, Any]], where: str) -> None:
    """Refuse what no dot can be, and name the first that is."""
    for f in fields(Dots):
        if (fault := first_fault(f.name, getattr(dots, f.name))) is not None:
            raise DrawingFileError(f"its {fault[1]}", f"{where}, dot {fault[0]}", _DO)
    on_curve = dots.constraint == ON_CURVE
    areas = np.fromiter(tables[records.AREA], np.int64)
    lines = np.fromiter(tables[records.LINE], np.int64)
    for fine, what in (
        (np.isin(dots.area, areas), "area is not in the drawing"),
        (~on_curve | np.isin(dots.curve, lines), "line is not in the drawing"),
    ):
        if not fine.all():
            k = int(np.flatnonzero(~fine)[0])
            raise DrawingFileError(f"its {what}", f"{where}, dot {k}", _DO)
    if (np.diff(np.sort(dots.id)) == 0).any():
        raise DrawingFileError("an id stands twice", where, _DO)


def _check_styles(drawing: Drawing, where: str) -> None:
    if 0 not in drawing.areas:
        raise DrawingFileError("the page's own area is missing", where, _DO)
    for i, area in drawing.areas.items():
        if area.style not in drawing.styles:
            raise DrawingFileError("its style is missing", f"{where}, area {i}", _DO)
