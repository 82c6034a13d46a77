"""Random convex polygons: ``convex-circle`` and ``convex-valtr``.

Both are strictly convex as floats, not merely before rounding, so that their kernel is the whole
polygon: a left turn at every vertex is checked with a rigorous bound on the rounding.
"""

from __future__ import annotations

import numpy as np

from generators.family import Family
from generators.portable import (
    Array,
    Stream,
    surely_convex_corners,
    surely_positive_cross,
    unit_vectors,
)


def convex_circle(n: int, seed: int = 0) -> Array:
    """The polygon of n independent uniform points on the unit circle; shape (n, 2).

    Points at whose rounded position the polygon would not turn left (three points closer
    together than about 10⁻⁵ turn; hardly ever below n = 10⁵) are drawn again.  The centre need
    not lie inside.

    Source: classical; random inscribed polygons, e.g. Schneider & Weil, "Stochastic and
    Integral Geometry", 2008, section 8.2.  O(n log n).
    """
    CONVEX_CIRCLE.check(n)
    stream = Stream("convex-circle", n, seed)
    turns = np.sort(stream.uniform(n))
    while True:
        vertices = unit_vectors(turns)
        flat = ~surely_convex_corners(vertices)
        if not flat.any():
            return vertices
        turns[flat] = stream.uniform(int(flat.sum()))
        turns = np.sort(turns)


def convex_valtr(n: int, seed: int = 0) -> Array:
    """Valtr's random convex n-gon in the unit square; shape (n, 2).

    Distributed as n independent uniform points of the square given that they are in convex
    position: n random abscissae are split into a chain going right and a chain going left,
    n ordinates likewise up and down; the steps are paired at random, sorted by direction and laid
    end to end.  All coordinates are multiples of 2⁻⁵³ below 1, so every difference and every
    partial sum is exact and the polygon closes exactly.

    Source: P. Valtr, "Probability that n random points are in convex position", Discrete &
    Computational Geometry 13 (1995) 637–643, proof of Theorem 1.  O(n log n).
    """
    CONVEX_VALTR.check(n)
    stream = Stream("convex-valtr", n, seed)
    while True:
        west, x = _steps(stream, n)
        south, y = _steps(stream, n)
        steps = _by_direction(np.stack([x, stream.shuffle(y)], axis=1))
        # Two steps in one direction (or a zero step) would leave a straight angle: draw again.
        if surely_positive_cross(steps, np.roll(steps, -1, axis=0)).all():
            corner = np.cumsum(steps, axis=0)
            corner -= corner.min(axis=0)
            corner += [west, south]
            return corner


def _steps(stream: Stream, n: int) -> tuple[float, Array]:
    """The least of n random numbers, and n signed steps summing to zero: up one chain, down one."""
    values = np.sort(stream.uniform(n))
    ahead = np.concatenate([[True], stream.uniform(n - 2) < 0.5, [True]])
    back = ~ahead
    back[0] = back[-1] = True
    return float(values[0]), np.concatenate([np.diff(values[ahead]), -np.diff(values[back])])


def _by_direction(steps: Array) -> Array:
    """The vectors sorted by direction, counter-clockwise from the positive x-axis.

    The sort key runs round the diamond |x| + |y| = 1 and needs one division only.
    """
    x, y = steps[:, 0], steps[:, 1]
    across = np.divide(y, np.add(np.abs(x), np.abs(y)))
    key = np.where(x >= 0.0, np.where(y >= 0.0, across, np.add(across, 4.0)), 2.0 - across)
    return steps[np.argsort(key, kind="stable")]


CONVEX_CIRCLE = Family(
    name="convex-circle",
    kind="polygon",
    summary="random points on a circle",
    source="classical; Schneider & Weil 2008",
    growth="1",
    build=convex_circle,
    largest=1_000_000,
)

CONVEX_VALTR = Family(
    name="convex-valtr",
    kind="polygon",
    summary="random points of a square, given that they are in convex position",
    source="Valtr 1995",
    growth="1",
    build=convex_valtr,
    largest=1_000_000,
)
