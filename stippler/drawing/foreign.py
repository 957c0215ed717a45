"""What a later program has put into a drawing's file: not understood here, kept and given back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Foreign:
    """Parts of a file that this program does not know.

    Attributes
    ----------
    document : mapping
        Fields of the document itself.
    fields : mapping of (kind, id) to mapping
        Fields of values.
    members : mapping of name to bytes
    """

    document: Mapping[str, Any] = field(default_factory=dict)
    fields: Mapping[tuple[str, int], Mapping[str, Any]] = field(default_factory=dict)
    members: Mapping[str, bytes] = field(default_factory=dict)
