"""Dots that take the place of others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dot_edit import FIELDS
from stippler.drawing.dots import Dots

if TYPE_CHECKING:
    from stippler.drawing.document import Document


def replace_dots(document: Document, before: NDArray[np.int64], after: Dots) -> None:
    """Let dots take the place of others, within a stroke.

    Those whose ids are among the others' change; all that are left are added, with ids of their
    own: what ids they have may be those of dots elsewhere.

    Parameters
    ----------
    before : ids of dots
    """
    document.remove(document.rows(before[~np.isin(before, after.id)]))
    known = np.isin(after.id, before)
    rows, kept = document.rows(after.id[known]), after.take(np.flatnonzero(known))
    for name in FIELDS:
        document.change(name, rows, getattr(kept, name))
    document.insert(after.take(np.flatnonzero(~known)))
