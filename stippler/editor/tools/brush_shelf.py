"""The brushes at hand: each type at least once, and those that a person has made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from stippler.brushes.brush import Brush, first_brushes
from stippler.brushes.presets import load_brushes, save_brushes
from stippler.editor.messages import INFO, WARNING
from stippler.errors import StipplerError

Say = Callable[[str, str], None]
_SAVED_AFTER_S = 2.0


class BrushShelf:
    """Brushes in order of their types, each type with one in use.

    Parameters
    ----------
    path : Path
        Where they are kept.
    say : callable
        Tells the person a line, with how grave it is.
    """

    def __init__(self, path: Path, say: Say) -> None:
        self._path, self._say = path, say
        self.brushes, problem = load_brushes(path)
        if problem:
            say(f"some brushes could not be loaded: {problem}", WARNING)
        self._used: dict[str, int] = {}  # of each type, which of its brushes
        self._lent: list[Brush] = []
        self._deleted: list[tuple[int, Brush]] = []
        self._unsaved = bool(problem)  # what could be read is written anew
        self._due_s: float | None = None

    def of(self, kind: str) -> list[Brush]:
        """Return the brushes of a type."""
        return [brush for brush in self.brushes if brush.kind == kind]

    def used(self, kind: str) -> Brush:
        """Return the brush of a type that is in use."""
        return self.of(kind)[self.place(kind)]

    def place(self, kind: str) -> int:
        """Return which of its type's brushes is in use."""
        return min(self._used.get(kind, 0), len(self.of(kind)) - 1)

    def in_use(self) -> list[Brush]:
        """Return the brush in use of each type."""
        return [self.used(kind) for kind in dict.fromkeys(brush.kind for brush in self.brushes)]

    def lend(self, brushes: list[Brush]) -> None:
        """Use brushes that came with a drawing; those of the drawing before go.

        One that is not on the shelf stands there until another drawing is opened, and is kept
        only if a person changes it.
        """
        for brush in self._lent:
            if brush in self.brushes and len(self.of(brush.kind)) > 1:
                self.brushes.remove(brush)
        self._lent = []
        for brush in brushes:
            if brush not in self.brushes:
                at = max(k for k, b in enumerate(self.brushes) if b.kind == brush.kind) + 1
                self.brushes.insert(at, brush)
                self._lent.append(brush)
            self._used[brush.kind] = self.of(brush.kind).index(brush)

    def use(self, kind: str, k: int) -> None:
        """Use one of a type's brushes."""
        self._used[kind] = k

    def use_next(self, kind: str) -> None:
        """Use the next of a type's brushes."""
        self._used[kind] = (self.place(kind) + 1) % len(self.of(kind))

    def set(self, brush: Brush) -> None:
        """Change the brush in use of a type."""
        at = self._index(brush.kind)
        if brush != self.brushes[at]:
            self.brushes[at] = brush
            self._note()

    def copy(self, kind: str) -> None:
        """Add a copy of the brush in use, and use that."""
        brush, names = self.used(kind), {brush.name for brush in self.brushes}
        n = next(n for n in range(2, len(names) + 3) if f"{brush.name} {n}" not in names)
        self.brushes.insert(self._index(kind) + 1, replace(brush, name=f"{brush.name} {n}"))
        self._used[kind] = self.place(kind) + 1
        self._note()

    def delete(self, kind: str) -> None:
        """Remove the brush in use, if its type has another."""
        if len(self.of(kind)) < 2:
            return
        at = self._index(kind)
        brush = self.brushes.pop(at)
        self._deleted.append((self.place(kind), brush))
        self._used[kind] = 0
        self._note()
        self._say(f"{brush.name} is deleted; Restore deleted brush brings it back", INFO)

    @property
    def can_restore(self) -> bool:
        """Whether a brush has been deleted since the start."""
        return bool(self._deleted)

    def restore(self) -> str:
        """Bring the brush back that was deleted last; return its type, empty if there is none."""
        if not self._deleted:
            return ""
        k, brush = self._deleted.pop()
        first = next(at for at, b in enumerate(self.brushes) if b.kind == brush.kind)
        k = min(k, len(self.of(brush.kind)))
        self.brushes.insert(first + k, brush)
        self._used[brush.kind] = k
        self._note()
        return brush.kind

    def reset(self, kind: str) -> None:
        """Give the brush in use the values that its type has at first; its name stays."""
        first = next(brush for brush in first_brushes() if brush.kind == kind)
        self.set(replace(first, name=self.used(kind).name))

    def _index(self, kind: str) -> int:
        first = next(at for at, brush in enumerate(self.brushes) if brush.kind == kind)
        return first + self.place(kind)

    # --- the file ---------------------------------------------------------------------------

    def _note(self) -> None:
        self._unsaved, self._due_s = True, None

    def save(self) -> None:
        """Keep the brushes, if they have changed."""
        if self._unsaved:
            self._unsaved = False
            try:
                own = [brush for brush in self.brushes if brush not in self._lent]
                save_brushes(self._path, own)
            except StipplerError as error:
                self._say(str(error), WARNING)

    def save_soon(self, now_s: float) -> float | None:
        """Keep changes that are some seconds old; return when to ask again, None is not at all."""
        if not self._unsaved:
            return None
        self._due_s = now_s + _SAVED_AFTER_S if self._due_s is None else self._due_s
        if now_s < self._due_s:
            return self._due_s
        self.save()
        return None
