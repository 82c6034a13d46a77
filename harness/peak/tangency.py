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

from typing import Any

from flint import arb

from harness.peak.rational import Edge

Ball = Any


def tangencies(edge: Edge, other: Edge, sign: int) -> list[tuple[Ball, Ball, Ball]] | None:
    """(c, x, y) in balls where the circles of two edges touch, from outside (1) or inside (−1).

    At most two; none for edges with a common endpoint, as all their circles meet there, nor from
    inside for edges of equal length.  Edges in exact coordinates, the domain to their left; the
    precision is that of flint's context.  None if it does not suffice to enclose all of them.
    """
    if {edge[0], edge[1]} & {other[0], other[1]}:
        return []
    (mx, my, hx, hy, first), (nx, ny, kx, ky, second) = _circle(edge), _circle(other)
    if sign < 0 and first == second:
        return []
    length, width = arb(first).sqrt(), arb(second).sqrt()
    s = (length + sign * width) / 2
    dx, dy, ex, ey = nx - mx, ny - my, kx - hx, ky - hy
    lead = 4 * (ex * ex + ey * ey) - first - second  # ± 2 l_i l_j if c² has the coefficient 0
    is_linear = sign * lead >= 0 and lead * lead == 4 * first * second
    roots = _roots(
        arb(0) if is_linear else arb(ex * ex + ey * ey) - s * s,
        arb(dx * ex + dy * ey),
        arb(dx * dx + dy * dy) - s * s,
    )
    t = length / (length + sign * width)
    if roots is None or not t.is_finite():
        return None
    found = []
    for c in roots:
        x, y = mx + c * hx, my + c * hy
        found.append((c, x + t * (nx + c * kx - x), y + t * (ny + c * ky - y)))
    return found


def _circle(edge: Edge) -> tuple[Any, Any, Any, Any, Any]:
    """Midpoint, half the inner normal, the square of the length."""
    (ax, ay), (bx, by) = edge
    dx, dy = bx - ax, by - ay
    return (ax + bx) / 2, (ay + by) / 2, -dy / 2, dx / 2, dx * dx + dy * dy


def _roots(a: Ball, b: Ball, d: Ball) -> list[Ball] | None:
    """The real roots of a c² + 2 b c + d; a double root counts if it cannot be excluded.

    ``a`` = 0 exactly leaves a linear equation, where ``b`` is 0 exactly or does not contain it.
    None if an enclosure is not finite.
    """
    square = b * b - a * d
    if square < 0:
        return []
    # The square root of a ball that reaches below 0, be it by a rounding, is no number.
    root = arb(0).union(square.upper().sqrt()) if square.contains(0) else square.sqrt()
    if b > 0:
        root = -root
    w = root - b  # the sum that does not cancel
    if a == 0:
        return [-d / (2 * b)] if b != 0 else []
    found = [d / w if not w.contains(0) else -b / a, w / a]
    return found if all(c.is_finite() for c in found) else None
