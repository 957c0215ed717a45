"""Which processor this is, found without numba."""

from __future__ import annotations

import hashlib
import os
import platform
from functools import cache
from pathlib import Path

_LEVELS = {
    "x86-64-v4": {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"},
    "x86-64-v3": {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe", "abm", "xsave"},
    "x86-64-v2": {"cx16", "popcnt", "sse4_1", "sse4_2", "ssse3"},
}
"""What a level asks for beyond those below it, as the x86-64 psABI lists it, in Linux's names."""


@cache
def _about() -> tuple[str, frozenset[str]]:
    """Return a processor's name and its features; only Linux tells the latter."""
    name, features = platform.machine(), frozenset[str]()
    try:
        with Path("/proc/cpuinfo").open(encoding="utf-8", errors="replace") as lines:
            for line in lines:
                key, _, value = line.partition(":")
                if key.strip() in ("model name", "CPU part", "CPU implementer"):
                    name += value.strip()
                elif key.strip() in ("flags", "Features"):
                    features = frozenset(value.split())
                    break
    except OSError:
        pass
    return name, features


def processor_key() -> str:
    """Return what tells machine code for this processor from that for another."""
    asked = [os.environ.get(name, "") for name in ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES")]
    name, features = _about()
    text = " ".join([name, *sorted(features), *asked])
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def levels() -> tuple[str, ...]:
    """Return the levels that wheels carry kernels for on this kind of machine."""
    machine = platform.machine()
    return tuple(_LEVELS) if machine == "x86_64" else (f"{machine}-generic",)


def level() -> str:
    """Return the highest level that this processor has; empty if none."""
    _, features = _about()
    asked = levels()
    for k, name in enumerate(asked):
        if all(_LEVELS.get(lower, set()) <= features for lower in asked[k:]):
            return name
    return "none"


def reads_lanes() -> bool:
    """Whether kernels are compiled for processors that read numbers from many places at once.

    Others read them one by one: what is gained by lanes then is lost by that.
    """
    name = os.environ.get("NUMBA_CPU_NAME") or level()
    if name.startswith("x86-64"):
        return name >= "x86-64-v3"
    return platform.machine().lower() in ("x86_64", "amd64") and not _about()[1]  # most do
