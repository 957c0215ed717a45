"""Whether tests notice small faults in `stippler/files` and `stippler/drawing`.

    make coverage                                     # which test goes through which line
    python -m tests.long.mutants baseline FILE        # which tests pass here, and their time
    python -m tests.long.mutants run FILE N [SEED]    # put in N faults, chosen by chance
    python -m tests.long.mutants again FILE           # those that none noticed, once more
    python -m tests.long.mutants score FILE           # print score and survivors

Each fault (`tests.long.faults`) is judged in a process of its own by the tests that go through its
lines, quickest first, until one fails. A fault that runs out of time or memory is noticed. What is
known stays in FILE and FILE.tests, so that a run can go on, on another day too: a fault counts as
judged as long as the function that it lies in stays as it is. `tests/long/judged.jsonl` is a FILE;
`tests/long/equivalent.tsv` says which faults change nothing, and why.
"""

from __future__ import annotations

import json
import math
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path
from types import CodeType
from typing import Any

import pytest

from tests.long.faults import Fault, faults_of, with_fault

ROOT = Path(__file__).parents[2]
FOLDERS = ("stippler/files", "stippler/drawing")
FAULTY = ("stippler.files", "stippler.drawing")
MOST_S = float(os.environ.get("MUTANT_S", "60"))
MOST_TESTS_S = MOST_S / 3
_WALL = 6  # times the processor's time: others may use it, and a fault may wait for ever
MOST_BYTES = 6 << 30


def main(words: Sequence[str]) -> None:
    """Do what the command line says."""
    what, file = words[0], Path(words[1])
    if what == "baseline":
        _keep_baseline(file)
    elif what == "run":
        seed = int(words[3]) if len(words) > 3 else 1
        done = {r["key"] for r in _results(file)}
        chosen = random.Random(seed).sample(all_faults(), int(words[2]))
        _judge_all([f for f in chosen if f.key not in done], file)
    elif what == "again":
        alive = {r["key"] for r in _results(file) if r["end"] != "noticed"} - _equivalent().keys()
        _judge_all([f for f in all_faults() if f.key in alive], file)
    print_score(file)


def all_faults() -> list[Fault]:
    """Return every fault of both folders."""
    files = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py"))
    return [fault for path in files for fault in faults_of(path, ROOT)]


# --- which tests judge --------------------------------------------------------------------------


@dataclass
class Covering:
    """Tests by the lines they go through.

    Attributes
    ----------
    of_line : mapping of path to {line: ids of tests}
    seconds : mapping of id of a test to float
        Of those that pass.
    """

    of_line: dict[str, dict[int, set[str]]] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)

    def tests_of(self, fault: Fault) -> list[str]:
        """Return the tests that judge a fault, those of its own folder first."""
        lines = self.of_line.get(fault.path, {})
        first, last = fault.lines
        found = set[str]().union(*(lines.get(k, set()) for k in range(first, last + 1)))
        if not found:  # a line that runs when the module is imported
            found = set[str]().union(*lines.values())
        own = "tests/" + fault.path.split("/")[1]
        order = sorted(
            (t for t in found if t in self.seconds),
            key=lambda t: (not t.startswith(own), self.seconds[t], t),
        )
        chosen, total = [], 0.0
        for test in order:
            total += self.seconds[test] + 0.02
            if total > MOST_TESTS_S and chosen:
                break
            chosen.append(test)
        return chosen


def contexts(file: Path) -> dict[str, dict[int, set[str]]]:
    """Read which test, without its parameters, went through which line."""
    from coverage import CoverageData

    data = CoverageData(str(file))
    data.read()
    return {
        path: {
            line: {name for name in names if name.startswith("tests/")}
            for line, names in data.contexts_by_lineno(path).items()
        }
        for path in data.measured_files()
    }


class _Recorder:
    """Takes note of what becomes of tests."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.failed: list[str] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        name = report.nodeid.split("[")[0]
        self.seconds[name] = self.seconds.get(name, 0.0) + report.duration
        if report.failed:
            self.failed.append(name)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self.failed.append(report.nodeid)


def _keep_baseline(file: Path) -> None:
    """Run all tests that go through the folders, and keep those that pass, with their time."""
    of_line = contexts(ROOT / ".coverage")
    names = {name for lines in of_line.values() for tests in lines.values() for name in tests}
    files = sorted({name.split("::")[0] for name in names})
    seconds: dict[str, float] = {}
    for k in range(0, len(files), 8):
        found = _in_child(lambda k=k: _run_tests(files[k : k + 8]), None, 900.0)
        if isinstance(found, dict):
            failed = set(found["failed"])
            seconds.update({t: s for t, s in found["seconds"].items() if t not in failed})
            print(f"{files[k]} ...: {len(seconds)} pass; not {sorted(failed)}", flush=True)
    _tests_file(file).write_text(json.dumps(seconds, indent=0, sort_keys=True))


def _tests_file(file: Path) -> Path:
    return file.with_name(file.name + ".tests")


# --- judging ------------------------------------------------------------------------------------


def _judge_all(faults: Sequence[Fault], file: Path) -> None:
    seconds = json.loads(_tests_file(file).read_text())
    covering = Covering(contexts(ROOT / ".coverage"), seconds)
    _warm_up(list(seconds))
    for n, fault in enumerate(faults):
        began = time.monotonic()
        end, by = judge(fault, covering)
        known = {"key": fault.key, "line": fault.lines[0]}
        result = {**known, "what": fault.what, "end": end, "by": by}
        with file.open("a") as out:
            out.write(json.dumps(result) + "\n")
        took = time.monotonic() - began
        place = f"{fault.path}:{fault.lines[0]} {fault.what}"
        print(f"{n + 1}/{len(faults)} {took:.1f} s {place}: {end} {by}", flush=True)


def judge(fault: Fault, covering: Covering) -> tuple[str, str]:
    """Return whether a fault was noticed, and by what."""
    tests = covering.tests_of(fault)
    if not tests:
        return "not reached", ""
    found = _in_child(lambda: _run_tests(tests), fault, _WALL * MOST_S)
    if found is None:
        return "noticed", "time or memory"
    if found["failed"]:
        return "noticed", found["failed"][0]
    return ("survived", f"{len(tests)} tests") if found["code"] == 0 else ("noticed", "import")


def _run_tests(names: Sequence[str]) -> dict[str, Any]:
    recorder = _Recorder()
    stop = ["-x"] if "::" in names[0] else []
    options = ["-q", "--tb=no", "-p", "no:cacheprovider", "-p", "no:xdist", "--no-header", *stop]
    code = pytest.main([*options, *names], plugins=[recorder])
    return {"code": int(code), "seconds": recorder.seconds, "failed": recorder.failed}


def _in_child(work: Any, fault: Fault | None, most_s: float) -> Any:
    """Do work in a process of its own; return what it gives, None if time or memory ran out."""
    folder = tempfile.mkdtemp(prefix="mutant-")
    answer = Path(folder) / "answer.json"
    process = os.fork()
    if process == 0:
        _begin_child(folder, fault)
        try:
            answer.write_text(json.dumps(work()))
        finally:
            os._exit(0)
    try:
        deadline = time.monotonic() + most_s
        while os.waitpid(process, os.WNOHANG) == (0, 0):
            if time.monotonic() > deadline:
                os.killpg(process, signal.SIGKILL)
                os.waitpid(process, 0)
                return None
            time.sleep(0.02)
        return json.loads(answer.read_text()) if answer.exists() else None
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _begin_child(folder: str, fault: Fault | None) -> None:
    os.setsid()
    os.environ["TMPDIR"] = tempfile.tempdir = folder
    os.environ["HYPOTHESIS_PROFILE"] = "mutants"
    if fault is not None:
        resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(MOST_S), math.ceil(MOST_S) + 1))
        sys.meta_path.insert(0, _Finder(fault))
    out = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(out, stream)


class _Finder(MetaPathFinder):
    """Finds one module with a fault in it."""

    def __init__(self, fault: Fault) -> None:
        self._fault = fault
        name = fault.path.removesuffix(".py").replace("/", ".")
        self._name = name.removesuffix(".__init__")

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        if name != self._name:
            return None
        file = ROOT / self._fault.path
        return spec_from_file_location(name, file, loader=_Loader(name, str(file), self._fault))


class _Loader(SourceFileLoader):
    def __init__(self, name: str, path: str, fault: Fault) -> None:
        super().__init__(name, path)
        self._fault = fault

    def get_code(self, fullname: str) -> CodeType:
        return compile(with_fault(Path(self.path), self._fault.number), self.path, "exec")


def _warm_up(tests: Sequence[str]) -> None:
    """Import what tests need and no fault lies in, so that it is not done for each fault."""
    files = sorted({name.split("::")[0] for name in tests})
    for name in _in_child(lambda: _imported_by(files), None, 300.0) or ():
        with suppress(Exception):
            import_module(name)
    assert not any(name.startswith(FAULTY) for name in sys.modules)


def _imported_by(files: Sequence[str]) -> list[str]:
    """Return the modules that tests import, but for those that depend on what has faults."""
    pytest.main(["-q", "--collect-only", "-p", "no:cacheprovider", "-p", "no:xdist", *files])
    ours = ("stippler", "tests", "benchmarks", "__")
    return [n for n in sys.modules if n.startswith("stippler.kernels") or not n.startswith(ours)]


# --- the score ----------------------------------------------------------------------------------


def _results(file: Path) -> list[dict[str, Any]]:
    """Return the last result of each fault that there still is."""
    if not file.exists():
        return []
    lines: Iterator[dict[str, Any]] = map(json.loads, file.read_text().splitlines())
    last = {r["key"]: r for r in lines}
    return [
        {**last[fault.key], "path": fault.path, "line": fault.lines[0]}
        for fault in all_faults()
        if fault.key in last
    ]


def _equivalent() -> dict[str, str]:
    """Return why some faults change nothing that anyone could notice, by their keys."""
    lines = Path(__file__).with_name("equivalent.tsv").read_text().splitlines()
    return dict(line.split("\t", 1) for line in lines)


def print_score(file: Path) -> None:
    """Print how many faults were noticed in each folder, and those that were not."""
    known = _equivalent()
    results = [
        {**r, "end": "equivalent" if r["end"] == "survived" and r["key"] in known else r["end"]}
        for r in _results(file)
    ]
    for folder in FOLDERS:
        ends = Counter(r["end"] for r in results if r["path"].startswith(folder))
        total = ends.total() - ends["equivalent"]
        if total:
            share = f"{ends['noticed']} of {total} ({ends['noticed'] / total:.1%})"
            print(f"{folder}: {share}, beside {ends['equivalent']} that change nothing")
    for r in sorted(results, key=lambda r: (r["path"], r["line"])):
        if r["end"] != "noticed":
            print(f"{r['path']}:{r['line']} {r['what']}: {r['end']}")


if __name__ == "__main__":
    main(sys.argv[1:])
