"""Painters killed at random moments: ``python tests/long/killed_painters.py 1000``.

After each kill the drawing made anew from the journal has to be one that the painter had, and to
have all that was on disk.
"""

from __future__ import annotations

import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import painting

from stippler.drawing.document import Document
from stippler.files.native.drawing_file import drawing_of
from stippler.files.native.edit_log import replay
from stippler.files.native.recovery import lost_drawings
from stippler.files.read.picture import picture_of_bytes


def kill_painters(n_kills: int, seed: int = 1) -> Counter[str]:
    """Kill a painter again and again; count how many steps that it had done were not recovered."""
    dice, lost = random.Random(seed), Counter[str]()
    for k in range(n_kills):
        with tempfile.TemporaryDirectory() as folder:
            said = _killed_painter(Path(folder), seed + k, dice.uniform(0.0, 0.5))
            found = _recovered(Path(folder))
            wanted = _digests(seed + k, len(said))
            on_disk = max((n for n, (_, is_flushed) in enumerate(said) if is_flushed), default=0)
            assert [text for text, _ in said] == wanted[: len(said)], "another course of things"
            if found is None:
                assert not on_disk, "a drawing that was on disk is gone"
                lost["before the journal had begun"] += 1
                continue
            assert found in wanted[on_disk:], "what was on disk is gone, or was never there"
            newest = max(n for n, text in enumerate(wanted) if text == found)
            lost[f"{max(len(said) - 1 - newest, 0)} steps lost"] += 1
    return lost


def _killed_painter(folder: Path, seed: int, after_s: float) -> list[tuple[str, bool]]:
    """Return what a painter said before it was killed: digests, and whether they were on disk."""
    out, into = os.pipe()
    process = os.fork()
    if process == 0:
        try:
            os.close(out)
            os.dup2(into, 1)
            sys.stdout = os.fdopen(1, "w")
            painting.main(folder, seed)
        finally:
            os._exit(1)
    os.close(into)
    with os.fdopen(out) as stream:
        first = stream.readline()
        time.sleep(after_s)
        os.kill(process, signal.SIGKILL)
        lines = [first, *stream.read().splitlines(keepends=True)]
    os.waitpid(process, 0)
    words = [line.split() for line in lines if line.endswith("\n")]
    return [(line[1], line[-1] == "flushed") for line in words]


def _recovered(root: Path) -> str | None:
    """Return the digest of the drawing made anew; None where there is none."""
    found = lost_drawings(root)
    if not found:
        return None
    (lost,) = found
    kept, torn = lost.read()
    document = Document(drawing_of(kept, picture_of_bytes, "here")[0])
    n_done, problem = replay(document, torn.records, picture_of_bytes)
    assert (n_done, problem) == (len(torn.records), ""), problem
    return painting.digest(document.drawing)


def _digests(seed: int, n: int) -> list[str]:
    """Return what the drawing was after each step, and after one more than was said."""
    document = Document(painting.first_drawing())
    found = [painting.digest(document.drawing)]
    steps = painting.paint(document, seed)
    while len(found) <= n:
        next(steps)
        found.append(painting.digest(document.drawing))
    return found


if __name__ == "__main__":
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    print(f"{n} kills: {dict(sorted(kill_painters(n).items()))}")
