"""All angles of the triangles around one vertex, and proofs that none of them is inverted."""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled

ROUND = 5 * 2.0**-53
TINY = 2.0**-1050
"""With coordinates of at most 1 in absolute value, a cross product of differences is positive if
the computed one exceeds ROUND · (sum of the absolute products) + TINY (proof:
:func:`harness.geometry.sweep.turn`)."""
INVERTED = -1.0
SLIM = 1e-6
"""Radians below which the third angle is not taken as what is left of π: that has few digits."""


@compiled
def load_star(v, offsets, degrees, ring, x, y, rx, ry):
    """Copy the neighbours' coordinates to ``rx``, ``ry``; return how many there are."""
    k, first = degrees[v], offsets[v]
    for i in range(k):
        w = ring[first + i]
        rx[i], ry[i] = x[w], y[w]
    return k


@compiled
def star_angles(px, py, k, rx, ry, strict, angles):
    """The least of the 3k angles of a closed star with its centre at (px, py), in radians.

    ``angles[3 i]`` is seen from the centre, ``[3 i + 1]`` and ``[3 i + 2]`` are those at the
    neighbours i and i + 1 of triangle i.  With ``strict``, the answer is INVERTED unless every
    triangle is proven to be positive; without, an angle that is not positive counts as 0.
    """
    least = np.inf
    wx, wy = rx[0] - px, ry[0] - py
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        ux, uy = rx[j] - px, ry[j] - py
        left, right = wx * uy, wy * ux
        cross = left - right
        if not cross > ROUND * (abs(left) + abs(right)) + TINY:
            if strict:
                return INVERTED
            cross = max(cross, 0.0)
        ex, ey = rx[j] - rx[i], ry[j] - ry[i]
        apex = np.arctan2(cross, wx * ux + wy * uy)
        base = np.arctan2(cross, -(wx * ex + wy * ey))
        rest = np.pi - apex - base
        if rest < SLIM:
            rest = np.arctan2(cross, ux * ex + uy * ey)
        angles[3 * i], angles[3 * i + 1], angles[3 * i + 2] = apex, base, rest
        least = min(least, apex, base, rest)
        wx, wy = ux, uy
    return least


@compiled
def triangle_least(ax, ay, bx, by, cx, cy):
    """The least angle of one triangle in radians; 0 if it is not positive in doubles."""
    ux, uy, wx, wy = bx - ax, by - ay, cx - ax, cy - ay
    cross = ux * wy - uy * wx
    if not cross > 0.0:
        return 0.0
    first = np.arctan2(cross, ux * wx + uy * wy)
    ex, ey = wx - ux, wy - uy
    second = np.arctan2(cross, -(ux * ex + uy * ey))
    third = np.pi - first - second
    if third < SLIM:
        third = np.arctan2(cross, wx * ex + wy * ey)
    return min(first, second, third)


@compiled
def star_least(v, offsets, degrees, ring, closed, x, y):
    """The least angle of all triangles at v, open or closed; ∞ if there are none."""
    least = np.inf
    k, first = degrees[v], offsets[v]
    for i in range(k if closed[v] else k - 1):
        a, b = ring[first + i], ring[first + (i + 1 if i + 1 < k else 0)]
        least = min(least, triangle_least(x[v], y[v], x[a], y[a], x[b], y[b]))
    return least


@compiled
def all_proven(offsets, degrees, ring, closed, x, y):
    """Whether every triangle is proven to be positive."""
    for v in range(len(degrees)):
        k, first = degrees[v], offsets[v]
        for i in range(k if closed[v] else k - 1):
            a, b = ring[first + i], ring[first + (i + 1 if i + 1 < k else 0)]
            if v < a and v < b:
                left = (x[a] - x[v]) * (y[b] - y[v])
                right = (y[a] - y[v]) * (x[b] - x[v])
                if not left - right > ROUND * (abs(left) + abs(right)) + TINY:
                    return False
    return True
