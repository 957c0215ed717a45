"""What the editor has to say to the person, newest last."""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from stippler.errors import StipplerError
from stippler.names import shown

INFO, WARNING, ERROR = "info", "warning", "error"
_SHOWN_S = {INFO: 6.0, WARNING: 15.0, ERROR: 30.0}
_KEPT = 200
_LONGEST = 300  # characters

_log = logging.getLogger("stippler")


@dataclass(frozen=True, slots=True)
class Message:
    """One line, with how grave it is and when it was said."""

    level: str
    text: str
    at_s: float


class Messages:
    """The log; `current` is the line to show now.

    Parameters
    ----------
    clock : callable
        Seconds, never going back.

    Attributes
    ----------
    log_path : Path or None
        The file that the program's log goes to.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.log_path: Path | None = None
        self._seen = False
        self._logged: set[str] = set()
        self.log: deque[Message] = deque(maxlen=_KEPT)

    def say(self, text: str, level: str = INFO, error: BaseException | None = None) -> None:
        """Add a line; one that repeats the last only shows it for longer.

        Parameters
        ----------
        error : BaseException, optional
            What was raised; the line tells where the log is, if nobody has foreseen it.
        """
        line = Message(level, _shortened(text) + self._pointer(error), self._clock())
        if self.log and (self.log[-1].level, self.log[-1].text) == (level, line.text):
            self.log.pop()
        elif level == ERROR and line.text not in self._logged:
            self._logged.add(line.text)
            _log.error("%s", line.text, exc_info=error)
        self.log.append(line)
        self._seen = False

    def _pointer(self, error: BaseException | None) -> str:
        if self.log_path is None or error is None or isinstance(error, StipplerError):
            return ""
        return f"; details are in {shown(self.log_path)}"

    def dismiss(self) -> None:
        """Take the current line off; the log keeps it."""
        self._seen = True

    @property
    def current(self) -> Message | None:
        """The line to show now, if any."""
        if self._seen or not self.log:
            return None
        return self.log[-1] if self.left_s > 0.0 else None

    @property
    def left_s(self) -> float:
        """How long the current line is still to be shown."""
        if self._seen or not self.log:
            return 0.0
        last = self.log[-1]
        return max(last.at_s + _SHOWN_S[last.level] - self._clock(), 0.0)


def _shortened(text: str) -> str:
    line = shown(" ".join(text.split()))
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 1]}…"
