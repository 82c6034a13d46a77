"""Where the visual angle of two edges, kept equal, has its extrema: their circles touch.

The circle of an edge of length l at level c has the centre m + c h (midpoint m, half the inner
normal h, |h| = l/2) and the radius (l/2)√(1 + c²).  So the circles of two edges touch from outside
(sign +) or inside (sign −) iff

    |m_j − m_i + c (h_j − h_i)|² = ((l_i ± l_j)/2)² (1 + c²):

the quartic of tangent circles is a product of two quadratics.  Where they touch from outside, in
the kernel, the discs of greater angles are disjoint: a local maximum of the common angle along the
bisector.  Where they touch from inside both angles grow in the same direction, across the
bisector: a local maximum or minimum along it, but no maximum in the plane.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from flint import arb

from harness.peak.rational import Edge

Ball = Any


def tangencies(edge: Edge, other: Edge, sign: int) -> Iterator[tuple[Ball, Ball, Ball]]:
    """(c, x, y) in balls where the circles of two edges touch, from outside (1) or inside (−1).

    At most two; none for edges with a common endpoint, as all their circles meet there.  Edges in
    exact coordinates, the domain to their left; the precision is that of flint's context.  Edges
    of equal length (to that precision) do not touch from inside.
    """
    if {edge[0], edge[1]} & {other[0], other[1]}:
        return
    (mx, my, hx, hy, length), (nx, ny, kx, ky, width) = _circle(edge), _circle(other)
    s = (length + sign * width) / 2
    dx, dy, ex, ey = nx - mx, ny - my, kx - hx, ky - hy
    a = ex * ex + ey * ey - s * s
    b = dx * ex + dy * ey
    d = dx * dx + dy * dy - s * s
    for c in _roots(a, b, d):
        t = length / (length + sign * width)
        if t.is_finite():
            x, y = mx + c * hx, my + c * hy
            yield c, x + t * (nx + c * kx - x), y + t * (ny + c * ky - y)


def _circle(edge: Edge) -> tuple[Ball, Ball, Ball, Ball, Ball]:
    """Midpoint, half the inner normal, length."""
    (ax, ay), (bx, by) = edge
    dx, dy = bx - ax, by - ay
    length = arb(dx * dx + dy * dy).sqrt()
    return arb((ax + bx) / 2), arb((ay + by) / 2), arb(-dy / 2), arb(dx / 2), length


def _roots(a: Ball, b: Ball, d: Ball) -> list[Ball]:
    """The real roots of a c² + 2 b c + d; a double root counts if it cannot be excluded."""
    square = b * b - a * d
    if square < 0:
        return []
    if square.contains(0):
        square = square.union(arb(0))
        square = arb(0).union(square.upper())
    root = square.sqrt()
    if b > 0:
        root = -root
    w = root - b  # the sum that does not cancel
    found = [d / w if not w.contains(0) else -b / a]
    if not a.contains(0):
        found.append(w / a)
    return [c for c in found if c.is_finite()]
