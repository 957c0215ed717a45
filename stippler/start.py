"""The process: what it does before the command line is imported, and how it ends.

Whatever happens, at any moment, a person gets one line at most and the right exit code: 0 done,
1 failed, 2 wrong use, 128 + n stopped by signal n.
"""

from __future__ import annotations

import contextlib
import gc
import os
import sys
from collections.abc import Callable
from typing import NoReturn

from stippler.stopping import Stopped, fail, stops

_ONE_BLAS_THREAD = "OPENBLAS_NUM_THREADS", "1"
"""Numpy's BLAS, of which a render needs next to nothing, starts a thread for each core, which spin
for 50 ms while there are imports to be done."""


def main() -> NoReturn:
    """Run the command line and end by `SystemExit`."""
    args = sys.argv[1:]
    stops.begin(args[0] if args else "edit")
    try:
        command = _command(args)
        stops.loaded = True
        status = command()
        _flush_output()
    except Stopped as stop:
        status = _stopped(stop.number)
    except KeyboardInterrupt:  # raised by a library on its own account
        status = _stopped(2)
    except BrokenPipeError:
        status = 1  # whoever read has had enough; there is nobody to tell
    except OSError as error:
        status = fail(f"standard output: {error.strerror or error}", 1)
    except Exception:
        if not stops.number:
            raise
        status = _stopped(stops.number)  # what a library made of being stopped
    finally:
        stops.taken()
        _give_up_output()
    sys.exit(status)


def _command(args: list[str]) -> Callable[[], int]:
    """Return what carries out the arguments, having imported what reads them."""
    collects = gc.isenabled()
    gc.disable()  # imports leave little to collect, and a render makes no cycles worth looking for
    if args[:1] == ["render"]:
        os.environ.setdefault(*_ONE_BLAS_THREAD)
        from stippler.cli_plain import plain

        if (asked := plain(args)) is not None:
            return asked.run
    from stippler import cli

    if collects:
        gc.enable()
    return lambda: cli.run(args)


def _stopped(number: int) -> int:
    stops.taken()
    return fail(stops.line(), 128 + number)


def program() -> NoReturn:
    """Run `main` as a process; a render ends without taking the interpreter apart.

    Numba's machine code takes half a second to be disposed of, and all files are closed by then.
    """
    reserve_standard_streams()
    try:
        main()
    except SystemExit as stop:
        if sys.argv[1:2] != ["render"]:
            raise
        os._exit(int(stop.code or 0))


def reserve_standard_streams() -> None:
    """Put nothing in the place of standard streams that are closed.

    Else the next file that is opened, a drawing maybe, would be number 2, and get the messages.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            flags = os.O_RDONLY if number == 0 else os.O_WRONLY
            opened = os.open(os.devnull, flags)
            if opened != number:
                os.dup2(opened, number)
                os.close(opened)


def _flush_output() -> None:
    """Bring to the reader what was printed; an error shows here and not at the very end."""
    if sys.stdout is not None and not sys.stdout.closed:
        sys.stdout.flush()


def _give_up_output() -> None:
    """See to it that the interpreter's own last flush has nothing to complain of."""
    for number, stream in ((1, sys.stdout), (2, sys.stderr)):
        try:
            if stream is not None and not stream.closed:
                stream.flush()
        except OSError:
            with contextlib.suppress(OSError):
                os.dup2(os.open(os.devnull, os.O_WRONLY), number)
