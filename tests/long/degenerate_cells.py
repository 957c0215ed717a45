"""Judge cells of degenerate cases by shapely: ``python -m tests.long.degenerate_cells [CELLS]``.

A million cells unless told otherwise; prints each wrong one's seed and fails if there is any.
"""

import sys
from concurrent.futures import ProcessPoolExecutor

from stippler.stippling.tessellation import Tessellation
from tests.stippling.degenerate import shape_and_dots, wrong_cells

BATCH = 500


def judge(first: int) -> tuple[int, list[tuple[int, list[int]]]]:
    """Return how many cells a batch of seeds has, and the wrong ones by seed."""
    n, wrong = 0, []
    for seed in range(first, first + BATCH):
        shape, xy = shape_and_dots(seed)
        if not len(xy):
            continue
        cells = Tessellation.of(xy, shape)
        bad = wrong_cells(shape, xy, cells.area, cells.centroid)
        n += len(xy)
        if bad:
            wrong.append((seed, bad))
    return n, wrong


def main() -> int:
    """Run batches on all cores until there are enough cells."""
    wanted = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    n = n_wrong = 0
    with ProcessPoolExecutor(2) as pool:
        while n < wanted:
            for count, wrong in pool.map(judge, range(first, first + 20 * BATCH, BATCH)):
                n += count
                for seed, dots in wrong:
                    n_wrong += len(dots)
                    print(f"seed {seed}: cells {dots}")
            first += 20 * BATCH
            print(f"{n:,} cells, {n_wrong} wrong", flush=True)
    return 1 if n_wrong else 0


if __name__ == "__main__":
    sys.exit(main())
