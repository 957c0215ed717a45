"""The program's log: what went wrong, with all that programmers need, in the state folder."""

from __future__ import annotations

import logging
import os
from logging.handlers import RotatingFileHandler
from pathlib import Path

from platformdirs import user_state_path

_MOST_BYTES = 1 << 20


def log_path() -> Path:
    """Return where the log is; ``STIPPLER_STATE_DIR`` moves it."""
    base = os.environ.get("STIPPLER_STATE_DIR")
    return (Path(base) if base else user_state_path("stippler")) / "stippler.log"


def begin_log(path: Path) -> logging.Handler | None:
    """Write what the program logs to a file from now on, two of a megabyte at most.

    None where that is not possible: a program without a log goes on.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handler = RotatingFileHandler(path, maxBytes=_MOST_BYTES, backupCount=1, encoding="utf-8")
    except OSError:
        return None
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    logging.getLogger("stippler").addHandler(handler)
    return handler


def end_log(handler: logging.Handler | None) -> None:
    """Let go of the file."""
    if handler is not None:
        logging.getLogger("stippler").removeHandler(handler)
        handler.close()
