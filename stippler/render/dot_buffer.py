"""The dots as the GPU holds them, and a copy of that in memory to choose from."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots, first_seeds
from stippler.drawing.polarity import Polarity
from stippler.kernels.shapes import gpu_dots
from stippler.kernels.shapes.dot_shape import check_shapes
from stippler.render.paper import Origin
from stippler.render.weighing import Weighing, shares_of

_STRIDE = gpu_dots.N_WORDS * gpu_dots.WORD_BYTES
_GAP = 256  # rows that stand still are uploaded too where that saves a call
_AT_ONCE = 30_000  # dots whose shares take a frame little


class DotBuffer:
    """One GL buffer with a row for each dot, grown by doubling.

    Parameters
    ----------
    live : bool
        Frames do not wait for the shares of many dots: they keep those that they had, until
        `take_shares` finds the new ones done.

    Attributes
    ----------
    n : int
        Dots in it.
    revision : int
        Counts changes.
    is_round, is_rough, has_flags : bool
        Whether all are round and smooth; any is rough; any is fixed or selected. After partial
        updates they may be wrong towards the costlier side.
    polarity : Polarity
        How dots are painted, by their areas; what is set counts from the next `set` on.
    max_radius_mm, max_elongation : float
        At least as large as any dot's.
    """

    def __init__(self, ctx: moderngl.Context, *, live: bool = False) -> None:
        self._ctx, self._live = ctx, live
        self._room = 1024
        self._words = gpu_dots.words(self._room)
        self.gl = ctx.buffer(reserve=self._room * _STRIDE)
        self.n = self.revision = 0
        self._knows_shares = True
        self._had_shares = False  # those that are there are of the same dots, before
        self._weighing: Weighing | None = None
        self.polarity = Polarity()
        self._row_of_slot = self._slot_of_row = np.empty(0, np.int64)
        self._forget()

    @property
    def rows(self) -> NDArray[np.uint32]:
        """What is uploaded, (n, 6) words."""
        return self._words[: self.n]

    def set(self, dots: Dots, selected: NDArray[np.bool_], origin_mm: Origin) -> None:
        """Upload all dots; the GL buffer is another one where it had to grow.

        Raises
        ------
        ParameterError
            If a shape lies outside its range.
        """
        check_shapes(dots.elongation, dots.angle_rad, dots.roughness)
        before = self._shares_by_row() if len(dots) == self.n else None
        self._resize(len(dots))
        self._order(dots.position_mm, origin_mm)
        self._pack(dots, origin_mm, selected, self._row_of_slot, self.rows)
        if before is not None:
            gpu_dots.set_shares(self.rows, before[self._row_of_slot])
        self._forget()
        self.has_flags = bool(dots.fixed.any() or selected.any())
        self._weigh_anew(later=before is not None)
        self._learn(dots.radius_mm, dots.elongation, dots.roughness)
        self._upload()

    def set_positions(
        self,
        position_mm: NDArray[np.float64],
        radius_mm: NDArray[np.float32],
        origin_mm: Origin,
        *,
        settled: bool,
    ) -> None:
        """Upload positions and radii; shapes stay if there are as many dots as before."""
        same = len(position_mm) == self.n
        self._resize(len(position_mm))
        if not same:
            self._order(position_mm, origin_mm)
            self.rows[:, 3:] = gpu_dots.ROUND_WORDS
            self.rows[:, gpu_dots.SEED] = first_seeds(self._row_of_slot)
            self._forget()
        rows = self._row_of_slot
        gpu_dots.pack_places(position_mm, radius_mm, origin_mm, rows, self.rows)
        self.max_radius_mm = float(radius_mm.max(initial=0.0))
        if settled:
            self._weigh_anew(later=same)
        else:
            self._knows_shares, self._weighing = True, None
        self._upload()

    def update(
        self,
        dots: Dots,
        rows: NDArray[np.intp],
        selected: NDArray[np.bool_],
        origin_mm: Origin,
    ) -> None:
        """Upload some rows, which include all new ones."""
        n_new = len(dots) - self.n
        has_new = np.count_nonzero(np.unique(rows[rows >= self.n])) == max(n_new, 0)
        much = max(len(rows), -n_new) > len(dots) // 4
        if not has_new or len(dots) > self._room or much:
            self.set(dots, selected, origin_mm)
            return
        if len(rows) == 0 and n_new == 0:
            return
        check_shapes(dots.elongation[rows], dots.angle_rad[rows], dots.roughness[rows])
        closed = self._drop(len(dots))
        self._append(n_new)
        slots = np.union1d(self._slot_of_row[rows], closed)
        changed = self._row_of_slot[slots]
        fresh = gpu_dots.words(len(slots))
        self._pack(dots, origin_mm, selected, changed, fresh)
        self.has_flags = self.has_flags or bool((dots.is_fixed(rows) | selected[rows]).any())
        self._words[slots] = fresh
        if self._weighing is not None:
            self._weighing.note_change(slots)
        self._learn(dots.radius_mm[rows], dots.elongation[rows], dots.roughness[rows])
        self._upload_runs(slots)

    def find_shares(self) -> None:
        """Find how much each dot adds to the union of all; only after a full upload.

        Until the next one dots that a worker moves keep their shares, and those that a brush
        changes count whole, so that drawing never waits.
        """
        if self._knows_shares:
            return
        if not self._had_shares:
            self._knows_shares = True
            self._write_shares(shares_of(self.rows, is_plain=self.polarity.is_plain))
        elif self._weighing is None:
            self._weighing = Weighing(self.rows, is_plain=self.polarity.is_plain)

    @property
    def is_weighing(self) -> bool:
        """Whether dots still have the shares of before."""
        return self._weighing is not None

    def take_shares(self) -> bool:
        """Upload the shares that are being found, if they are; return whether it is so."""
        if self._weighing is None or not self._weighing.is_done:
            return False
        weighing, self._weighing, self._knows_shares = self._weighing, None, True
        self._write_shares(weighing.shares(self.n))
        return True

    def _weigh_anew(self, *, later: bool) -> None:
        """Let shares be found when they are asked for: at once, or later beside the frames."""
        self._knows_shares, self._weighing = False, None
        self._had_shares = later and self._live and self.n > _AT_ONCE

    def _shares_by_row(self) -> NDArray[np.float32] | None:
        """Return the shares that dots have, in the drawing's order, if they are to be kept."""
        if not self._live or self.n <= _AT_ONCE:
            return None
        return gpu_dots.shares_in(self.rows)[self._slot_of_row]

    def _write_shares(self, shares: NDArray[np.float32]) -> None:
        if self.n and (shares.min() < 1.0 or self._had_shares):
            gpu_dots.set_shares(self.rows, shares)
            self._upload()

    def _pack(
        self,
        dots: Dots,
        origin_mm: Origin,
        selected: NDArray[np.bool_],
        rows: NDArray[np.int64],
        out: NDArray[np.uint32],
    ) -> None:
        if self.polarity.is_plain:
            gpu_dots.pack(dots, origin_mm, selected, rows, out)
        else:
            paint = self.polarity.of(dots.area[rows])
            gpu_dots.pack(dots, origin_mm, selected, rows, out, paint)

    def _order(self, position_mm: NDArray[np.float64], origin_mm: Origin) -> None:
        size_mm = (2 * origin_mm[0], 2 * origin_mm[1])
        self._row_of_slot = gpu_dots.nearby_order(position_mm, size_mm)
        self._slot_of_row = np.empty_like(self._row_of_slot)
        self._slot_of_row[self._row_of_slot] = np.arange(self.n)

    def _drop(self, n: int) -> NDArray[np.intp]:
        """Let go of the rows from n on; return the slots that the last dots have moved into."""
        if n >= self.n:
            return np.empty(0, np.intp)
        gone = self._slot_of_row[n:]
        stays = np.ones(self.n - n, np.bool_)
        stays[gone[gone >= n] - n] = False
        moved, gaps = n + np.flatnonzero(stays), np.sort(gone[gone < n])
        self._words[gaps] = self._words[moved]
        row = self._row_of_slot[moved]
        self._row_of_slot[gaps] = row
        self._slot_of_row[row] = gaps
        self._row_of_slot, self._slot_of_row = self._row_of_slot[:n], self._slot_of_row[:n]
        self.n = n
        return gaps

    def _append(self, n_new: int) -> None:
        """Give new dots the slots after the last."""
        if n_new > 0:
            new = np.arange(self.n, self.n + n_new)
            self._row_of_slot = np.concatenate([self._row_of_slot, new])
            self._slot_of_row = np.concatenate([self._slot_of_row, new])
            self.n += n_new

    def _upload(self) -> None:
        self.revision += 1
        self.gl.orphan()
        if self.n:
            self.gl.write(self.rows)

    def _upload_runs(self, slots: NDArray[np.intp]) -> None:
        self.revision += 1
        if not len(slots):
            return
        breaks = np.flatnonzero(np.diff(slots) > _GAP)
        first = slots[np.concatenate([[0], breaks + 1])].tolist()
        last = slots[np.concatenate([breaks, [len(slots) - 1]])].tolist()
        memory = self._words.reshape(-1).view(np.uint8)
        for a, b in zip(first, last, strict=True):
            self.gl.write(memory[a * _STRIDE : (b + 1) * _STRIDE], a * _STRIDE)

    def _resize(self, n: int) -> None:
        self.n = n
        if n <= self._room:
            return
        self._room = 1 << (n - 1).bit_length()
        self._words = gpu_dots.words(self._room)
        self.gl.release()
        self.gl = self._ctx.buffer(reserve=self._room * _STRIDE)

    def _forget(self) -> None:
        self.is_round, self.is_rough, self.has_flags = True, False, False
        self.max_radius_mm, self.max_elongation = 0.0, 1.0

    def _learn(
        self,
        radius: NDArray[np.float32],
        elongation: NDArray[np.float32],
        roughness: NDArray[np.float32],
    ) -> None:
        self.max_radius_mm = max(self.max_radius_mm, float(radius.max(initial=0.0)))
        self.max_elongation = max(self.max_elongation, float(elongation.max(initial=1.0)))
        self.is_rough = self.is_rough or float(roughness.max(initial=0.0)) > 0
        self.is_round = self.is_round and not self.is_rough and self.max_elongation == 1.0

    def release(self) -> None:
        """Free the GL buffer."""
        self.gl.release()
