"""Shader sources: `#include`, `#define`, and error messages that name the real file and line."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import moderngl

from stippler import resources

_INCLUDE = re.compile(r'^\s*#include\s+"([^"]+)"\s*$')
_VERSION = re.compile(r"^\s*#version\b")
_PLACES = (
    re.compile(r"\b(\d+):(\d+)\(\d+\)"),  # Mesa
    re.compile(r"\b(\d+)\((\d+)\)"),  # NVIDIA
    re.compile(r"(?<=ERROR: )(\d+):(\d+)"),  # AMD, Apple
)


class ShaderError(Exception):
    """A shader that does not load, compile or link, or a uniform it does not have."""


class Source:
    """The text of one shader with its includes put in place.

    Parameters
    ----------
    path : Path
        The shader; includes are relative to `folder`.
    defines : sequence of str
        Names to `#define`.
    """

    def __init__(self, path: Path, folder: Path, defines: Sequence[str] = ()) -> None:
        self.files: list[str] = []
        self._folder = folder
        self._done: set[Path] = set()
        lines = self._lines(path, str(path))
        version = next((i for i, line in enumerate(lines) if _VERSION.match(line)), None)
        if version is None:
            raise ShaderError(f"{path}: no #version line")
        body = [*lines[:version], "", *lines[version + 1 :]]
        self.text = "\n".join([lines[version], *(f"#define {d} 1" for d in defines), *body, ""])

    def _lines(self, path: Path, wanted_by: str) -> list[str]:
        if not path.is_file():
            raise ShaderError(f"{wanted_by}: there is no {path.relative_to(self._folder)}")
        self._done.add(path)
        number = len(self.files)
        self.files.append(path.relative_to(self._folder).as_posix())
        out = [f"#line 1 {number}"]
        for i, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            included = _INCLUDE.match(line)
            if not included:
                out.append(line)
                continue
            target = self._folder / included[1]
            if target not in self._done:
                out += self._lines(target, f"{self.files[number]}:{i}")
            out.append(f"#line {i + 1} {number}")
        return out

    def explain(self, message: str) -> str:
        """Replace source numbers in a driver's message by file names."""

        def named(match: re.Match[str]) -> str:
            number = int(match[1])
            known = number < len(self.files)
            return f"{self.files[number]}:{match[2]}" if known else match[0]

        for place in _PLACES:
            message = place.sub(named, message)
        return message


class Program:
    """A linked shader program whose uniforms are checked by name.

    Parameters
    ----------
    vertex, fragment : str
        File names in `shaders/`.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        vertex: str,
        fragment: str,
        defines: Sequence[str] = (),
        folder: Path | None = None,
    ) -> None:
        folder = folder or resources.shaders()
        self.name = f"{vertex} + {fragment}"
        sources = [Source(folder / name, folder, defines) for name in (vertex, fragment)]
        for define in defines:
            if not any(re.search(rf"def(ined)?\W+{define}\b", s.text) for s in sources):
                raise ShaderError(f"{self.name}: nothing asks for the define {define}")
        try:
            self.gl = ctx.program(vertex_shader=sources[0].text, fragment_shader=sources[1].text)
        except moderngl.Error as error:
            at_fault = sources["fragment_shader" in str(error)]
            raise ShaderError(at_fault.explain(str(error).strip())) from error
        self._uniforms = {n for n in self.gl if isinstance(self.gl[n], moderngl.Uniform)}

    def set(self, values: Mapping[str, Any]) -> None:
        """Set uniforms; one that the program does not have is an error."""
        for name, value in values.items():
            if name not in self._uniforms:
                raise ShaderError(f"{self.name}: no uniform {name}")
            uniform = self.gl[name]
            if hasattr(value, "tobytes"):
                uniform.write(value.tobytes())  # type: ignore[union-attr]
            else:
                uniform.value = value  # type: ignore[union-attr]

    def release(self) -> None:
        """Free the GL program."""
        self.gl.release()
