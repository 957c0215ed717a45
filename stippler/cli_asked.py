"""What a command line asks to be made of a picture, from the options that stand there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from stippler.drawing.parameter import Kind, Parameter
from stippler.drawing.picture_values import TONE, WIDTH
from stippler.drawing.style import PARAMETERS, Style
from stippler.drawing.style_presets import preset
from stippler.errors import ParameterError


@dataclass(frozen=True, slots=True)
class Asked:
    """What to make of a picture, as asked for on the command line.

    Attributes
    ----------
    options : dict of name to option
        Those that stand there, by the names of the values they set.
    base : Style or None
        The one that is named.
    keywords : dict
        The style's values that stand there, as Python takes them.
    """

    style: Style
    tone: str
    width_mm: float
    options: dict[str, str]
    base: Style | None
    keywords: dict[str, Any]

    @classmethod
    def of(cls, values: dict[str, Any], parameters: tuple[Parameter, ...]) -> Asked:
        """Make it of the values that stand there, by `python_name`, and of those that may."""
        given = {one.name: one.option for one in parameters if python_name(one) in values}
        keywords = {
            one.word: _value_of(one, values[python_name(one)])
            for one in PARAMETERS
            if one.name in given
        }
        base = preset(values["style"]) if values.get("style") else None
        options = dict.fromkeys((one.name for one in PARAMETERS), "--style") if base else {}
        page = values.get("tone", TONE.default), values.get("width", WIDTH.default)
        return cls(Style.of(base, **keywords), *page, options | given, base, keywords)


def python_name(about: Parameter) -> str:
    """Return what a value is called by where the option's name has to be one of Python's."""
    return about.flag.lstrip("-").replace("-", "_") if about.flag else about.word


def _value_of(about: Parameter, value: Any) -> Any:
    """Return what an option stands for."""
    if about.kind is Kind.FLAG:
        return about.default is not value if about.flag else value
    if about.kind is Kind.RANGE and value is not None:
        low, colon, high = value.partition(":")
        try:
            return float(low), float(high if colon else low)
        except ValueError:
            raise ParameterError(
                f"{value!r} is no range", about.said_name, "give MIN:MAX in mm, such as 0.15:0.3"
            ) from None
    return value
