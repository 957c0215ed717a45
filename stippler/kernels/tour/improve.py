"""A closed tour made shorter: 2-opt and Or-opt moves among near neighbours (Bentley 1992).

The tour is an array of points and the inverse of it; a reversal turns the shorter side around.
Every move can be taken back, so that a tour can be disturbed at one place and put right again a
million times (Martin, Otto, Felten 1992).
"""

from __future__ import annotations

import numpy as np

from stippler.kernels.machine.jit import inline, inner, kernel
from stippler.kernels.tour.neighbours import length_between

_MOST_IN_SEGMENT = 3
_LONGEST = 30  # points in each of the two pieces that a disturbance swaps
_MOST_LOGGED = 200
_REVERSED, _CARRIED = 0, 1


@inner
def reverse(tour, place, i, j):
    """Turn around what lies from place i to place j, or all the rest instead."""
    n = tour.shape[0]
    inside = j - i
    if inside < 0:
        inside += n
    inside += 1
    if 2 * inside > n:
        i, j = j + 1, i - 1
        if i == n:
            i = 0
        if j < 0:
            j = n - 1
        inside = n - inside
    for _ in range(inside // 2):
        a, b = tour[i], tour[j]
        tour[i], tour[j] = b, a
        place[b], place[a] = i, j
        i = i + 1 if i + 1 < n else 0
        j = j - 1 if j > 0 else n - 1


@inner
def carry(tour, place, i, size, k, turned, onwards, held):
    """Carry `size` points from place i on to between places k and k + 1; return where they begin.

    They may be turned around; `onwards` tells which way they go.
    """
    n = tour.shape[0]
    for m in range(size):
        held[m] = tour[(i + m) % n]
    if onwards:
        at = i
        for _ in range((k - i - size + 1) % n):
            moved = tour[(at + size) % n]
            tour[at], place[moved] = moved, at
            at = at + 1 if at + 1 < n else 0
    else:
        at = (i + size - 1) % n
        for _ in range((i - k - 1) % n):
            moved = tour[(at - size) % n]
            tour[at], place[moved] = moved, at
            at = at - 1 if at > 0 else n - 1
        at = (k + 1) % n
    start = at
    for m in range(size):
        point = held[size - 1 - m] if turned else held[m]
        tour[at], place[point] = point, at
        at = at + 1 if at + 1 < n else 0
    return start


@inline
def _wake(queue, waiting, tail, point):
    if not waiting[point]:
        waiting[point] = True
        queue[tail % queue.shape[0]] = point
        tail += 1
    return tail


@inner
def _two_opt(tour, place, xy, near, a, eps, ends, move):
    """Find how to part a from its next or previous point; return what it gains, 0 if nothing."""
    n = tour.shape[0]
    for way in range(2):
        step = 1 if way == 0 else n - 1
        b = tour[(place[a] + step) % n]
        ab = length_between(xy, a, b)
        for k in range(near.shape[1]):
            c = near[a, k]
            if c < 0:
                break
            gain = ab - length_between(xy, a, c)
            if gain <= eps:
                break
            d = tour[(place[c] + step) % n]
            if c == b or d == a:
                continue
            gain += length_between(xy, c, d) - length_between(xy, b, d)
            if gain > eps:
                move[0] = _REVERSED
                move[1] = place[b] if way == 0 else place[c]
                move[2] = place[c] if way == 0 else place[b]
                ends[0], ends[1], ends[2], ends[3], ends[4], ends[5] = a, b, c, d, a, a
                return gain
    return 0.0


@inner
def _or_opt(tour, place, xy, near, a, eps, ends, move):
    """Find how to carry a, and up to two points beside it, to between others."""
    n = tour.shape[0]
    for way in range(2):
        for size in range(1 + way, _MOST_IN_SEGMENT + 1):
            first = place[a] if way == 0 else (place[a] - size + 1) % n
            end = tour[(first + size - 1) % n] if way == 0 else tour[first]
            before, after = tour[(first - 1) % n], tour[(first + size) % n]
            p, q = (before, after) if way == 0 else (after, before)
            freed = length_between(xy, p, a) + length_between(xy, end, q) - length_between(xy, p, q)
            if freed <= eps:
                continue
            for k in range(near.shape[1]):
                c = near[a, k]
                if c < 0 or freed - length_between(xy, a, c) <= eps:
                    break
                if (place[c] - first) % n < size:
                    continue
                for side in range(2):
                    d = tour[(place[c] + (1 if side == 0 else n - 1)) % n]
                    if (place[d] - first) % n < size:
                        continue
                    gain = freed - length_between(xy, a, c)
                    gain += length_between(xy, c, d) - length_between(xy, end, d)
                    if gain > eps:
                        place_before = place[c] if side == 0 else place[d]
                        move[0], move[1], move[2], move[3] = _CARRIED, first, size, place_before
                        # in order of the tour: c, a .. end, d or d, end .. a, c
                        move[4] = 1 if (side == 0) == (way == 1) else 0
                        ahead = (place_before - first - size + 1) % n
                        move[5] = 1 if 2 * ahead <= n - size else 0
                        ends[0], ends[1], ends[2] = a, end, c
                        ends[3], ends[4], ends[5] = d, p, q
                        return gain
    return 0.0


@inner
def _make(tour, place, move, held):
    """Make a move; it is changed into the one that takes it back."""
    if move[0] == _REVERSED:
        reverse(tour, place, move[1], move[2])
        return
    n = tour.shape[0]
    first, size, k, turned, onwards = move[1], move[2], move[3], move[4], move[5]
    move[1] = carry(tour, place, first, size, k, turned, onwards, held)
    move[3] = (first - 1) % n if onwards else (first + size - 1) % n
    move[5] = 0 if onwards else 1


@kernel
def improve(tour, place, xy, near, eps, queue, waiting, state, most_moves):
    """Make moves until none helps or so many are made; `state` (head, tail) is of the queue."""
    head, tail = state[0], state[1]
    ends, move = np.empty(6, np.int64), np.empty(6, np.int64)
    held = np.empty(_MOST_IN_SEGMENT, np.int32)
    n_moves = 0
    while head < tail and n_moves < most_moves:
        a = queue[head % queue.shape[0]]
        head += 1
        waiting[a] = False
        while True:
            gain = _two_opt(tour, place, xy, near, a, eps, ends, move)
            if gain == 0.0:
                gain = _or_opt(tour, place, xy, near, a, eps, ends, move)
            if gain == 0.0:
                break
            _make(tour, place, move, held)
            n_moves += 1
            for k in range(6):
                if ends[k] != a:
                    tail = _wake(queue, waiting, tail, ends[k])
    state[0], state[1] = head, tail
    return n_moves


@inline
def _random(state, below):
    """Return a number below another: xorshift (Marsaglia 2003)."""
    x = state[0]
    x ^= x << np.uint64(13)
    x ^= x >> np.uint64(7)
    x ^= x << np.uint64(17)
    state[0] = x
    return np.int64((x >> np.uint64(11)) % np.uint64(below))


@kernel
def disturb(tour, place, xy, near, eps, queue, waiting, random, n_times):
    """Swap two short pieces somewhere, put right what can be, and keep it if it is shorter."""
    n = tour.shape[0]
    longest = max(min(_LONGEST, (n - 2) // 4), 1)
    ends, log = np.empty(6, np.int64), np.empty((_MOST_LOGGED, 6), np.int64)
    held = np.empty(_MOST_IN_SEGMENT, np.int32)
    for _ in range(n_times):
        i = _random(random, n)
        j = i + 1 + _random(random, longest)
        k = j + 1 + _random(random, longest)
        a, b, c = tour[i], tour[(i + 1) % n], tour[j % n]
        d, e, f = tour[(j + 1) % n], tour[k % n], tour[(k + 1) % n]
        total = length_between(xy, a, b) + length_between(xy, c, d) + length_between(xy, e, f)
        total -= length_between(xy, a, d) + length_between(xy, e, b) + length_between(xy, c, f)
        n_logged = 3
        for m in range(3):
            log[m, 0] = _REVERSED
        log[0, 1], log[0, 2] = (i + 1) % n, j % n
        log[1, 1], log[1, 2] = (j + 1) % n, k % n
        log[2, 1], log[2, 2] = (i + 1) % n, k % n
        for m in range(3):
            reverse(tour, place, log[m, 1], log[m, 2])
        head = tail = 0
        for point in (a, b, c, d, e, f):
            tail = _wake(queue, waiting, tail, point)
        while head < tail:
            a = queue[head % n]
            head += 1
            waiting[a] = False
            while n_logged < _MOST_LOGGED:
                gain = _two_opt(tour, place, xy, near, a, eps, ends, log[n_logged])
                if gain == 0.0:
                    gain = _or_opt(tour, place, xy, near, a, eps, ends, log[n_logged])
                if gain == 0.0:
                    break
                _make(tour, place, log[n_logged], held)
                n_logged += 1
                total += gain
                for m in range(6):
                    if ends[m] != a:
                        tail = _wake(queue, waiting, tail, ends[m])
        if total < 0.0:
            for m in range(n_logged - 1, -1, -1):
                _make(tour, place, log[m], held)


@kernel
def uncross(tour, place, pairs):
    """Exchange the ends of crossing steps, given by the points that they begin with."""
    n = tour.shape[0]
    done = 0
    for k in range(pairs.shape[0]):
        a, b, c, d = pairs[k]
        if tour[(place[a] + 1) % n] != b:
            a, b = b, a
        if tour[(place[c] + 1) % n] != d:
            c, d = d, c
        is_there = tour[(place[a] + 1) % n] == b and tour[(place[c] + 1) % n] == d
        if is_there and a != d and b != c:
            reverse(tour, place, place[b], place[c])
            done += 1
    return done
