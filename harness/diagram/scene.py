"""The visual angles of an instance as exact polynomials in sheared coordinates, and their order.

With Q and L as in :mod:`harness.geometry.visual_angle`, cot θ_p(s) = Q/|L|, so a smaller visual
angle is a larger cotangent.  All input coordinates are rational; one positive rational factor (a
similarity: no angle changes) makes them integers without a common factor.  Then they are sheared,
(u, v) = (x + shear·y, y), which only renames the points of the plane and brings them into generic
position.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction

from flint import arb, ctx, fmpq, fmpz_mpoly

from harness.diagram.algebra import FIRST_PRECISION, Point, Polynomial, U, V, precisions
from harness.diagram.counts import Objective
from harness.diagram.planar_map import RationalPoint

TINY = arb(2) ** -60


def integer_ratio(points: Sequence[RationalPoint]) -> Fraction:
    """The factor that makes all coordinates integers without a common factor."""
    denominator = math.lcm(*(c.denominator for point in points for c in point))
    numerators = [int(c * denominator) for point in points for c in point]
    return Fraction(denominator, math.gcd(*numerators) or 1)


def coordinate_bits(points: Sequence[RationalPoint]) -> int:
    """The length in bits of the longest coordinate, as an integer in the common finest unit."""
    ratio = integer_ratio(points)
    return max(int(abs(c) * ratio).bit_length() for point in points for c in point)


class Scene:
    """n segments, their forms Q_i and L_i in (u, v), and exact comparison of visual angles.

    ``sense`` is +1 for the objective ``smallest`` (the winner has the greatest cotangent) and −1
    for ``largest``.
    """

    def __init__(
        self,
        segments: Sequence[tuple[RationalPoint, RationalPoint]],
        objective: Objective,
        shear: int,
        others: Iterable[RationalPoint] = (),
    ) -> None:
        """``others``: further points (corners of the domain) that must become integers too."""
        corners = [point for segment in segments for point in segment] + list(others)
        self.ratio = integer_ratio(corners)
        self.scale = fmpq(self.ratio.numerator, self.ratio.denominator)
        self.shear = shear
        self.sense = 1 if objective == "smallest" else -1
        self.segments = segments
        self.n = len(segments)
        self.order = list(range(self.n))
        self.q: list[Polynomial] = []
        self.line: list[Polynomial] = []
        for a, b in segments:
            (ax, ay), (bx, by) = self.integers(a), self.integers(b)
            x, y = U - shear * V, V
            self.q.append(Polynomial((ax - x) * (bx - x) + (ay - y) * (by - y)))
            self.line.append(self.line_through(a, b))
        self._ties: dict[tuple[int, int, int], Polynomial] = {}
        self._winners: dict[Point, tuple[int, ...]] = {}

    def integers(self, point: RationalPoint) -> tuple[int, int]:
        """The point in the scaled (unsheared) integer coordinates."""
        return int(point[0] * self.ratio), int(point[1] * self.ratio)

    def sheared(self, point: RationalPoint) -> Point:
        """The exact point (u, v) of a rational point (x, y) of the plane."""
        x, y = (fmpq(c.numerator, c.denominator) * self.scale for c in point)
        return Point.rational(x + self.shear * y, y)

    def floats(self, point: Point) -> tuple[float, float]:
        """The point in the coordinates of the input, as doubles within 2^-53 of its size."""
        for bits in precisions():
            with ctx.workprec(bits):
                u, v = point.balls(bits)
                x, y = (u - self.shear * v) / self.scale, v / self.scale
                if not (x.is_finite() and y.is_finite()):
                    continue
                size = abs(x).upper() + abs(y).upper()
                if x.rad() <= size * TINY and y.rad() <= size * TINY:
                    return _to_float(x), _to_float(y)
        raise AssertionError  # precisions() raises first

    def line_through(self, a: RationalPoint, b: RationalPoint) -> Polynomial:
        """The oriented line ab as a polynomial that is positive to its left."""
        (ax, ay), (bx, by) = self.integers(a), self.integers(b)
        x, y = U - self.shear * V, V
        return Polynomial((ax - x) * (by - y) - (ay - y) * (bx - x))

    def tie(self, i: int, j: int, sign: int) -> Polynomial:
        """F^±_ij = Q_i L_j ∓ Q_j L_i: zero where θ_i = θ_j and sign(L_i L_j) = ``sign``."""
        key = (i, j, sign)
        if key not in self._ties:
            q, line = self.q, self.line
            form: fmpz_mpoly = q[i].mpoly * line[j].mpoly - sign * (q[j].mpoly * line[i].mpoly)
            self._ties[key] = Polynomial(form)
        return self._ties[key]

    def jacobian(self, i: int, j: int) -> Polynomial:
        """The numerator of det(∇(Q_i/L_i), ∇(Q_j/L_j)): zero where the level circles touch."""
        gradients = []
        for k in (i, j):
            q, line = self.q[k].mpoly, self.line[k].mpoly
            for name in ("u", "v"):
                gradients.append(line * q.derivative(name) - q * line.derivative(name))
        return Polynomial(gradients[0] * gradients[3] - gradients[1] * gradients[2])

    def side(self, i: int, p: Point) -> int:
        """The sign of L_i at p: on which side of the line of segment i the point is."""
        return p.sign(self.line[i])

    def level(self, i: int, p: Point) -> int | None:
        """0 where cot θ_i is finite, ±1 where it is ±∞, None at an endpoint (undefined)."""
        if self.side(i, p):
            return 0
        return p.sign(self.q[i]) or None

    def difference(self, i: int, j: int, p: Point) -> tuple[Polynomial, int]:
        """(G, s) such that s·G has the sign of cot θ_i − cot θ_j at p and near it."""
        side_i, side_j = self.side(i, p), self.side(j, p)
        return self.tie(i, j, side_i * side_j), side_j

    def compare(self, i: int, j: int, p: Point) -> int:
        """The sign of cot θ_i − cot θ_j at p, exactly; ±∞ are values like any other.

        p must not be an endpoint of i or j.
        """
        level_i, level_j = self.level(i, p), self.level(j, p)
        assert level_i is not None, "the visual angle is undefined at an endpoint"
        assert level_j is not None, "the visual angle is undefined at an endpoint"
        if level_i or level_j:
            return (level_i > level_j) - (level_i < level_j)
        form, sign = self.difference(i, j, p)
        return sign * p.sign(form)

    def cotangent(self, i: int, u: arb, v: arb) -> arb:
        """Enclosure of cot θ_i near (u, v); not finite where L_i cannot be told from zero."""
        return self.q[i].at_balls(u, v) / abs(self.line[i].at_balls(u, v))

    def may_win(self, i: int, u: arb, v: arb) -> bool:
        """False only if another segment certainly beats segment i in the box u × v."""
        reference = self.sense * self.cotangent(i, u, v)
        for position, k in enumerate(self.order):
            if k != i and self.sense * self.cotangent(k, u, v) > reference:
                # Who beat the last one is likely to beat the next.
                self.order.insert(0, self.order.pop(position))
                return False
        return True

    def winners(self, p: Point, tied: frozenset[int] = frozenset()) -> tuple[int, ...]:
        """All segments whose angle at p is the best (least or greatest), increasing.

        ``tied``: segments known to tie at p, which need not be compared with one another.
        p must not be an endpoint of a segment.
        """
        if p not in self._winners:
            result: list[int] = []
            for k in self._likely_winners(p):
                order = 1
                if result and not (k in tied and result[0] in tied):
                    order = self.sense * self.compare(k, result[0], p)
                elif result:
                    order = 0
                if order > 0:
                    result = [k]
                elif order == 0:
                    result.append(k)
            self._winners[p] = tuple(sorted(result))
        return self._winners[p]

    def _likely_winners(self, p: Point) -> list[int]:
        """The segments that balls of the first precision cannot rule out."""
        u, v = p.balls(FIRST_PRECISION)
        with ctx.workprec(FIRST_PRECISION):
            values = [self.sense * self.cotangent(k, u, v) for k in range(self.n)]
        bound: arb | None = None
        for value in values:
            if value.is_finite() and (bound is None or value.lower() > bound):
                bound = value.lower()
        return [k for k, value in enumerate(values) if bound is None or not value < bound]

    def side_winner(self, tied: Sequence[int], p: Point, above: bool) -> int:
        """Who of the ``tied`` segments wins just above (below) p on its vertical line.

        The first derivative ∂^m/∂v^m of the difference that does not vanish at p decides.
        """
        best = tied[0]
        for k in tied[1:]:
            form, sign = self.difference(k, best, p)
            order = 0
            value = p.sign(form)
            while value == 0:
                form, order = form.derivative, order + 1
                value = p.sign(form)
            if not above and order % 2:
                value = -value
            if self.sense * sign * value > 0:
                best = k
        return best


def _to_float(value: arb) -> float:
    """The double at the middle of a tight ball; zero if the ball contains it."""
    return 0.0 if value.contains(0) else float(value.mid())
