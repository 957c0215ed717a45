"""How much of each dot is ink of its own, found beside the frames that show it.

For 200,000 dots that takes 20 ms, and several times as long where a worker uses the same cores:
too long for a frame.
"""

from __future__ import annotations

import threading

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.shapes import gpu_dots
from stippler.kernels.tone.union_share import shares_of_union


def shares_of(words: NDArray[np.uint32], *, is_plain: bool) -> NDArray[np.float32]:
    """Return what each dot adds to the union of all that are painted as it is, (n,).

    Parameters
    ----------
    words : (n, 6) uint32
        Packed dots.
    is_plain : bool
        All are black and seen.
    """
    discs = words.view(np.float32)
    if is_plain:
        return shares_of_union(discs)
    shares = np.ones(len(words), np.float32)
    kind = gpu_dots.flags_of(words) & (gpu_dots.IN_WHITE | gpu_dots.UNSEEN)
    for seen in (0, gpu_dots.IN_WHITE):
        which = np.flatnonzero(kind == seen)
        shares[which] = shares_of_union(discs[which])
    return shares


class Weighing:
    """The shares of dots as they are now, found by a thread of its own.

    Parameters
    ----------
    words : (n, 6) uint32
        Packed dots; they are copied.
    is_plain : bool
        All are black and seen.
    """

    def __init__(self, words: NDArray[np.uint32], *, is_plain: bool) -> None:
        self._words, self._is_plain = words.copy(), is_plain
        self._changed: list[NDArray[np.intp]] = []
        self._shares: NDArray[np.float32] | None = None
        self._thread = threading.Thread(target=self._find, name="weighing", daemon=True)
        self._thread.start()

    def _find(self) -> None:
        self._shares = shares_of(self._words, is_plain=self._is_plain)

    def note_change(self, slots: NDArray[np.intp]) -> None:
        """Take note of rows that are others by now: they count whole."""
        self._changed.append(slots)

    @property
    def is_done(self) -> bool:
        """Whether `shares` need not wait."""
        return not self._thread.is_alive()

    def shares(self, n: int) -> NDArray[np.float32]:
        """Wait for the end; return the shares of the n dots that are there by now."""
        self._thread.join()
        out = np.ones(n, np.float32)
        if self._shares is not None:  # None where memory ran out: all count whole
            m = min(n, len(self._shares))
            out[:m] = self._shares[:m]
        for slots in self._changed:
            out[slots[slots < n]] = 1.0
        return out
