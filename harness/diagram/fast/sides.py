"""What is seen on the sides of a triangle: ports, and the winners between them.

``slots``, the result: row r is the r-th port counter-clockwise from corner 0, with its *place*
(0, 2, 4: at corner 0, 1, 2; 1, 3, 5: on the side that follows) and the candidate that owns the
piece after it.  Without ports, row 0 names the owner.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.collinear import collinear_cubic
from harness.diagram.fast.fine import is_fine
from harness.diagram.fast.forms import (
    SIDES,
    UNKNOWN,
    U,
    cubic,
    divided_by_distance,
    is_flat,
    relation,
    sure_signs,
)
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import (
    MOST_PORTS,
    germ,
    has_two_zeros,
    side_value,
    side_zero,
    sign_changes,
)

#: The side after each corner, by its opposite corner.
SIDE_AFTER = np.array([2, 0, 1])
#: Candidates at most of which all pairs are looked at.
MOST_PAIRED = 6


@compiled
def new_scratch():
    """Working space: values, signs, bounds of all pairs, controls, and small vectors."""
    return (
        np.zeros((MOST_PAIRED, MOST_PAIRED, 10)),
        np.zeros((MOST_PAIRED, MOST_PAIRED, 10), np.int64),
        np.zeros((MOST_PAIRED, MOST_PAIRED)),
        np.zeros((MOST_PAIRED, MOST_PAIRED, 6, 2)),
        np.zeros((MOST_PORTS, 2), np.int64),
        np.zeros(3),
        np.zeros(2),
        np.zeros(MOST_PORTS, np.int64),
    )


@compiled
def all_pairs(tables, start, m, sides, norms, factor, far, world, spots, ids, w):
    """F of all pairs a < b of candidates, and its opposite for b > a, into the scratch ``w``.

    ``sides``: the sign of L of every candidate on the triangle.
    """
    values, signs, bounds = w[0], w[1], w[2]
    lines, lengths, classes, tie_first, ties = world
    for a in range(m):
        for b in range(a + 1, m):
            i, j = ids[start + a], ids[start + b]
            if lines[i] >= 0 and lines[i] == lines[j]:
                bound = factor * (
                    norms[start + a, 1] * lengths[j, 0] + norms[start + b, 1] * lengths[i, 0]
                )
                bound = collinear_cubic(
                    tables,
                    start + a,
                    start + b,
                    lengths[i],
                    lengths[j],
                    bound,
                    far,
                    relation(i, j, classes, tie_first, ties, spots),
                    values[a, b],
                    signs[a, b],
                )
            else:
                bound = factor * (
                    norms[start + a, 1] * norms[start + b, 0]
                    + norms[start + b, 1] * norms[start + a, 0]
                )
                known = relation(i, j, classes, tie_first, ties, spots)
                cubic(
                    tables,
                    start + a,
                    start + b,
                    sides[a],
                    sides[b],
                    bound,
                    far,
                    known,
                    values[a, b],
                    signs[a, b],
                )
                bound += rounding(tables, values[a, b])
                if known & 1 and _vanishes_far(signs[a, b], far):
                    near = 0 if far == 6 else (1 if far == 5 else 2)
                    divided_by_distance(values[a, b], near)
                    bound *= 9.0
                    sure_signs(values[a, b], bound, signs[a, b])
                    for k in range(3):
                        if is_flat(known, k) and k != near:
                            values[a, b, k], signs[a, b, k] = 0.0, 0
            bounds[a, b] = bounds[b, a] = bound
            for c in range(10):
                values[b, a, c] = -values[a, b, c]
                sign = signs[a, b, c]
                signs[b, a, c] = sign if sign == UNKNOWN else -sign


@compiled
def beaten_by_one(m, w, beaten):
    """Mark candidates that certainly lose to another on the whole triangle; how many do not."""
    signs = w[1]
    left = m
    for x in range(m):
        beaten[x] = 0
        for u in range(m):
            if u != x and _is_never_negative(signs[u, x]):
                beaten[x] = 1
                left -= 1
                break
    return left


@compiled
def _is_never_negative(signs):
    """Whether no coefficient can be negative and one is positive."""
    some = False
    for c in range(10):
        if signs[c] == -1 or signs[c] == UNKNOWN:
            return False
        some = some or signs[c] == 1
    return some


@compiled
def compact(m, sides, w, beaten):
    """Move what is known of the pairs of candidates that are not beaten to the front."""
    values, signs, bounds = w[0], w[1], w[2]
    row = 0
    for a in range(m):
        if beaten[a]:
            continue
        column = 0
        for b in range(m):
            if beaten[b]:
                continue
            if row != column and (row != a or column != b):
                bounds[row, column] = bounds[a, b]
                for c in range(10):
                    values[row, column, c] = values[a, b, c]
                    signs[row, column, c] = signs[a, b, c]
            column += 1
        sides[row] = sides[a]
        row += 1


@compiled
def rounding(tables, values):
    """How far values are off after rounding to doubles, if they come from fine tables."""
    if not is_fine(tables):
        return 0.0
    largest = 0.0
    for c in range(10):
        largest = max(largest, abs(values[c]))
    return 12.0 * U * largest


@compiled
def _vanishes_far(signs, far):
    """Whether a cubic is zero by construction on a side at infinity."""
    if far == 6:
        k = 0
    elif far == 5:
        k = 1
    elif far == 3:
        k = 2
    else:
        return False
    return (
        signs[SIDES[k, 0]] == 0
        and signs[SIDES[k, 1]] == 0
        and signs[SIDES[k, 2]] == 0
        and signs[SIDES[k, 3]] == 0
    )


@compiled
def _winner_near(signs, m, k, at_end):
    """The candidate that wins near one end of side k, or −1."""
    for a in range(m):
        wins = True
        for b in range(m):
            if b != a and germ(signs[a, b], k, at_end) != 1:
                wins = False
                break
        if wins:
            return a
    return -1


@compiled
def _never_loses(signs, k):
    """Whether a cubic is certainly ≥ 0 on side k, and > 0 somewhere."""
    some = False
    for r in range(4):
        sign = signs[SIDES[k, r]]
        if sign == -1 or sign == UNKNOWN:
            return False
        some = some or sign == 1
    return some


@compiled
def _loses_at(values, bounds, winner, loser, k, t):
    """1 if ``loser`` certainly loses at parameter t of side k, −1 if it wins, 0 if unsure."""
    value = side_value(values[winner, loser], k, t)
    if value > 2.0 * bounds[winner, loser]:
        return 1
    return -1 if value < -2.0 * bounds[winner, loser] else 0


@compiled
def _crosses_once(u, v, k, w):
    return sign_changes(w[1][u, v], w[0][u, v], w[2][u, v], k) == 1


@compiled
def _side_pieces(m, k, u, v, w):
    """The piece strictly between the pieces u and v at the ends of side k.

    Returns −1 if there is none, −2 if that is not certain or there are several.

    Let t be the zero of F_uv.  A candidate x with at most one zero of F_ux and of F_vx on the side
    loses to u before t if it loses to u at t, and to v after t if it loses to v at t.
    """
    values, signs, bounds = w[0], w[1], w[2]
    if u == v:
        between = -1
        for x in range(m):
            if x != u and not _never_loses(signs[u, x], k):
                if between >= 0 or not has_two_zeros(values[u, x], bounds[u, x], k):
                    return -2
                between = x
        return between
    if not _crosses_once(u, v, k, w):
        return -2
    t, between = -1.0, -1
    for x in range(m):
        if x in (u, v) or _never_loses(signs[u, x], k) or _never_loses(signs[v, x], k):
            continue
        if not (_crosses_once(u, x, k, w) and _crosses_once(v, x, k, w)):
            return -2
        if t < 0:
            t = side_zero(values[u, v], k, False)
        to_u = _loses_at(values, bounds, u, x, k, t)
        to_v = _loses_at(values, bounds, v, x, k, t)
        if to_u == 1 and to_v == 1:
            continue
        if to_u != -1 or to_v != -1:
            return -2
        if between < 0 or side_value(values[x, between], k, t) > 0.0:
            between = x
    if between < 0:
        return -1
    x = between
    before, after = side_zero(values[u, x], k, False), side_zero(values[x, v], k, False)
    for y in range(m):
        if y in (u, v, x) or _never_loses(signs[u, y], k) or _never_loses(signs[v, y], k):
            continue
        if (
            _loses_at(values, bounds, u, y, k, t) == 1
            and _loses_at(values, bounds, v, y, k, t) == 1
        ):
            continue
        if sign_changes(signs[x, y], values[x, y], bounds[x, y], k) < 0:
            return -2
        # y must lose to u up to ``before``, to x up to ``after``, and then to v.
        if (
            _loses_at(values, bounds, u, y, k, before) != 1
            or _loses_at(values, bounds, x, y, k, before) != 1
            or _loses_at(values, bounds, x, y, k, after) != 1
            or _loses_at(values, bounds, v, y, k, after) != 1
        ):
            return -2
    return x


@compiled
def trace_sides(m, w):
    """Ports and pieces around the triangle into the slots: the number of ports, or −1."""
    slots = w[4]
    signs = w[1]
    count = 0
    start = _winner_near(signs, m, 2, False)
    if start < 0:
        return -1
    before = _winner_near(signs, m, 1, True)
    if before < 0:
        return -1
    current = before
    for position in range(3):
        k = SIDE_AFTER[position]
        u = start if position == 0 else _winner_near(signs, m, k, False)
        v = before if position == 2 else _winner_near(signs, m, k, True)
        if u < 0 or v < 0:
            return -1
        if u != current:
            slots[count, 0], slots[count, 1] = 2 * position, u
            count += 1
        between = _side_pieces(m, k, u, v, w)
        if between == -2 or count > 8:
            return -1
        if between >= 0:
            slots[count, 0], slots[count, 1] = 2 * position + 1, between
            count += 1
        if u != v or between >= 0:
            slots[count, 0], slots[count, 1] = 2 * position + 1, v
            count += 1
        current = v
    if count == 0:
        slots[0, 0], slots[0, 1] = 1, start
    return count
