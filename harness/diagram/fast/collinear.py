"""Two segments on one line: |L| is a common factor of F, and what is left is

    G = Q_i/length_i − Q_j/length_j

times both lengths.  If the lengths are equal, G is affine: it vanishes where two corners are at
infinity, and is w times a linear form H there.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.fine import fine_at_length, is_fine
from harness.diagram.fast.forms import AT_LEAST_TWICE, is_flat, raise_degree, sure_signs
from harness.diagram.fast.jit import compiled

#: The corners, a bit each, of the entries q₀₀ q₁₁ q₂₂ q₀₁ q₀₂ q₁₂.
ENTRIES = np.array([1, 2, 4, 3, 5, 6])


@compiled
def at_length(tables, i, j, length_i, length_j, q):
    """q_i·length_j − q_j·length_i for an entry q of Q; lengths (2,) in double-double."""
    if is_fine(tables):
        return fine_at_length(tables, i, j, length_i, length_j, q)
    return tables[i, q] * length_j[0] - tables[j, q] * length_i[0]


@compiled
def is_zero_entry(r, far, known):
    """Whether an entry of G is zero by construction; ``known``: see ``relation``."""
    if known & 1 and ENTRIES[r] & ~far == 0:
        return True
    for k in range(3):
        if is_flat(known, k) and ENTRIES[r] >> k & 1:
            return True
    return False


@compiled
def collinear_beats(tables, i, j, length_i, length_j, bound, far, known):
    """Whether the first of two segments on one line certainly wins in the whole triangle."""
    some = False
    for r in range(6):
        if is_zero_entry(r, far, known):
            continue
        if not at_length(tables, i, j, length_i, length_j, 3 + r) > bound:
            return False
        some = True
    return some


@compiled
def collinear_cubic(tables, i, j, length_i, length_j, bound, far, known, values, signs):
    """G, or H on a triangle with two corners at infinity, raised to degree three, with its signs.

    Returns the error bound of the coefficients.
    """
    g = np.zeros(6)
    largest = 0.0
    for r in range(6):
        if not is_zero_entry(r, far, known):
            g[r] = at_length(tables, i, j, length_i, length_j, 3 + r)
        largest = max(largest, abs(g[r]))
    zeros = twice = 0  # corners at which the form is zero by construction
    if known & 1 and far in (3, 5, 6):
        n = 2 if far == 3 else (1 if far == 5 else 0)
        # H has g_nn at the corner n, 2 g_nk at the corner k; as a quadratic form:
        h = np.empty(3)
        for k in range(3):
            h[k] = g[n] if k == n else 2.0 * g[2 + n + k]
            if k != n and is_flat(known, k):
                zeros |= 1 << k
        g[0], g[1], g[2] = h[0], h[1], h[2]
        g[3], g[4], g[5] = 0.5 * (h[0] + h[1]), 0.5 * (h[0] + h[2]), 0.5 * (h[1] + h[2])
        bound *= 2.0
        largest *= 2.0
    else:
        for k in range(3):
            zeros |= (1 << k) if is_zero_entry(k, far, known) else 0
            twice |= (1 << k) if is_flat(known, k) else 0
    raise_degree(g[0], g[1], g[2], g[3], g[4], g[5], values)
    # Raising the degree rounds.
    bound += 2.0**-49 * largest
    sure_signs(values, bound, signs)
    for k in range(3):
        if zeros >> k & 1:
            values[k], signs[k] = 0.0, 0
            for c in range(3, 9):
                if twice >> k & 1 and AT_LEAST_TWICE[k, c]:
                    values[c], signs[c] = 0.0, 0
    return bound
