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


def least_power(rows: Sequence[Row]) -> tuple[Any, ExactPoint, tuple[int, ...]] | None:
    """(M, point, positions of a basis): the least of the greatest disc, inside the walls.

    Exact, by trying all subsets; O(m⁴) for m rows.  None if the walls leave nothing.
    """
    for size in (1, 2, 3):
        for subset in combinations(range(len(rows)), size):
            solved = _tight([rows[k] for k in subset])
            if solved is None:
                continue
            t, x, y = solved
            if all(g * x + h * y + r <= (t if disc else 0) for g, h, r, disc in rows):
                return x * x + y * y + t, (x, y), subset
    return None


def _tight(rows: list[Row]) -> tuple[Any, Any, Any] | None:
    """(t, x, y) of the least with these rows tight, if their multipliers are not negative."""
    rows = sorted(rows, key=lambda row: not row[3])
    g, h, r, is_disc = rows[0]
    if not is_disc:
        return None
    lines = [(a - g, b - h, e - r) if disc else (a, b, e) for a, b, e, disc in rows[1:]]
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
    discs = sum((w for w, row in zip(weights, rows[1:], strict=True) if row[3]), fmpq(0))
    if discs > 1 or any(w < 0 for w in weights):
        return None
    return g * x + h * y + r, x, y


def rational_ascent(
    edges: Sequence[Edge], start: Any, bits: int, first: Sequence[int] = ()
) -> RationalAscent:
    """The ascent from the rational level ``start`` ≤ c* until level and reach agree.

    ``edges``: counter-clockwise, around a kernel with interior; ``bits``: how closely, relative to
    1 + |c|; ``first``: edges to begin with.  A few hundred operations for each edge.

    Raises ArithmeticError if it does not come to an end.
    """
    active = sorted({2 * i for i in first} or {0})
    least = fmpq(1, 1 << bits)
    c, best = start, None
    for _ in range(MOST_STEPS):
        solved = least_power([row_of(edges, k, c) for k in active])
        if solved is None:
            raise ArithmeticError("the walls leave nothing: the kernel has no interior")
        value, p, subset = solved
        basis = tuple(active[k] for k in subset)
        violated = _most_violated(edges, c, p, value)
        if violated is not None:
            active = sorted({*basis, violated})
            continue
        for q, vertex in _candidates(edges, basis, p):
            reached = reach(edges, q, vertex, bits)
            if reached is not None and (best is None or reached < best.reached):
                best = RationalAscent(c, reached, q, basis, vertex)
        if best is not None and best.reached - c <= (1 + abs(c)) * least:
            break
        rise = _rise(edges, basis, value, c, p, bits)
        if not rise > (1 + abs(c)) * least * least:
            break
        active = list(basis)
        c += rise
    if best is None:
        raise ArithmeticError("the ascent found no point inside")
    return replace(best, level=c, basis=basis)


def _most_violated(edges: Sequence[Edge], c: Any, p: ExactPoint, value: Any) -> int | None:
    """The disc that p violates most, else such a wall, else None."""
    found = [forms(edge, p) for edge in edges]
    excess = [q - c * level for q, level in found]
    worst = max(range(len(edges)), key=excess.__getitem__)
    if excess[worst] > value:
        return 2 * worst
    deepest = min(range(len(edges)), key=lambda i: found[i][1])
    return 2 * deepest + 1 if found[deepest][1] < 0 else None


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
    (ax, ay), (bx, by) = edges[vertex - 1]
    (cx, cy), (dx, dy) = edges[vertex]
    ux, uy, vx, vy = bx - ax, by - ay, dx - cx, dy - cy
    s, k = ux * vy - uy * vx, ux * vx + uy * vy
    with ctx.workprec(2 * bits + 64):
        size = arb(s * s + k * k).sqrt()  # of the two forms the one that does not cancel
        return rational_bounds(-s / (size + k) if k > 0 else (arb(k) - size) / s)


def rational_start(edges: Sequence[Edge], capped: int, bits: int) -> Any:
    """A rational level ≤ c*: cot(2π/n), or the cap of vertex ``capped`` (−1: none)."""
    with ctx.workprec(2 * bits + 64):
        lowest, _ = rational_bounds((2 * arb.pi() / len(edges)).cot())
    return lowest if capped < 0 else max(lowest, cap(edges, capped, bits)[0])


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


def _rise(
    edges: Sequence[Edge], basis: tuple[int, ...], value: Any, c: Any, p: ExactPoint, bits: int
) -> Any:
    """A step to a higher level ≤ c*, rounded down: see :func:`harness.peak.ascent.rise`."""
    if value <= 0:
        return fmpq(0)
    rows = [row_of(edges, k, c) for k in basis]
    s = hx = hy = fmpq(0)
    for constraint, weight in zip(basis, _multipliers(rows, p), strict=True):
        (ax, ay), (bx, by) = edges[constraint >> 1]
        if constraint & 1:
            weight = weight / c if c > 0 else fmpq(0)
        else:
            s += weight * forms(edges[constraint >> 1], p)[1]
        hx -= weight * (by - ay)
        hy += weight * (bx - ax)
    with ctx.workprec(2 * bits + 64):
        step = 2 * arb(value) / (arb(s) + (arb(s * s + value * (hx * hx + hy * hy))).sqrt())
        return max(rational_bounds(step)[0], fmpq(0)) if step.is_finite() else fmpq(0)


def _multipliers(rows: list[Row], p: ExactPoint) -> list[Any]:
    """The multipliers of tight rows at their optimum p (in the order given)."""
    order = sorted(range(len(rows)), key=lambda k: not rows[k][3])
    g, h, _, _ = rows[order[0]]
    x, y = p
    s, t = -2 * x - g, -2 * y - h
    lines = [
        (rows[k][0] - g, rows[k][1] - h) if rows[k][3] else (rows[k][0], rows[k][1])
        for k in order[1:]
    ]
    if not lines:
        found = []
    elif len(lines) == 1:
        ((a, b),) = lines
        found = [(s * a + t * b) / (a * a + b * b)]
    else:
        (a, b), (k, m) = lines
        det = a * m - b * k
        found = [(s * m - t * k) / det, (a * t - b * s) / det]
    discs = sum((w for w, k in zip(found, order[1:], strict=True) if rows[k][3]), fmpq(0))
    result = [fmpq(0)] * len(rows)
    for w, k in zip([1 - discs, *found], order, strict=True):
        result[k] = w
    return result
