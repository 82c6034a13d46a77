"""Dropping candidates that certainly lose all over a triangle."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.collinear import collinear_beats
from harness.diagram.fast.double import plus_product, times
from harness.diagram.fast.fine import form_at, is_fine, line_at
from harness.diagram.fast.forms import relation, surely_positive
from harness.diagram.fast.jit import compiled


@compiled
def localise(norms, start, m, lam, share, first):
    """ML and MQ of all candidates on a triangle, columns 0 and 1, from those of the root, in the
    column ``first`` and the next.

    Column 4 holds the root's corners at which L is zero (3 bits) and at which Q is (3 bits).  At
    a point λ only the other corners contribute to L, so |L| ≤ ML·Σ λ_k over these, and roundings
    are as much smaller.  If Q is zero at just one corner, |q(λ, λ')| ≤ MQ·(Σ λ_k + Σ λ'_k).
    """
    for bits in range(1, 8):
        share[bits] = -1.0
    for a in range(start, start + m):
        norms[a, 0], norms[a, 1] = norms[a, first], norms[a, first + 1]
        flags = int(norms[a, 4])
        if flags == 0:
            continue
        norms[a, 0] *= _share_of(flags & 7, lam, share)
        ends = flags >> 3
        if ends == 1 or ends == 2 or ends == 4:
            norms[a, 1] *= min(1.0, 2.0 * _share_of(ends, lam, share))


@compiled
def _share_of(bits, lam, share):
    """The greatest Σ λ_k over the other corners of the root; ``share``: those known already, and 1
    for none."""
    if bits and share[bits] < 0.0:
        most = 0.0
        for p in range(3):
            total = 0.0
            for k in range(3):
                if not bits >> k & 1:
                    total += lam[3 * p + k]
            most = max(most, total)
        share[bits] = most
    return share[bits]


@compiled
def _line_sign(tables, row, error):
    """The sign of L on the triangle if it is certainly constant in its interior, else 0."""
    positive = negative = 0
    for k in range(3):
        if tables[row, k] > error:
            positive += 1
        elif tables[row, k] < -error:
            negative += 1
        elif tables[row, k] != 0.0:
            return 0
    if positive and negative:
        return 0
    return 1 if positive else (-1 if negative else 0)


@compiled
def _form_sign(tables, row, error):
    """1 if Q ≥ 0 on the triangle, −1 if Q ≤ 0, certainly; else 0."""
    positive = negative = 0
    for k in range(3, 9):
        if tables[row, k] > error:
            positive += 1
        elif tables[row, k] < -error:
            negative += 1
        elif tables[row, k] != 0.0:
            return 0
    if positive and negative:
        return 0
    return 1 if positive else (-1 if negative else 0)


@compiled
def beats(tables, i, j, lt, ls, qt, qs, bound, far, known):
    """Whether the first candidate certainly wins against the second all over the triangle.

    ``lt``, ``ls``: signs of L (0: not constant).  ``qt``, ``qs``: signs of Q (0: not constant).
    """
    if lt != 0 and ls != 0:
        return surely_positive(tables, i, j, float(lt), float(ls), bound, far, known)
    if qt == 1 and qs == -1:
        return True
    if lt != 0:  # |L_s| is ±L_s: one sign suffices where Q_t ≥ 0, else take both
        one = surely_positive(tables, i, j, float(lt), 1.0, bound, far, known)
        if qt == 1:
            return one or surely_positive(tables, i, j, float(lt), -1.0, bound, far, known)
        return one and surely_positive(tables, i, j, float(lt), -1.0, bound, far, known)
    if ls != 0:  # likewise for |L_t|, where Q_s ≤ 0
        one = surely_positive(tables, i, j, 1.0, float(ls), bound, far, known)
        if qs == -1:
            return one or surely_positive(tables, i, j, -1.0, float(ls), bound, far, known)
        return one and surely_positive(tables, i, j, -1.0, float(ls), bound, far, known)
    return False


#: Weights of the points at which the best candidate is looked for: the middle and, instead of
#: corners at infinity, where segments with equal vectors tie, points near them.
_MIDDLE = np.array([1.0, 1.0, 1.0])
_NEAR = np.array([[62.0, 1.0, 1.0], [1.0, 62.0, 1.0], [1.0, 1.0, 62.0]])


@compiled
def _best_at(tables, start, m, corner, far):
    """The candidate with the greatest Q/|L| at a corner (3: the middle), in doubles."""
    best, bq, bl = -1, 0.0, 1.0
    inner = corner == 3 or far >> corner & 1
    z, x, y = _NEAR[corner] if corner < 3 else _MIDDLE
    for a in range(m):
        r = start + a
        if inner:
            q = z * z * tables[r, 3] + x * x * tables[r, 4] + y * y * tables[r, 5]
            q += 2.0 * (z * (x * tables[r, 6] + y * tables[r, 7]) + x * y * tables[r, 8])
            line = abs(z * tables[r, 0] + x * tables[r, 1] + y * tables[r, 2])
        else:
            q, line = tables[r, 3 + corner], abs(tables[r, corner])
        if q == 0.0 and line == 0.0:
            continue
        if best < 0 or q * bl > bq * line:
            best, bq, bl = a, q, line
    return best


@compiled
def _fine_best_at(tables, start, m, corner, far):
    """The same with fine tables."""
    best = -1
    bq, bl = (0.0, 0.0), (1.0, 0.0)
    inner = corner == 3 or far >> corner & 1
    x, y, z = ((0.0, 0.0),) * 3
    if inner:
        weights = _NEAR[corner] if corner < 3 else _MIDDLE
        z, x, y = (weights[0], 0.0), (weights[1], 0.0), (weights[2], 0.0)
    for a in range(m):
        r = start + a
        if inner:
            q, line = form_at(tables, r, z, x, y), line_at(tables, r, z, x, y)
        else:
            q = (tables[r, 3 + corner], tables[r, 12 + corner])
            line = (tables[r, corner], tables[r, 9 + corner])
        if line[0] < 0.0:
            line = (-line[0], -line[1])
        if q[0] == 0.0 and line[0] == 0.0:
            continue
        more = times(q[0], q[1], bl[0], bl[1])
        more = plus_product(more[0], more[1], -bq[0], -bq[1], line[0], line[1])
        if best < 0 or more[0] > 0.0:
            best, bq, bl = a, q, line
    return best


@compiled
def find_signs(tables, norms, start, m, factor, definite, work):
    """The signs of L and Q of all candidates on the triangle (0: not constant)."""
    _, lsign, qsign, _ = work
    for a in range(m):
        if definite:
            lsign[a] = 1
            qsign[a] = 0
        else:
            lsign[a] = _line_sign(tables, start + a, factor * norms[start + a, 0])
            qsign[a] = _form_sign(tables, start + a, factor * norms[start + a, 1])


@compiled
def prune(tables, norms, ids, start, m, factor, far, definite, work, world, spots):
    """Drop candidates beaten by a pivot; the number left, moved to the front (stable), and that of
    tests."""
    pivots, lsign, qsign, beaten = work
    count = 0
    for corner in range(4):
        if is_fine(tables):
            best = _fine_best_at(tables, start, m, corner, far)
        else:
            best = _best_at(tables, start, m, corner, far)
        new = best >= 0
        for r in range(count):
            new = new and pivots[r] != best
        if new:
            pivots[count] = best
            count += 1
    for a in range(m):
        beaten[a] = 0
    find_signs(tables, norms, start, m, factor, definite, work)
    tests = 0
    for a in range(m):
        for r in range(count):
            p = pivots[r]
            if p == a or beaten[p]:
                continue
            tests += 1
            if _tested(tables, norms, ids, start, p, a, lsign, qsign, factor, far, world, spots):
                beaten[a] = 1
                break
    return keep(tables, norms, ids, start, m, lsign, qsign, beaten), tests


@compiled
def keep(tables, norms, ids, start, m, lsign, qsign, beaten):
    """Move the candidates that are not beaten to the front; their number."""
    kept = 0
    for a in range(m):
        if not beaten[a]:
            if kept != a:
                for c in range(tables.shape[1]):
                    tables[start + kept, c] = tables[start + a, c]
                for c in range(norms.shape[1]):
                    norms[start + kept, c] = norms[start + a, c]
                ids[start + kept] = ids[start + a]
                lsign[kept] = lsign[a]
                qsign[kept] = qsign[a]
            kept += 1
    return kept


@compiled
def _tested(tables, norms, ids, start, p, a, lsign, qsign, factor, far, world, spots):
    lines, lengths, classes, tie_first, ties = world
    i, j = ids[start + p], ids[start + a]
    if lines[i] >= 0 and lines[i] == lines[j]:
        bound = factor * (norms[start + p, 1] * lengths[j, 0] + norms[start + a, 1] * lengths[i, 0])
        known = relation(i, j, classes, tie_first, ties, spots)
        return collinear_beats(
            tables, start + p, start + a, lengths[i], lengths[j], bound, far, known
        )
    bound = factor * (
        norms[start + p, 1] * norms[start + a, 0] + norms[start + a, 1] * norms[start + p, 0]
    )
    known = relation(i, j, classes, tie_first, ties, spots)
    return beats(
        tables, start + p, start + a, lsign[p], lsign[a], qsign[p], qsign[a], bound, far, known
    )


@compiled
def prune_pairs(tables, norms, ids, start, m, factor, far, work, world, spots):
    """Drop candidates beaten by any other; the number left.  O(m²)."""
    _, lsign, qsign, beaten = work
    for a in range(m):
        beaten[a] = 0
    for a in range(m):
        for p in range(m):
            if (
                p != a
                and not beaten[p]
                and _tested(
                    tables, norms, ids, start, p, a, lsign, qsign, factor, far, world, spots
                )
            ):
                beaten[a] = 1
                break
    return keep(tables, norms, ids, start, m, lsign, qsign, beaten)
