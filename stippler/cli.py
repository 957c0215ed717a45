"""The command line: edit, render, stats, bench and info."""

from __future__ import annotations

import gc
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer
from typer.exceptions import TyperException

from stippler.errors import ParameterError, StipplerError
from stippler.kernels.machine.numba_import import skip_blas
from stippler.units import DEFAULT_WIDTH_MM

if TYPE_CHECKING:
    from stippler.stippling.plan import Plan


_INTERRUPTED = 130
COMMANDS = ("edit", "render", "stats", "bench", "info")

app = typer.Typer(
    add_completion=False,
    no_args_is_help=False,
    rich_markup_mode=None,
    help="Stipple drawings: tens of thousands of ink dots, from a picture.",
    epilog="stippler photo.jpg opens the editor; stippler alone opens it on a sample.",
)

Dots = Annotated[
    int | None, typer.Option(help="Number of dots; 20,000, or what --size-range asks for.")
]
SizeRange = Annotated[
    str | None,
    typer.Option(metavar="MIN:MAX", help="Dot radii in mm; 1:2, as large as --dots asks for."),
]
Width = Annotated[float, typer.Option(help="Page width in mm; the height follows.")]
Iterations = Annotated[int, typer.Option(help="Relaxation steps.")]
Seed = Annotated[int, typer.Option(help="Same seed, same drawing.")]
ToneOption = Annotated[
    str, typer.Option(metavar="linear|perceptual", help="Ink for light, or for the file's numbers.")
]
FirstDots = Annotated[
    str,
    typer.Option(metavar="METHOD", help="pulse-density, floyd-steinberg, random or hexagonal."),
]
Growth = Annotated[
    str, typer.Option(metavar="circular|triangular", help="How pulse-density regions grow.")
]
Start = Annotated[str, typer.Option(metavar="top|border", help="Where pulse-density begins.")]
Sizes = Annotated[
    str,
    typer.Option(
        metavar="tone|regions", help="Dot sizes solved for the tone, or the paper's by region."
    ),
]
Spacing = Annotated[
    str,
    typer.Option(
        metavar="METHOD",
        help="even (no rows), or lloyd, delaunay-mean, springs, as in the paper.",
    ),
]
Unweighted = Annotated[
    bool, typer.Option("--unweighted", help="Relax as the paper does, whatever the tone.")
]
PenOption = Annotated[
    str,
    typer.Option(
        "--pen", metavar="NAME", help="technical-pen, quill, brush, rough-paper or stick."
    ),
]


def _version(shown: bool) -> None:
    if shown:
        from stippler import __version__

        typer.echo(f"stippler {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    pass


_VALUES = {
    "dots": "n_dots",
    "size_range": "size_range_mm",
    "width": "width_mm",
    "unweighted": "weighted",
}


def _given(context: typer.Context) -> set[str]:
    """Return the values that stand on the command line, by the names that plans have for them."""
    return {
        _VALUES.get(name, name)
        for name in context.params
        if (source := context.get_parameter_source(name)) and source.name == "COMMANDLINE"
    }


@app.command()
def edit(
    context: typer.Context,
    file: Annotated[Path | None, typer.Argument(help="A picture; without one, a sample.")] = None,
    dots: Dots = None,
    size_range: SizeRange = None,
    width: Width = DEFAULT_WIDTH_MM,
    iterations: Iterations = 20,
    seed: Seed = 1,
    tone: ToneOption = "linear",
    first_dots: FirstDots = "pulse-density",
    growth: Growth = "circular",
    start: Start = "top",
    sizes: Sizes = "tone",
    spacing: Spacing = "even",
    unweighted: Unweighted = False,
    pen: PenOption = "technical-pen",
) -> None:
    """Open the editor."""
    plan = _plan(
        n_dots=dots,
        size_range_mm=_size_range(size_range),
        iterations=iterations,
        seed=seed,
        first_dots=first_dots,
        growth=growth,
        start=start,
        sizes=sizes,
        spacing=spacing,
        weighted=not unweighted,
        pen=pen,
    )
    _check_page(tone, width)
    if file is not None:
        from stippler.files.read.picture import check_picture

        check_picture(file)  # before a window opens
    from stippler.app import edit as open_editor

    given = _given(context)
    raise typer.Exit(open_editor(file or _sample(), plan, tone=tone, width_mm=width, given=given))


@app.command()
def render(
    file: Annotated[Path, typer.Argument(help="A picture.")],
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Drawing to write: .svg, .png or .csv.")
    ],
    dots: Dots = None,
    width: Width = DEFAULT_WIDTH_MM,
    iterations: Iterations = 20,
    seed: Seed = 1,
    dpi: Annotated[float, typer.Option(help="Pixels an inch of a .png.")] = 300.0,
    tone: ToneOption = "linear",
    size_range: SizeRange = None,
    first_dots: FirstDots = "pulse-density",
    growth: Growth = "circular",
    start: Start = "top",
    sizes: Sizes = "tone",
    spacing: Spacing = "even",
    unweighted: Unweighted = False,
    pen: PenOption = "technical-pen",
) -> None:
    """Turn a picture into a drawing, without a window."""
    gc.disable()  # a short process that makes no cycles worth looking for; a tenth of its time
    from stippler.export import check_output

    check_output(output, dpi, [file])
    plan = _plan(
        n_dots=dots,
        size_range_mm=_size_range(size_range),
        iterations=iterations,
        seed=seed,
        first_dots=first_dots,
        growth=growth,
        start=start,
        sizes=sizes,
        spacing=spacing,
        weighted=not unweighted,
        pen=pen,
    )
    _check_page(tone, width)
    from stippler.progress import stages_shown

    with stages_shown() as show:
        from stippler.api import draw

        show("picture", 0, 1)
        drawing = draw(file, plan, tone=tone, width_mm=width, show=show)
        show("write", 0, 1)
        drawing.save(output, dpi=dpi)
        show("write", 1, 1)
    for note in drawing.notes:
        typer.echo(f"stippler: {file}: {note}", err=True)


@app.command()
def stats(
    context: typer.Context,
    file: Annotated[Path, typer.Argument(help="A .csv from render, or a picture to draw.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    reference: Annotated[
        Path | None, typer.Option(help="For a .csv: the picture that its ink should meet.")
    ] = None,
    dots: Dots = None,
    width: Width = DEFAULT_WIDTH_MM,
    iterations: Iterations = 20,
    seed: Seed = 1,
    tone: ToneOption = "linear",
    size_range: SizeRange = None,
    first_dots: FirstDots = "pulse-density",
    growth: Growth = "circular",
    start: Start = "top",
    sizes: Sizes = "tone",
    spacing: Spacing = "even",
    unweighted: Unweighted = False,
) -> None:
    """Print the number of dots, their spacing, spectrum and tone error.

    A picture is drawn as render would draw it with the same options, and nothing is written. For a
    .csv, --reference, --width and --tone say what it was drawn from.
    """
    _check_page(tone, width)
    from stippler import stats as statistics

    if file.suffix.lower() == ".csv":
        given = _given(context) - {"file", "as_json", "reference", "width_mm", "tone"}
        if given:
            raise ParameterError(
                "is drawn already", file, "leave out all but --reference, --width and --tone"
            )
        report = statistics.of_table(file, reference, tone=tone, width_mm=width)
    else:
        if reference is not None:
            raise ParameterError("is for a .csv", "reference", "a picture is its own")
        plan = _plan(
            n_dots=dots,
            size_range_mm=_size_range(size_range),
            iterations=iterations,
            seed=seed,
            first_dots=first_dots,
            growth=growth,
            start=start,
            sizes=sizes,
            spacing=spacing,
            weighted=not unweighted,
        )
        report, notes = statistics.of_picture(file, plan, tone=tone, width_mm=width)
        for note in notes:
            typer.echo(f"stippler: {file}: {note}", err=True)
    typer.echo(statistics.as_json(report) if as_json else statistics.as_text(report))


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


def _plan(**values: Any) -> Plan:
    from stippler.stippling.plan import Plan

    return Plan(**values)


def _size_range(text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    low, colon, high = text.partition(":")
    try:
        return float(low), float(high if colon else low)
    except ValueError:
        raise ParameterError(
            f"{text!r} is no range", "size range", "give MIN:MAX in mm, such as 0.15:0.3"
        ) from None


def _check_page(tone: str, width_mm: float) -> None:
    from stippler.drawing.drawing import Page
    from stippler.files.read.picture import check_tone

    check_tone(tone)
    Page(width_mm, 1.0)


def _terminate(signum: int, frame: Any) -> NoReturn:
    raise KeyboardInterrupt


def main() -> None:
    """Run the command line and end the process: 0 done, 1 failed, 2 usage, 130 interrupted."""
    signal.signal(signal.SIGTERM, _terminate)
    skip_blas()
    args = sys.argv[1:]
    if not args or args[0] not in (*COMMANDS, "--help", "--version"):
        args = ["edit", *args]  # `stippler photo.jpg`
    try:
        status = app(args, prog_name="stippler", standalone_mode=False)
        if status == _INTERRUPTED:  # typer's word for Ctrl-C
            raise KeyboardInterrupt
    except TyperException as error:
        status = _fail(error.format_message(), error.exit_code, f"see stippler {args[0]} --help")
    except ParameterError as error:
        status = _fail(str(error), 2)
    except StipplerError as error:
        status = _fail(str(error), 1)
    except (KeyboardInterrupt, typer.Abort):
        status = _fail(
            "stopped; nothing was written" if args[0] == "render" else "stopped", _INTERRUPTED
        )
    except MemoryError:
        status = _fail("not enough memory; ask for fewer dots or a smaller picture", 1)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = 1
    sys.exit(status or 0)


def program() -> None:
    """Run `main` as a process; a render ends without taking the interpreter apart.

    Numba's machine code takes half a second to be disposed of, and all files are closed by then.
    """
    try:
        main()
    except SystemExit as stop:
        if sys.argv[1:2] != ["render"]:
            raise
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(int(stop.code or 0))


def _fail(message: str, status: int, do: str = "") -> int:
    line = f"stippler: {message.rstrip('.')}{'; ' + do if do else ''}"
    typer.echo(" ".join(line.split()), err=True)
    return status
