"""Recognising leaves of definite candidates; see :mod:`harness.diagram.fast.leaves`."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.forms import UNKNOWN, value_and_gradient
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import (
    ARC,
    EMPTY,
    FAILED,
    OPEN,
    QUAD,
    TRIPLE,
    TWO_ARCS,
    hull_determinant,
    longest,
    meet,
)
from harness.diagram.fast.loops import has_no_loop
from harness.diagram.fast.pairs import classify_pair
from harness.diagram.fast.sides import trace_sides


@compiled
def _corners_are_plain(m, w):
    """At every corner at most two candidates compete, where there are more than two in all.

    That is so where at most one pair has a structural zero at the corner, or where one candidate
    has them with all others (the corner is an endpoint of its segment) but these do not tie.
    """
    signs = w[1]
    for corner in range(3):
        zeros = 0
        for a in range(m):
            for b in range(a + 1, m):
                zeros += signs[a, b, corner] == 0
        if zeros <= 1:
            continue
        common = False
        for a in range(m):
            count = 0
            for b in range(m):
                count += b != a and signs[a, b, corner] == 0
            common = common or count == zeros
        if not common:
            return False
    return True


@compiled
def _no_loops(m, w):
    for a in range(m):
        for b in range(a + 1, m):
            if not has_no_loop(w[1][a, b], w[0][a, b], w[2][a, b], w[3][a, b]):
                return False
    return True


@compiled
def _ties_once(a, b, c, w):
    """Whether three candidates certainly tie in at most one point (hull)."""
    for x, y, z in ((a, b, c), (b, c, a), (c, a, b)):
        i, j, k, n = min(x, y), max(x, y), min(x, z), max(x, z)
        if hull_determinant(w[3][i, j], w[3][k, n], w[2][i, j], w[2][k, n]) != 0.0:
            return True
    return False


@compiled
def _meet_where_all_tie(w):
    """The common zero of two cubics that have no other: a special corner may be one of the rest."""
    for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        i, j, k, n = min(x, y), max(x, y), min(x, z), max(x, z)
        if hull_determinant(w[3][i, j], w[3][k, n], w[2][i, j], w[2][k, n]) != 0.0:
            meet(w[0][i, j], w[0][k, n], w[6], w[5])
            return


@compiled
def is_blurred(m, w):
    """Whether rounding blurs some F beyond what halving can mend: all of it is near its bound."""
    for a in range(m):
        for b in range(a + 1, m):
            largest = 0.0
            for c in range(10):
                largest = max(largest, abs(w[0][a, b, c]))
            if largest <= 32.0 * w[2][a, b]:
                return True
    return False


@compiled
def may_tie_at_corner(m, w, exponents, lam, corners, special):
    """Whether some F may be zero at a special corner without our knowing.

    Halving would not end: whether it is so must be found out otherwise.  ``exponents``: 0 at the
    triangle's corners that are corners of the root, which has the numbers ``corners``.
    """
    for k in range(3):
        if exponents[k] != 0:
            continue
        for c in range(3):
            if lam[3 * k + c] == 1.0 and special[corners[c]]:
                for a in range(m):
                    for b in range(a + 1, m):
                        if w[1][a, b, k] == UNKNOWN:
                            return True
    return False


@compiled
def classify_definite(m, w):
    """The kind of leaf and, for some kinds, a choice; FAILED if none is proved.

    The scratch ``w`` holds all pairs.
    """
    slots = w[4]
    ports = trace_sides(m, w)
    if ports < 0:
        return FAILED, 0, 0
    if m == 2:
        return classify_pair(ports, w)
    if m > 4 or not _corners_are_plain(m, w) or not _no_loops(m, w):
        return FAILED, 0, 0
    if m == 3:
        if not _ties_once(0, 1, 2, w):
            return _classify_strip(ports, w)
        p0, p1, p2, p3 = slots[0, 1], slots[1, 1], slots[2, 1], slots[3, 1]
        if ports == 0:
            return EMPTY, 0, 0
        if ports == 2:
            return ARC, 2, 0
        if ports == 3 and p0 != p1 and p1 != p2 and p0 != p2:
            _meet_where_all_tie(w)
            return TRIPLE, 3, 0
        if ports == 4 and p0 == p2 and p1 != p3:
            return TWO_ARCS, 4, 1
        if ports == 4 and p1 == p3 and p0 != p2:
            return TWO_ARCS, 4, 0
        return FAILED, 0, 0
    if ports != 4:
        return FAILED, 0, 0
    for x in range(4):
        for y in range(x):
            if slots[x, 1] == slots[y, 1]:
                return FAILED, 0, 0
    for x in range(4):
        if not _ties_once((x + 1) & 3, (x + 2) & 3, (x + 3) & 3, w):
            return FAILED, 0, 0
    return QUAD, 4, _quad_choice(w)


@compiled
def _quad_choice(w):
    """0 if the owners of slots 0 and 2 share an edge, 1 if those of 1 and 3 do, OPEN if unsure.

    Let p be any point near the tie of a, b, c, and σ a bound with |Φ(p') − Φ(p)| ≥ σ|p' − p| for
    Φ = (F_ab, F_ac) (σ = least determinant / norm of the gradients, as between two points the mean
    gradients of both are the same convex combination of their control vectors).  If the ball of
    radius ρ = |Φ(p)|/σ about p lies in T, the tie is in it, by the degree of Φ; there F_ad differs
    from F_ad(p) by at most ρ·max|∇F_ad|.
    """
    values, bounds, controls, slots, out, point = w[0], w[2], w[3], w[4], w[5], w[6]
    for x in range(4):
        a, b, c, d = (
            slots[x, 1],
            slots[(x + 1) & 3, 1],
            slots[(x + 2) & 3, 1],
            slots[(x + 3) & 3, 1],
        )
        meet(values[a, b], values[a, c], point, out)
        px, py = point[0], point[1]
        inside = min(px, py, (1.0 - px - py) * 0.7)
        if not inside > 0.0:
            continue
        f, g, h = controls[min(a, b), max(a, b)], controls[min(a, c), max(a, c)], values[a, d]
        least = abs(hull_determinant(f, g, bounds[a, b], bounds[a, c]))
        if least == 0.0:
            continue
        steep = slope = 0.0
        k = controls[min(a, d), max(a, d)]
        for r in range(6):
            steep = max(steep, longest(f[r], bounds[a, b]) + longest(g[r], bounds[a, c]))
            slope = max(slope, longest(k[r], bounds[a, d]))
        sigma = 0.99 * least / np.sqrt(steep)
        value_and_gradient(values[a, b], px, py, out)
        residue = abs(out[0]) + 2.0 * bounds[a, b]
        value_and_gradient(values[a, c], px, py, out)
        residue += abs(out[0]) + 2.0 * bounds[a, c]
        radius = residue / sigma
        if not radius < inside:
            continue
        value_and_gradient(h, px, py, out)
        if abs(out[0]) > 2.0 * bounds[a, d] + 1.01 * radius * np.sqrt(slope):
            # d loses to a: a, b, c meet and a, c share an edge (slots x and x + 2).
            return (x & 1) if out[0] > 0.0 else 1 - (x & 1)
    return OPEN


@compiled
def _classify_strip(ports, w):
    """Pieces u, v, u, w where v and w are kept apart: F_uv/‖F_uv‖ + F_uw/‖F_uw‖ > 0 on T.

    Then u beats v or w everywhere, no three tie, and F_uv and F_uw are two separate contests.
    """
    values, bounds, slots = w[0], w[2], w[4]
    if ports != 4:
        return FAILED, 0, 0
    x = 0 if slots[0, 1] == slots[2, 1] else 1
    u, v, z = slots[x, 1], slots[x + 1, 1], slots[(x + 3) & 3, 1]
    if slots[x + 2, 1] != u or v == z:
        return FAILED, 0, 0
    if not never_both(values[u, v], values[u, z], bounds[u, v], bounds[u, z]):
        return FAILED, 0, 0
    return TWO_ARCS, 4, 1 - x


@compiled
def never_both(f, g, bound_f, bound_g):
    """Whether two cubics are certainly nowhere ≤ 0 together: a positive combination of their
    coefficients is positive."""
    size_f = size_g = 0.0
    for c in range(10):
        if f[c] <= 0.0 and g[c] <= 0.0:
            return False
        size_f, size_g = max(size_f, abs(f[c])), max(size_g, abs(g[c]))
    if size_f == 0.0 or size_g == 0.0:
        return False
    for weight in (1.0, 3.0, 1.0 / 3.0):
        alpha, beta = 1.0 / size_f, weight / size_g
        least = 1.1 * (alpha * bound_f + beta * bound_g)
        if _all_above(f, g, alpha, beta, least):
            return True
    return False


@compiled
def _all_above(f, g, alpha, beta, least):
    for c in range(10):
        if not alpha * f[c] + beta * g[c] > least:
            return False
    return True


@compiled
def beaten_by_two(m, w, beaten):
    """Mark candidates that lose everywhere to one of two others; the number of the unmarked.

    If αF_ux + βF_vx > 0 with α, β > 0, x never beats both u and v.
    """
    left = m
    for x in range(m):
        beaten[x] = 0
    for x in range(m):
        for u in range(m):
            if beaten[x] or u == x or beaten[u]:
                continue
            for v in range(u):
                if v == x or beaten[v]:
                    continue
                if never_both(w[0][u, x], w[0][v, x], w[2][u, x], w[2][v, x]):
                    beaten[x] = 1
                    left -= 1
                    break
    return left
