"""The commands `check` and `calibrate`: what print would spoil, and how much ink spreads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stippler.errors import ParameterError

if TYPE_CHECKING:
    from stippler.files.checks import Process

FILE = Annotated[Path, typer.Argument(help="A drawing: .stipple or .csv.")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="File for what is repaired.")]
PROFILE = Annotated[str | None, typer.Option(help="Width, dpi and least dot of a publisher.")]
COLUMN = Annotated[str | None, typer.Option(help="Which of the profile's widths.")]
WIDTH = Annotated[float | None, typer.Option(metavar="MM", help="Width in print.")]
LEAST_DOT = Annotated[float | None, typer.Option(metavar="MM", help="Least diameter of dots.")]
LEAST_GAP = Annotated[float, typer.Option(metavar="MM", help="Least gap between dots.")]
GAIN = Annotated[
    float | None, typer.Option(metavar="MM", help="How much edges grow as ink spreads.")
]
PRESS = Annotated[
    str | None, typer.Option(metavar="NAME", help="Gain and least dot of a calibrated press.")
]
NAME = Annotated[
    str, typer.Option(metavar="PRESS", help="Keep the gain under a name, for --press.")
]
DPI = Annotated[float | None, typer.Option(help="Of a 1-bit picture.")]
SMALLER = Annotated[bool, typer.Option("--compensate", help="Make dots smaller by the gain, too.")]
MEASURED = Annotated[
    str, typer.Option(metavar="SHARES", help="What the patches measured: 0.12,0.24,...")
]


def check(
    file: FILE,
    profile: PROFILE = None,
    column: COLUMN = None,
    print_width: WIDTH = None,
    least_dot: LEAST_DOT = None,
    least_gap: LEAST_GAP = 0.05,
    gain: GAIN = None,
    press: PRESS = None,
    dpi: DPI = None,
    compensate: SMALLER = False,
    output: OUTPUT = None,
) -> None:
    """Count what print would spoil; with -o, write the drawing with that repaired."""
    gain, least_dot = _with_press(press, gain, least_dot)
    process = _process(profile, column, print_width, least_dot, least_gap, gain, dpi)
    from dataclasses import replace

    from stippler.api import open as open_drawing
    from stippler.files import checks

    if output is not None:
        from stippler.export import check_output

        check_output(output, [file])
    drawing = open_drawing(file)
    lines = checks.check(drawing, process).lines()
    typer.echo("\n".join(lines) if lines else "nothing that print would spoil")
    if output is None:
        return
    drawing.dots = checks.repaired(drawing, process)
    if compensate:
        drawing.dots = checks.compensated(drawing, process)
        process = replace(process, gain_mm=0.0)
    left = checks.check(drawing, process).lines()
    drawing.inputs = (file,)
    drawing.save(output)
    typer.echo(f"repaired; left: {'; '.join(left) or 'nothing'}")


def _with_press(
    name: str | None, gain: float | None, least_dot: float | None
) -> tuple[float, float | None]:
    """Return gain and least dot, a press's where they are not given."""
    if name is not None:
        from stippler.files.presses import press_named

        press = press_named(name)
        gain = press.gain_mm if gain is None else gain
        least_dot = press.least_dot_mm or None if least_dot is None else least_dot
    return 0.01 if gain is None else max(gain, 0.0), least_dot


def _process(
    profile: str | None,
    column: str | None,
    print_width: float | None,
    least_dot: float | None,
    least_gap: float,
    gain: float,
    dpi: float | None,
) -> Process:
    from stippler.files.checks import Process
    from stippler.files.write.profiles import profile_named

    least = 0.1 if least_dot is None else least_dot
    if profile is not None:
        one = profile_named(profile)
        print_width = one.width_mm(column) if print_width is None else print_width
        dpi = one.dpi if dpi is None else dpi
        if least_dot is None and one.smallest_line_mm is not None:
            least = one.smallest_line_mm
    elif column is not None:
        raise ParameterError("is one of a profile's", "column", "name a profile, too")
    return Process(print_width, least, least_gap, gain, dpi)


def calibrate(
    output: OUTPUT = None,
    measured: MEASURED = "",
    name: NAME = "",
    least_dot: LEAST_DOT = None,
) -> None:
    """Write a sheet of patches to print and measure; or tell the dot gain that was measured."""
    from stippler.files import checks

    if output is None and not measured:
        raise ParameterError("is missing", "output", "give -o SHEET.pdf, or --measured SHARES")
    if output is not None:
        from stippler.export import save

        save(checks.calibration_sheet(), output)
        shares = ", ".join(f"{share:.0%}" for share in checks.SHEET_STEPS)
        typer.echo(f"patches of {shares}, lightest first; measure the ink of each")
    if measured:
        try:
            values = [float(text) for text in measured.split(",")]
        except ValueError:
            raise ParameterError(
                f"{measured!r} is no list", "measured", "such as 0.1,0.2"
            ) from None
        if name:
            from stippler.files.presses import calibrated, keep_press

            keep_press(calibrated(name, values, least_dot or 0.0))
            typer.echo(f"--press {name!r} is kept")
        typer.echo(f"--gain {checks.gain_of(values):.4f}")
    elif name:
        raise ParameterError("is of what was measured", "name", "give --measured, too")
