"""Visual angles at rational points, exactly: as cotangents, in the order of decreasing angles.

Everything here is rational arithmetic on the coordinates as given, written apart from the builders
and from the filtered predicates, so that the claims do not lean on what they are to judge.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from fractions import Fraction

from harness.diagram import domain_corners
from harness.diagram.counts import Domain
from harness.geometry.coordinates import Point
from harness.geometry.instance import Instance

Segment = tuple[Point, Point]
Cotangent = Fraction | float
"""cot θ as a rational; ∞ where θ is 0, −∞ where it is π."""


def forms(s: Segment, p: Point) -> tuple[Fraction, Fraction]:
    """Q = (a − p)·(b − p) and L = (a − p)×(b − p)."""
    (ax, ay), (bx, by) = s
    ux, uy, vx, vy = ax - p[0], ay - p[1], bx - p[0], by - p[1]
    return ux * vx + uy * vy, ux * vy - uy * vx


def cotangent(s: Segment, p: Point) -> Cotangent | None:
    """cot θ_p(s); None at an end point of s, where there is no angle."""
    q, area = forms(s, p)
    if area:
        return q / abs(area)
    return None if q == 0 else math.copysign(math.inf, q)


def cotangents(segments: Sequence[Segment], p: Point) -> list[Cotangent] | None:
    """All of them; None at an end point."""
    found = []
    for s in segments:
        value = cotangent(s, p)
        if value is None:
            return None
        found.append(value)
    return found


def winner(segments: Sequence[Segment], p: Point) -> int | None:
    """The segment seen under strictly the smallest angle; None for a tie or at an end point."""
    values = cotangents(segments, p)
    if values is None:
        return None
    best = max(values)
    return values.index(best) if values.count(best) == 1 else None


def middle(p: Point, q: Point, part: Fraction = Fraction(1, 2)) -> Point:
    """The point at this part of the way from p to q."""
    return p[0] + part * (q[0] - p[0]), p[1] + part * (q[1] - p[1])


def inner_points(instance: Instance, domain: Domain, rng: random.Random, count: int) -> list[Point]:
    """Rational points strictly inside the kernel, or strictly inside the polygon.

    Those of the kernel are averages of its corners with random weights.  Those of the polygon are
    lattice points of a fine grid over its box; fewer than ``count`` where few are inside.
    """
    if domain == "kernel":
        corners = domain_corners(instance, "kernel")
        return [_average(corners, [rng.randint(1, 24) for _ in corners]) for _ in range(count)]
    vertices = [instance.exact_vertex(k) for k in range(instance.n)]
    low = [min(v[k] for v in vertices) for k in (0, 1)]
    size = [max(v[k] for v in vertices) - low[k] for k in (0, 1)]
    found = []
    for _ in range(20 * count):
        x, y = (low[k] + size[k] * Fraction(rng.randint(1, 47), 48) for k in (0, 1))
        if is_inside((x, y), vertices):
            found.append((x, y))
        if len(found) == count:
            break
    return found


def is_inside(p: Point, vertices: Sequence[Point]) -> bool:
    """Whether a point is strictly inside a simple polygon; O(n), by the crossings of a ray."""
    inside = False
    for a, b in zip(vertices, [*vertices[1:], vertices[0]], strict=True):
        q, area = forms((a, b), p)
        if area == 0 and q <= 0:
            return False
        if (a[1] > p[1]) != (b[1] > p[1]):
            x = a[0] + (p[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1])
            inside ^= x > p[0]
    return inside


def stays_inside(p: Point, q: Point, vertices: Sequence[Point]) -> bool:
    """Whether the segment between two inner points of a simple polygon meets no edge of it."""
    for a, b in zip(vertices, [*vertices[1:], vertices[0]], strict=True):
        one, two = forms((p, q), a)[1], forms((p, q), b)[1]
        three, four = forms((a, b), p)[1], forms((a, b), q)[1]
        if one * two <= 0 and three * four <= 0:
            return False
    return True


def as_doubles(p: Point) -> tuple[float, float]:
    """The nearest doubles."""
    return float(p[0]), float(p[1])


def _average(corners: Sequence[Point], weights: Sequence[int]) -> Point:
    total = sum(weights)
    x, y = (
        sum((w * corner[k] for w, corner in zip(weights, corners, strict=True)), Fraction(0))
        for k in (0, 1)
    )
    return x / total, y / total
