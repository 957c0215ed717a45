"""What `stippler info` prints: all one needs to know of this machine to read a report."""

from __future__ import annotations

import platform
import sys
from collections.abc import Iterator
from importlib import metadata

from stippler import resources
from stippler.editor.log_file import log_path
from stippler.errors import DisplayError
from stippler.files.native.backups import backups_root
from stippler.files.native.recovery import recovery_root
from stippler.kernels.machine.cache import cache_root
from stippler.kernels.machine.pool import n_threads
from stippler.version import VERSION
from stippler.warm import is_warm

_LIBRARIES = (
    "numpy", "numba", "scipy", "shapely", "pillow", "moderngl", "glfw", "imgui-bundle", "typer",
)  # fmt: skip


def lines() -> Iterator[str]:
    """Yield name and value, a line each."""
    yield f"stippler   {VERSION}"
    yield f"python     {platform.python_version()} ({sys.executable})"
    yield f"system     {platform.platform()}"
    yield f"cores      {n_threads()}"
    yield from _gl()
    yield f"libraries  {', '.join(f'{name} {metadata.version(name)}' for name in _LIBRARIES)}"
    yield f"shaders    {resources.shaders()}"
    yield f"assets     {resources.assets()}"
    state = "compiled for this processor" if is_warm() else "not compiled yet for this processor"
    yield f"kernels    {cache_root()} ({state})"
    yield f"recovery   {recovery_root()}"
    yield f"backups    {backups_root()}"
    yield f"log        {log_path()}"


def _gl() -> Iterator[str]:
    from stippler.headless import open_context

    try:
        context = open_context()
    except DisplayError as error:
        yield f"OpenGL     none: {error}"
        return
    info = context.info
    yield f"OpenGL     {info['GL_VERSION']}, {info['GL_RENDERER']} ({info['GL_VENDOR']})"
    context.release()
