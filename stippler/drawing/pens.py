"""What a pen makes of a dot's shape, and how a brush would change it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Preview:
    """A change of size and shape, shown on dots before it is made."""
