"""All formats and their options; importing it costs nothing, so that a command line knows them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from stippler.errors import OutputError, ParameterError
from stippler.files.write.format import Format
from stippler.files.write.options import Option

CIRCLES, COMPOUND, TAPS, POINTS = "circles", "compound", "taps", "points"
NONE, OPEN, CLOSED = "none", "open", "closed"
CROP, ALL = "crop", "all"
AREAS, PENS, POLARITY = "areas", "pens", "polarity"
MAX_DECIMALS = 6

PLATE = (
    Option("profile", None, "What a publisher asks for: width, dpi, bits.", kind=str),
    Option("column", None, "Which of the profile's widths: column, page.", kind=str),
    Option(
        "print_width", None, "Width of the drawing in print.", "mm", 1, 10_000, kind=float,
        label="Width",
    ),
    Option(
        "one_line",
        NONE,
        "One line through all dots instead of dots.",
        choices=(NONE, OPEN, CLOSED),
    ),
    Option("line_width", 0.25, "Width of that line.", "mm", 0.01, 10),
    Option(
        "magnification",
        None,
        "How much larger than life it is drawn; adds a scale bar.",
        low=1e-6,
        high=1e6,
        kind=float,
        label="Life size ×",
    ),
    Option("marks", NONE, "Marks to cut and to register by.", choices=(NONE, CROP, ALL)),
    Option("caption", "", "Text under the drawing."),
    Option("letter", "", "Letter in the upper left corner, such as A."),
    Option(
        "layers", AREAS, "A layer, or a plotter's file, for each area or pen, or for ink, paper.",
        choices=(AREAS, PENS, POLARITY),
    ),
    Option("press", None, "A calibrated press, pen or paper: dots are solved for it.", kind=str),
    Option("gain", None, "How much every edge grows in print; dots are solved for it.",
           "mm", -1, 1, kind=float),
    Option("least_dot", None, "Diameter of the smallest dots that the press holds.",
           "mm", 0, 10, kind=float),
)  # fmt: skip
"""Options of every picture."""

_DPI = "Pixels an inch."
_SORT = Option(
    "sort", False, "Dots in an order of little travel, for plotters and lasers.", label="Short ways"
)
_SVG = (
    Option(
        "round_dots",
        CIRCLES,
        "Round dots as circles, as strokes of few paths, or as pen taps.",
        choices=(CIRCLES, COMPOUND, TAPS),
    ),
    Option("decimals", None, "Decimals of positions in mm.", low=0, high=MAX_DECIMALS, kind=int),
    Option("paper", True, "White paper behind the dots; plotters never see it.",
           label="White paper"),
    _SORT,
)  # fmt: skip
_PLOTTING = (
    Option("pen_width", 0.3, "Width of the pen's line.", "mm", 0.01, 10),
    Option("feed", 2000.0, "Speed of drawing.", "mm/min", 1, 100_000),
    Option("travel", 6000.0, "Speed above the paper.", "mm/min", 1, 100_000),
    Option("lift_time", 0.15, "Time to lower and lift the pen.", "s", 0, 60),
    Option("sort", True, "Dots in an order of little travel.", label="Short ways"),
)
_GCODE = (
    *_PLOTTING,
    Option("pen_up", "M5", "Command that lifts the pen, such as G0Z3."),
    Option("pen_down", "M3S1000", "Command that lowers it, such as G1Z0F600."),
)

SVG = Format("SVG", (".svg",), "print, plotters, lasers", "svg.chunks", _SVG)
SVGZ = Format("SVG, compressed", (".svgz",), "print, in small files", "svg.zipped_chunks", _SVG)
PDF = Format("PDF", (".pdf",), "print, journals", "pdf.chunks")
EPS = Format("EPS", (".eps",), "older presses", "eps.chunks")
TIFF = Format(
    "TIFF",
    (".tif", ".tiff"),
    "journals",
    "tiff.chunks",
    (
        Option("dpi", 1200.0, _DPI, "dpi", 10, 9600, label="Resolution"),
        Option("bits", "1", "1: black or white; 8: grey edges.", choices=("1", "8")),
    ),
)
PNG = Format(
    "PNG",
    (".png",),
    "screens",
    "png.chunks",
    (
        Option("dpi", 300.0, _DPI, "dpi", 1e-3, 9600, label="Resolution"),
        Option("transparent", False, "Clear ground instead of white.", label="Clear ground"),
    ),
)
CSV = Format("CSV", (".csv",), "scripts", "table.csv_of", is_data=True)
JSON = Format("JSON", (".json",), "scripts", "table.json_chunks", is_data=True)
NPZ = Format("NPZ", (".npz",), "NumPy", "table.npz_chunks", is_data=True)
GCODE = Format(
    "G-code", (".gcode", ".nc"), "plotters", "plotter.gcode", _GCODE, a_file_a_layer=True
)
HPGL = Format("HPGL", (".hpgl", ".plt"), "plotters", "plotter.hpgl", _PLOTTING, a_file_a_layer=True)
DXF = Format(
    "DXF",
    (".dxf",),
    "lasers, CAD",
    "dxf.chunks",
    (
        Option("dots_as", CIRCLES, "Dots as circles and outlines, or as points.",
               choices=(CIRCLES, POINTS)),
        _SORT,
    ),
)  # fmt: skip
STIPPLE = Format("Stippler drawing", (".stipple",), "going on", "whole.chunks", is_data=True)

FORMATS = (SVG, SVGZ, PDF, EPS, TIFF, PNG, CSV, JSON, NPZ, GCODE, HPGL, DXF, STIPPLE)
ENDINGS = tuple(ending for one in FORMATS for ending in one.endings)


def format_of(path: str | Path) -> Format:
    """Return the format of a file's ending.

    Raises
    ------
    OutputError
        If no format has it.
    """
    ending = Path(path).suffix.lower()
    for one in FORMATS:
        if ending in one.endings:
            return one
    what = f"the ending {ending!r} is not written" if ending else "the name has no ending"
    raise OutputError(what, path, f"end it in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")


def format_named(name: str) -> Format:
    """Return the format that has an ending of this name, such as "svg".

    Raises
    ------
    ParameterError
        If no format has it.
    """
    ending = f".{name.lower().removeprefix('.')}"
    for one in FORMATS:
        if ending in one.endings:
            return one
    known = ", ".join(ending[1:] for ending in ENDINGS)
    raise ParameterError(f"{name!r} is no format", "format", f"choose one of {known}")


def options_of(one: Format) -> tuple[Option, ...]:
    """Return a format's own options, and those of every picture if it is one."""
    return (*one.options, *(() if one.is_data else PLATE))


@cache
def every_option() -> dict[str, tuple[Option, list[Format]]]:
    """Return all options by name, each as first declared, with the formats that have it."""
    found: dict[str, tuple[Option, list[Format]]] = {}
    for one in FORMATS:
        for option in options_of(one):
            found.setdefault(option.name, (option, []))[1].append(one)
    return found
