"""The command line: edit, render, stats, bench and info."""

from __future__ import annotations

import gc
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.exceptions import TyperException

from stippler.cli_check import calibrate, check
from stippler.cli_options import (
    Asked,
    with_export_options,
    with_only_style_options,
    with_style_options,
)
from stippler.errors import ParameterError, StipplerError, StipplerWarning
from stippler.kernels.machine.numba_import import skip_blas
from stippler.names import shown
from stippler.spooled import STDIN, at_hand
from stippler.stopping import fail, stops

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.page import Page


_INTERRUPTED = 130
COMMANDS = ("edit", "render", "process", "scale", "stats", "check", "calibrate", "bench", "info")

app = typer.Typer(
    add_completion=False,
    no_args_is_help=False,
    rich_markup_mode=None,
    help="Stipple drawings: tens of thousands of ink dots, from a picture.",
    epilog="stippler photo.jpg opens the editor; stippler alone opens it on a sample.",
)

Seed = Annotated[int, typer.Option(help="Same seed, same drawing.")]


def _version(shown: bool) -> None:
    if shown:
        from stippler.version import VERSION

        typer.echo(f"stippler {VERSION}")
        raise typer.Exit


def _install_desktop(wanted: bool) -> None:
    if wanted:
        from stippler.desktop import install

        for path in install():
            typer.echo(f"{shown(path)} is written")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
    install_desktop: Annotated[
        bool,
        typer.Option(
            "--install-desktop",
            callback=_install_desktop,
            is_eager=True,
            help="Put the program into the menus of a Linux desktop.",
        ),
    ] = False,
) -> None:
    pass


@app.command()
@with_style_options
def edit(
    context: typer.Context,
    file: Annotated[
        Path | None, typer.Argument(help="A picture or a drawing; without one, a sample.")
    ] = None,
    *,
    asked: Asked,
) -> None:
    """Open the editor."""
    _check_page(asked)
    with at_hand(file or _sample()) as picture:
        if file is not None:
            from stippler.files.read.picture import check_picture
            from stippler.opening import is_drawing

            if not is_drawing(picture):
                check_picture(picture)  # before a window opens
        from stippler.app import edit as open_editor

        raise typer.Exit(
            open_editor(
                picture, asked.style, tone=asked.tone, width_mm=asked.width_mm,
                given=set(asked.options),
            )
        )  # fmt: skip


@app.command()
@with_export_options
@with_style_options
def render(
    context: typer.Context,
    file: Annotated[Path, typer.Argument(help="A picture, or a drawing (.stipple, .csv).")],
    output: Annotated[
        Path,
        typer.Option("-o", "--output", help="File to write, by its ending; - for output."),
    ],
    form: Annotated[
        str,
        typer.Option("--format", metavar="NAME", help="Format, whatever the ending."),
    ] = "",
    *,
    asked: Asked,
    exports: dict[str, Any],
) -> None:
    """Turn a picture into a drawing, or a drawing into a file of another kind, without a window."""
    gc.disable()  # a short process that makes no cycles worth looking for; a tenth of its time
    from stippler.export import check_output

    check_output(output, [_input(file)], form, **exports)
    from stippler.opening import is_drawing

    with at_hand(file) as at:
        if is_drawing(at):
            _write_again(file, at, output, form, exports, asked)
            return
        _check_page(asked)
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
        _note(file, note)


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


@app.command()
@with_only_style_options
def process(
    context: typer.Context,
    file: Annotated[Path, typer.Argument(help="A drawing (.stipple) with a picture.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="File to write, by its ending.")],
    area: Annotated[
        list[str], typer.Option(metavar="NAME", help="Name or number of an area; several times.")
    ],
    *,
    asked: Asked,
) -> None:
    """Stipple areas of a drawing anew, all others untouched; what is given is their style then."""
    from stippler.api import open as open_drawing
    from stippler.api import process as process_areas
    from stippler.export import check_output

    check_output(output, [_input(file)], "")
    drawing = open_drawing(file)
    areas = _area_ids(drawing, area)
    made = process_areas(drawing, areas, style=asked.base, **asked.keywords)
    made.inputs = (file,)
    made.save(output)
    stops.written = True
    for note in made.notes:
        _note(file, note)


def _area_ids(drawing: Drawing, told: list[str]) -> list[int]:
    """Return the ids of areas that are told by name or id; a name counts before an id."""
    from stippler.api import area_id

    named = {one.name for one in drawing.areas.values()}
    return [
        area_id(drawing, int(one) if one.isdecimal() and one not in named else one) for one in told
    ]


@app.command()
def scale(
    file: Annotated[Path, typer.Argument(help="A drawing (.stipple, .csv).")],
    output: Annotated[Path, typer.Option("-o", "--output", help="File to write, by its ending.")],
    by: Annotated[float, typer.Option(help="Size in percent.")] = 100.0,
    dots: Annotated[int | None, typer.Option(help="Number of dots; else as the size asks.")] = None,
    least_radius: Annotated[
        float, typer.Option(help="No dot is smaller than this radius, in mm.")
    ] = 0.0,
    area: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Name or number of an area; several times. Else all."),
    ] = None,
    seed: Seed = 1,
) -> None:
    """Scale a drawing, or areas of it, to another size or number of dots, keeping its tone."""
    from stippler.api import open as open_drawing
    from stippler.stippling.scale import Scaling, patterns_aside, scaled_drawing
    from stippler.stippling.scale_areas import scaled_areas

    before = open_drawing(file)
    for note in patterns_aside(before):
        _note(file, note)
    how = Scaling(by / 100.0, dots, least_radius, seed)
    if area:
        drawing = scaled_areas(before, _area_ids(before, area), how)
    else:
        drawing = scaled_drawing(before, how)
    drawing.inputs = (file,)
    drawing.save(output)
    stops.written = True


@app.command()
@with_style_options
def stats(
    context: typer.Context,
    file: Annotated[Path, typer.Argument(help="A drawing (.stipple, .csv), or a picture to draw.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    reference: Annotated[
        Path | None, typer.Option(help="For a drawing: the picture that its ink should meet.")
    ] = None,
    *,
    asked: Asked,
) -> None:
    """Print the number of dots, their spacing, spectrum and tone error.

    A picture is drawn as render would draw it with the same options, and nothing is written. For a
    .csv, --reference, --width and --tone say what it was drawn from; a .stipple knows.
    """
    _check_page(asked)
    from stippler.opening import is_drawing

    with at_hand(file) as at, at_hand(reference or file) as seen:
        from stippler import stats as statistics

        if not _is_table(file, at) and is_drawing(at):
            if asked.options.keys() - {"tone"}:
                raise ParameterError(
                    "is drawn already", file, "leave out all but --reference and --tone"
                )
            report = statistics.of_drawing(at, None if reference is None else seen, tone=asked.tone)
        elif _is_table(file, at):
            if asked.options.keys() - {"width_mm", "tone"}:
                raise ParameterError(
                    "is drawn already", file, "leave out all but --reference, --width and --tone"
                )
            report = statistics.of_table(
                at, None if reference is None else seen, tone=asked.tone, width_mm=asked.width_mm
            )
        else:
            if reference is not None:
                raise ParameterError("is for a drawing", "reference", "a picture is its own")
            report, notes = statistics.of_picture(
                at, asked.style, tone=asked.tone, width_mm=asked.width_mm
            )
            for note in notes:
                _note(file, note)
    typer.echo(statistics.as_json(report) if as_json else statistics.as_text(report))


app.command()(check)
app.command()(calibrate)


@app.command()
def bench(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    quick: Annotated[bool, typer.Option(help="Smaller sizes.")] = False,
    only: Annotated[str, typer.Option(help="Topics, by comma.")] = "",
) -> None:
    """Measure every performance figure on this machine."""
    from stippler.resources import benchmarks

    sys.path.insert(0, str(benchmarks().parent))
    from benchmarks.all import main as run  # type: ignore[import-not-found,unused-ignore]

    raise typer.Exit(run(as_json=as_json, quick=quick, only=only))


@app.command()
def info() -> None:
    """Show versions, GL, cores and folders."""
    from stippler.about import lines

    for line in lines():
        typer.echo(line)


def _sample() -> Path:
    from stippler.resources import assets

    return assets() / "samples" / "ammonite.png"


def _input(file: Path) -> str | Path:
    """Return a name under which an input can be told from outputs."""
    return "/dev/fd/0" if str(file) == STDIN else file


def _is_table(file: Path, at: Path) -> bool:
    """Return whether a file is a table of dots, by its name or, piped, by what is in it."""
    if at == file:
        return file.suffix.lower() in (".csv", ".tsv")
    from stippler.files.read.kinds import HEAD_BYTES, is_table

    with at.open("rb") as stream:
        return is_table(stream.read(HEAD_BYTES))


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
        _note(file, text)


def _note(file: Path, note: str) -> None:
    """Say what is to be known of a drawing."""
    fail(f"{shown(file)}: {note}", 0)


def _tell(message: Warning | str, category: type[Warning], *_: object, **__: object) -> None:
    """Say what is to be known, in a line."""
    if issubclass(category, StipplerWarning):
        fail(str(message), 0)


def _check_page(asked: Asked) -> None:
    from stippler.drawing.page import Page
    from stippler.files.read.picture import check_tone

    check_tone(asked.tone)
    Page(asked.width_mm, 1.0)


def run(args: list[str]) -> int:
    """Carry out a command; return the exit code, having said in one line what went wrong."""
    skip_blas()
    if not sys.warnoptions:
        warnings.simplefilter("ignore")  # of libraries, about files; what matters is told by us
        warnings.simplefilter("always", StipplerWarning)
        warnings.showwarning = _tell
    if not args or args[0] not in (*COMMANDS, "--help", "--version", "--install-desktop"):
        args = ["edit", *args]  # `stippler photo.jpg`
    try:
        return int(app(args, prog_name="stippler", standalone_mode=False) or 0)
    except TyperException as error:
        return fail(error.format_message(), error.exit_code, f"see stippler {args[0]} --help")
    except ParameterError as error:
        return fail(str(error), 2)
    except StipplerError as error:
        return fail(str(error), 1)
    except MemoryError:
        return fail("not enough memory; ask for fewer dots or a smaller picture", 1)
    except typer.Abort:
        return fail(stops.line(), _INTERRUPTED)
