"""What lies around some cells, told from their stars (see `kept_cells`)."""

from __future__ import annotations

from stippler.kernels.cells.tables import F8, I4, U1
from stippler.kernels.machine.jit import kernel


@kernel
def ring_around(chosen: I4, around: I4, n_star: U1, is_known: U1, ring: I4) -> int:
    """List the dots that some cells border on, but for those known; return how many.

    `is_known` by row: the chosen are to be marked in it, those listed get marked.
    """
    count = 0
    for w in range(len(chosen)):
        i = chosen[w]
        for k in range(n_star[i]):
            j = around[i, k]
            if j >= 0 and is_known[j] == 0:
                is_known[j] = 1
                ring[count] = j
                count += 1
    return count


@kernel
def mean_among_alike(
    rows: I4, around: I4, n_star: U1, place: I4, kind: F8, most: float, values: F8, mean: F8
) -> None:
    """Find the means of values over dots and those around them whose kind differs by less than so.

    Parameters
    ----------
    rows : (k,) int32
    place : int32 by row
        Of a row in `rows`; below 0 for those that are not in it, which do not count.
    kind, values, mean : (k,) float64
        By place; the last is the result.
    """
    for w in range(len(rows)):
        i = rows[w]
        total, count = values[w], 1.0
        for k in range(n_star[i]):
            j = around[i, k]
            if j < 0 or place[j] < 0:
                continue
            at = place[j]
            if abs(kind[at] - kind[w]) < most:
                total += values[at]
                count += 1.0
        mean[w] = total / count
