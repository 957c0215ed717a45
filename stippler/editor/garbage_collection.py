"""Python's garbage collection, moved to where nobody waits for it.

A full collection walks every object there is: with numba in memory it takes 40 to 140 ms, in
whichever thread happens to trip it, and holds the interpreter lock meanwhile. So the collections
of young objects stay as they are, and full ones wait until the editor rests.
"""

from __future__ import annotations

import gc

_YOUNG, _MIDDLE, _NEVER = 700, 10, 1_000_000
_ENOUGH = 30  # collections of middle-aged objects since the last full one
_EVERY = 20  # full collections, of which one looks at all that was set aside, too


class Garbage:
    """Keeps full collections out of frames for as long as it is open."""

    def __init__(self) -> None:
        self._before = gc.get_threshold()
        self._n_full = 0
        gc.set_threshold(_YOUNG, _MIDDLE, _NEVER)

    def rest(self) -> None:
        """Collect what has gathered, if it is enough to be worth it; nothing moves just now."""
        if gc.get_count()[2] < _ENOUGH:
            return
        self._n_full += 1
        if self._n_full % _EVERY == 0:
            gc.unfreeze()
        gc.collect()
        gc.freeze()  # what is left is here to stay: the next collection need not walk it

    def close(self) -> None:
        """Leave collection as it was."""
        gc.unfreeze()
        gc.set_threshold(*self._before)
