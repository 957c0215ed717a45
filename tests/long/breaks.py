"""Whether the tests of what is promised fail where a promise is broken (`docs/reliability.md`).

    python tests/long/breaks.py            # every break, one after the other
    python tests/long/breaks.py 3 shader   # those of a promise, or with a word

Each break is put into a copy of the tree by itself; the tests named beside it must fail there. The
table of breaks is `tests/long/breaks.toml`; a break whose text is not found is an error.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
PARTS = ("stippler", "tests", "shaders", "assets", "benchmarks", "pyproject.toml")


def main(words: set[str]) -> int:
    """Try the breaks of some promises or with some words; return how many no test noticed."""
    breaks = tomllib.loads(Path(__file__).with_suffix(".toml").read_text())["break"]
    chosen = [
        one
        for one in breaks
        if not words or str(one["promise"]) in words or any(word in one["what"] for word in words)
    ]
    missed = 0
    with tempfile.TemporaryDirectory(prefix="breaks-") as folder:
        tree = Path(folder) / "tree"
        tree.mkdir()
        for part in PARTS:
            copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copyfile
            copy(ROOT / part, tree / part)
        for one in chosen:
            failed = _tried(tree, one)
            missed += not failed
            print(f"{one['promise']:>2} {one['what']}: {failed or 'NOT NOTICED'}", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} noticed")
    return missed


def _tried(tree: Path, one: dict[str, Any]) -> str:
    """Break one thing; return the first test that fails, or nothing."""
    path = tree / one["file"]
    whole = path.read_text()
    if whole.count(one["old"]) != 1:
        raise SystemExit(f"{one['what']}: {one['old']!r} stands {whole.count(one['old'])} times")
    path.write_text(whole.replace(one["old"], one["new"]))
    try:
        options = ["-q", "-x", "--tb=no", "-p", "no:cacheprovider", "-p", "no:xdist"]
        command = [sys.executable, "-m", "pytest", *options, *one["tests"]]
        env = {**os.environ, "PYTHONPATH": str(tree)}
        done = subprocess.run(
            command, cwd=tree, env=env, capture_output=True, text=True, timeout=600
        )
    finally:
        path.write_text(whole)
    if done.returncode not in (0, 1):
        raise SystemExit(f"{one['what']}: the tests could not run\n{done.stdout[-2000:]}")
    said = (line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR")))
    return next(said, "").split(" - ")[0].removeprefix("FAILED ")


if __name__ == "__main__":
    sys.exit(bool(main(set(sys.argv[1:]))))
