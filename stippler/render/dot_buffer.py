"""The dots as the GPU holds them, and a copy of that in memory to choose from."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.kernels import gpu_dots

Origin = tuple[float, float]

_STRIDE = gpu_dots.N_WORDS * gpu_dots.WORD_BYTES
_GAP = 48  # rows that stand still are uploaded too where that saves a call


class DotBuffer:
    """One GL buffer with a row for each dot, grown by doubling.

    Attributes
    ----------
    n : int
        Dots in it.
    revision : int
        Counts changes.
    is_round, is_rough : bool
        Whether all are round and smooth; whether any is rough. After partial updates they may
        be wrong towards the costlier side.
    max_radius_mm, max_elongation : float
        At least as large as any dot's.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._room = 1024
        self._words = gpu_dots.words(self._room)
        self.gl = ctx.buffer(reserve=self._room * _STRIDE)
        self.n = self.revision = 0
        self._forget()

    @property
    def rows(self) -> NDArray[np.uint32]:
        """What is uploaded, (n, 6) words."""
        return self._words[: self.n]

    def set(self, dots: Dots, selected: NDArray[np.bool_], origin_mm: Origin) -> bool:
        """Upload all dots; return whether the GL buffer is another one now."""
        grown = self._resize(len(dots))
        gpu_dots.pack(dots, origin_mm, _flags(dots.fixed, selected), self.rows)
        self._forget()
        self._learn(dots.radius_mm, dots.elongation, dots.roughness)
        self._upload()
        return grown

    def set_positions(
        self, position_mm: NDArray[np.float64], radius_mm: NDArray[np.float32], origin_mm: Origin
    ) -> bool:
        """Upload positions and radii; shapes stay if there are as many dots as before."""
        same = len(position_mm) == self.n
        grown = self._resize(len(position_mm))
        gpu_dots.pack_places(position_mm, radius_mm, origin_mm, self.rows)
        if not same:
            self.rows[:, 3:] = 0
            self._forget()
        self.max_radius_mm = float(radius_mm.max(initial=0.0))
        self._upload()
        return grown

    def update(
        self,
        dots: Dots,
        rows: NDArray[np.intp],
        selected: NDArray[np.bool_],
        origin_mm: Origin,
    ) -> bool:
        """Upload some rows, which include all new ones; return as `set` does."""
        rows = np.unique(rows)
        n_new = len(dots) - self.n
        has_new = n_new >= 0 and np.count_nonzero(rows >= self.n) == n_new
        if not has_new or len(dots) > self._room or len(rows) > len(dots) // 4:
            return self.set(dots, selected, origin_mm)
        if len(rows) == 0:
            return False
        self.n = len(dots)
        fresh = gpu_dots.words(len(rows))
        flags = _flags(dots.fixed[rows], selected[rows])
        some = dots.take(rows)
        gpu_dots.pack(some, origin_mm, flags, fresh)
        self._words[rows] = fresh
        self._learn(some.radius_mm, some.elongation, some.roughness)
        self._upload_runs(rows)
        return False

    def _upload(self) -> None:
        self.revision += 1
        self.gl.orphan()
        if self.n:
            self.gl.write(self.rows)

    def _upload_runs(self, rows: NDArray[np.intp]) -> None:
        self.revision += 1
        breaks = np.flatnonzero(np.diff(rows) > _GAP)
        first = rows[np.concatenate([[0], breaks + 1])].tolist()
        last = rows[np.concatenate([breaks, [len(rows) - 1]])].tolist()
        memory = memoryview(self._words).cast("B")
        for a, b in zip(first, last, strict=True):
            self.gl.write(memory[a * _STRIDE : (b + 1) * _STRIDE], a * _STRIDE)

    def _resize(self, n: int) -> bool:
        self.n = n
        if n <= self._room:
            return False
        self._room = 1 << (n - 1).bit_length()
        self._words = gpu_dots.words(self._room)
        self.gl.release()
        self.gl = self._ctx.buffer(reserve=self._room * _STRIDE)
        return True

    def _forget(self) -> None:
        self.is_round, self.is_rough = True, False
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


def _flags(fixed: NDArray[np.bool_], selected: NDArray[np.bool_]) -> NDArray[np.uint8]:
    return fixed * np.uint8(gpu_dots.FIXED) | selected * np.uint8(gpu_dots.SELECTED)
