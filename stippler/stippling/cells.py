"""The cells of all dots, computed from nothing or carried over from the step before."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.kernels.cells.big_cells import MANY
from stippler.kernels.cells.grid import find_grid_cells, sort_by_grid_cell
from stippler.kernels.cells.kept_cells import check_stars, renumber_stars, verify_stars
from stippler.kernels.cells.relaxation import INNER, RIM, TOO_MANY_CORNERS, relax_dots
from stippler.kernels.cells.spacing import UNIT
from stippler.kernels.cells.spacing_lanes import LEAST, MASS, NEIGHBOUR
from stippler.kernels.cells.tables import Dots, Field, Grid, Moves, Outlines, Spacing, Stars
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.machine.simd import LANES, SCAN
from stippler.stippling.compartments import RECTANGLE, Compartments
from stippler.stippling.crowds import Crowds
from stippler.stippling.dotgrid import DotGrid
from stippler.stippling.field_sums import NO_FIELD, Weights, running_sums
from stippler.stippling.spacing import Rules, Wanted

Floats = NDArray[np.float64]
Rows = NDArray[np.int32]
Question = Callable[[], bool] | None
Redirect = Callable[[Floats, Floats], Floats]
"""Given where dots are and where a step would take them, (n, 2) mm, returns where they shall go."""


@runtime_checkable
class Crossing(Protocol):
    """A `Redirect` that may send some dots into other compartments, `may_cross` by dot."""

    may_cross: NDArray[np.bool_]

    def __call__(self, before: Floats, wanted: Floats) -> Floats:
        """Return where dots shall go."""
        ...


CORNER_CAP = MANY
GRAIN = 4096
GATHERED = 32
"""Ranges for each thread in which rows are brought into order: a range of all fits the cache."""

FEW = 256
"""Smallest share of a thread where cells are computed one by one, and of a list of them."""

PART, AT_ONCE = 2048, 8
"""Dots that a thread outlines the cells of, and how many such parts are made before a pause."""

KEEP_BELOW = 0.25
"""Mean move, in spacings, below which stars are worth keeping."""

MOST_TODO = 0.5
"""Share of stars that fail from which on all cells are computed from nothing."""

ELSEWHERE = int(np.iinfo(np.int32).min)
"""Number of a dot beyond a side whose own cell is not asked for."""

SLACK = 0.5
"""How far, in grid cells, dots may go before they are sorted anew."""

_NO_ROWS = np.empty(0, np.int32)
_NO_CELLS = np.empty((0, 6))
_NO_FLAGS = np.empty(0, np.uint8)
_NO_STARS = Stars(np.empty((0, LANES), np.int32), _NO_FLAGS, _NO_FLAGS)
NO_OUTLINES = Outlines(np.empty((0, 2)), _NO_ROWS, _NO_ROWS, _NO_ROWS, np.zeros(1, np.int64))
_NO_WANTS = np.empty((0, 3))
LLOYD = Spacing(_NO_WANTS, _NO_WANTS, np.empty((0, 2)), np.empty((0, 4)), np.empty(0), np.empty(11))
"""No rules: dots go to the centroids of their cells."""


class Cells:
    """Dots sorted into grids, and the stars of their cells.

    Row arrays are in the order of the grid; ``order[row]`` is the dot's place in what was given.
    """

    def __init__(
        self,
        xy: Floats,
        fixed: NDArray[np.bool_],
        compartment_of_dot: Rows,
        parts: Compartments,
        density: Weights | None,
        over: float,
    ) -> None:
        n = len(xy)
        self.n, self.over = n, over
        self.xs, self.ys = np.zeros(n + SCAN), np.zeros(n + SCAN)
        self.xs[:n], self.ys[:n] = xy.T
        self.fixed, self.compartment_of_dot = fixed, compartment_of_dot
        self.order = np.arange(n, dtype=np.int32)
        self.parts = parts
        self.grid = DotGrid.over(parts, np.bincount(compartment_of_dot, minlength=len(parts)))
        self.spacing = float(np.sqrt(parts.area.sum() / max(n, 1)))
        self._cell_start = np.zeros(self.grid.n_cells + 1, np.int32)
        self._crowds = Crowds.none()
        self._field = running_sums(density, parts)
        self._slack = np.inf
        self._keep = False
        self._star = np.zeros((n, LANES), np.int32)
        self._n_star = np.zeros(n, np.uint8)
        self._kind_of_cell = np.zeros(n, np.uint8)
        self._free_of_dot = np.zeros(n)
        self._has_stars = False
        self.n_failed = n  # stars of the step before that did not hold
        self.rules, self._is_measured, self._is_met = LLOYD, True, np.zeros(self.n, np.bool_)
        self._has_met = False

    def space_by(
        self,
        wanted: Wanted | Sequence[Wanted],
        radius_mm: Floats | None = None,
        is_met: NDArray[np.bool_] | None = None,
    ) -> None:
        """Move dots by the rules of even spacing from now on; what is wanted goes by the field.

        One thing is wanted of all, or one of each shape. With radii given, by dot, density follows
        from these and the tone. The mass of dots that are met counts as what they want.
        """
        n = self.n
        self._sort(self._has_stars)
        self._is_met = np.zeros(n, np.bool_) if is_met is None else is_met[self.order]
        self._has_met = bool(self._is_met.any())
        each = [wanted] if isinstance(wanted, Wanted) else list(wanted)
        tables = [one.table() for one in each]
        rows = np.array([len(table) for table in tables])
        scale = np.array([one.scale for one in each])
        part = np.column_stack([np.cumsum(rows) - rows, rows, scale, np.ones(len(each))])
        of_shape = np.zeros_like(self.parts.shape_of) if len(each) == 1 else self.parts.shape_of
        self.rules = Spacing(
            np.zeros((n, 3)), np.zeros((n, 3)), np.concatenate(tables), part[of_shape],
            np.empty(0) if radius_mm is None else np.asarray(radius_mm, np.float64)[self.order],
            Rules().array(),
        )  # fmt: skip
        self._is_measured = False

    def _measure_wants(self) -> None:
        """Find what dots want before the first step that asks for it; Lloyd's asks for nothing."""
        if self._is_measured or self.rules.rule[LEAST] >= 1.0:
            return
        self._relax(np.arange(self.n, dtype=np.int32), False, self._new_moves())
        self._hand_over_wants()

    def _hand_over_wants(self) -> None:
        """Let the next step go by what this one has found."""
        if not self._is_measured:
            self._fit_wants_to_number()
        if self._has_met:
            self.rules.found[self._is_met, MASS] = 1.0
        self.rules = self.rules._replace(wants=self.rules.found, found=self.rules.wants)

    def _fit_wants_to_number(self) -> None:
        """Scale what is found so that all dots of a compartment want as many as there are."""
        n_parts, owner, found = len(self.parts), self.compartment_of_dot, self.rules.found
        mass = np.bincount(owner, found[:, MASS], minlength=n_parts)
        count = np.bincount(owner, minlength=n_parts)
        unit = np.divide(count, mass, out=np.ones(n_parts), where=mass > 0)
        found[:, MASS] *= unit[owner]
        found[:, NEIGHBOUR] /= np.sqrt(unit[owner])
        of_part = self.rules.of_part.copy()
        of_part[:, UNIT] = unit
        self.rules, self._is_measured = self.rules._replace(of_part=of_part), True

    def set_rules(self, rules: Rules) -> None:
        """Change how strictly dots are spaced."""
        self.rules = self.rules._replace(rule=rules.array())

    @property
    def keeps_stars(self) -> bool:
        """Whether the next step starts from this step's stars."""
        return self._has_stars and self._keep

    @property
    def xy(self) -> Floats:
        """Positions in the order given, fresh."""
        out = np.empty((self.n, 2))
        out[self.order, 0] = self.xs[: self.n]
        out[self.order, 1] = self.ys[: self.n]
        return out

    def step(self, cancel: Question = None, redirect: Redirect | None = None) -> Floats | None:
        """Move every free dot once; return how far each row went, or None if cancelled."""
        self._measure_wants()
        new = self._new_moves()
        done = self.keeps_stars and self._step_from_stars(new, cancel)
        if not done:
            self._has_stars, self.n_failed = False, self.n
            done = self._sort(cancel=cancel) and self._step_from_nothing(new, cancel)
            self._has_stars = done
        if not done:
            return None
        if redirect is not None:
            self._redirect(new, redirect)
        self.xs, self.ys = new.x, new.y
        self._hand_over_wants()
        if self.n:
            self._slack += float(new.gone.max())
            self._keep = float(new.gone.mean()) < KEEP_BELOW * self.spacing
        return new.gone

    def _redirect(self, new: Moves, redirect: Redirect) -> None:
        """Let others choose where free dots go; one sent out of its compartment stays."""
        n, order = self.n, self.order
        wanted = np.empty((n, 2))
        wanted[order] = np.column_stack([new.x[:n], new.y[:n]])
        chosen = np.array(redirect(self.xy, wanted.copy()), np.float64)
        if chosen.shape != (n, 2) or not np.isfinite(chosen).all():
            raise ParameterError(f"gave shape {chosen.shape} or what is not finite", "redirect")
        rows = np.flatnonzero((chosen != wanted).any(axis=1)[order] & ~self.fixed)
        at = chosen[order[rows]]
        gone = np.hypot(at[:, 0] - self.xs[rows], at[:, 1] - self.ys[rows])
        free = new.free[rows] + new.gone[rows]
        owner = self.compartment_of_dot[rows]
        near = np.flatnonzero(~(gone < free) | (self.parts.kind[owner] == RECTANGLE))
        out = near[~self.parts.contain(at[near], owner[near])]
        if len(out) and isinstance(redirect, Crossing):
            out = self._cross(rows, at, out, redirect.may_cross)
        at[out] = np.column_stack([self.xs[rows[out]], self.ys[rows[out]]])
        gone[out] = 0.0
        new.x[rows], new.y[rows] = at.T
        new.gone[rows], new.free[rows] = gone, free - gone

    def _cross(
        self, rows: NDArray[np.intp], at: Floats, out: NDArray[np.intp], may: NDArray[np.bool_]
    ) -> NDArray[np.intp]:
        """Let dots go to the compartments they are sent to; return those of `out` that cannot."""
        asked = out[may[self.order[rows[out]]]]
        found = self.parts.at(at[asked])
        goes = asked[found >= 0]
        if len(goes):
            self.compartment_of_dot = self.compartment_of_dot.copy()
            self.compartment_of_dot[rows[goes]] = found[found >= 0]
            self._slack, self._has_stars = np.inf, False  # all is found anew
        return np.setdiff1d(out, goes)

    def measure(self, weighted: bool) -> Floats:
        """Return mass, centroid from the dot, area, second moment of cells, in the order given."""
        self._sort(self._has_stars)
        cells = np.zeros((self.n, 6))
        rows = np.arange(self.n, dtype=np.int32)
        rules, self.rules = self.rules, LLOYD
        self._relax(rows, False, self._scratch_moves(), cells, weighted, _NO_STARS)
        self.rules = rules
        out = np.empty_like(cells)
        out[self.order] = cells
        return out

    def outline(
        self, weighted: bool, which: Rows | None = None
    ) -> Generator[float, None, tuple[Outlines, Rows, Floats]]:
        """Find the outlines of all cells, in the order given, or of the dots `which` alone.

        Yields the share done. Returns them with the row of each one's dot and, (6, n), what
        `measure` returns. The dots beyond sides have the numbers they were given in, or are the
        places in `which` and `ELSEWHERE`.
        """
        self._sort(self._has_stars)
        number, row_of_dot = self.order, np.empty(self.n, np.int32)
        row_of_dot[self.order] = np.arange(self.n, dtype=np.int32)
        rows = row_of_dot if which is None else row_of_dot[which]
        n = len(rows)
        if which is not None:
            number = np.full(self.n, ELSEWHERE, np.int32)
            number[rows] = np.arange(n, dtype=np.int32)
        n_parts = max(n // PART, min(n // FEW, AT_ONCE), 1)
        ends = np.arange(n_parts + 1) * n // n_parts
        room, used = 8 * np.diff(ends) + 64, np.zeros(n_parts, np.int64)
        n_sides, cells, measured = np.zeros(n, np.int32), np.zeros((self.n, 6)), np.empty((6, n))
        new = self._scratch_moves()
        dots = self._dots._replace(fixed=np.empty(0, np.bool_))

        def outline_part(k: int) -> None:
            mine, place = slice(ends[k], ends[k + 1]), slice(last[k] - room[k], last[k])
            out = Outlines(corner[place], beyond[place], following[place], n_sides, used[k : k + 1])
            cap = CORNER_CAP
            while True:
                used[k] = 0
                relax_dots(
                    mine.start, mine.stop, cap, rows, False, dots, self._table, self.grid.border,
                    self._field_for(weighted), self.over, new, cells, _NO_STARS, out, LLOYD,
                )  # fmt: skip
                if not (new.kind[rows[mine]] == TOO_MANY_CORNERS).any():
                    break
                cap *= 16
            other = out.beyond[: used[k]]
            is_dot = other >= 0
            other[is_dot] = number[other[is_dot]]
            measured[:, mine] = cells[rows[mine]].T

        while True:
            last = np.cumsum(room)
            corner, beyond, following = _room_for_sides(int(last[-1]))
            for first in range(0, n_parts, AT_ONCE):

                def parts(start: int, stop: int, first: int = first) -> None:
                    for k in range(first + start, first + stop):
                        outline_part(k)

                parallel_for(parts, min(AT_ONCE, n_parts - first), grain=1, chunks=AT_ONCE)
                yield min((first + AT_ONCE) / n_parts, 1.0)
            if (used <= room).all():
                break
            room = used.copy()
        n_used = 0
        for start, count in zip(last - room, used, strict=True):
            source, target = slice(start, start + count), slice(n_used, n_used + count)
            corner[target], beyond[target] = corner[source], beyond[source]
            following[target] = following[source] + n_used
            n_used += int(count)
        found = corner[:n_used], beyond[:n_used], following[:n_used]
        return Outlines(*found, n_sides, np.array([n_used])), rows, measured

    def _field_for(self, weighted: bool) -> Field:
        return self._field if weighted else NO_FIELD

    def _new_moves(self) -> Moves:
        n = self.n
        new = np.zeros(n + SCAN), np.zeros(n + SCAN), np.empty(n)
        return Moves(*new, self._kind_of_cell, self._free_of_dot)

    def _scratch_moves(self) -> Moves:
        """Return room for moves that leaves what is known of kept cells alone."""
        return self._new_moves()._replace(kind=np.zeros(self.n, np.uint8), free=np.empty(self.n))

    @property
    def _dots(self) -> Dots:
        return Dots(self.xs, self.ys, self.fixed, self.compartment_of_dot)

    @property
    def _table(self) -> Grid:
        real, whole = self.grid.real, self.grid.whole
        return Grid(real, whole, self._cell_start, self._slack, *self._crowds.tables)

    def _relax(
        self,
        which: Rows,
        is_all: bool,
        new: Moves,
        cells: Floats = _NO_CELLS,
        weighted: bool = True,
        stars: Stars = _NO_STARS,
        cancel: Question = None,
    ) -> bool:
        """Compute cells from nothing; once more, with more room, those of very many corners."""
        field = self._field_for(weighted)
        dots = self._dots
        if len(cells):
            dots = dots._replace(fixed=np.empty(0, np.bool_))
        cap, n = CORNER_CAP, self.n if is_all else len(which)
        while n:
            done = parallel_for(
                relax_dots, n, cap, which, is_all, dots, self._table, self.grid.border, field,
                self.over, new, cells, stars, NO_OUTLINES, self.rules,
                grain=GRAIN if is_all else FEW, chunks=8, cancel=cancel,
            )  # fmt: skip
            if not done:
                return False
            if is_all:
                which = np.flatnonzero(new.kind == TOO_MANY_CORNERS).astype(np.int32)
            else:
                which = which[new.kind[which] == TOO_MANY_CORNERS]
            is_all, n, cap = False, len(which), 16 * cap
        return True

    def _step_from_nothing(self, new: Moves, cancel: Question) -> bool:
        new = new._replace(kind=self._kind_of_cell, free=self._free_of_dot)
        stars = Stars(self._star, self._n_star, _NO_FLAGS)
        done = self._relax(_NO_ROWS, True, new, stars=stars, cancel=cancel)
        if done:
            self._distrust(np.ones(self.n, np.bool_))
        return done

    def _distrust(self, computed: NDArray[np.bool_]) -> None:
        """Have cells of concave compartments computed anew in each step that others do not confirm.

        Beyond a side of theirs lies what is nobody's, since a border cuts its cell apart.
        """
        if self.parts.is_convex.all():
            return
        of_dot = self.compartment_of_dot
        rows = np.flatnonzero(computed & ~self.parts.is_convex[of_dot]).astype(np.int32)
        todo = np.zeros(self.n, np.uint8)
        parallel_for(check_stars, len(rows), rows, self._star, self._n_star, todo, grain=1024)
        kind = self._kind_of_cell
        kind[(todo != 0) & (kind == INNER)] = RIM

    def _step_from_stars(self, new: Moves, cancel: Question) -> bool:
        """Move dots by verified stars; False if that is not worth it now, or cancelled."""
        has_run = self._slack > SLACK * float(self.grid.real[:, 2].min())
        if has_run and not self._sort(True, cancel):
            return False
        new = new._replace(kind=self._kind_of_cell, free=self._free_of_dot)
        todo = np.empty(self.n, np.uint8)
        stars = Stars(self._star, self._n_star, np.zeros(self.n, np.uint8))
        done = parallel_for(
            verify_stars, self.n, self._dots, self._table, self.grid.border, self._field,
            self.over, new, stars, self.rules, todo, grain=GRAIN, chunks=8, cancel=cancel,
        )  # fmt: skip
        which = np.flatnonzero(todo.view(np.bool_)).astype(np.int32)  # quick for truth values alone
        self.n_failed = len(which)
        if self.n_failed > MOST_TODO * self.n:
            return False
        self._crowds.bound(self.xs, self.ys)
        settled = np.zeros(self.n, np.bool_)
        while done and len(which):
            settled[which] = True
            done = self._relax(which, False, new, stars=stars, cancel=cancel)
            if not done:
                break
            rows = np.flatnonzero(stars.suspect.view(np.bool_) > settled).astype(np.int32)
            stars.suspect[:] = 0
            parallel_for(check_stars, len(rows), rows, stars.around, stars.n, todo, grain=1024)
            which = rows[todo[rows] != 0]
        if done:
            self._distrust(settled)
        return done

    def _sort(self, with_stars: bool = False, cancel: Question = None) -> bool:
        """Bring the dots into the order of the grid; False, and nothing done, if cancelled."""
        if self._slack == 0.0:
            return True
        n = self.n
        cell_of_dot, order = np.empty(n, np.int32), np.empty(n, np.int32)
        cell_start = np.empty_like(self._cell_start)
        done = parallel_for(
            find_grid_cells, n, self.xs, self.ys, self.compartment_of_dot, self.grid.real,
            self.grid.whole, cell_of_dot, grain=GRAIN, cancel=cancel,
        )  # fmt: skip
        if not done:
            return False
        sort_by_grid_cell(cell_of_dot, cell_start, order)
        crowds = Crowds.split(cell_start, order, self.xs, self.ys)
        if cancel is not None and cancel():
            return False
        names = ["fixed", "compartment_of_dot", "order", "_is_met"]
        sorted_rows: dict[str, Any] = {"_cell_start": cell_start, "_crowds": crowds}
        if with_stars:
            names += ["_n_star", "_kind_of_cell", "_free_of_dot"]
            new_row = np.empty(n, np.int32)
            new_row[order] = np.arange(n, dtype=np.int32)
            star = sorted_rows["_star"] = np.empty_like(self._star)
            args = (renumber_stars, n, order, new_row, self._star, star)
            if not parallel_for(*args, grain=GRAIN, cancel=cancel):
                return False
        old: dict[str, Any] = {name: getattr(self, name) for name in names}
        old |= {"x": self.xs, "y": self.ys}
        if len(self.rules.table):
            old["wants"] = self.rules.wants
        if len(self.rules.radius):
            old["radius"] = self.rules.radius
        new = {name: np.empty((n, *rows.shape[1:]), rows.dtype) for name, rows in old.items()}

        def part(start: int, stop: int) -> None:
            for name, rows in old.items():
                new[name][start:stop] = rows[order[start:stop]]

        if not parallel_for(part, n, grain=GRAIN, chunks=GATHERED, cancel=cancel):
            return False
        of_rules = {name: new.pop(name) for name in ("wants", "radius") if name in new}
        self.rules = self.rules._replace(**of_rules)
        self.xs[:n], self.ys[:n] = new.pop("x"), new.pop("y")
        for name, rows in (sorted_rows | new).items():
            setattr(self, name, rows)
        self._slack = 0.0
        crowds.bound(self.xs, self.ys)
        crowds.join(self.grid.whole, self.xs, self.ys)
        self._has_stars = self._has_stars and with_stars
        return True


def _room_for_sides(n: int) -> tuple[Floats, Rows, Rows]:
    return np.empty((n, 2)), np.empty(n, np.int32), np.empty(n, np.int32)
