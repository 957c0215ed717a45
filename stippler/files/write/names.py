"""Names of layers as formats can hold them."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufffe\uffff]+")


def one_line(name: str) -> str:
    """Return a name without control characters, line breaks or halves of characters."""
    return " ".join(_CONTROL.sub(" ", name).split()) or "unnamed"


def plain(name: str) -> str:
    """Return a name of letters, digits, hyphens and underscores of ASCII."""
    ascii_only = unicodedata.normalize("NFKD", one_line(name)).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9_-]+", "-", ascii_only).strip("-")[:31] or "layer"


def unique(names: Iterable[str]) -> list[str]:
    """Return names that differ, whatever their case, by numbers at their ends."""
    seen: set[str] = set()
    result = []
    for name in names:
        one, k = name, 1
        while one.lower() in seen:
            k += 1
            end = f"-{k}"
            one = name[: 31 - len(end)] + end
        seen.add(one.lower())
        result.append(one)
    return result
