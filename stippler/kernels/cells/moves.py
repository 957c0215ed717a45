"""Where a dot goes in the piece of its cell that the border leaves it.

To the centroid, if that lies in the piece, round corners too; else to where the piece's second
moment is least among the places it may stand on, which is the piece's point nearest to the
centroid, a little off the wall.
"""

from __future__ import annotations

import math

from stippler.kernels.cells.tables import F8, I4, Spot
from stippler.kernels.machine.jit import inline, inner

OFF_WALL = 0.1
"""Distance from the wall of a dot whose centroid lies beyond it, in the root of its cell's area."""

_HALVINGS = 12


@inline
def _sees(out: F8, n: int, du: float, dv: float, margin: float) -> bool:
    """Whether a place lies to the left of all sides, clear of walls by `margin`."""
    for s in range(n):
        au, av = out[s, 0], out[s, 1]
        eu, ev = out[s, 2] - au, out[s, 3] - av
        side = eu * (dv - av) - ev * (du - au)
        if side < 0.0 or (out[s, 4] < 0.0 and side * side < margin * margin * (eu * eu + ev * ev)):
            return False
    return True


@inner
def is_in_piece(out: F8, n: int, du: float, dv: float, margin: float) -> bool:
    """Whether a place lies in the outline, clear of its walls by `margin`."""
    inside = False
    for s in range(n):
        au, av = out[s, 0] - du, out[s, 1] - dv
        bu, bv = out[s, 2] - du, out[s, 3] - dv
        if (av > 0.0) != (bv > 0.0) and (au * bv - bu * av > 0.0) == (bv > av):
            inside = not inside
        if out[s, 4] < 0.0:
            eu, ev = bu - au, bv - av
            length2 = eu * eu + ev * ev
            t = -(au * eu + av * ev) / length2 if length2 > 0.0 else 0.0
            t = min(max(t, 0.0), 1.0)
            au += t * eu
            av += t * ev
            if au * au + av * av < margin * margin:
                return False
    return inside


@inline
def _nearest_on(out: F8, n: int, du: float, dv: float) -> tuple[float, float, float, float]:
    """Return the outline's point nearest to a place, and the way inwards there."""
    best, best_s, best_t = math.inf, 0, 0.0
    for s in range(n):
        au, av = out[s, 0] - du, out[s, 1] - dv
        eu, ev = out[s, 2] - out[s, 0], out[s, 3] - out[s, 1]
        length2 = eu * eu + ev * ev
        if length2 == 0.0:
            continue
        t = min(max(-(au * eu + av * ev) / length2, 0.0), 1.0)
        au += t * eu
        av += t * ev
        if au * au + av * av < best:
            best, best_s, best_t = au * au + av * av, s, t
    s = best_s
    qu = out[s, 0] + best_t * (out[s, 2] - out[s, 0])
    qv = out[s, 1] + best_t * (out[s, 3] - out[s, 1])
    if best_t == 1.0:
        qu, qv = out[s, 2], out[s, 3]
    nu = nv = 0.0
    for k in range(n):
        is_there = k == s or (out[k, 0] == qu and out[k, 1] == qv)
        if is_there or (out[k, 2] == qu and out[k, 3] == qv):
            eu, ev = out[k, 2] - out[k, 0], out[k, 3] - out[k, 1]
            length = math.sqrt(eu * eu + ev * ev)
            if length > 0.0:
                nu -= ev / length
                nv += eu / length
    length = math.sqrt(nu * nu + nv * nv)
    if length < 1e-6:  # the point of a needle: back to where the dot is
        nu, nv = -qu, -qv
        length = max(math.sqrt(nu * nu + nv * nv), 1e-300)
    return qu, qv, nu / length, nv / length


@inner
def move_in_piece(
    out: F8, n: int, area: float, du: float, dv: float, over: float, margin: float
) -> tuple[float, float]:
    """Return the way a dot goes whose piece has its centroid at (du, dv).

    Parameters
    ----------
    out, n
        The piece's outline, see `border`.
    area
        Of the piece.
    over
        Share of the way that is tried first.
    margin
        What a dot keeps of distance from walls in any case.
    """
    for share in (over, 1.0):
        u, v = share * du, share * dv
        if _sees(out, n, u, v, margin) or is_in_piece(out, n, u, v, margin):
            return u, v
    qu, qv, nu, nv = _nearest_on(out, n, du, dv)
    off = OFF_WALL * math.sqrt(max(area, 0.0))
    before = (du * du + dv * dv) * (1.0 - 1e-9)
    for _ in range(_HALVINGS):
        u, v = qu + off * nu, qv + off * nv
        if (u - du) * (u - du) + (v - dv) * (v - dv) < before and is_in_piece(
            out, n, u, v, max(margin, 0.25 * off)
        ):
            return u, v
        if qu * qu + qv * qv <= 2.25 * off * off:
            break  # there already
        off *= 0.5
    return 0.0, 0.0


@inner
def crosses_border(edge: F8, near: I4, n_near: int, spot: Spot, du: float, dv: float) -> bool:
    """Whether the move (du, dv) goes more often out over the edges listed than in, or less often.

    In the narrowest cusps an outline may be wrong; no dot leaves its compartment all the same.
    """
    net = 0
    for s in range(n_near):
        e = near[s]
        au, av = edge[e, 0] - spot.x, edge[e, 1] - spot.y
        bu, bv = edge[e, 2] - spot.x, edge[e, 3] - spot.y
        if (du * av - dv * au <= 0.0) == (du * bv - dv * bu <= 0.0):
            continue
        eu, ev = bu - au, bv - av
        before = ev * au - eu * av  # left is positive
        after = before + eu * dv - ev * du
        if (before >= 0.0) != (after >= 0.0):
            net += 1 if before >= 0.0 else -1
    return net != 0
