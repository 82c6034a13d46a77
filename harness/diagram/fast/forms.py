"""Q, L and F over a triangle in Bernstein form, in doubles with a proven error bound.

A *table* holds, for one segment and one triangle with (homogeneous) corners P₀, P₁, P₂, the nine
numbers L₀ L₁ L₂ q₀₀ q₁₁ q₂₂ q₀₁ q₀₂ q₁₂: the values L(P_k) and the polar form of Q,

    q(P, P') = ½((aw − P)·(bw' − P') + (aw' − P')·(bw − P)),      q(P, P) = Q(P),

so that L = Σ λ_k L_k and Q = Σ λ_k λ_l q_kl in barycentric coordinates λ.  Halving a side halves
sums of table entries (de Casteljau).  The ten Bernstein coefficients of the cubic

    F^s = Q_i L_j − s Q_j L_i

are sums of at most three products q·L with weights that add up to one.

**Error bound.**  Let u = 2⁻⁵³, and for a segment let ML ≥ Σ|products| in every L_k, MQ likewise
for q, at the corners of the root triangle.  The coordinate differences aw − P are computed in
double-double arithmetic and rounded once, hence off by at most u relatively (plus 2⁻⁹⁵ of the
size S of all coordinates, which `magnitude` covers by adding 2⁻⁴²S to each).  So an L_k is off by
at most 5u·ML, a q_kl by at most 6u·MQ.  A halving adds one rounding of a
number bounded by ML (MQ) to an entry; the entry q of a new corner is halved twice and adds two.
After d of them the errors are at most (5 + d)u·ML and (6 + 2d)u·MQ, but for terms in u².  A product
q·L is then off by (12 + 3d)u·MQ·ML, and a sum of three with the weights 2/3, 1/3 adds at most 5
more roundings; two such sums are subtracted, one more.  Altogether

    |error of a coefficient| ≤ (18 + 3d) u (MQ_i ML_j + MQ_j ML_i),

for which :func:`error_factor` returns (24 + 3d)u; the slack covers the terms in u² and underflow.

In triangles where that is too much the tables are in double-double, with 18 columns, and the bound
is that of :mod:`harness.diagram.fast.fine`; the functions of this room take either kind.

**Structural zeros.**  An entry 0.0 *is* zero (the corner lies on the segment's line, or is its
endpoint, by construction); an entry that merely rounds to zero is replaced by ``TINY``, far below
every error bound.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.double import TINY
from harness.diagram.fast.fine import fine_coefficients, is_fine
from harness.diagram.fast.jit import compiled

U = 2.0**-53

# Positions in a table.
L0, L1, L2, Q00, Q11, Q22, Q01, Q02, Q12 = range(9)
#: Signs: −1, 0 (structurally zero), 1, or
UNKNOWN = 2

#: The coefficients 300, 030, 003, 210, 201, 120, 021, 102, 012, 111 that lie on the side opposite
#: to each corner, counter-clockwise.
SIDES = np.array([[1, 6, 8, 2], [2, 7, 4, 0], [0, 3, 5, 1]])
#: For each index of order two (200, 020, 002, 110, 101, 011): the coefficients one step further
#: towards corners 0, 1 and 2.
STEPS = np.array([[0, 3, 4], [5, 1, 6], [7, 8, 2], [3, 5, 9], [4, 9, 7], [9, 6, 8]])


@compiled
def error_factor(depth):
    """See the room's docstring."""
    return (24.0 + 3.0 * depth) * U


@compiled
def mean(x, y):
    """(x + y)/2, zero only if both are."""
    value = 0.5 * (x + y)
    if value == 0.0 and x != 0.0:
        return TINY
    return value


@compiled
def halve(tables, row, k, other):
    """The tables of both halves of a triangle whose side opposite to corner k is halved.

    With corners P (number k), Q, R in counter-clockwise order and M the middle of QR: (P, Q, M)
    goes to the row ``other``, (P, M, R) replaces the triangle's own.
    """
    if k == 0:
        lp, lq, lr = tables[row, 0], tables[row, 1], tables[row, 2]
        pp, qq, rr = tables[row, 3], tables[row, 4], tables[row, 5]
        pq, pr, qr = tables[row, 6], tables[row, 7], tables[row, 8]
    elif k == 1:
        lp, lq, lr = tables[row, 1], tables[row, 2], tables[row, 0]
        pp, qq, rr = tables[row, 4], tables[row, 5], tables[row, 3]
        pq, pr, qr = tables[row, 8], tables[row, 6], tables[row, 7]
    else:
        lp, lq, lr = tables[row, 2], tables[row, 0], tables[row, 1]
        pp, qq, rr = tables[row, 5], tables[row, 3], tables[row, 4]
        pq, pr, qr = tables[row, 7], tables[row, 8], tables[row, 6]
    lm = mean(lq, lr)
    pm = mean(pq, pr)
    qm = mean(qq, qr)
    mr = mean(qr, rr)
    mm = mean(qm, mr)
    tables[other, 0], tables[other, 1], tables[other, 2] = lp, lq, lm
    tables[other, 3], tables[other, 4], tables[other, 5] = pp, qq, mm
    tables[other, 6], tables[other, 7], tables[other, 8] = pq, pm, qm
    tables[row, 0], tables[row, 1], tables[row, 2] = lp, lm, lr
    tables[row, 3], tables[row, 4], tables[row, 5] = pp, mm, rr
    tables[row, 6], tables[row, 7], tables[row, 8] = pm, pr, mr


#: The products q·L in each coefficient, as positions in a table; −1 fills up.
TERMS = np.array(
    [
        [[3, 0], [-1, -1], [-1, -1]],
        [[4, 1], [-1, -1], [-1, -1]],
        [[5, 2], [-1, -1], [-1, -1]],
        [[6, 0], [3, 1], [-1, -1]],
        [[7, 0], [3, 2], [-1, -1]],
        [[6, 1], [4, 0], [-1, -1]],
        [[8, 1], [4, 2], [-1, -1]],
        [[7, 2], [5, 0], [-1, -1]],
        [[8, 2], [5, 1], [-1, -1]],
        [[6, 2], [7, 1], [8, 0]],
    ]
)
#: The corners (a bit each) on whose multiplicities a coefficient depends.
SUPPORT = np.array([1, 2, 4, 3, 5, 3, 6, 5, 6, 7])


#: Whether corner k counts at least twice in the index of a coefficient.
AT_LEAST_TWICE = np.zeros((3, 10), np.bool_)
AT_LEAST_TWICE[0, [0, 3, 4]] = AT_LEAST_TWICE[1, [1, 5, 6]] = AT_LEAST_TWICE[2, [2, 7, 8]] = True


@compiled
def coefficients(tables, i, j, si, sj):
    """The ten coefficients of Q_i sj L_j − Q_j si L_i, of the candidates in rows i and j."""
    if is_fine(tables):
        return fine_coefficients(tables, i, j, si, sj)
    a, b, c = si * tables[i, 0], si * tables[i, 1], si * tables[i, 2]
    d, e, f = sj * tables[j, 0], sj * tables[j, 1], sj * tables[j, 2]
    t3, t4, t5 = tables[i, 3], tables[i, 4], tables[i, 5]
    t6, t7, t8 = tables[i, 6], tables[i, 7], tables[i, 8]
    s3, s4, s5 = tables[j, 3], tables[j, 4], tables[j, 5]
    s6, s7, s8 = tables[j, 6], tables[j, 7], tables[j, 8]
    third = 1.0 / 3.0
    return (
        t3 * d - s3 * a,
        t4 * e - s4 * b,
        t5 * f - s5 * c,
        ((2.0 * t6 * d + t3 * e) - (2.0 * s6 * a + s3 * b)) * third,
        ((2.0 * t7 * d + t3 * f) - (2.0 * s7 * a + s3 * c)) * third,
        ((2.0 * t6 * e + t4 * d) - (2.0 * s6 * b + s4 * a)) * third,
        ((2.0 * t8 * e + t4 * f) - (2.0 * s8 * b + s4 * c)) * third,
        ((2.0 * t7 * f + t5 * d) - (2.0 * s7 * c + s5 * a)) * third,
        ((2.0 * t8 * f + t5 * e) - (2.0 * s8 * c + s5 * b)) * third,
        ((t6 * f + t7 * e + t8 * d) - (s6 * c + s7 * b + s8 * a)) * third,
    )


@compiled
def _tie_of(i, j, low, high, ties):
    """What is known of a pair i < j among the sorted rows ``low`` … ``high`` − 1 of ties."""
    while low < high:
        middle = (low + high) // 2
        if ties[middle, 0] < i or (ties[middle, 0] == i and ties[middle, 1] < j):
            low = middle + 1
        elif ties[middle, 0] == i and ties[middle, 1] == j:
            return ties[middle, 2]
        else:
            high = middle
    return 0


@compiled
def relation(i, j, classes, tie_first, ties, spots):
    """What is known by construction about the pair i, j over a triangle, as bits.

    Bit 0: the segments have the same vector up to sign, so that at infinity their L are equal up
    to sign.  Bits 1 … 3: F⁺_ij is zero at corner 0, 1, 2 of the triangle; bits 4 … 6: F⁻_ij is;
    bits 7 … 9 and 10 … 12: so is its gradient.
    ``spots``: the numbers of the triangle's corners among the corners of roots, or −1; at some
    of these ties are known (``ties``: rows of :mod:`harness.diagram.fast.ties` without the corner,
    from ``tie_first`` on).
    """
    bits = 1 if classes[i] >= 0 and classes[i] == classes[j] else 0
    for k in range(3):
        if spots[k] >= 0:
            which = _tie_of(
                min(i, j), max(i, j), tie_first[spots[k]], tie_first[spots[k] + 1], ties
            )
            bits |= (which & 1) << (k + 1) | (which >> 1 & 1) << (k + 4)
            bits |= (which >> 2 & 1) << (k + 7) | (which >> 3 & 1) << (k + 10)
    return bits


@compiled
def is_structural_zero(c, tables, i, j, si, sj, far, known):
    """Whether coefficient c of Q_i sj L_j − Q_j si L_i is zero by construction.

    ``far``: the corners at infinity, a bit each.  ``known``: see :func:`relation`.
    """
    zero = True
    for r in range(3):
        q, line = TERMS[c, r, 0], TERMS[c, r, 1]
        if q >= 0 and not (
            (tables[i, q] == 0.0 or tables[j, line] == 0.0)
            and (tables[j, q] == 0.0 or tables[i, line] == 0.0)
        ):
            zero = False
    if zero:
        return True
    if c < 3 and known >> ((c + 1) if si * sj > 0 else (c + 4)) & 1:
        return True
    if known & 1 and (SUPPORT[c] & ~far) == 0:
        for k in range(3):
            if SUPPORT[c] >> k & 1 and sj * tables[j, k] != si * tables[i, k]:
                return False
        return True
    first = 7 if si * sj > 0 else 10
    for k in range(3):
        if known >> (k + first) & 1 and AT_LEAST_TWICE[k, c]:
            return True
    return False


@compiled
def is_flat(known, k):
    """Whether one of F⁺ and F⁻ is zero at corner k with its gradient."""
    return (known >> (k + 7) | known >> (k + 10)) & 1 == 1


@compiled
def divided_by_distance(values, k):
    """Replace F by the quadratic G of F = w·G, raised to degree three again.

    For two segments with the same vector (up to sign), over a triangle whose corners but k are at
    infinity: all of F vanishes there.  w is λ_k times a constant, so that coefficient e of G is
    3/(e_k + 1) times the coefficient of F one step further towards corner k.  The signs of the
    raised form, with 9 times the bound, are left to the caller.
    """
    g = np.empty(6)
    for r in range(6):
        # Multiplicity of corner k in the index r: 2 at its own square, 1 at the mixed ones.
        times = 2 if r == k else (1 if _MIXED[r, k] else 0)
        g[r] = 3.0 / (times + 1) * values[STEPS[r, k]]
    raise_degree(g[0], g[1], g[2], g[3], g[4], g[5], values)


_MIXED = np.array(
    [
        [False] * 3,
        [False] * 3,
        [False] * 3,
        [True, True, False],
        [True, False, True],
        [False, True, True],
    ]
)


@compiled
def raise_degree(g200, g020, g002, g110, g101, g011, values):
    """The cubic Bernstein coefficients of a quadratic form."""
    third = 1.0 / 3.0
    values[0], values[1], values[2] = g200, g020, g002
    values[3] = (g200 + 2.0 * g110) * third
    values[4] = (g200 + 2.0 * g101) * third
    values[5] = (g020 + 2.0 * g110) * third
    values[6] = (g020 + 2.0 * g011) * third
    values[7] = (g002 + 2.0 * g101) * third
    values[8] = (g002 + 2.0 * g011) * third
    values[9] = (g110 + g101 + g011) * third


@compiled
def sure_signs(values, bound, signs):
    """Signs of coefficients, UNKNOWN within the bound."""
    for c in range(10):
        if values[c] > bound:
            signs[c] = 1
        elif values[c] < -bound:
            signs[c] = -1
        else:
            signs[c] = UNKNOWN


@compiled
def surely_positive(tables, i, j, si, sj, bound, far, known):
    """Whether Q_i sj L_j − Q_j si L_i > 0 in the interior of the triangle."""
    if not is_fine(tables):  # most comparisons fail at a corner
        for k in range(3):
            if tables[i, 3 + k] * sj * tables[j, k] - tables[j, 3 + k] * si * tables[i, k] < -bound:
                return False
    values = coefficients(tables, i, j, si, sj)
    least = min(
        min(min(values[0], values[1]), min(values[2], values[3])),
        min(min(values[4], values[5]), min(values[6], values[7])),
    )
    if min(least, min(values[8], values[9])) > bound:
        return True
    some = False
    for c in range(10):
        if values[c] > bound:
            some = True
        elif values[c] < -bound or not is_structural_zero(c, tables, i, j, si, sj, far, known):
            return False
    return some


@compiled
def cubic(tables, i, j, si, sj, bound, far, known, values, signs):
    """Coefficients and certain signs of Q_i sj L_j − Q_j si L_i."""
    computed = coefficients(tables, i, j, si, sj)
    some = False
    for c in range(10):  # without branches: signs cannot be foreseen
        sign = int(computed[c] > bound) - int(computed[c] < -bound)
        values[c], signs[c] = computed[c], sign
        some = some | (sign == 0)
    if some:
        for c in range(10):
            if signs[c] == 0 and not is_structural_zero(c, tables, i, j, si, sj, far, known):
                signs[c] = UNKNOWN
            elif signs[c] == 0:
                values[c] = 0.0


@compiled
def value_and_gradient(b, x, y, out):
    """F and its derivatives along corner 0 → 1 and 0 → 2 at λ = (1 − x − y, x, y)."""
    z = 1.0 - x - y
    # Quadratic controls after one step of de Casteljau, in the order 200 020 002 110 101 011.
    c0 = z * b[0] + x * b[3] + y * b[4]
    c1 = z * b[5] + x * b[1] + y * b[6]
    c2 = z * b[7] + x * b[8] + y * b[2]
    c3 = z * b[3] + x * b[5] + y * b[9]
    c4 = z * b[4] + x * b[9] + y * b[7]
    c5 = z * b[9] + x * b[6] + y * b[8]
    d0 = z * c0 + x * c3 + y * c4
    d1 = z * c3 + x * c1 + y * c5
    d2 = z * c4 + x * c5 + y * c2
    out[0] = z * d0 + x * d1 + y * d2
    out[1] = 3.0 * (d1 - d0)
    out[2] = 3.0 * (d2 - d0)


@compiled
def gradient_controls(b, out):
    """The six control vectors of the gradient (along 0 → 1 and 0 → 2), shape (6, 2)."""
    for r in range(6):
        base = b[STEPS[r, 0]]
        out[r, 0] = 3.0 * (b[STEPS[r, 1]] - base)
        out[r, 1] = 3.0 * (b[STEPS[r, 2]] - base)
