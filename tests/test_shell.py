"""The command line among shells, pipes, services and signals: one line or none, right exit code."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from stippler.files.write.table import FIRST_COLUMNS as COLUMNS

WAIT_S = 180
ODD = r"$'caf\xe9'"  # in Latin-1
QUICK = "--dots 60 --iterations 1"
TEXT = f"{COLUMNS}\n9,9,0.5,1,0,0,1,0,0\n5,5,0.5,1,0,0,1,0,0\n8,3,0.5,1,0,0,1,0,0\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a picture, a table, and `stippler` as a command."""
    made = tmp_path_factory.mktemp("shell")
    Image.fromarray(np.arange(0, 256, 4, dtype=np.uint8).reshape(8, 8)).save(made / "p.png")
    (made / "dots.csv").write_text(TEXT)
    command = made / "stippler"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m stippler "$@"\n')
    command.chmod(0o755)
    return made


def shell(folder, line, **env):
    path = f"{folder}:{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, capture_output=True, timeout=WAIT_S, check=False,
        env={**os.environ, "PATH": path, **env},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip


SVG, PNG, TABLE = b"<svg", b"\x89PNG\r\n\x1a\n", COLUMNS.encode()
LINES = {
    # what runs: exit code, what standard output begins with or holds, words on standard error
    f"cat p.png | stippler render - -o - --format svg {QUICK}": (0, SVG, ""),
    f"cat p.png | stippler render - -o - --format csv {QUICK}": (0, TABLE, ""),
    f"cat p.png | stippler render - -o - --format png {QUICK}": (0, PNG, ""),
    f"stippler render - -o - --format csv {QUICK} < p.png": (0, TABLE, ""),
    f"cat p.png | stippler render /dev/stdin -o /dev/stdout --format csv {QUICK}": (0, TABLE, ""),
    f"stippler render <(cat p.png) -o >(cat) --format csv {QUICK} | cat": (0, TABLE, ""),
    f"mkfifo in1; cat p.png > in1 & stippler render in1 -o - --format csv {QUICK}": (0, TABLE, ""),
    f"mkfifo out1; cat out1 & stippler render p.png -o out1 --format csv {QUICK}; wait":
        (0, TABLE, ""),
    f"stippler render p.png -o a.dat --format csv {QUICK}; cat a.dat": (0, TABLE, ""),
    f"echo before; stippler render p.png -o /dev/stdout --format csv {QUICK} >> log; cat log":
        (0, TABLE, ""),
    "cat dots.csv | stippler stats - | head -1": (0, b"dots ", ""),
    "stippler stats - < dots.csv": (0, b"dots ", ""),
    "stippler stats <(cat dots.csv) | cat": (0, b"dots ", ""),
    "stippler render p.png -o -": (2, b"", "--format"),
    "stippler render p.png -o b.svg --format doc": (2, b"", "is no format; choose"),
    "echo hello | stippler render - -o c.svg": (1, b"", "standard input: is no picture"),
    "printf '' | stippler render - -o c.svg": (1, b"", "standard input: is empty"),
    "cat dots.csv | stippler render - -o c.svg": (1, b"", "standard input: is a table of numbers"),
    "stippler render - -o c.svg <&-": (1, b"", "standard input: is closed"),
    "stippler render . -o c.svg": (1, b"", "is a folder"),
    f"stippler render p.png -o - --format csv {QUICK} >&-": (1, b"", "standard output"),
    f"stippler render p.png -o - --format csv {QUICK} > /dev/full": (1, b"", "disk is full"),
    "stippler render p.png -o - --format svg --dots 9000 | true; echo ${PIPESTATUS[0]}":
        (0, b"1\n", None),
    f"stippler render p.png -o d.csv {QUICK} >&- 2>&-; cat d.csv": (0, TABLE, ""),
    f"stippler render p.png -o e.csv {QUICK} <&- >&- 2>&-; cat e.csv": (0, TABLE, ""),
    "stippler render none.png -o f.csv >&- 2>&-": (1, b"", ""),
    "stippler render none.png -o f.csv 2> /dev/full": (1, b"", ""),
    "stippler stats dots.csv > /dev/full": (1, b"", "standard output"),
    "stippler stats dots.csv >&-": (0, b"", ""),
    "stippler --help > /dev/full": (1, b"", "standard output"),
    "stippler --version >&-": (0, b"", ""),
    "stippler --help | true; echo ${PIPESTATUS[0]}": (0, b"", None),
    f"stippler render p.png -o p.png {QUICK}": (1, b"", "the very file that is read"),
    f"stippler render - -o p.png {QUICK} < p.png": (1, b"", "the very file that is read"),
    "ln -s loop loop; stippler render loop -o g.svg": (1, b"", "loop"),
    f"ln -s l.svg k.svg; ln -s k.svg l.svg; stippler render p.png -o k.svg {QUICK}":
        (1, b"", "leads back to itself"),
    f"cp p.png {ODD}.png; stippler render {ODD}.png -o {ODD}.csv {QUICK}; cat {ODD}.csv":
        (0, TABLE, ""),
    "stippler render $'gon\\xe9.png' -o h.svg": (1, b"", "gon"),
    f"stippler render p.png -o {'線' * 83}.c {QUICK}": (1, b"", "ending"),
    f"stippler render p.png -o {'線' * 82}.csv {QUICK}; cat {'線' * 82}.csv": (0, TABLE, ""),
    f"stippler render p.png -o {'線' * 90}.csv {QUICK}": (1, b"", "too long"),
    "stippler render p.png -o i.svg --width 0.001": (2, b"", "0.01 to"),
    "stippler render p.png -o i.png --dpi 1e9": (2, b"", "dpi"),
    "stippler render p.png -o i.png --dpi 1e-9": (2, b"", "dpi"),
    f"NUMBA_NUM_THREADS=none stippler render p.png -o j.csv {QUICK}; cat j.csv": (0, TABLE, ""),
    f"NUMBA_OPT=x NUMBA_DISABLE_JIT=maybe stippler render p.png -o j.csv {QUICK}; cat j.csv":
        (0, TABLE, ""),
    f"taskset -c 0 stippler render p.png -o n.csv {QUICK}; cat n.csv": (0, TABLE, ""),
}  # fmt: skip


@pytest.mark.parametrize("line", LINES)
def test_a_line_of_a_shell(folder, line):
    status, out, words = LINES[line]
    before = (folder / "p.png").read_bytes()
    result = shell(folder, line)
    told = result.stderr.decode()
    assert result.returncode == status, told
    assert out in result.stdout
    assert "Traceback" not in told
    assert "Exception" not in told
    if words is not None:
        assert told.count("\n") == (1 if words else 0), told
        assert words in told
    assert (folder / "p.png").read_bytes() == before
    assert not [name for name in os.listdir(folder) if name.endswith(".part")]


STOPS = {"INT": 130, "TERM": 143, "HUP": 129}


def not_ignored():
    """Take signals as a shell of one's own does, even where the tests run under nohup."""
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


@pytest.mark.parametrize("name", STOPS)
@pytest.mark.parametrize("after_s", [0.06, 0.12, 0.2, 0.35, 0.6, 1.0, 2.0])
def test_a_signal_at_any_moment(folder, name, after_s):
    out = folder / "stopped.svg"
    out.write_bytes(b"before")
    process = subprocess.Popen(
        [sys.executable, "-m", "stippler", "render", folder / "p.png", "-o", out,
         "--dots", "30000", "--iterations", "100000"],
        stderr=subprocess.PIPE, text=True,
        preexec_fn=not_ignored,
    )  # fmt: skip
    time.sleep(after_s)
    number = getattr(signal, f"SIG{name}")
    process.send_signal(number)
    _, told = process.communicate(timeout=WAIT_S)
    # before Python runs a line of ours, the system's own way applies
    assert process.returncode in (STOPS[name], -number), told
    if process.returncode > 0:
        assert told == "stippler: stopped; nothing was written\n"
    assert out.read_bytes() == b"before"
    assert not [p for p in folder.iterdir() if p.name.endswith(".part")]


def test_what_was_ignored_stays_ignored(folder):
    result = shell(
        folder,
        "(trap '' HUP; stippler render p.png -o nohup.csv --dots 3000 & pid=$!;"
        " sleep 0.5; kill -HUP $pid; wait $pid)",
    )
    assert result.returncode == 0, result.stderr
    assert (folder / "nohup.csv").exists()


def test_two_signals_are_as_one(folder):
    line = (
        "stippler render p.png -o two.svg --dots 30000 --iterations 100000 & pid=$!; sleep 1;"
        " kill -TERM $pid; kill -TERM $pid; wait $pid"
    )
    result = shell(folder, line)
    assert result.returncode == 143
    assert result.stderr == b"stippler: stopped; nothing was written\n"
    assert not Path(folder / "two.svg").exists()
