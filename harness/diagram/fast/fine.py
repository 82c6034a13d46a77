"""Tables and cubics in double-double, for triangles in which doubles no longer tell segments apart.

A fine table has 18 columns: the nine numbers of a table (:mod:`harness.diagram.fast.forms`), then
their low parts.  It is not halved along but computed anew in a triangle, from the fine table of the
root triangle and the triangle's barycentric coordinates λ, which are exact (a double-double holds
100 halvings), as L(P_k) = Σ λ_kc L_c and q(P_k, P_l) = Σ λ_kc λ_ld q_cd.

**Error bound.**  Let u = 2⁻⁵³, S the size of all coordinates, and ML, MQ as in ``forms``, but with
S added to every length.  Coordinates are given up to u²S, and an operation is off by at most 5u²
relatively (:mod:`harness.diagram.fast.double`).  Differences then are off by 3u² relatively and
2u²S; an L of the root triangle by (2·3 + 5 + 3)u²·ML and 4u²·ML for the coordinates, together less
than 20u²·ML; a q likewise by less than 30u²·MQ.  The sums with λ add 5 + 2·3 for each λ: L is off
by at most 31u²·ML, q by 52u²·MQ, a product q·L by 88u²·MQ·ML.  A cubic's coefficient times three is
a sum of at most six such products with weights that add up to 3 + 3: six more sums.  Altogether

    |error of a coefficient| ≤ 106 u² (MQ_i ML_j + MQ_j ML_i) < FINE (MQ_i ML_j + MQ_j ML_i);

the coefficient is then rounded to a double and divided by three, which keeps its sign and is off by
2u relatively.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.double import TINY, plus, plus_product, times
from harness.diagram.fast.jit import compiled

#: The factor of the error bound, 128u².
FINE = 2.0**-99
#: Halving keeps λ exact in double-doubles so many times.
FINEST = 100


@compiled
def _difference(ah, al, bh, bl):
    return plus(ah, al, -bh, -bl)


@compiled
def _store(table, c, high, low):
    """Store an entry that is not zero by construction."""
    table[c], table[9 + c] = high, low
    if high == 0.0:
        table[c] = TINY


@compiled
def fine_root_table(segment, corners, weights, zeros, ends, size, sense, table, norm):
    """The fine table of one segment over a root triangle, and (ML, MQ); see ``root_table``."""
    dxh, dxl = _difference(segment[4], segment[5], segment[0], segment[1])
    dyh, dyl = _difference(segment[6], segment[7], segment[2], segment[3])
    # For every corner: a − P, b − P.
    to = np.empty((3, 8))
    reach = 0.0
    for k in range(3):
        c = corners[k]
        if weights[k] == 0.0:
            axh, axl, ayh, ayl = -c[0], -c[1], -c[2], -c[3]
            bxh, bxl, byh, byl = axh, axl, ayh, ayl
        else:
            axh, axl = _difference(segment[0], segment[1], c[0], c[1])
            ayh, ayl = _difference(segment[2], segment[3], c[2], c[3])
            bxh, bxl = _difference(segment[4], segment[5], c[0], c[1])
            byh, byl = _difference(segment[6], segment[7], c[2], c[3])
        reach = max(reach, abs(axh) + abs(ayh), abs(bxh) + abs(byh))
        to[k, 0], to[k, 1], to[k, 2], to[k, 3] = axh, axl, ayh, ayl
        to[k, 4], to[k, 5], to[k, 6], to[k, 7] = bxh, bxl, byh, byl
        table[k] = table[9 + k] = 0.0
        if not zeros >> k & 1:
            h, low = times(axh, axl, dyh, dyl)
            h, low = plus_product(h, low, -ayh, -ayl, dxh, dxl)
            _store(table, k, h, low)
    half = 0.5 * sense
    for r in range(6):
        k = r if r < 3 else (0 if r < 5 else 1)
        m = r if r < 3 else (1 if r == 3 else 2)
        table[3 + r] = table[12 + r] = 0.0
        if k == m and ends >> k & 1:
            continue
        p, q = to[k], to[m]
        h, low = times(p[0], p[1], q[4], q[5])
        h, low = plus_product(h, low, p[2], p[3], q[6], q[7])
        h, low = plus_product(h, low, q[0], q[1], p[4], p[5])
        h, low = plus_product(h, low, q[2], q[3], p[6], p[7])
        _store(table, 3 + r, half * h, half * low)
    largest = abs(dxh) + abs(dyh)
    norm[0] = 1.01 * (reach + size) * (largest + size)
    norm[1] = 1.01 * (reach + size) * (reach + size)


@compiled
def _combination(root, a, b, c, lam, k):
    """Σ λ_k · (entries a, b, c of a root table), λ of corner k."""
    h, low = times(lam[3 * k], lam[9 + 3 * k], root[a], root[9 + a])
    h, low = plus_product(h, low, lam[3 * k + 1], lam[10 + 3 * k], root[b], root[9 + b])
    return plus_product(h, low, lam[3 * k + 2], lam[11 + 3 * k], root[c], root[9 + c])


@compiled
def fine_table(root, zeros, ends, lam, table):
    """The fine table of a triangle in a root triangle.

    ``root`` (18,): the root's table.  ``lam`` (18,): λ of its corners, high and low parts.
    """
    for k in range(3):
        table[k] = table[9 + k] = 0.0
        for c in range(3):
            if lam[3 * k + c] != 0.0 and not zeros >> c & 1:
                h, low = _combination(root, 0, 1, 2, lam, k)
                _store(table, k, h, low)
                break
    for m in range(3):
        # q(P_m, ·) at the corners of the root.
        v0h, v0l = _combination(root, 3, 6, 7, lam, m)
        v1h, v1l = _combination(root, 6, 4, 8, lam, m)
        v2h, v2l = _combination(root, 7, 8, 5, lam, m)
        for k in range(m + 1):
            r = 3 + k if k == m else (5 + k + m)
            table[r] = table[9 + r] = 0.0
            if k == m and _is_end(ends, lam, k):
                continue
            h, low = times(lam[3 * k], lam[9 + 3 * k], v0h, v0l)
            h, low = plus_product(h, low, lam[3 * k + 1], lam[10 + 3 * k], v1h, v1l)
            h, low = plus_product(h, low, lam[3 * k + 2], lam[11 + 3 * k], v2h, v2l)
            _store(table, r, h, low)


@compiled
def _is_end(ends, lam, k):
    """Whether a corner is a corner of the root at which the segment ends."""
    for c in range(3):
        if ends >> c & 1 and lam[3 * k + (c + 1) % 3] == 0.0 and lam[3 * k + (c + 2) % 3] == 0.0:
            return True
    return False


@compiled
def is_fine(tables):
    """Whether tables are in double-double."""
    return tables.shape[1] == 18


@compiled
def _product(t, i, q, s, j, line, h, low):
    """h + s·q·L, with entry q of row i and entry L of row j."""
    return plus_product(h, low, t[i, q], t[i, 9 + q], s * t[j, line], s * t[j, 9 + line])


@compiled
def _one(t, i, j, si, sj, q, line):
    """The coefficient at a corner: q_i L_j − q_j L_i."""
    h, low = times(t[i, q], t[i, 9 + q], sj * t[j, line], sj * t[j, 9 + line])
    h, low = _product(t, j, q, -si, i, line, h, low)
    return h


@compiled
def _two(t, i, j, si, sj, qm, lm, qs, ls):
    """The coefficient at a side, times three: 2 q_m L_m + q_s L_s, antisymmetrically."""
    h, low = times(t[i, qm], t[i, 9 + qm], 2.0 * sj * t[j, lm], 2.0 * sj * t[j, 9 + lm])
    h, low = _product(t, i, qs, sj, j, ls, h, low)
    h, low = _product(t, j, qm, -2.0 * si, i, lm, h, low)
    h, low = _product(t, j, qs, -si, i, ls, h, low)
    return h


@compiled
def fine_coefficients(t, i, j, si, sj):
    """The ten coefficients of Q_i sj L_j − Q_j si L_i; see ``coefficients``."""
    third = 1.0 / 3.0
    h, low = times(t[i, 6], t[i, 15], sj * t[j, 2], sj * t[j, 11])
    h, low = _product(t, i, 7, sj, j, 1, h, low)
    h, low = _product(t, i, 8, sj, j, 0, h, low)
    h, low = _product(t, j, 6, -si, i, 2, h, low)
    h, low = _product(t, j, 7, -si, i, 1, h, low)
    h, low = _product(t, j, 8, -si, i, 0, h, low)
    return (
        _one(t, i, j, si, sj, 3, 0),
        _one(t, i, j, si, sj, 4, 1),
        _one(t, i, j, si, sj, 5, 2),
        third * _two(t, i, j, si, sj, 6, 0, 3, 1),
        third * _two(t, i, j, si, sj, 7, 0, 3, 2),
        third * _two(t, i, j, si, sj, 6, 1, 4, 0),
        third * _two(t, i, j, si, sj, 8, 1, 4, 2),
        third * _two(t, i, j, si, sj, 7, 2, 5, 0),
        third * _two(t, i, j, si, sj, 8, 2, 5, 1),
        third * h,
    )


@compiled
def fine_at_length(t, i, j, length_i, length_j, q):
    """q_i·length_j − q_j·length_i, for an entry q; lengths in double-double."""
    h, low = times(t[i, q], t[i, 9 + q], length_j[0], length_j[1])
    h, low = plus_product(h, low, t[j, q], t[j, 9 + q], -length_i[0], -length_i[1])
    return h


@compiled
def line_at(t, i, z, x, y):
    """L of row i at the weights z, x, y of the corners (pairs: double-doubles)."""
    h, low = times(t[i, 0], t[i, 9], z[0], z[1])
    h, low = plus_product(h, low, t[i, 1], t[i, 10], x[0], x[1])
    return plus_product(h, low, t[i, 2], t[i, 11], y[0], y[1])


@compiled
def form_at(t, i, z, x, y):
    """Q there."""
    ah, al = times(t[i, 3], t[i, 12], z[0], z[1])
    ah, al = plus_product(ah, al, 2.0 * t[i, 6], 2.0 * t[i, 15], x[0], x[1])
    ah, al = plus_product(ah, al, 2.0 * t[i, 7], 2.0 * t[i, 16], y[0], y[1])
    bh, bl = times(t[i, 4], t[i, 13], x[0], x[1])
    bh, bl = plus_product(bh, bl, 2.0 * t[i, 8], 2.0 * t[i, 17], y[0], y[1])
    ch, cl = times(t[i, 5], t[i, 14], y[0], y[1])
    h, low = times(ah, al, z[0], z[1])
    h, low = plus_product(h, low, bh, bl, x[0], x[1])
    return plus_product(h, low, ch, cl, y[0], y[1])
