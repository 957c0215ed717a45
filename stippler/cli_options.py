"""Options of file formats on the command line, made from where they are declared."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Annotated, Any

import typer

from stippler.files.write.formats import FORMATS, every_option

PANEL = "What is written"


def with_export_options(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of all formats; it gets those given as `exports`, a dict."""
    signature = inspect.signature(function, eval_str=True)
    own = [p for p in signature.parameters.values() if p.name != "exports"]
    added = {name: _parameter(name) for name in every_option()}

    def command(**values: Any) -> None:
        exports = {name: values.pop(name) for name in added}
        function(**values, exports={k: v for k, v in exports.items() if v is not None})

    parameters = [*own, *added.values()]
    command.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {p.name: p.annotation for p in parameters}
    command.__doc__, command.__name__ = function.__doc__, function.__name__
    return command


def export_names() -> set[str]:
    """Return the names of all options of formats."""
    return set(every_option())


def _parameter(name: str) -> inspect.Parameter:
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
    kind: Any = Annotated[option.type | None, info]
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=kind)
