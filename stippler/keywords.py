"""Python's keywords for the parameters of a style, in signatures and docstrings."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, TypeVar

from stippler.drawing.parameter import Kind, Parameter
from stippler.drawing.style import PARAMETERS

Function = TypeVar("Function", bound=Callable[..., Any])

_TYPES: dict[Kind, Any] = {
    Kind.WHOLE: int,
    Kind.NUMBER: float,
    Kind.RANGE: tuple[float, float],
    Kind.CHOICE: str,
    Kind.FLAG: bool,
}


def with_keywords(function: Function) -> Function:
    """Show the style's keywords in a function's signature, and ``{keywords}`` in its docstring."""
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    more = [one for one in PARAMETERS if one.word not in signature.parameters]
    shown = [
        inspect.Parameter(
            one.word,
            inspect.Parameter.KEYWORD_ONLY,
            default=one.default,
            annotation=_TYPES[one.kind] | None if one.may_lack else _TYPES[one.kind],
        )
        for one in more
    ]
    function.__signature__ = signature.replace(parameters=[*own, *shown])  # type: ignore[attr-defined]
    if function.__doc__ is not None:
        lines = "\n    ".join(line for one in more for line in _described(one))
        function.__doc__ = function.__doc__.replace("{keywords}", lines)
    return function


def _described(about: Parameter) -> tuple[str, str]:
    kind = ", ".join(f'"{value}"' for value in about.values)
    if kind:
        kind = f"{{{kind}}}"
    else:
        kind = {Kind.RANGE: "(min, max)", Kind.FLAG: "bool", Kind.WHOLE: "int"}.get(
            about.kind, "float"
        )
    unit = f", {about.unit}" if about.unit else ""
    may_lack = ", optional" if about.may_lack else ""
    return f"{about.word} : {kind}{unit}{may_lack}", f"    {about.help}"
