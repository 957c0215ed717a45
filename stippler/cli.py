"""The command line: edit, render, stats, bench and info."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.exceptions import TyperException

from stippler.cli_asked import Asked
from stippler.cli_check import calibrate, check
from stippler.cli_ends import ended, say_of, say_what_matters
from stippler.cli_options import with_export_options, with_only_style_options, with_style_options
from stippler.cli_render import check_page, input_name, render_file
from stippler.errors import ParameterError
from stippler.kernels.machine.numba_import import skip_blas
from stippler.names import shown
from stippler.spooled import at_hand
from stippler.stopping import fail, stops

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing


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
    check_page(asked)
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
    render_file(file, output, form, asked, exports)


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

    check_output(output, [input_name(file)], "")
    drawing = open_drawing(file)
    areas = _area_ids(drawing, area)
    made = process_areas(drawing, areas, style=asked.base, **asked.keywords)
    made.inputs = (file,)
    made.save(output)
    stops.written = True
    for note in made.notes:
        say_of(file, note)


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
        say_of(file, note)
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
    check_page(asked)
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
                say_of(file, note)
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


def _is_table(file: Path, at: Path) -> bool:
    """Return whether a file is a table of dots, by its name or, piped, by what is in it."""
    if at == file:
        return file.suffix.lower() in (".csv", ".tsv")
    from stippler.files.read.kinds import HEAD_BYTES, is_table

    with at.open("rb") as stream:
        return is_table(stream.read(HEAD_BYTES))


def run(args: list[str]) -> int:
    """Carry out a command; return the exit code, having said in one line what went wrong."""
    skip_blas()
    say_what_matters()
    if not args or args[0] not in (*COMMANDS, "--help", "--version", "--install-desktop"):
        args = ["edit", *args]  # `stippler photo.jpg`
    return ended(lambda: _parsed(args))


def _parsed(args: list[str]) -> int:
    try:
        return int(app(args, prog_name="stippler", standalone_mode=False) or 0)
    except TyperException as error:
        return fail(error.format_message(), error.exit_code, f"see stippler {args[0]} --help")
    except typer.Abort:
        return fail(stops.line(), _INTERRUPTED)
