"""`render` where its arguments are plain: read without the parser, which takes 60 ms to import.

Plain is a file, options written out in full, each once and with a value that does not begin with a
hyphen. All else, and all that is wrong, is the parser's (`stippler.cli`), which knows what to say.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stippler.cli_asked import Asked, python_name
from stippler.cli_ends import ended, say_what_matters
from stippler.drawing.parameter import Kind, Parameter
from stippler.drawing.picture_values import TONE, WIDTH
from stippler.drawing.style import PARAMETERS
from stippler.files.write.formats import every_option
from stippler.hidden_import import emptied
from stippler.kernels.machine.numba_import import skip_blas

STYLED: tuple[Parameter, ...] = (WIDTH, TONE, *PARAMETERS)
"""What `render` takes beside the options of formats."""

_COMPLETING = "_STIPPLER_COMPLETE"  # a shell asks what could come next
_DOCSTRINGS = ("numpy._core._add_newdocs", "numpy._core._add_newdocs_scalars")
"""What gives numpy's functions their docstrings, in 7 ms, which a render does not read."""

_KINDS: dict[Kind, Callable[[str], Any]] = {Kind.WHOLE: int, Kind.NUMBER: float}


@dataclass(frozen=True, slots=True)
class Plain:
    """What plain arguments of `render` say.

    Attributes
    ----------
    styled : dict of Python's name to value
        The options of pictures and styles that stand there.
    exports : dict of name to value
        Those of formats.
    """

    file: Path
    output: Path
    form: str
    styled: dict[str, Any]
    exports: dict[str, Any]

    def run(self) -> int:
        """Carry it out; return the exit code, having said in one line what went wrong."""
        skip_blas()
        say_what_matters()
        return ended(self._rendered)

    def _rendered(self) -> int:
        asked = Asked.of(self.styled, STYLED)
        with emptied(*_DOCSTRINGS):
            import numpy as np  # noqa: F401
        from stippler.cli_render import render_file

        render_file(self.file, self.output, self.form, asked, self.exports)
        return 0


def plain(args: list[str]) -> Plain | None:
    """Return what the command line asks for if that is plain, else None."""
    if args[:1] != ["render"] or _COMPLETING in os.environ:
        return None
    taking, flags = _options()
    values: dict[str, Any] = {}
    rest = iter(args[1:])
    for word in rest:
        value: Any
        if word in taking:
            name, kind = taking[word]
            text = next(rest, "-")
            if text.startswith("-"):
                return None
            try:
                value = kind(text)
            except ValueError:
                return None
        elif word in flags:
            name, value = flags[word]
        elif word.startswith("-") or not word:
            return None
        else:
            name, value = "file", Path(word)
        if name in values:
            return None
        values[name] = value
    if "file" not in values or "output" not in values:
        return None
    own = values.pop("file"), values.pop("output"), values.pop("format", "")
    exports = {name: values.pop(name) for name in every_option() if name in values}
    return Plain(*own, values, exports)


def _options() -> tuple[dict[str, tuple[str, Callable[[str], Any]]], dict[str, tuple[str, bool]]]:
    """Return options that take a value, with name and kind, and flags, with name and value."""
    taking: dict[str, tuple[str, Callable[[str], Any]]] = {
        "-o": ("output", Path), "--output": ("output", Path), "--format": ("format", str),
        "--style": ("style", str),
    }  # fmt: skip
    flags: dict[str, tuple[str, bool]] = {}
    for one in STYLED:
        if one.kind is Kind.FLAG:
            flags[one.option] = python_name(one), True
        else:
            taking[one.option] = python_name(one), _KINDS.get(one.kind, str)
    for name, (option, _) in every_option().items():
        if option.type is bool:
            flags[option.flag] = name, True
            flags[f"--no-{option.flag[2:]}"] = name, False
        else:
            taking[option.flag] = name, option.type
    return taking, flags
