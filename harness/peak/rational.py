"""The ascent in rational arithmetic: where doubles cannot tell, and an oracle for them.

The same problem as in :mod:`harness.peak.powers`, solved another way: at a rational level all
subsets of at most three constraints are tried, and the edges that take part are found by adding
the most violated one until none is violated.  Everything is exact but the levels, which are
rounded down.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

from flint import arb, ctx, fmpq

from harness.geometry.exact import ExactPoint

Edge = tuple[ExactPoint, ExactPoint]
#: (g, h, r, is_disc): |p|² + g x + h y + r for a disc, g x + h y + r for a wall.
Row = tuple[Any, Any, Any, bool]

MOST_STEPS = 4000


@dataclass(frozen=True)
class Tight:
    """An optimum at one level: its tight ``rows`` with their multipliers, a disc first.

    ``t``: the greatest disc less |p|² there.
    """

    t: Any
    point: ExactPoint
    rows: tuple[int, ...]
    weights: tuple[Any, ...]

    @property
    def value(self) -> Any:
        """M, the power of the point to the greatest disc."""
        x, y = self.point
        return x * x + y * y + self.t


@dataclass(frozen=True)
class RationalAscent:
    """An end: c ≤ c*, and a point p of the closed kernel near which ``reached`` ≥ c* is reached.

    ``basis``: constraints as in :mod:`harness.peak.powers`.  ``vertex``: the vertex that p is, at
    which its two edges count with their cap (None: p is none).
    """

    level: Any
    reached: Any
    point: ExactPoint
    basis: tuple[int, ...]
    vertex: int | None


def forms(edge: Edge, p: ExactPoint) -> tuple[Any, Any]:
    """Q and L of an edge at a point."""
    (ax, ay), (bx, by) = edge
    ux, uy, vx, vy = ax - p[0], ay - p[1], bx - p[0], by - p[1]
    return ux * vx + uy * vy, ux * vy - uy * vx


def row_of(edges: Sequence[Edge], constraint: int, c: Any) -> Row:
    """A disc E ≤ t or a wall −L ≤ 0 at level c."""
    (ax, ay), (bx, by) = edges[constraint >> 1]
    dx, dy = bx - ax, by - ay
    area = ax * dy - ay * dx
    if constraint & 1:
        return dy, -dx, -area, False
    return c * dy - ax - bx, -c * dx - ay - by, ax * bx + ay * by - c * area, True


def least_power(rows: Sequence[Row]) -> Tight | None:
    """The least of the greatest disc, inside the walls.

    Exact, by trying all subsets; O(m⁴) for m rows.  None if the walls leave nothing.
    """
    for size in (1, 2, 3):
        for subset in combinations(range(len(rows)), size):
            found = _tight(rows, subset)
            if found is None:
                continue
            x, y = found.point
            if all(g * x + h * y + r <= (found.t if disc else 0) for g, h, r, disc in rows):
                return found
    return None


def _tight(rows: Sequence[Row], subset: tuple[int, ...]) -> Tight | None:
    """The least with these rows tight, if their multipliers are not negative."""
    order = sorted(subset, key=lambda k: not rows[k][3])
    g, h, r, is_disc = rows[order[0]]
    if not is_disc:
        return None
    others = [rows[k] for k in order[1:]]
    lines = [(a - g, b - h, e - r) if disc else (a, b, e) for a, b, e, disc in others]
    if not lines:
        x, y, weights = -g / 2, -h / 2, []
    elif len(lines) == 1:
        ((a, b, e),) = lines
        square = a * a + b * b
        if square == 0:
            return None
        weights = [(2 * e - g * a - h * b) / square]
        x, y = -(g + weights[0] * a) / 2, -(h + weights[0] * b) / 2
    else:
        (a, b, e), (k, m, o) = lines
        det = a * m - b * k
        if det == 0:
            return None
        x, y = (b * o - e * m) / det, (e * k - a * o) / det
        s, t = -2 * x - g, -2 * y - h
        weights = [(s * m - t * k) / det, (a * t - b * s) / det]
    discs = sum((w for w, row in zip(weights, others, strict=True) if row[3]), fmpq(0))
    if discs > 1 or any(w < 0 for w in weights):
        return None
    return Tight(g * x + h * y + r, (x, y), tuple(order), (1 - discs, *weights))


def rational_ascent(
    edges: Sequence[Edge], start: Any, bits: int, first: Sequence[int] = ()
) -> RationalAscent:
    """The ascent from the rational level ``start`` ≤ c* until level and reach agree.

    ``edges``: counter-clockwise, around a kernel with interior; ``bits``: how closely, relative to
    1 + |c|; ``first``: edges to begin with.  The next level is Newton's, for −Σ ν_i L_i(p) is the
    derivative of M; every third one, and where that leaves what is known, it lies in the middle
    of what is known.  A level counts as ≤ c* only after M > 0 has been found there.  A few hundred
    operations for each edge.

    Raises ArithmeticError if it does not come to an end.
    """
    active = sorted({2 * i for i in first} or {0})
    least = fmpq(1, 1 << bits)
    low, c, best = start, start, None
    basis: tuple[int, ...]
    levels = 0
    for _ in range(MOST_STEPS):
        found = least_power([row_of(edges, k, c) for k in active])
        if found is None:
            raise ArithmeticError("the walls leave nothing: the kernel has no interior")
        basis = tuple(active[k] for k in found.rows)
        violated = _most_violated(edges, c, found)
        if violated is not None:
            active = sorted({*basis, violated})
            continue
        active = list(basis)
        for q, vertex in _candidates(edges, basis, found.point):
            reached = reach(edges, q, vertex, bits)
            if reached is not None and (best is None or reached < best.reached):
                best = RationalAscent(c, reached, q, basis, vertex)
        if found.value > 0:
            low = c
        if best is not None and best.reached - low <= (1 + abs(low)) * least:
            return replace(best, level=low, basis=basis)
        levels += 1
        newton = None if levels % 3 == 0 else _newton(edges, basis, found, c, least)
        high = None if best is None else best.reached
        with ctx.workprec(2 * bits + 64):  # short numbers, or they grow with every level
            c = rational_bounds(arb(_between(low, high, newton)))[0]
    raise ArithmeticError("the ascent did not come to an end")


def _newton(
    edges: Sequence[Edge], basis: tuple[int, ...], found: Tight, c: Any, least: Any
) -> Any | None:
    """The level at which M would vanish if it were linear, a quarter of ``least`` on or more.

    So near the end it steps over c*, and the point found there closes the gap from above.
    """
    slope = sum(
        (
            weight * forms(edges[k >> 1], found.point)[1]
            for k, weight in zip(basis, found.weights, strict=True)
            if not k & 1
        ),
        fmpq(0),
    )
    if slope <= 0:
        return None
    step, shortest = found.value / slope, (1 + abs(c)) * least / 4
    return c + (max(step, shortest) if found.value > 0 else min(step, -shortest))


def _between(low: Any, high: Any | None, proposed: Any | None) -> Any:
    """The proposed level if it lies between the bounds, else one in the middle.

    The middle is that of the sizes if the upper bound is large, and beyond all of them if there
    is none.
    """
    if proposed is not None and low < proposed and (high is None or proposed < high):
        return proposed
    size = 1 + abs(low)
    if high is None:
        return low + 4 * size
    if high - low < 4 * size:
        return (low + high) / 2
    ratio = (high - low) / size
    doublings = int(ratio.p).bit_length() - int(ratio.q).bit_length()
    return low + size * fmpq(2) ** (doublings // 2)


def _most_violated(edges: Sequence[Edge], c: Any, found: Tight) -> int | None:
    """The disc that the point violates most, else such a wall, else None."""
    values = [forms(edge, found.point) for edge in edges]
    excess = [q - c * level for q, level in values]
    worst = max(range(len(edges)), key=excess.__getitem__)
    if excess[worst] > found.value:
        return 2 * worst
    deepest = min(range(len(edges)), key=lambda i: values[i][1])
    return 2 * deepest + 1 if values[deepest][1] < 0 else None


def _candidates(
    edges: Sequence[Edge], basis: tuple[int, ...], p: ExactPoint
) -> Iterator[tuple[ExactPoint, int | None]]:
    """p itself, and the ends of the edges of the basis."""
    yield p, None
    for i in {(k >> 1) + end for k in basis for end in (0, 1)}:
        yield edges[i % len(edges)][0], i % len(edges)


def reach(edges: Sequence[Edge], p: ExactPoint, vertex: int | None, bits: int) -> Any:
    """The greatest cotangent at p; None if p is not in the closed kernel.

    From an inner point of an edge it is seen under π.  At a ``vertex`` its two edges count with
    their cap, rounded up.
    """
    greatest = None
    if vertex is not None:
        greatest = cap(edges, vertex, bits)[1]
    for i, edge in enumerate(edges):
        if vertex is not None and i in (vertex, (vertex - 1) % len(edges)):
            continue
        q, level = forms(edge, p)
        if level < 0 or (level == 0 and q >= 0):
            return None
        if level > 0 and (greatest is None or q / level > greatest):
            greatest = q / level
    return greatest


def least_edge(edges: Sequence[Edge], p: ExactPoint, vertex: int) -> int:
    """The edge of greatest cotangent at a vertex, its own two left out."""
    others = [i for i in range(len(edges)) if i not in (vertex, (vertex - 1) % len(edges))]
    values = {i: forms(edges[i], p) for i in others}
    seen = [i for i in others if values[i][1] > 0]
    return max(seen, key=lambda i: values[i][0] / values[i][1])


def cap(edges: Sequence[Edge], vertex: int, bits: int) -> tuple[Any, Any]:
    """Rational bounds of the cap cot(π − γ/2) = −tan(turn/2) of the vertex at which an edge begins.

    An edge beyond which the next one turns back (γ = 0 or 2π) has no finite cap.
    """
    s, k = turn(edges, vertex)
    with ctx.workprec(2 * bits + 64):
        size = arb(s * s + k * k).sqrt()  # of the two forms the one that does not cancel
        return rational_bounds(-s / (size + k) if k > 0 else (arb(k) - size) / s)


def rational_start(edges: Sequence[Edge], bits: int) -> Any:
    """A rational level ≤ c*: cot(2π/n), or the greatest cap of a vertex; O(n).

    As in :func:`harness.peak.ascent.greatest_cap`, but none is overlooked.
    """
    with ctx.workprec(2 * bits + 64):
        greatest, _ = rational_bounds((2 * arb.pi() / len(edges)).cot())
    for vertex in range(len(edges)):
        if len(edges) == 3 or turn(edges, vertex)[0] <= 0:
            greatest = max(greatest, cap(edges, vertex, bits)[0])
    return greatest


def turn(edges: Sequence[Edge], vertex: int) -> tuple[Any, Any]:
    """Cross and dot product of the edges before and after the vertex at which an edge begins."""
    (ax, ay), (bx, by) = edges[vertex - 1]
    (cx, cy), (dx, dy) = edges[vertex]
    ux, uy, vx, vy = bx - ax, by - ay, dx - cx, dy - cy
    return ux * vy - uy * vx, ux * vx + uy * vy


def angle_ball(c: Any) -> arb:
    """The angle in (0, π) of a rational cotangent."""
    return (1 / arb(c)).atan() if c > 0 else arb.pi() / 2 - arb(c).atan()


def rational_bounds(ball: arb) -> tuple[Any, Any]:
    """Rationals below and above a ball."""
    ends = []
    for end in (ball.lower(), ball.upper()):
        mantissa, exponent = end.man_exp()
        ends.append(fmpq(mantissa) * fmpq(2) ** int(exponent))
    return ends[0], ends[1]
