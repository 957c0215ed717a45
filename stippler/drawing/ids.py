"""The row of each id, in memory that follows the number of dots and not their ids."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.dots.id_table import PAGE, find_rows, put_rows, rehash

GONE = -1
MAX_ID = 2**53 - 1
"""The largest id: what JSON can tell of."""

Rows = NDArray[np.int64]


class IdTable:
    """Finds rows by id."""

    def __init__(self) -> None:
        self._keys = np.full(64, -1, np.int64)
        self._page_of = np.zeros(64, np.int32)
        self._pages = np.empty((32, PAGE), np.int32)
        self._n_pages = 0

    @property
    def n_bytes(self) -> int:
        """Memory it takes."""
        return self._keys.nbytes + self._page_of.nbytes + self._pages.nbytes

    def find(self, ids: NDArray[np.int64]) -> Rows:
        """Return the rows of ids; `GONE` for those that are not there."""
        rows = np.empty(len(ids), np.int64)
        find_rows(_own(ids), self._keys, self._page_of, self._pages, rows)
        return rows

    def put(self, ids: NDArray[np.int64], rows: Rows) -> None:
        """Give ids their rows."""
        ids, rows = _own(ids), _own(rows)
        done = 0
        while True:
            n, self._n_pages = put_rows(
                ids[done:], rows[done:], self._keys, self._page_of, self._pages, self._n_pages
            )
            done += n
            if done == len(ids):
                return
            self._grow()

    def drop(self, ids: NDArray[np.int64]) -> None:
        """Take ids out."""
        self.put(ids, np.full(len(ids), GONE, np.int64))

    def _grow(self) -> None:
        """Take twice the room: pages are in use and half of the keys, which are twice as many."""
        pages = np.empty((2 * len(self._pages), PAGE), np.int32)
        pages[: self._n_pages] = self._pages
        self._pages = pages
        keys = np.full(2 * len(self._keys), -1, np.int64)
        page_of = np.zeros(len(keys), np.int32)
        rehash(self._keys, self._page_of, keys, page_of)
        self._keys, self._page_of = keys, page_of


def _own(values: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return an array that numba takes for the one type it has compiled for."""
    values = np.ascontiguousarray(values, np.int64)
    return values if values.flags.writeable else values.copy()
