"""Options on the command line that are made from where they are declared: styles and formats."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Annotated, Any

import typer

from stippler.cli_asked import Asked, python_name
from stippler.drawing.parameter import Kind, Parameter
from stippler.drawing.picture_values import TONE, WIDTH
from stippler.drawing.style import PARAMETERS
from stippler.drawing.style_presets import preset_keys
from stippler.files.write.formats import FORMATS, every_option

PANEL = "What is written"

_STYLE = typer.Option(
    metavar="NAME", help=f"A style to begin with: {', '.join(preset_keys())}. Other options count "
    "before it.", show_default=False,
)  # fmt: skip
_TYPES: dict[Kind, type] = {
    Kind.WHOLE: int,
    Kind.NUMBER: float,
    Kind.RANGE: str,
    Kind.CHOICE: str,
    Kind.FLAG: bool,
}


def with_style_options(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of pictures and styles; it gets them as `asked`."""
    return _with_options(function, (WIDTH, TONE, *PARAMETERS))


def with_only_style_options(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of styles alone; it gets them as `asked`."""
    return _with_options(function, PARAMETERS)


def _with_options(
    function: Callable[..., None], parameters: tuple[Parameter, ...]
) -> Callable[..., None]:
    def gather(values: dict[str, Any], context: typer.Context) -> Asked:
        there = {name: value for name, value in values.items() if _is_given(context, name)}
        return Asked.of(there, parameters)

    named = _keyword("style", str, _STYLE, "")
    return _with(function, "asked", [named, *map(_option, parameters)], gather)


def with_export_options(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of all formats; it gets those given as `exports`, a dict."""

    def gather(values: dict[str, Any], _: typer.Context) -> dict[str, Any]:
        return {name: value for name, value in values.items() if value is not None}

    return _with(function, "exports", [_export_option(name) for name in every_option()], gather)


def _with(
    function: Callable[..., None],
    slot: str,
    added: list[inspect.Parameter],
    gather: Callable[[dict[str, Any], typer.Context], Any],
) -> Callable[..., None]:
    """Give a command more options; it gets what is gathered from them under the slot's name."""
    signature = inspect.signature(function, eval_str=True)
    own = [p for p in signature.parameters.values() if p.name != slot]
    names = [p.name for p in added]

    def command(context: typer.Context, **values: Any) -> None:
        gathered = gather({name: values.pop(name) for name in names}, context)
        function(context, **values, **{slot: gathered})

    parameters = [*own, *added]
    command.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {p.name: p.annotation for p in parameters}
    command.__doc__, command.__name__ = function.__doc__, function.__name__
    return command


def _is_given(context: typer.Context, name: str) -> bool:
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


# --- styles -----------------------------------------------------------------------------------


def _option(about: Parameter) -> inspect.Parameter:
    metavar = None
    if about.kind is Kind.CHOICE:
        short = "|".join(about.values)
        metavar = short if len(short) <= 32 else "NAME"
    elif about.kind is Kind.RANGE:
        metavar = "MIN:MAX"
    elif about.kind is Kind.NUMBER:
        metavar = about.unit.upper() or None
    text = about.help
    if metavar == "NAME":
        text += f" One of {', '.join(about.values)}."
    default = about.default
    if about.kind is Kind.FLAG:
        default = False
    info = typer.Option(about.option, help=text, metavar=metavar)
    kind: Any = _TYPES[about.kind]
    return _keyword(python_name(about), kind | None if default is None else kind, info, default)


def _keyword(name: str, kind: Any, info: Any, default: Any) -> inspect.Parameter:
    annotation: Any = Annotated[kind, info]
    return inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation
    )


# --- formats ----------------------------------------------------------------------------------


def _export_option(name: str) -> inspect.Parameter:
    option, formats = every_option()[name]
    help_text = option.help
    pictures = [one for one in FORMATS if not one.is_data]
    if formats != pictures:
        help_text += f" For {', '.join(one.endings[0] for one in formats)}."
    both = f"{option.flag}/--no-{option.flag[2:]}"
    flags = [both if option.type is bool else option.flag]
    metavar = "|".join(option.choices) or (option.unit.upper() or None)
    info = typer.Option(
        *flags, help=help_text, metavar=None if option.type is bool else metavar,
        show_default=False,
    )  # fmt: skip
    return _keyword(name, option.type | None, info, None)
