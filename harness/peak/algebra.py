"""The exact decision: the optimal cotangent as an algebraic number, and every edge that ties.

At the optimum the point is a rational function of c, p = (X/Δ, Y/Δ), by two equations linear in p
with coefficients linear (or, for the line of centres, quadratic) in c:

* three discs: the differences E_j − E_i and E_k − E_i;      E_i(p(c)) = 0 is a quintic
* two discs:   E_j − E_i and the line of the centres;        a quartic (tangent circles)
* two discs and a wall: E_j − E_i and the wall's L;          a cubic
* a vertex:    the point is known; its cap is a root of s c² + 2 k c − s (s, k: sine and cosine of
  its angle γ, times a length), the cotangent of any other edge is rational.

(Degrees after spurious factors are gone.)  All that makes the point an optimum (it lies in the
closed kernel and in all discs; the gradients of the basis balance) are signs of polynomials at
the root c, decided in ℚ[c]/(irreducible factor) and by balls.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

from flint import arb, ctx, fmpq_poly, fmpz_poly

from harness.diagram.roots import real_root_balls
from harness.geometry.exact import ExactPoint
from harness.peak.rational import Edge, cap, forms, rational_bounds, turn

BITS = (128, 512, 2048)
C = fmpq_poly([0, 1])


@dataclass(frozen=True)
class ExactPeak:
    """The optimal cotangent: the root of an irreducible integer polynomial in an interval.

    ``polynomial``: coefficients, that of c⁰ first.  ``low``, ``high``: rationals (flint) around
    this root and no other.  ``tied``: all segments seen under exactly the optimal angle (at a
    vertex also its two edges).
    """

    polynomial: tuple[int, ...]
    low: Any
    high: Any
    tied: tuple[int, ...]

    def as_dict(self) -> dict[str, Any]:
        """For JSON: the polynomial in the cotangent and the interval as strings, the ties."""
        return {
            "polynomial": [str(value) for value in self.polynomial],
            "interval": [str(self.low), str(self.high)],
            "tied": list(self.tied),
        }


class Root:
    """A real algebraic number: a root of an irreducible polynomial over ℤ."""

    def __init__(self, polynomial: fmpz_poly, index: int) -> None:
        """``index``: among the real roots in increasing order."""
        self.polynomial = polynomial
        self.index = index
        self._balls: dict[int, arb] = {}

    def ball(self, bits: int) -> arb:
        """An enclosure to about so many bits."""
        if bits not in self._balls:
            self._balls[bits] = real_root_balls(self.polynomial, bits)[self.index]
        return self._balls[bits]

    def sign(self, value: fmpq_poly) -> int:
        """The sign of a rational polynomial at this root."""
        bits = BITS[0]
        while True:
            with ctx.workprec(bits):
                ball = evaluate(value, self.ball(bits))
                if ball > 0 or ball < 0:
                    return 1 if ball > 0 else -1
            if value % fmpq_poly(self.polynomial) == 0:
                return 0
            bits *= 2

    @cached_property
    def isolated(self) -> tuple[Any, Any]:
        """Rationals around this root and no other."""
        return rational_bounds(self.ball(BITS[0]))


def evaluate(value: fmpq_poly, x: arb) -> arb:
    """A polynomial at a ball, by Horner's rule."""
    total = arb(0)
    for coefficient in reversed(value.coeffs()):
        total = total * x + arb(coefficient)
    return total


def roots_between(polynomial: fmpq_poly, low: Any, high: Any) -> list[Root]:
    """The roots of irreducible factors that balls cannot tell from the interval [low, high]."""
    found = []
    _, factors = polynomial.numer().factor()
    for factor, _ in factors:
        with ctx.workprec(BITS[0]):
            inside = arb(low).union(arb(high))
            balls = real_root_balls(factor, BITS[0])
        found += [Root(factor, k) for k, ball in enumerate(balls) if ball.overlaps(inside)]
    return found


class AlgebraicPoint:
    """The point of a basis as a function of c: X/Δ, Y/Δ."""

    def __init__(self, edges: Sequence[Edge], discs: Sequence[int], walls: Sequence[int]) -> None:
        """Three discs, two discs, or two discs and a wall."""
        self.edges = edges
        self.discs, self.walls = list(discs), list(walls)
        g, h, r = self.disc(discs[0])
        g2, h2, r2 = self.disc(discs[1])
        a, b, e = g2 - g, h2 - h, r2 - r
        if walls:
            k, m, o = self.wall(walls[0])
        elif len(discs) == 3:
            g3, h3, r3 = self.disc(discs[2])
            k, m, o = g3 - g, h3 - h, r3 - r
        else:
            k, m, o = b, -a, (g * b - h * a) / 2
        self.X, self.Y, self.delta = b * o - e * m, e * k - a * o, a * m - b * k

    def disc(self, i: int) -> tuple[fmpq_poly, fmpq_poly, fmpq_poly]:
        """(g, h, r) with E_i = |p|² + g x + h y + r."""
        (ax, ay), (bx, by) = self.edges[i]
        dx, dy = bx - ax, by - ay
        return C * dy - (ax + bx), -C * dx - (ay + by), ax * bx + ay * by - C * (ax * dy - ay * dx)

    def wall(self, i: int) -> tuple[fmpq_poly, fmpq_poly, fmpq_poly]:
        """(g, h, r) with L_i = g x + h y + r."""
        (ax, ay), (bx, by) = self.edges[i]
        dx, dy = bx - ax, by - ay
        return fmpq_poly([-dy]), fmpq_poly([dx]), fmpq_poly([ax * dy - ay * dx])

    def power(self, i: int) -> fmpq_poly:
        """E_i Δ² at the point."""
        g, h, r = self.disc(i)
        X, Y, delta = self.X, self.Y, self.delta
        return X * X + Y * Y + (g * X + h * Y + r * delta) * delta

    def level(self, i: int) -> fmpq_poly:
        """L_i Δ² at the point."""
        g, h, r = self.wall(i)
        return (g * self.X + h * self.Y + r * self.delta) * self.delta

    def away(self, i: int) -> tuple[fmpq_poly, fmpq_poly]:
        """Δ times the vector from the centre of disc i to the point."""
        g, h, _ = self.disc(i)
        return self.X + g * self.delta / 2, self.Y + h * self.delta / 2

    def balances(self, root: Root) -> bool:
        """Whether no direction leads into all discs (and over no wall) of the basis."""
        away = [self.away(i) for i in self.discs]
        if self.walls:
            (ax, ay), (bx, by) = self.edges[self.walls[0]]
            tx, ty = bx - ax, by - ay
            along = [x * tx + y * ty for x, y in away]
            normal = [y * tx - x * ty for x, y in away]
            first, second = (root.sign(value) for value in along)
            if first * second > 0:
                return False
            one, two = along[1] * second, along[0] * first
            return root.sign((one * normal[0] + two * normal[1]) * self.delta) >= 0
        if len(away) == 2:
            (a, b), (c, d) = away
            return root.sign(a * c + b * d) <= 0
        turns = [
            root.sign(away[k][0] * away[k - 1][1] - away[k][1] * away[k - 1][0]) for k in range(3)
        ]
        return max(turns) * min(turns) >= 0


def decide(
    edges: Sequence[Edge],
    discs: Sequence[int],
    walls: Sequence[int],
    low: Any,
    high: Any,
) -> tuple[Root, list[int]] | None:
    """The optimal root and the tied edges, if this basis is exactly optimal; else None.

    ``low``, ``high``: rational bounds of the optimal cotangent.  O(n) operations with balls, and
    algebra for the edges that are as near as that.
    """
    for subset in _subsets(list(discs), bool(walls)):
        point = AlgebraicPoint(edges, subset, walls)
        for root in roots_between(point.power(subset[0]), low, high):
            if root.sign(point.delta) == 0:
                continue
            tied = _ties(point, root)
            if tied is not None and point.balances(root):
                return root, tied
    return None


def _subsets(discs: list[int], with_wall: bool) -> list[list[int]]:
    """The bases within a set of discs, pairs first."""
    sizes = (2,) if with_wall else (2, 3)
    return [list(subset) for size in sizes for subset in combinations(discs, size)]


def _ties(point: AlgebraicPoint, root: Root) -> list[int] | None:
    """The edges whose circles run through the point; None if it is in no optimum's place."""
    tied = []
    with ctx.workprec(BITS[0]):
        c = root.ball(BITS[0])
        delta = evaluate(point.delta, c)
        x, y = evaluate(point.X, c) / delta, evaluate(point.Y, c) / delta
    for i, ((ax, ay), (bx, by)) in enumerate(point.edges):
        with ctx.workprec(BITS[0]):
            ux, uy, vx, vy = arb(ax) - x, arb(ay) - y, arb(bx) - x, arb(by) - y
            area = ux * vy - uy * vx
            if area > 0 and ux * vx + uy * vy - c * area < 0:
                continue
        power = root.sign(point.power(i))
        if power > 0 or root.sign(point.level(i)) < 0:
            return None
        if power == 0:
            tied.append(i)
    return tied


def decide_at_vertex(edges: Sequence[Edge], vertex: int) -> tuple[Root, list[int]] | None:
    """The same for a peak in the vertex at which edge ``vertex`` begins."""
    p: ExactPoint = edges[vertex][0]
    own = [vertex - 1 if vertex else len(edges) - 1, vertex]
    others = {i: forms(edges[i], p) for i in range(len(edges)) if i not in own}
    if any(level <= 0 for _, level in others.values()):
        return None
    cotangents = {i: q / level for i, (q, level) in others.items()}
    greatest = max(cotangents.values())
    own_cap = _cap(edges, vertex)
    order = own_cap.sign(C - greatest)
    if order >= 0:
        return own_cap, sorted(
            [*own, *(i for i, c in cotangents.items() if order == 0 and c == greatest)]
        )
    linear = fmpq_poly([-greatest, 1]).numer()
    tied = [i for i, c in cotangents.items() if c == greatest]
    centres = [_towards(edges[i], p, greatest) for i in (*own, *tied)]
    return (Root(linear, 0), sorted([*own, *tied])) if _surround(centres) else None


def _cap(edges: Sequence[Edge], vertex: int) -> Root:
    """cot(π − γ/2) = −tan(turn/2), a root of s t² + 2 k t − s = 0 with t = tan(turn/2)."""
    s, k = turn(edges, vertex)
    low, high = cap(edges, vertex, BITS[0])
    (root,) = roots_between(fmpq_poly([-s, -2 * k, s]), low, high)
    return root


def _towards(edge: Edge, p: ExactPoint, c: Any) -> ExactPoint:
    """The vector from p to the centre of the disc of an edge at level c."""
    (ax, ay), (bx, by) = edge
    return (ax + bx - c * (by - ay)) / 2 - p[0], (ay + by + c * (bx - ax)) / 2 - p[1]


def _surround(vectors: Sequence[ExactPoint]) -> bool:
    """Whether the origin is in the convex hull of the vectors."""
    for a, b in combinations(vectors, 2):
        if a[0] * b[1] == a[1] * b[0] and a[0] * b[0] + a[1] * b[1] <= 0:
            return True
    for trio in combinations(vectors, 3):
        turns = [trio[k][0] * trio[k - 1][1] - trio[k][1] * trio[k - 1][0] for k in range(3)]
        if all(t > 0 for t in turns) or all(t < 0 for t in turns):
            return True
    return False
