"""Small parts of even tone that a picture falls into, and how they join to larger ones.

The parts are found by OpenCV's watershed (the only use of OpenCV; see `docs/decisions.md`); they
are joined two by two, always the two neighbours whose tones differ least for their sizes (Ward).
"""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

MOST_PIXELS = 1_000_000
N_PARTS = 2000
_BLUR_PX = 1.5
_FAR = 0.004  # what a step between two parts of one tone costs, in darkness


@dataclass(frozen=True, slots=True, eq=False)
class PictureParts:
    """A picture's parts and what lies beside what.

    Attributes
    ----------
    labels : (h, w) int32
        The part of each pixel, 0 to n - 1; of the picture made smaller, if it is large.
    scale : float
        Pixels of the picture for each of these.
    size, tone : (n,) float64
        Pixels of each part, and their mean darkness.
    first, second : (m,) int32
        Parts that lie beside each other.
    """

    labels: Ints
    scale: float
    size: Floats
    tone: Floats
    first: Ints
    second: Ints

    @property
    def n(self) -> int:
        """How many parts there are."""
        return len(self.size)

    # --- regions made of parts ----------------------------------------------------------------

    def regions(self, n_regions: int) -> Ints:
        """Return the region of each part when neighbours are joined until so many are left."""
        return joined(self, np.arange(self.n, dtype=np.int32), n_regions)

    def split(self, region_of: Ints, part: int) -> Ints:
        """Return regions in which the one that has a part falls in two."""
        inside = np.flatnonzero(region_of == region_of[part])
        if len(inside) < 2:
            return region_of
        two = joined(self, inside.astype(np.int32), 2)
        out = region_of.copy()
        out[inside[two != two[0]]] = region_of.max() + 1
        return out

    def merged(self, region_of: Ints, parts: Collection[int]) -> Ints:
        """Return regions in which those that have any of some parts are one."""
        touched = np.unique(region_of[list(parts)])
        out = region_of.copy()
        out[np.isin(out, touched)] = touched[0]
        return out

    def parted(self, region_of: Ints, parts: Collection[int]) -> Ints:
        """Return regions of which some parts of one are a region of their own."""
        chosen = np.array(sorted(parts))
        mine = chosen[region_of[chosen] == region_of[chosen[0]]]
        out = region_of.copy()
        out[mine] = region_of.max() + 1
        return out

    def grown(self, inside: Collection[int], outside: Collection[int]) -> NDArray[np.bool_]:
        """Return which parts are nearer to some than to others, by the tones between them.

        Without any outside the picture's rim is.
        """
        from scipy.sparse import coo_matrix
        from scipy.sparse.csgraph import dijkstra

        out = set(outside) - set(inside)
        if not out:
            rim = (self.labels[0], self.labels[-1], self.labels[:, 0], self.labels[:, -1])
            out = set(np.unique(np.concatenate(rim)).tolist()) - set(inside)
        cost = np.abs(self.tone[self.first] - self.tone[self.second]) + _FAR
        shape = (self.n, self.n)
        graph = coo_matrix((cost, (self.first, self.second)), shape).tocsr()
        far = [
            dijkstra(graph, directed=False, indices=sorted(seeds), min_only=True)
            for seeds in (inside, out)
            if seeds
        ]
        return np.asarray(far[0] < far[1]) if len(far) == 2 else np.isfinite(far[0])

    def at(self, x_px: float, y_px: float) -> int | None:
        """Return the part at a point in pixels of `labels`; None beside them."""
        h, w = self.labels.shape
        x, y = int(np.floor(x_px)), int(np.floor(y_px))
        return int(self.labels[y, x]) if 0 <= x < w and 0 <= y < h else None


def parts_of(darkness: NDArray[np.float32], n_parts: int = N_PARTS) -> PictureParts:
    """Find the parts of a picture.

    Parameters
    ----------
    darkness : (h, w) float32
        0 to 1; made smaller above `MOST_PIXELS`.

    Notes
    -----
    Deterministic. 0.1 to 0.2 s for a megapixel on one core.
    """
    import cv2

    h, w = darkness.shape
    scale = max(1.0, float(np.sqrt(h * w / MOST_PIXELS)))
    if scale > 1.0:
        size = (max(round(w / scale), 1), max(round(h / scale), 1))
        darkness = np.asarray(cv2.resize(darkness, size, interpolation=cv2.INTER_AREA), np.float32)
    smooth = cv2.GaussianBlur(np.ascontiguousarray(darkness), (0, 0), _BLUR_PX)
    dx, dy = cv2.Sobel(smooth, cv2.CV_32F, 1, 0), cv2.Sobel(smooth, cv2.CV_32F, 0, 1)
    marks = _markers(np.asarray(np.hypot(dx, dy)), n_parts)
    grey = np.clip(np.asarray(smooth) * 255.0 + 0.5, 0, 255).astype(np.uint8)
    cv2.watershed(cv2.merge([grey, grey, grey]), marks)
    labels = _without_lines(marks)
    return _measured(labels, np.asarray(darkness, np.float64), scale)


def _markers(slope: NDArray[np.float32], n_parts: int) -> Ints:
    """Return a seed in each cell of a square grid, where the picture is most even."""
    h, w = slope.shape
    side = max(int(np.sqrt(h * w / n_parts)), 1)
    rows, columns = max(h // side, 1), max(w // side, 1)
    ys = np.linspace(0, h, rows + 1).astype(int)
    xs = np.linspace(0, w, columns + 1).astype(int)
    marks = np.zeros((h, w), np.int32)
    k = 0
    for top, bottom in itertools.pairwise(ys):
        for left, right in itertools.pairwise(xs):
            i = int(np.argmin(slope[top:bottom, left:right]))
            k += 1
            marks[top + i // (right - left), left + i % (right - left)] = k
    return marks


def _without_lines(marks: Ints) -> Ints:
    """Give the lines that the watershed leaves between parts to a part beside them."""
    labels = marks.copy()
    labels[labels < 1] = 0
    while not (known := labels > 0).all():
        grown = labels.copy()
        for axis, way in ((0, 1), (0, -1), (1, 1), (1, -1)):
            moved = np.roll(labels, way, axis)
            edge = [slice(None), slice(None)]
            edge[axis] = slice(0, 1) if way == 1 else slice(-1, None)
            moved[tuple(edge)] = 0
            grown = np.where((grown == 0) & (moved > 0), moved, grown)
        if (grown == labels).all():
            labels[~known] = 1
            break
        labels = grown
    _, flat = np.unique(labels, return_inverse=True)
    return np.asarray(flat.reshape(labels.shape), np.int32)


def _measured(labels: Ints, darkness: Floats, scale: float) -> PictureParts:
    size = np.bincount(labels.ravel()).astype(np.float64)
    tone = np.bincount(labels.ravel(), darkness.ravel()) / size
    pairs = []
    for a, b in ((labels[:, :-1], labels[:, 1:]), (labels[:-1], labels[1:])):
        low, high = np.minimum(a, b), np.maximum(a, b)
        apart = low != high
        pairs.append(low[apart].astype(np.int64) * len(size) + high[apart])
    first, second = np.divmod(np.unique(np.concatenate(pairs)), len(size))
    return PictureParts(labels, scale, size, tone, first.astype(np.int32), second.astype(np.int32))


def joined(parts: PictureParts, chosen: Ints, n_regions: int) -> Ints:
    """Join neighbours among some parts until so many regions are left; return theirs.

    Returns
    -------
    (len(chosen),) int32
        Regions from 0 on.
    """
    place = np.full(parts.n, -1)
    place[chosen] = np.arange(len(chosen))
    size, ink = parts.size[chosen].tolist(), (parts.size * parts.tone)[chosen].tolist()
    near: list[set[int]] = [set() for _ in chosen]
    a, b = place[parts.first], place[parts.second]
    for i, j in zip(a[(a >= 0) & (b >= 0)].tolist(), b[(a >= 0) & (b >= 0)].tolist(), strict=True):
        near[i].add(j)
        near[j].add(i)

    def cost(i: int, j: int) -> float:
        gap = ink[i] / size[i] - ink[j] / size[j]
        return float(gap * gap * size[i] * size[j] / (size[i] + size[j]))

    queue = [(cost(i, j), i, j) for i in range(len(chosen)) for j in near[i] if i < j]
    heapq.heapify(queue)
    parent = list(range(len(chosen)))
    alive = len(chosen)
    while queue and alive > n_regions:
        _, i, j = heapq.heappop(queue)
        if parent[i] != i or parent[j] != j:
            continue
        k = len(parent)  # a region of its own, so that old costs are known as such
        parent.append(k)
        parent[i] = parent[j] = k
        size.append(size[i] + size[j])
        ink.append(ink[i] + ink[j])
        beside = {n for n in near[i] | near[j] if parent[n] == n and n not in (i, j)}
        near.append(beside)
        for n in beside:
            near[n].add(k)
            heapq.heappush(queue, (cost(k, n), n, k))
        alive -= 1
    for k in range(len(parent) - 1, -1, -1):
        parent[k] = parent[parent[k]]
    _, region = np.unique(np.array(parent[: len(chosen)]), return_inverse=True)
    return np.asarray(region, np.int32)
