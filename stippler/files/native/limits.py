"""What a file may hold at most: checked against what it declares, before any memory is taken."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds on a file's content.

    Attributes
    ----------
    file_bytes, member_bytes, total_bytes : int
        Of the file, of one member unpacked, and of all members unpacked.
    members : int
    ratio : float
        Unpacked over packed, of one member; deflate itself reaches 1032.
    structure_bytes : int
        Of one JSON document.
    """

    file_bytes: int = 4 << 30
    member_bytes: int = 2 << 30
    total_bytes: int = 4 << 30
    members: int = 4096
    ratio: float = 1100.0
    structure_bytes: int = 256 << 20


DEFAULT_LIMITS = Limits()
