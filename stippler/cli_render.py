"""The command `render`: a picture made a drawing, or a drawing a file of another kind."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.cli_asked import Asked
from stippler.cli_ends import say_of
from stippler.errors import ParameterError
from stippler.names import shown
from stippler.spooled import STDIN, at_hand
from stippler.stopping import stops

if TYPE_CHECKING:
    from stippler.drawing.page import Page


def render_file(file: Path, output: Path, form: str, asked: Asked, exports: dict[str, Any]) -> None:
    """Write a picture as a drawing in a format (by the ending where `form` is empty)."""
    gc.disable()  # a short process that makes no cycles worth looking for; a tenth of its time
    from stippler.export import check_output

    check_output(output, [input_name(file)], form, **exports)
    from stippler.opening import is_drawing

    with at_hand(file) as at:
        if is_drawing(at):
            _write_again(file, at, output, form, exports, asked)
            return
        check_page(asked)
        from stippler.export import check_size
        from stippler.progress import stages_shown

        check_size(output, _page_of(at, asked.width_mm), form, **exports)
        _warn_of_memory(file, at, asked)
        with stages_shown() as show:
            from stippler.api import draw

            show("picture", 0, 1)
            drawing = draw(at, asked.style, tone=asked.tone, width_mm=asked.width_mm, show=show)
            show("write", 0, 1)
            drawing.save(output, form=form, **exports)
            stops.written = True
            show("write", 1, 1)
    for note in drawing.notes:
        say_of(file, note)


def _write_again(
    file: Path, at: Path, output: Path, form: str, exports: dict[str, Any], asked: Asked
) -> None:
    """Write a drawing, which can be read `at` a place, to a file of another kind."""
    if asked.options:
        name = "standard input" if str(file) == STDIN else shown(file)
        raise ParameterError(
            f"is of a picture, and {name} is a drawing already",
            min(asked.options.values()),
            "leave it out",
        )
    from stippler.api import open as open_drawing

    drawing = open_drawing(at)
    drawing.inputs = (at,)
    drawing.save(output, form=form, **exports)
    stops.written = True


def input_name(file: Path) -> str | Path:
    """Return a name under which an input can be told from outputs."""
    return "/dev/fd/0" if str(file) == STDIN else file


def _page_of(picture: Path, width_mm: float) -> Page:
    """Return the page that a picture will have."""
    from stippler.drawing.page import Page
    from stippler.files.read.picture import size_of_picture

    columns, rows = size_of_picture(picture)
    return Page(width_mm, width_mm * rows / columns)


def _warn_of_memory(file: Path, picture: Path, asked: Asked) -> None:
    """Say so before a job that will hardly fit into memory."""
    from stippler.drawing.style import DEFAULT_DOTS
    from stippler.files.read.picture import size_of_picture
    from stippler.jobs.preflight import warning

    columns, rows = size_of_picture(picture)
    if text := warning("stipple", asked.style.n_dots or DEFAULT_DOTS, columns * rows):
        say_of(file, text)


def check_page(asked: Asked) -> None:
    """Refuse a tone or a width that no page has, before any work."""
    from stippler.drawing.page import Page
    from stippler.files.read.picture import check_tone

    check_tone(asked.tone)
    Page(asked.width_mm, 1.0)
