"""Fuzz all readers one after the other: ``python -m tests.fuzz.campaign [MILLIONS] [READER ...]``.

Prints executions, speed, peak of memory and kinds of faults a reader; the totals of all campaigns
are kept in ``out/fuzz/totals.json``. A reader that ends for time or memory is begun again.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
from pathlib import Path

OUT = Path("out") / "fuzz"
SHARES = {
    "structure": 14, "arrays": 14, "journal": 14, "container": 14, "style": 9, "table": 9,
    "geojson": 9, "svg": 6, "picture": 4, "drawing": 3, "replay": 3, "brushes": 3, "preferences": 3,
}  # fmt: skip
"""Of 100 executions: the cheap readers get more, the dear ones a fair part."""

_ROUNDS = {
    "structure": 1_000_000, "arrays": 1_000_000, "journal": 1_000_000, "container": 500_000,
    "style": 300_000, "geojson": 300_000,
}  # fmt: skip
_ROUND = 100_000
"""Executions of one process; the fuzzer itself keeps some memory of each, so others follow."""

_NUMBER = re.compile(r"^#(\d+)\s", re.MULTILINE)
_PEAK = re.compile(r"peak_rss_mb:\s*(\d+)")


def run(name: str, n: int) -> tuple[int, float, int]:
    """Run a reader; return how many executions there were, seconds, and its peak in MB."""
    began = time.monotonic()
    command = [sys.executable, "-m", "tests.fuzz.fuzz", name, f"-runs={n}", "-print_final_stats=1"]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    counts = [int(found) for found in _NUMBER.findall(done.stderr)]
    if not counts:
        raise SystemExit(f"{name}: {done.stderr[-2000:]}")
    peak = _PEAK.search(done.stderr)
    if done.returncode:
        sys.stdout.write(f"{name}: ended early\n{done.stderr[-600:]}\n")
    return max(counts), time.monotonic() - began, int(peak[1]) if peak else 0


def note(name: str, n: int, seconds: float, peak_mb: int) -> None:
    """Add to the totals."""
    path = OUT / "totals.json"
    totals = json.loads(path.read_text()) if path.exists() else {}
    one = totals.setdefault(name, {"executions": 0, "seconds": 0.0, "peak_mb": 0})
    one["executions"] += n
    one["seconds"] = round(one["seconds"] + seconds, 1)
    one["peak_mb"] = max(one["peak_mb"], peak_mb)
    path.write_text(json.dumps(totals, indent=1))


def main() -> None:
    """Run all."""
    millions = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
    names = sys.argv[2:] or list(SHARES)
    total = sum(SHARES[name] for name in names)
    left = {name: round(millions * 1e6 * SHARES[name] / total) for name in names}
    while any(left.values()):
        for name in names:
            if left[name]:
                n, seconds, peak_mb = run(name, min(left[name], _ROUNDS.get(name, _ROUND)))
                left[name] = max(left[name] - n, 0)
                note(name, n, seconds, peak_mb)
                faults = sorted(path.name for path in (OUT / name / "faults").glob("*[!t]"))
                text = f"{name:<12}{n:>10,} in {seconds:6.0f} s, {peak_mb:>4} MB {faults or ''}\n"
                sys.stdout.write(text)
                sys.stdout.flush()


if __name__ == "__main__":
    main()
