"""What has changed in a document, for any number of followers, each with a cursor of its own."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from stippler.drawing.ids import Rows

_MOST_PARTS = 256


@dataclass(frozen=True, slots=True, eq=False)
class Changed:
    """What has changed since a cursor.

    Attributes
    ----------
    rows : array or None
        Of dots that have changed, sorted; None is all of them.
    places : bool
        Whether a result has moved or sized dots all over the drawing, besides.
    records : frozenset of (kind, id)
        Values of other kinds that have changed.
    cursor : int
        To be given to `Changes.since` the next time, once all this has been taken in.
    """

    rows: Rows | None
    places: bool
    records: frozenset[tuple[str, int]]
    cursor: int

    def has(self, kind: str) -> bool:
        """Whether any value of a kind has changed."""
        return any(changed == kind for changed, _ in self.records)


class Changes:
    """The changes of a document, as far back as followers who keep up need them.

    Attributes
    ----------
    now : int
        Grows with every change; the cursor of a follower who knows everything. One who knows
        nothing has the cursor 0.
    """

    def __init__(self) -> None:
        self.now = 1
        self._n_dots = 0
        self._rows: deque[tuple[int, Rows]] = deque()
        self._all_since = 1  # who has an older cursor has to look at all dots
        self._places_at = 0
        self._records: dict[tuple[str, int], int] = {}

    def note_rows(self, rows: Rows, n_dots: int) -> None:
        """Take note of rows of dots that changed; those from `n_dots` on are there no longer."""
        self.now += 1
        self._n_dots = n_dots
        if len(rows) >= n_dots > 0:
            self._forget_rows(self.now)
            return
        self._rows.append((self.now, rows))
        if len(self._rows) > _MOST_PARTS:
            half = len(self._rows) // 2
            self._all_since = self._rows[half - 1][0]
            for _ in range(half):
                self._rows.popleft()

    def note_all(self, n_dots: int) -> None:
        """Take note that any dot may have changed in any way."""
        self.now += 1
        self._n_dots = n_dots
        self._forget_rows(self.now)

    def note_places(self) -> None:
        """Take note that a result has moved or sized dots all over the drawing."""
        self.now += 1
        self._places_at = self.now

    def note_record(self, kind: str, i: int) -> None:
        """Take note of a value that changed."""
        self.now += 1
        self._records[kind, i] = self.now

    def since(self, cursor: int) -> Changed:
        """Return what has changed after a cursor."""
        from stippler.drawing.store import union

        records = frozenset(key for key, at in self._records.items() if at > cursor)
        rows = None
        if cursor >= self._all_since:
            n = self._n_dots
            rows = union([rows[rows < n] for at, rows in self._rows if at > cursor], n)
        return Changed(rows, self._places_at > cursor, records, self.now)

    def _forget_rows(self, at: int) -> None:
        self._rows.clear()
        self._all_since = at
