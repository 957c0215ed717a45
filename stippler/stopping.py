"""Being stopped by signals, and words to whoever listens, at any moment of the process."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import time
from types import FrameType
from typing import Any, NoReturn

_STOPPING = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
_AGAIN_S = 0.25  # a stop that something has swallowed comes again
_PATIENCE_S = 5.0  # for a clean end; then a second signal ends at once


class Stopped(BaseException):
    """A signal asked for the end. No `KeyboardInterrupt`, which libraries catch and print of."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


class Stops:
    """Turns signals into `Stopped`, raised in the main thread until somebody takes it.

    Attributes
    ----------
    command : str
        What was asked for.
    loaded : bool
        Whether the command line is imported; before that a stop ends the process at once.
    written : bool
        Whether the drawing is in its file, whatever comes then.
    """

    def __init__(self) -> None:
        self.number = 0
        self._since_s = 0.0
        self.command = ""
        self.loaded = self.written = False

    def begin(self, command: str) -> None:
        """Take the signals that end a process; those that were ignored stay ignored (nohup)."""
        self.number, self.command, self.loaded, self.written = 0, command, False, False
        for name in _STOPPING:
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._stop)
        sys.unraisablehook = _quiet(sys.unraisablehook)

    def _stop(self, number: int, frame: FrameType | None) -> None:
        if not self.loaded:  # imports hold nothing that would have to be cleaned up
            _end(self.line(), 128 + number)
        if self.number:
            if time.monotonic() - self._since_s > _PATIENCE_S:
                os._exit(128 + number)
            return
        self.number, self._since_s = number, time.monotonic()
        if hasattr(signal, "setitimer"):
            signal.signal(signal.SIGALRM, self._again)
            signal.setitimer(signal.ITIMER_REAL, _AGAIN_S, _AGAIN_S)
        raise Stopped(number)

    def _again(self, number: int, frame: FrameType | None) -> None:
        if not _is_unwinding():
            raise Stopped(self.number)

    def taken(self) -> None:
        """Stop raising: the end has come."""
        if hasattr(signal, "setitimer"):
            signal.setitimer(signal.ITIMER_REAL, 0)

    def line(self) -> str:
        """Return what to say."""
        unwritten = self.command == "render" and not self.written
        return "stopped; nothing was written" if unwritten else "stopped"


stops = Stops()
"""Of this process."""


def _is_unwinding() -> bool:
    """Return whether a stop is on its way already, through clean-ups."""
    error = sys.exc_info()[1]
    while error is not None:
        if isinstance(error, Stopped):
            return True
        error = error.__context__
    return False


def _quiet(hook: Any) -> Any:
    """Say nothing of stops that were raised where nothing can be (in finalizers)."""

    def told(unraisable: Any) -> None:
        if not isinstance(unraisable.exc_value, Stopped | BrokenPipeError):
            hook(unraisable)

    return told


def fail(message: str, status: int, do: str = "") -> int:
    """Say what went wrong in one line, if anybody listens; return the status."""
    line = f"stippler: {message.rstrip('.')}{'; ' + do if do else ''}"
    with contextlib.suppress(OSError, ValueError, AttributeError):
        sys.stderr.write(" ".join(line.split()) + "\n")
        sys.stderr.flush()
    return status


def _end(line: str, status: int) -> NoReturn:
    with contextlib.suppress(OSError):
        os.write(2, f"stippler: {line}\n".encode())
    os._exit(status)
