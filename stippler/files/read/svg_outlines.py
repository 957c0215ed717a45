"""Outlines from SVG: shapes with transforms, units and groups; no entities, scripts or links."""

from __future__ import annotations

import collections
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from xml.parsers import expat

import numpy as np

from stippler.drawing.planar.path import path_of_cubics
from stippler.errors import GeometryError
from stippler.files.read.outlines import (
    MOST_SHAPES,
    MOST_VERTICES,
    OutlineError,
    Outlines,
    Shape,
)
from stippler.files.read.svg_data import (
    PX_MM,
    Matrix,
    Piece,
    Subpath,
    arc,
    joined,
    length_mm,
    mapped,
    matrix,
    numbers,
    subpaths,
    user_length,
)

_MOST_DEPTH = 200
_MOST_USES = 50_000
_SILENT = {
    "defs", "symbol", "title", "desc", "metadata", "style", "namedview", "linearGradient",
    "radialGradient", "stop", "sodipodi:namedview",
}  # fmt: skip
_NAMED = {
    "text", "image", "foreignObject", "script", "switch", "clipPath", "mask", "pattern", "marker",
    "filter", "animate", "animateTransform", "set", "video", "audio", "iframe",
}  # fmt: skip


@dataclass(slots=True)
class _Element:
    tag: str
    given: dict[str, str]
    children: list[_Element] = field(default_factory=list)


def outlines_of_svg(data: bytes, where: FilePath) -> Outlines:
    """Read the shapes of an SVG.

    Raises
    ------
    OutlineError
        If it is no SVG, has entities, is too large, or holds no shape.
    """
    root = _tree(data, where)
    if root.tag != "svg":
        raise OutlineError("is no SVG", where)
    walk = _Walk(where, _by_id(root))
    to_mm, size = _page(root.given)
    for child in root.children:
        walk.visit(child, to_mm, "nonzero", 0)
    if not walk.shapes:
        raise OutlineError("holds no shape", where, "; ".join(walk.notes()))
    return Outlines(tuple(walk.shapes), size, tuple(walk.notes()))


def _tree(data: bytes, where: FilePath) -> _Element:
    """Parse without expanding entities or reading anything else."""
    parser = expat.ParserCreate()
    top = _Element("", {})
    stack = [top]
    count = 0

    def start(tag: str, given: dict[str, str]) -> None:
        nonlocal count
        count += 1
        if count > 4 * MOST_SHAPES or len(stack) > _MOST_DEPTH:
            raise OutlineError(
                f"has more than {4 * MOST_SHAPES:,} elements, or {_MOST_DEPTH} one in another",
                where,
                "simplify it first",
            )
        name = tag.rpartition(":")[2] if tag.startswith("svg:") else tag
        element = _Element(name, given)
        stack[-1].children.append(element)
        stack.append(element)

    def refuse(*_: object) -> None:
        raise OutlineError("defines entities", where, "save it as plain SVG")

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda tag: stack.pop()
    parser.EntityDeclHandler = refuse
    parser.UnparsedEntityDeclHandler = refuse
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    try:
        parser.Parse(data, True)
    except (expat.ExpatError, ValueError, LookupError) as error:
        raise OutlineError("is no SVG", where, str(error)) from error
    return top.children[0]


def _by_id(root: _Element) -> dict[str, _Element]:
    found: dict[str, _Element] = {}
    todo = [root]
    while todo:
        element = todo.pop()
        if "id" in element.given:
            found.setdefault(element.given["id"], element)
        todo += element.children
    return found


def _page(given: dict[str, str]) -> tuple[Matrix, tuple[float, float] | None]:
    """Return what takes user units to mm, and the page's size."""
    box = numbers(given.get("viewBox", ""))
    width, height = (length_mm(given.get(k, "")) for k in ("width", "height"))
    if len(box) != 4 or box[2] <= 0 or box[3] <= 0:
        size = (width, height) if width and height else None
        return np.array([[PX_MM, 0, 0], [0, PX_MM, 0]]), size
    if width is None and height is None:
        width, height = box[2] * PX_MM, box[3] * PX_MM
    width = width if width is not None else (height or 0.0) * box[2] / box[3]
    height = height if height is not None else width * box[3] / box[2]
    return _fitted(box, width, height, given.get("preserveAspectRatio", "")), (width, height)


def _fitted(box: list[float], width: float, height: float, align: str) -> Matrix:
    sx, sy = width / box[2], height / box[3]
    if "none" not in align:
        sx = sy = max(sx, sy) if "slice" in align else min(sx, sy)
    share_x = 0.0 if "xMin" in align else 1.0 if "xMax" in align else 0.5
    share_y = 0.0 if "YMin" in align else 1.0 if "YMax" in align else 0.5
    dx = (width - sx * box[2]) * share_x - sx * box[0]
    dy = (height - sy * box[3]) * share_y - sy * box[1]
    return np.array([[sx, 0, dx], [0, sy, dy]])


class _Walk:
    """Goes through elements and gathers shapes; counts what it leaves out."""

    def __init__(self, where: FilePath, by_id: dict[str, _Element]) -> None:
        self.shapes: list[Shape] = []
        self._where, self._by_id = where, by_id
        self._left_out: collections.Counter[str] = collections.Counter()
        self._n_vertices = self._n_uses = 0

    def notes(self) -> list[str]:
        """Say what was left out."""
        return [f"left out: {n} x {what}" for what, n in sorted(self._left_out.items())]

    def visit(self, element: _Element, by: Matrix, rule: str, depth: int) -> None:
        """Take an element and what is in it."""
        given = {**element.given, **_declarations(element.given.get("style", ""))}
        tag = element.tag
        if tag in _SILENT or (":" in tag):
            return
        if tag in _NAMED or depth > _MOST_DEPTH:
            self._left_out[f"<{tag}>"] += 1
            return
        if given.get("display") == "none" or given.get("visibility") == "hidden":
            self._left_out["hidden"] += 1
            return
        if "transform" in given:
            try:
                by = joined(by, matrix(given["transform"]))
            except ValueError:
                self._left_out["unknown transform"] += 1
                return
        rule = given.get("fill-rule", rule)
        for name in ("clip-path", "mask", "filter"):
            if name in given:
                self._left_out[f"{name} (the shape is kept whole)"] += 1
        self._inside(element, given, by, rule, depth)

    def _inside(
        self, element: _Element, given: dict[str, str], by: Matrix, rule: str, depth: int
    ) -> None:
        tag = element.tag
        if tag in ("g", "a", "svg"):
            if tag == "svg":
                by = joined(by, _nested(given))
            for child in element.children:
                self.visit(child, by, rule, depth + 1)
        elif tag == "use":
            self._use(given, by, rule, depth)
        else:
            made = list(_shape_of(tag, given, self._left_out))
            if made:
                self._add(given, made, by, rule)

    def _use(self, given: dict[str, str], by: Matrix, rule: str, depth: int) -> None:
        link = given.get("href", given.get("xlink:href", ""))
        target = self._by_id.get(link[1:]) if link.startswith("#") else None
        self._n_uses += 1
        if target is None or depth > 30 or self._n_uses > _MOST_USES:
            self._left_out["<use> of something outside of the file" if target is None
                           else "<use> of too many"] += 1  # fmt: skip
            return
        move = [[1, 0, user_length(given.get("x"))], [0, 1, user_length(given.get("y"))]]
        by = joined(by, np.array(move))
        if target.tag == "symbol":
            for child in target.children:
                self.visit(child, by, rule, depth + 1)
        else:
            self.visit(target, by, rule, depth + 1)

    def _add(self, given: dict[str, str], made: list[Subpath], by: Matrix, rule: str) -> None:
        paths, closed = [], True
        for pieces, is_closed in made:
            try:
                path = path_of_cubics([mapped(p, by) for p in pieces], closed=is_closed)
            except GeometryError:
                self._left_out["shapes beyond all bounds"] += 1
                continue
            if len(path) < 2:
                self._left_out["shapes without extent"] += 1
                continue
            paths.append(path)
            closed &= path.is_closed
            self._n_vertices += len(path)
        if len(self.shapes) >= MOST_SHAPES or self._n_vertices > MOST_VERTICES:
            raise OutlineError(
                f"has more than {MOST_SHAPES:,} shapes or {MOST_VERTICES:,} vertices",
                self._where,
                "simplify it first",
            )
        if paths:
            name = given.get("inkscape:label", given.get("id", ""))
            even = "even-odd" if rule == "evenodd" else "non-zero"
            self.shapes.append(Shape(name, tuple(paths), even, closed))


def _declarations(text: str) -> dict[str, str]:
    return dict(re.findall(r"([\w-]+)\s*:\s*([^;]+?)\s*(?:;|$)", text))


def _nested(given: dict[str, str]) -> Matrix:
    box = numbers(given.get("viewBox", ""))
    move = np.array([[1.0, 0, user_length(given.get("x"))], [0, 1.0, user_length(given.get("y"))]])
    if len(box) != 4 or box[2] <= 0 or box[3] <= 0:
        return move
    width, height = (
        user_length(given.get("width"), box[2]),
        user_length(given.get("height"), box[3]),
    )
    return joined(move, _fitted(box, width, height, given.get("preserveAspectRatio", "")))


def _shape_of(
    tag: str, given: dict[str, str], left_out: collections.Counter[str]
) -> Iterator[Subpath]:
    """Yield the subpaths of a basic shape."""
    if tag == "path":
        found, whole = subpaths(given.get("d", ""), MOST_VERTICES)
        if not whole:
            left_out["path data from its first error on"] += 1
        yield from found
    elif tag in ("polygon", "polyline", "line"):
        at = numbers(given.get("points", ""))
        if tag == "line":
            at = [user_length(given.get(k)) for k in ("x1", "y1", "x2", "y2")]
        p = np.array(at[: len(at) // 2 * 2]).reshape(-1, 2)
        if len(p) > 1:
            yield [p[i : i + 2] for i in range(len(p) - 1)], tag == "polygon"
    elif tag in ("circle", "ellipse"):
        r = user_length(given.get("r"))
        rx, ry = (r, r) if tag == "circle" else (user_length(given.get(k)) for k in ("rx", "ry"))
        x, y = user_length(given.get("cx")), user_length(given.get("cy"))
        if rx > 0 and ry > 0:
            half = arc((x + rx, y), rx, ry, 0, False, True, (x - rx, y))
            yield half + arc((x - rx, y), rx, ry, 0, False, True, (x + rx, y)), True
    elif tag == "rect":
        yield from _rectangle(given)
    else:
        left_out[f"<{tag}>"] += 1


def _rectangle(given: dict[str, str]) -> Iterator[Subpath]:
    x, y, w, h = (user_length(given.get(k)) for k in ("x", "y", "width", "height"))
    if w <= 0 or h <= 0:
        return
    rx, ry = user_length(given.get("rx"), -1.0), user_length(given.get("ry"), -1.0)
    rx, ry = (ry if rx < 0 else rx), (rx if ry < 0 else ry)
    rx, ry = min(max(rx, 0.0), w / 2), min(max(ry, 0.0), h / 2)
    corners = [
        ((x + rx, y), (x + w - rx, y)), ((x + w, y + ry), (x + w, y + h - ry)),
        ((x + w - rx, y + h), (x + rx, y + h)), ((x, y + h - ry), (x, y + ry)),
    ]  # fmt: skip
    pieces: list[Piece] = []
    for k, (a, b) in enumerate(corners):
        if a != b:
            pieces.append(np.array([a, b]))
        following = corners[(k + 1) % 4][0]
        if b != following:
            pieces += arc(b, rx, ry, 0, False, True, following)
    yield pieces, True
