"""The row of each id: a hash table of small pages, so that memory follows the number of dots.

Ids beside one another share a page of `PAGE`; `keys` (a power of two long, -1 where free) and
`page_of` find the page of an id, `pages` holds rows, -1 for ids that are not there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel

I4 = NDArray[np.int32]
I8 = NDArray[np.int64]

PAGE_BITS = 6
PAGE = 1 << PAGE_BITS
_MIX = -7046029254386353131  # 2^64 / golden ratio, odd


@inline
def _slot_of(key: int, keys: I8) -> int:
    """Find where a page's key stands, or the free slot where it belongs."""
    mask = len(keys) - 1
    mixed = key * _MIX
    slot = (mixed ^ (mixed >> 29)) & mask
    while keys[slot] != key and keys[slot] != -1:
        slot = (slot + 1) & mask
    return int(slot)


@kernel
def find_rows(ids: I8, keys: I8, page_of: I4, pages: I4, rows: I8) -> None:
    """Write the row of each id, -1 where it is not there."""
    last, page = -1, -1
    for k in range(len(ids)):
        key = ids[k] >> PAGE_BITS
        if ids[k] < 0:
            rows[k] = -1
            continue
        if key != last:
            slot = _slot_of(key, keys)
            last, page = key, page_of[slot] if keys[slot] == key else -1
        rows[k] = pages[page, ids[k] & (PAGE - 1)] if page >= 0 else -1


@kernel
def put_rows(ids: I8, rows: I8, keys: I8, page_of: I4, pages: I4, n_pages: int) -> tuple[int, int]:
    """Give ids their rows; -1 takes one out. Return how many were done, and the pages in use.

    Ends early where half of the keys, or all pages, are in use.
    """
    for k in range(len(ids)):
        key = ids[k] >> PAGE_BITS
        slot = _slot_of(key, keys)
        if keys[slot] != key:
            if n_pages == len(pages) or 2 * n_pages >= len(keys):
                return k, n_pages
            keys[slot], page_of[slot] = key, n_pages
            pages[n_pages] = -1
            n_pages += 1
        pages[page_of[slot], ids[k] & (PAGE - 1)] = rows[k]
    return len(ids), n_pages


@kernel
def rehash(old_keys: I8, old_page_of: I4, keys: I8, page_of: I4) -> None:
    """Bring all keys into a larger table, whose keys are -1."""
    for k in range(len(old_keys)):
        if old_keys[k] >= 0:
            slot = _slot_of(old_keys[k], keys)
            keys[slot], page_of[slot] = old_keys[k], old_page_of[k]
