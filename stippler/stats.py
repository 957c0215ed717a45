"""What `stippler stats` prints: the measures of a table of dots, or of the drawing of a picture."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np

from stippler.analysis.report import Report, measure_against, measure_dots
from stippler.api import draw
from stippler.drawing.area import PAGE_AREA
from stippler.drawing.dots import Dots
from stippler.drawing.partition import Partition
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import GeometryError
from stippler.files.read.picture import read_picture
from stippler.files.read.table import read_csv
from stippler.opening import open_file
from stippler.stippling.style_tone import toned, toned_by_area

_SAID = {
    "dots": "dots",
    "width_mm": "page width, mm",
    "height_mm": "page height, mm",
    "radius_min_mm": "smallest radius, mm",
    "radius_mean_mm": "mean radius, mm",
    "radius_max_mm": "largest radius, mm",
    "size_noise": "size noise among neighbours",
    "spacing_mm": "mean distance to the nearest, mm",
    "spacing_cv": "variation of that distance",
    "relative_cv": "the same, relative to the seventh",
    "relative_min": "closest pairs, relative to the seventh",
    "edge_variance": "spacing variance (Delaunay edges)",
    "spectrum_dots": "dots of the spectrum (in the middle)",
    "spectrum_low": "power below half the mean frequency",
    "spectrum_peak": "peak power",
    "direction_db": "direction, dB",
    "tone_rmse": "tone error, from two spacings",
    "detail_rmse": "tone error, from one spacing",
    "tone_bias": "tone bias (above 0: too dark)",
    "tone_gain": "tone gain",
    "overlap": "ink lost to overlap",
}


def of_table(path: Path, reference: Path | None, *, tone: str, width_mm: float) -> Report:
    """Measure a .csv, and against a picture its tone error too; the page is as wide as given."""
    dots = read_csv(path)
    if reference is None:
        return measure_dots(dots.position_mm, dots.radius_mm)
    return _of_dots(dots, path, reference, tone=tone, width_mm=width_mm)


def of_drawing(path: Path, reference: Path | None, *, tone: str) -> Report:
    """Measure a drawing of our own, and its tone error where it has a picture or is given one.

    What it has is taken as the styles of its areas see it.
    """
    drawing = open_file(path)
    dots = drawing.dots
    if reference is not None:
        return _of_dots(dots, path, reference, tone=tone, width_mm=drawing.page.width_mm)
    report = measure_dots(dots.position_mm, dots.radius_mm)
    if drawing.reference is None:
        return report
    partition = Partition(drawing.outlines())
    seen = toned_by_area(
        drawing.reference,
        {k: (partition.part_of(k), drawing.style_of(k)) for k in drawing.areas},
    )
    report |= _against(dots, seen)
    if drawing.style_of(PAGE_AREA).is_inverse:
        report["tone_bias"] = -report["tone_bias"]
    return report


def _of_dots(dots: Dots, path: Path, reference: Path, *, tone: str, width_mm: float) -> Report:
    """Measure dots against the picture at a path, on a page so wide."""
    report = measure_dots(dots.position_mm, dots.radius_mm)
    picture = read_picture(reference, tone=tone, width_mm=width_mm)
    size = np.array((picture.width_mm, picture.height_mm))
    off = (dots.position_mm < -1e-6) | (dots.position_mm > size + 1e-6)
    if off.any():
        raise GeometryError(
            f"has dots off a page of {size[0]:g} × {size[1]:g} mm",
            path,
            "give the --width it was drawn with, and the right --reference",
        )
    return report | _against(dots, picture)


def of_picture(
    path: Path, style: Style, *, tone: str, width_mm: float
) -> tuple[Report, tuple[str, ...]]:
    """Draw a picture and measure the drawing; return what it falls short of, too."""
    drawing = draw(path, style, tone=tone, width_mm=width_mm)
    dots, picture = drawing.dots, drawing.reference
    assert picture is not None, "draw() keeps what it drew from"
    style = drawing.style_of(PAGE_AREA)
    report = measure_dots(dots.position_mm, dots.radius_mm) | _against(dots, toned(picture, style))
    if style.is_inverse:  # white that is too much is ink that is missing
        report["tone_bias"] = -report["tone_bias"]
    return report, drawing.notes


def as_json(report: Report) -> str:
    """Return a report as one JSON object; null where there is no value."""
    return json.dumps({k: None if math.isnan(v) else v for k, v in report.items()}, indent=1)


def as_text(report: Report) -> str:
    """Return a report as lines of a name and a value, in words."""
    width = max(map(len, _SAID.values()))
    return "\n".join(f"{_SAID[k]:{width}}  {_said(report[k])}" for k in _SAID if k in report)


def _against(dots: Dots, picture: Reference) -> Report:
    """Measure dots against the picture they were drawn from, on its page."""
    page: Report = {"width_mm": picture.width_mm, "height_mm": picture.height_mm}
    return page | measure_against(
        dots.position_mm, dots.radius_mm, picture.darkness, picture.width_mm
    )


def _said(value: float) -> str:
    if math.isnan(value):
        return "-"
    return f"{value:,}" if isinstance(value, int) else f"{value:.4f}"
