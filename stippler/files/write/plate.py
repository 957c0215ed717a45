"""A drawing made up for print: its size, one line, scale bar, marks, caption and letter."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

import numpy as np

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.files.write.format import Values
from stippler.files.write.formats import ALL, CLOSED, NONE, PENS, POLARITY
from stippler.files.write.sheet import Layer, Line, Sheet, moved, sheet_of

LINE_EFFORT = 0.6

_MARK_MM, _CLEAR_MM, _HAIR_MM = 5.0, 3.0, 0.1
_MARGIN_MM = 12.0  # around a sheet with marks
_BAR_MM, _BAR_SHARE = 0.5, 0.22
_TEXT_MM, _ROW = 2.2, 1.8
_GAP_MM = 3.0


def plate_of(drawing: Drawing, values: Values, cancel: Callable[[], bool] | None = None) -> Sheet:
    """Return a drawing as a sheet at the size of print, with what goes around it.

    Parameters
    ----------
    cancel : callable, optional
        Asked now and then while a line is sought; it may raise, or return True: the line is then
        as it is.
    """
    sheet = sheet_of(drawing)
    reduction = 1.0
    if values["print_width"] is not None:
        reduction = values["print_width"] / sheet.width_mm
        sheet = sheet.scaled(reduction)
    if values["one_line"] != NONE:
        closed = values["one_line"] == CLOSED
        sheet = one_line(sheet, values["line_width"], closed=closed, cancel=cancel)
    sheet = for_press(sheet, values)
    if values.get("layers") == POLARITY:
        sheet = by_polarity(sheet)
    elif values.get("layers") == PENS:
        sheet = by_pen(sheet)
    lines = _letter(values["letter"])
    under, used_mm = _under(sheet, values, reduction)
    layers = [*sheet.layers]
    if lines or under:
        layers.append(Layer("plate", lines=(*lines, *under)))
    sheet = replace(sheet, height_mm=sheet.height_mm + used_mm, layers=tuple(layers))
    return _marked(sheet, values["marks"]) if values["marks"] != NONE else sheet


def by_polarity(sheet: Sheet) -> Sheet:
    """Return a sheet whose neighbouring layers of one polarity are one, named for it.

    Painting order stays: ink above a white layer is a layer of its own.
    """
    groups: list[list[Layer]] = []
    for layer in sheet.layers:
        if groups and groups[-1][0].inverse == layer.inverse:
            groups[-1].append(layer)
        else:
            groups.append([layer])
    return replace(
        sheet, layers=tuple(_joined(g, "paper" if g[0].inverse else "ink") for g in groups)
    )


def by_pen(sheet: Sheet) -> Sheet:
    """Return a sheet with one layer for each pen, named for it; white layers stay by themselves.

    Ink may be laid in any order, so it does not matter which areas lie between.
    """
    white = [layer for layer in sheet.layers if layer.inverse]
    pens: dict[str, list[Layer]] = {}
    for layer in sheet.layers:
        if not layer.inverse:
            pens.setdefault(layer.pen or layer.name, []).append(layer)
    return replace(sheet, layers=(*white, *(_joined(g, name) for name, g in pens.items())))


def _joined(layers: list[Layer], name: str) -> Layer:
    dots = Dots(
        **{
            f.name: np.concatenate([getattr(layer.dots, f.name) for layer in layers])
            for f in fields(Dots)
        }
    )
    first = layers[0]
    return Layer(
        name,
        dots,
        first.inverse,
        tuple(shape for layer in layers for shape in layer.ground),
        tuple(line for layer in layers for line in layer.lines),
        tuple(shape for layer in layers for shape in layer.shapes),
        first.pen,
    )


def for_press(sheet: Sheet, values: Values) -> Sheet:
    """Return a sheet that the press chosen prints as the one given looks."""
    gain, least = values.get("gain"), values.get("least_dot")
    if values.get("press") is not None:
        from stippler.files.presses import press_named

        press = press_named(values["press"])
        gain = press.gain_mm if gain is None else gain
        least = press.least_dot_mm if least is None else least
    if not gain and not least:
        return sheet
    from stippler.files.write.press import solved

    return solved(sheet, gain or 0.0, least or 0.0)


def one_line(
    sheet: Sheet, width: float, *, closed: bool, cancel: Callable[[], bool] | None = None
) -> Sheet:
    """Return a sheet whose dots are joined, in each layer by one line that never crosses itself."""
    from stippler.stippling.tour import tour

    layers = []
    for layer in sheet.layers:
        points = layer.dots.position_mm
        lines = layer.lines
        if len(points):
            order = tour(points, closed=closed, effort=LINE_EFFORT, cancel=cancel)
            is_closed = closed and len(points) > 2
            lines = (*lines, Line(points[order], width, is_closed))
        layers.append(replace(layer, dots=Dots.none(), lines=lines))
    return replace(sheet, layers=tuple(layers))


def _letter(letter: str) -> list[Line]:
    if not letter:
        return []
    from stippler.files.write.lettering import text_lines

    height = 2 * _TEXT_MM
    return text_lines(letter, (_GAP_MM, _GAP_MM + height), height)


def _under(sheet: Sheet, values: Values, reduction: float) -> tuple[list[Line], float]:
    """Return what stands under a drawing, and how much higher that makes the sheet."""
    top, lines, used = sheet.height_mm + _GAP_MM, [], 0.0
    if values["magnification"] is not None:
        bar, used = _scale_bar(sheet, values["magnification"] * reduction, top)
        lines += bar
        top += used + _GAP_MM
    if caption := " ".join(values["caption"].split()):
        from stippler.files.write.lettering import text_lines, wrapped

        for row in wrapped(caption, _TEXT_MM, sheet.width_mm):
            lines += text_lines(row, (0.0, top + _TEXT_MM), _TEXT_MM)
            top += _ROW * _TEXT_MM
    if not lines:
        return [], 0.0
    return lines, top - sheet.height_mm


def round_length(at_most: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20, ... that is not above a length."""
    power = 10.0 ** math.floor(math.log10(at_most) + 1e-9)
    return max(step * power for step in (1, 2, 5) if step * power <= at_most * (1 + 1e-9))


def length_text(mm: float) -> str:
    """Return a length with a unit that makes it a small whole number."""
    for unit, per_mm in (("m", 1e-3), ("cm", 0.1), ("mm", 1.0), ("µm", 1e3)):
        if mm * per_mm >= 0.9999 and (unit != "cm" or mm * per_mm >= 10):
            return f"{mm * per_mm:g} {unit}"
    return f"{mm * 1e6:g} nm"


def _scale_bar(sheet: Sheet, magnification: float, top: float) -> tuple[list[Line], float]:
    from stippler.files.write.lettering import text_lines, width_mm

    length = round_length(_BAR_SHARE * sheet.width_mm / magnification)
    drawn = length * magnification
    text = length_text(length)
    right = sheet.width_mm
    y = top + _BAR_MM / 2
    bar = np.array([(right - drawn + _BAR_MM / 2, y), (right - _BAR_MM / 2, y)])
    middle = right - max(drawn, width_mm(text, _TEXT_MM)) / 2
    at = (middle, y + _BAR_MM + 1.6 * _TEXT_MM)
    return [Line(bar, _BAR_MM), *text_lines(text, at, _TEXT_MM, align=0.5)], 3.2 * _TEXT_MM


def _marked(sheet: Sheet, marks: str) -> Sheet:
    """Return a larger sheet with marks at the corners and the middles of the sides."""
    w, h, m = sheet.width_mm, sheet.height_mm, _MARGIN_MM
    larger = moved(sheet, 1.0, (m, m), (w + 2 * m, h + 2 * m))
    lines = []
    for x, out_x in ((m, -1), (m + w, 1)):
        for y, out_y in ((m, -1), (m + h, 1)):
            near, far = _CLEAR_MM, _CLEAR_MM + _MARK_MM
            lines.append(Line(np.array([(x + near * out_x, y), (x + far * out_x, y)]), _HAIR_MM))
            lines.append(Line(np.array([(x, y + near * out_y), (x, y + far * out_y)]), _HAIR_MM))
    if marks == ALL:
        middles = ((m / 2, m + h / 2), (w + 1.5 * m, m + h / 2), (m + w / 2, m / 2),
                   (m + w / 2, h + 1.5 * m))  # fmt: skip
        for middle in middles:
            lines += _registration(np.array(middle))
    return replace(larger, layers=(*larger.layers, Layer("marks", lines=tuple(lines))))


def _registration(at: Any) -> list[Line]:
    turn = np.linspace(0, 2 * math.pi, 33)[:-1]
    ring = at + 1.5 * np.column_stack([np.cos(turn), np.sin(turn)])
    across = [np.array([at - step, at + step]) for step in ((2.5, 0.0), (0.0, 2.5))]
    return [Line(ring, _HAIR_MM, closed=True), *(Line(line, _HAIR_MM) for line in across)]
