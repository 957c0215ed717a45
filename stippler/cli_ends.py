"""What commands say in one line, and the exit codes that their errors end with."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from pathlib import Path

from stippler.errors import ParameterError, StipplerError, StipplerWarning
from stippler.names import shown
from stippler.stopping import fail


def say_of(file: Path, text: str) -> None:
    """Say what is to be known of a drawing."""
    fail(f"{shown(file)}: {text}", 0)


def say_what_matters() -> None:
    """Tell our own warnings in a line each, and keep libraries' ones, about files, back."""
    if not sys.warnoptions:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", StipplerWarning)
        warnings.showwarning = _tell


def _tell(message: Warning | str, category: type[Warning], *_: object, **__: object) -> None:
    if issubclass(category, StipplerWarning):
        fail(str(message), 0)


def ended(command: Callable[[], int]) -> int:
    """Carry out a command; return the exit code, having said in one line what went wrong."""
    try:
        return command()
    except ParameterError as error:
        return fail(str(error), 2)
    except StipplerError as error:
        return fail(str(error), 1)
    except MemoryError:
        return fail("not enough memory; ask for fewer dots or a smaller picture", 1)
