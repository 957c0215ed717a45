"""What a document tells those that write down all that happens to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from stippler.drawing.edit import Edit

STEP, MADE, UNDONE, REDONE = "step", "made", "undone", "redone"
OPENED, PART, ENDED = "opened", "part", "ended"


@dataclass(frozen=True, slots=True, eq=False)
class Entry:
    """One thing that happened; a document to which all entries are replayed becomes the same.

    Attributes
    ----------
    what : str
        `STEP`: `edit` is a new step of the history. `MADE`: it is none, but how the drawing began.
        `OPENED`, `PART`, `ENDED`: a run began, has changed something, has ended; its parts joined
        are its step. `UNDONE`, `REDONE`: the last step was taken back, or done again;
        `edit` is what that did, so that a journal which began later can follow, too.
    of_job : bool
        Whether no hand has made that step.
    n_done : int
        How many steps of the history are in effect then.
    """

    what: str
    edit: Edit | None = None
    of_job: bool = False
    n_done: int = 0


Follower = Callable[[Entry], None]
