"""At one fixed level: the point of least greatest power to n discs, inside n half-planes.

Inside the kernel of a polygon the points that see edge i under at least α are those of a disc,

    E_i(p) = Q_i(p) − c·L_i(p) ≤ 0,    c = cot α,

and every E_i has the same leading part |p|²: E_i(p) is the power of p with respect to the circle
of edge i.  So  M(c) = min over the kernel of max_i E_i  is a quadratic program in the plane,

    minimise |p|² + t  subject to  g_i·p + r_i ≤ t (discs)  and  −L_i(p) ≤ 0 (walls),

of combinatorial dimension 3.  The discs and the kernel have a common point iff M(c) ≤ 0.

A *constraint* is a number: 2i for the disc of edge i, 2i + 1 for its wall, −1 for none.  A *basis*
holds at most three of them, at least one of which is a disc.  By weak duality the least value
over a basis with multipliers ν ≥ 0 (those of the discs add up to 1) bounds M(c) from below, so the
pivot step needs no tolerance: of all subsets of basis + violated constraint it takes the one of
greatest value that has such multipliers.  Values increase strictly, hence it ends.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled

NONE = -1
MOST_PIVOTS = 100
FAINT = 2.0**-960
"""In coordinates about 1 no product below this is trusted to have a small relative error."""
GRANTED = 4.0 * 2.0**-53
"""What is granted to rounding, as a part of the size of the products."""


@compiled
def put_row(row, k, constraint, c, px, py, ax, ay, dx, dy):
    """Row k: (g, r, 1 for a disc and 0 for a wall), with the origin moved to (px, py)."""
    i = constraint >> 1
    ux, uy, wx, wy = ax[i] - px, ay[i] - py, dx[i], dy[i]
    area = ux * wy - uy * wx
    if constraint & 1:
        row[k, 0], row[k, 1], row[k, 2], row[k, 3] = wy, -wx, -area, 0.0
    else:
        vx, vy = ux + wx, uy + wy
        row[k, 0], row[k, 1] = c * wy - (ux + vx), -c * wx - (uy + vy)
        row[k, 2], row[k, 3] = ux * vx + uy * vy - c * area, 1.0


@compiled
def one(row, i):
    """(value, x, y) of the least of the disc of row i alone: its centre."""
    x, y = -0.5 * row[i, 0], -0.5 * row[i, 1]
    return row[i, 2] - x * x - y * y, x, y


@compiled
def two(row, i, j):
    """(value, x, y, ν_i, ν_j) with row i (a disc) and row j tight; value −∞ unless ν ≥ 0.

    The point is the foot of the centre on the line where both are tight, as a sum of a vector
    across and one along: a rounded step along leaves both tight, however near the origin is.
    """
    a, b, e = row[j, 0], row[j, 1], row[j, 2]
    if row[j, 3] > 0.0:
        a, b, e = a - row[i, 0], b - row[i, 1], e - row[i, 2]
    square = a * a + b * b
    nu = (2.0 * e - (row[i, 0] * a + row[i, 1] * b)) / square
    rest = 1.0 - nu * row[j, 3]
    if not (nu >= 0.0 and rest >= 0.0 and square > 0.0):
        return -np.inf, 0.0, 0.0, 0.0, 0.0
    across, along = -e / square, 0.5 * (row[i, 0] * b - row[i, 1] * a) / square
    x, y = across * a - along * b, across * b + along * a
    return x * x + y * y + row[i, 0] * x + row[i, 1] * y + row[i, 2], x, y, rest, nu


@compiled
def three(row, i, j, k):
    """(value, x, y, ν_i, ν_j, ν_k) with three rows tight, i a disc; −∞ unless ν ≥ 0."""
    a, b, e = row[j, 0], row[j, 1], row[j, 2]
    if row[j, 3] > 0.0:
        a, b, e = a - row[i, 0], b - row[i, 1], e - row[i, 2]
    f, g, h = row[k, 0], row[k, 1], row[k, 2]
    if row[k, 3] > 0.0:
        f, g, h = f - row[i, 0], g - row[i, 1], h - row[i, 2]
    det = a * g - b * f
    x, y = (b * h - e * g) / det, (e * f - a * h) / det
    s, t = -2.0 * x - row[i, 0], -2.0 * y - row[i, 1]
    nu, mu = (s * g - t * f) / det, (a * t - b * s) / det
    rest = 1.0 - nu * row[j, 3] - mu * row[k, 3]
    if not (nu >= 0.0 and mu >= 0.0 and rest >= 0.0 and det != 0.0):
        return -np.inf, 0.0, 0.0, 0.0, 0.0, 0.0
    value = x * x + y * y + row[i, 0] * x + row[i, 1] * y + row[i, 2]
    return value, x, y, rest, nu, mu


@compiled
def best_subset(row, count, needed, chosen, nu):
    """(value, x, y): the subset of the rows, with row ``needed`` in it, of greatest value.

    ``chosen`` receives its row numbers (−1: none), ``nu`` its multipliers.  ``needed`` −1 asks for
    any subset.
    """
    best, x, y = -np.inf, 0.0, 0.0
    chosen[0] = chosen[1] = chosen[2] = NONE
    for i in range(count):
        if row[i, 3] > 0.0 and (needed < 0 or needed == i):
            value, px, py = one(row, i)
            if value > best:
                best, x, y = value, px, py
                chosen[0], nu[0] = i, 1.0
    for i in range(count):
        for j in range(i + 1, count):
            if needed >= 0 and needed != i and needed != j:
                continue
            f, s = (i, j) if row[i, 3] > 0.0 else (j, i)
            if row[f, 3] == 0.0:
                continue
            value, px, py, nu_f, nu_s = two(row, f, s)
            if value > best:
                best, x, y = value, px, py
                chosen[0], chosen[1], nu[0], nu[1] = f, s, nu_f, nu_s
    for i in range(count):
        for j in range(i + 1, count):
            for k in range(j + 1, count):
                if needed >= 0 and needed != i and needed != j and needed != k:
                    continue
                f, s, t = i, j, k
                if row[f, 3] == 0.0:
                    f, s = s, f
                if row[f, 3] == 0.0:
                    f, t = t, f
                if row[f, 3] == 0.0:
                    continue
                value, px, py, nu_f, nu_s, nu_t = three(row, f, s, t)
                if value > best:
                    best, x, y = value, px, py
                    chosen[0], chosen[1], chosen[2] = f, s, t
                    nu[0], nu[1], nu[2] = nu_f, nu_s, nu_t
    return best, x, y


@compiled
def most_violated(c, px, py, value, ax, ay, dx, dy, m):
    """The constraint that (px, py) violates most, walls only if no disc is violated; or −1.

    What rounding may have caused does not count: every product is off by a few u of its size,
    u = 2⁻⁵³, if the edges are given with relative errors of u from somewhere near the point.
    """
    worst, chosen = 0.0, NONE
    deepest, wall = 0.0, NONE
    for i in range(m):
        ux, uy, wx, wy = ax[i] - px, ay[i] - py, dx[i], dy[i]
        left, right = ux * wy, uy * wx
        area, size = left - right, abs(left) + abs(right)
        q = ux * (ux + wx) + uy * (uy + wy)
        excess = q - c * area - value
        if excess > worst and excess > GRANTED * (abs(q) + abs(c) * size + abs(value)):
            worst, chosen = excess, 2 * i
        if area < deepest and -area > GRANTED * size:
            deepest, wall = area, 2 * i + 1
    return chosen if chosen != NONE else wall


@compiled
def greatest_power(c, px, py, ax, ay, dx, dy, m):
    """The disc of greatest E at (px, py)."""
    greatest, chosen = -np.inf, 0
    for i in range(m):
        ux, uy, wx, wy = ax[i] - px, ay[i] - py, dx[i], dy[i]
        power = ux * (ux + wx) + uy * (uy + wy) - c * (ux * wy - uy * wx)
        if power > greatest:
            greatest, chosen = power, 2 * i
    return chosen


@compiled
def settle(c, state, basis, nu, row, chosen, ax, ay, dx, dy, m):
    """Make ``basis`` optimal for the level c, by pivots from what it is.

    ``state``: (x, y) of the point, updated; state[2] receives the value M(c).  ``basis`` (four
    places), ``nu`` (its multipliers), ``row`` (4 × 4) and ``chosen`` are room to work in.  Returns
    the number of pivots, each of which looks at all m edges.
    """
    count = 0
    for k in range(3):
        if basis[k] != NONE:
            put_row(row, count, basis[k], c, state[0], state[1], ax, ay, dx, dy)
            basis[count] = basis[k]
            count += 1
    if count == 0:
        basis[0] = greatest_power(c, state[0], state[1], ax, ay, dx, dy, m)
        put_row(row, 0, basis[0], c, state[0], state[1], ax, ay, dx, dy)
        count = 1
    for k in range(count, 4):
        basis[k] = NONE
    value = take_best(state, basis, nu, row, chosen, count, NONE)
    for pivots in range(MOST_PIVOTS):
        violated = most_violated(c, state[0], state[1], value, ax, ay, dx, dy, m)
        if violated == NONE:
            state[2] = value
            return pivots
        count = 0
        while count < 3 and basis[count] != NONE:
            put_row(row, count, basis[count], c, state[0], state[1], ax, ay, dx, dy)
            count += 1
        put_row(row, count, violated, c, state[0], state[1], ax, ay, dx, dy)
        basis[count] = violated
        raised = take_best(state, basis, nu, row, chosen, count + 1, count)
        if not raised > value:  # what is still violated is no more than rounding
            break
        value = raised
    state[2] = value
    return pivots


@compiled
def take_best(state, basis, nu, row, chosen, count, needed):
    """Reduce the basis to its best subset, move the point there, return the value.

    If no subset has multipliers ≥ 0 (rounding), the value is −∞ and the last constraint goes.
    """
    value, x, y = best_subset(row, count, needed, chosen, nu)
    if value == -np.inf:
        basis[count - 1] = NONE
        return value
    first = basis[chosen[0]]
    second = basis[chosen[1]] if chosen[1] != NONE else NONE
    third = basis[chosen[2]] if chosen[2] != NONE else NONE
    basis[0], basis[1], basis[2] = first, second, third
    state[0] += x
    state[1] += y
    return value
