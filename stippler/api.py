"""What `import stippler` offers."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from numbers import Integral
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.drawing.drawing import Drawing as _Drawing
from stippler.drawing.records import STYLE
from stippler.drawing.reference import Reference
from stippler.drawing.style import DEFAULT_DOTS, Style
from stippler.drawing.style_presets import preset
from stippler.errors import ParameterError, StipplerWarning
from stippler.jobs import preflight
from stippler.keywords import with_keywords
from stippler.stippling.stipple import Progress, notes_on, stages
from stippler.units import DEFAULT_WIDTH_MM

if TYPE_CHECKING:
    from shapely.geometry import MultiPolygon, Polygon

Tone = Literal["illustration", "linear", "perceptual"]


@dataclass(slots=True, eq=False)
class Drawing(_Drawing):
    """A drawing that can be saved, and shows itself in a notebook.

    Attributes
    ----------
    notes : tuple of str
        What the drawing falls short of, if anything: parts too dark for its dots, how much and
        where; dots that did not fit.
    inputs : tuple of Path
        The files it was made from; `save` writes over none of them.
    """

    notes: tuple[str, ...] = ()
    inputs: tuple[Path, ...] = ()

    def save(self, path: str | PathLike[str], *, form: str = "", **options: Any) -> list[Path]:
        """Write the drawing in the format that the file's ending chooses.

        Parameters
        ----------
        path : path
            Ends in .svg, .svgz, .pdf, .eps, .tif, .png, .csv, .json, .npz, .gcode, .hpgl
            or .dxf; .stipple keeps all of the drawing.
        form : str
            The format by its ending, whatever the file's own.
        options
            Such as ``dpi=600``, ``print_width=86`` or ``profile="elsevier"``; see
            `stippler.export.save` and ``docs/exports.md``.

        Returns
        -------
        list of Path
            The files written; more than one where a format wants a file a pen.
        """
        from stippler.export import check_output, save

        check_output(Path(path), self.inputs, form, **options)
        _warn_of(preflight.saving_warning(self, Path(path), options.get("dpi")))
        return save(self, Path(path), inputs=self.inputs, form=form, **options)

    def _repr_svg_(self) -> str:
        from stippler.files.write.svg import svg_chunks

        return b"".join(svg_chunks(self)).decode()


@with_keywords
def stipple(
    image: Any,
    dots: int | None = None,
    width: float = DEFAULT_WIDTH_MM,
    *,
    tone: Tone = "illustration",
    style: Style | str | None = None,
    **keywords: Any,
) -> Drawing:
    """Turn a picture into a stipple drawing.

    Parameters
    ----------
    image : path, Pillow image or array
        Arrays hold grey or RGB, with or without alpha: integers over their type's range, or
        floats from 0 (black) to 1 (white).
    dots : int, optional
        How many; None: as many as suit the page and the picture, or what the size range asks for.
    width : float, mm
        Width of the page; the height follows.
    tone : {"illustration", "linear", "perceptual"}
        As an illustrator would draw it, from the picture's own histogram, with deep parts just
        open; or true at arm's length: ink replaces the picture's light; or its encoded values.
    style : Style or str, optional
        How it is drawn, or the name of a style that comes with the program, such as "wood" (see
        ``docs/styles.md``); what is given beside it counts before it.
    {keywords}

    Returns
    -------
    Drawing

    Raises
    ------
    PictureError
        If the picture cannot be read.
    ParameterError
        If a value is outside its range, or a keyword is unknown.

    Notes
    -----
    Same values, same drawing, whatever the number of threads. Deussen et al. 2000, sections 4.2
    and 4.3.
    """
    if dots is not None:
        keywords["dots"] = dots
    made = Style.of(_style(style), **keywords)
    n_dots = made.n_dots or DEFAULT_DOTS
    _warn_of(preflight.warning("stipple", n_dots, _n_pixels(image)))
    return draw(image, made, tone=tone, width_mm=width)


def draw(
    image: Any,
    style: Style,
    *,
    tone: str,
    width_mm: float,
    show: Callable[[str, int, int], None] | None = None,
) -> Drawing:
    """Draw a picture in a style."""
    told: list[str] = []
    reference = _reference(image, tone, width_mm, told)
    last: Progress | None = None
    for last in stages(reference, style, snapshots=False):
        if show is not None:
            show(last.stage, last.done, last.total)
    assert last is not None, "stages() yields at least its end"
    drawing = Drawing.from_reference(reference, last.position_mm, last.radius_mm, style)
    drawing.notes = (*told, *notes_on(last))
    if isinstance(image, str | PathLike):
        drawing.inputs = (Path(image),)
    return drawing


@with_keywords
def process(
    drawing: _Drawing,
    area: int | str | Sequence[int | str],
    *,
    style: Style | str | None = None,
    **keywords: Any,
) -> Drawing:
    """Stipple areas of a drawing anew; all others stay untouched.

    Parameters
    ----------
    drawing : Drawing
        With a picture; not modified.
    area : int, str or a sequence of them
        Ids or names of areas. They are made one after the other; their fixed dots stay.
    style : Style or str, optional
        For these areas from now on; left out, each keeps its own. What is given beside it counts
        before it. Areas of one style share its number of dots, by their ink. A border that is
        given is the areas' own: it alone gives them no other style.
    {keywords}

    Returns
    -------
    Drawing

    Raises
    ------
    ParameterError
        If there is no such area, or no picture, or a value is outside its range.
    GeometryError
        If none of the areas has room for dots; those that have none are left out else, and named
        in `notes`.

    Notes
    -----
    Deussen et al. 2000, section 4: each area is processed on its own.
    """
    from stippler.drawing.document import Document
    from stippler.drawing.one_step import as_one_step
    from stippler.jobs.processing import process_now

    wanted = [area] if isinstance(area, int | str) else list(area)
    made = drawing.snapshot()
    ids = [area_id(made, one) for one in wanted]
    if style is not None or keywords:
        _restyle(made, ids, style, keywords)
    styles = [made.style_of(k) for k in ids]
    _warn_of(preflight.processing_warning(made, styles))
    document = Document(made)
    as_one_step(document, "Areas", lambda d: d.own_by_place(np.arange(len(d.dots))))
    notes = process_now(document, ids)
    out = Drawing(**{f.name: getattr(made, f.name) for f in fields(_Drawing)})
    out.notes, out.inputs = notes, getattr(drawing, "inputs", ())
    return out


def _style(style: Style | str | None) -> Style | None:
    return preset(style) if isinstance(style, str) else style


def area_id(drawing: _Drawing, area: int | str) -> int:
    """Return the id of an area that is told by its id or its name."""
    if isinstance(area, int):
        found = [area] if area in drawing.areas else []
    else:
        found = [k for k, one in drawing.areas.items() if one.name == area]
    if not found:
        known = ", ".join(f"{k} ({one.name})" for k, one in sorted(drawing.areas.items())[:20])
        raise ParameterError(f"there is no area {area!r}", "area", f"one of {known}")
    if len(found) > 1:
        raise ParameterError(f"{area!r} names {len(found)} areas", "area", "give its id")
    return found[0]


def _restyle(
    drawing: _Drawing, ids: list[int], style: Style | str | None, keywords: dict[str, Any]
) -> None:
    """Give areas a style of their own, and a border beside it."""
    if (border := keywords.pop("border", None)) is not None:
        for k in ids:
            drawing.areas[k] = replace(drawing.areas[k], border=border)
    if style is None and not keywords:
        return
    made = {k: Style.of(_style(style) or drawing.style_of(k), **keywords) for k in ids}
    for k, one in made.items():
        i = drawing.first_free(STYLE)
        drawing.styles[i] = one
        drawing.next_id[STYLE] = i + 1
        drawing.areas[k] = replace(drawing.areas[k], style=i)


def open(path: str | PathLike[str]) -> Drawing:
    """Open a drawing.

    Parameters
    ----------
    path : path
        A ``.stipple`` file, or a table of dots (.csv), whose page is as large as they need.

    Raises
    ------
    DrawingFileError
        If the drawing is damaged, or was written by a later version.
    TableError
        If the table cannot be read.
    """
    from stippler.opening import open_file

    drawing = open_file(Path(path))
    return Drawing(**{f.name: getattr(drawing, f.name) for f in fields(_Drawing)})


def pulse_density(
    image: Any,
    dots: int = 20_000,
    *,
    tone: Tone = "linear",
    area: Any = None,
    growth: str = "circular",
    start: str = "top",
    seed: int = 1,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Halftone a picture into dots by pulse-density modulation, without relaxation.

    Parameters
    ----------
    image : path, Pillow image or array
        As for `stipple`.
    dots : int
        How many.
    tone, growth, start, seed
        As for `stipple`.
    area : shapely Polygon or MultiPolygon, or (m, 2) array, px, optional
        Only what lies inside gets dots; with ``start="border"`` they line up with its outline.

    Returns
    -------
    points : (n, 2) float64, px
        Centres, x right and y down, (0, 0) at the top left corner of the picture.
    radii : (n,) float64, px

    Notes
    -----
    Deussen et al. 2000, section 4.2; Eschbach 1990.
    """
    from stippler.stippling.stipple import pulse_density as halftone

    _warn_of(preflight.warning("stipple", _number(dots), _n_pixels(image)))
    inside = None if area is None else _polygon(area)
    return halftone(
        _darkness(image, tone), dots=dots, growth=growth, start=start, seed=seed, area=inside
    )


def fill(
    area: Any, n: int, arrangement: str = "hexagonal", *, seed: int = 1
) -> NDArray[np.float64]:
    """Fill an area with dots, without a picture.

    Parameters
    ----------
    area : shapely Polygon or MultiPolygon, or (m, 2) array
    n : int
        How many; a hexagonal grid has about so many.
    arrangement : {"hexagonal", "random"}
    seed : int
        Chooses the random ones.

    Returns
    -------
    (k, 2) float64, in the area's unit
    """
    from stippler.stippling.initial_points import fill_area

    _warn_of(preflight.warning("fill", _number(n)))
    return fill_area(_polygon(area), n, arrangement, seed)


def relax(
    points: ArrayLike,
    polygon: Any,
    iterations: int = 20,
    fixed: ArrayLike | None = None,
    density: Any = None,
    *,
    method: str = "lloyd",
    compartment_of_dot: ArrayLike | None = None,
    tolerance_mm: float = 0.0,
    over_relaxation: float = 1.0,
) -> NDArray[np.float64]:
    """Move points to the centroids of their cells; see `stippler.stippling.relax.relax`."""
    from stippler.stippling.relax import relax as run

    _warn_of(preflight.warning("relax", math.prod(_shape(points)) // 2))
    return run(
        points,
        polygon,
        iterations,
        fixed,
        density,
        method=method,
        compartment_of_dot=compartment_of_dot,
        tolerance_mm=tolerance_mm,
        over_relaxation=over_relaxation,
    )


def _warn_of(text: str) -> None:
    """Tell whoever called the function that calls this; nothing, if there is nothing to tell."""
    if text:
        warnings.warn(text, StipplerWarning, stacklevel=3)


def _n_pixels(image: Any) -> int:
    """Return how many pixels a picture has, as far as that can be told without reading it."""
    if isinstance(image, str | PathLike):
        from stippler.files.read.picture import size_of_picture

        columns, rows = size_of_picture(Path(image))
        return columns * rows
    shape = image.size if hasattr(image, "getbands") else _shape(image)
    return math.prod(shape[:2]) if shape else 0


def _shape(values: Any) -> tuple[int, ...]:
    """Return the shape of an array; that it is none is told by what takes it."""
    try:
        return np.shape(values)
    except ValueError:
        return (0,)


def _number(value: Any) -> int:
    """Return a whole number; that it is none is told by what takes it."""
    return int(value) if isinstance(value, Integral) else 0


def _polygon(area: Any) -> Polygon | MultiPolygon:
    from stippler.stippling.compartments import polygon_of

    return polygon_of(area, "area")


def _reference(image: Any, tone: str, width_mm: float, notes: list[str]) -> Reference:
    """Return what tone is taken from; of a file it keeps the file."""
    if isinstance(image, str | PathLike):
        from stippler.files.read.picture import read_picture

        return read_picture(Path(image), tone=tone, width_mm=width_mm, notes=notes)
    return Reference(_darkness(image, tone, notes), width_mm)


def _darkness(image: Any, tone: str, notes: list[str] | None = None) -> NDArray[np.float32]:
    from PIL import Image

    from stippler.files.read import picture

    picture.check_tone(tone)
    if isinstance(image, str | PathLike):
        return picture.read_darkness(Path(image), tone, notes)
    if isinstance(image, Image.Image):
        return picture.darkness_of_image(image, tone)
    if image is None:
        raise ParameterError("is missing", "image", "give a path, a Pillow image or an array")
    return picture.darkness_of_array(image, tone)
