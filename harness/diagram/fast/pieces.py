"""Exact points of the pieces of a leaf's boundary, and ways inside a leaf that cross no edge.

Points of a leaf are homogeneous weights of its corners, (3,) whole numbers ≥ 0: a common positive
factor means nothing, and corners at infinity are like others.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import pairwise
from math import lcm
from typing import Any

from harness.diagram.fast.chart import Chart
from harness.diagram.fast.forms import STEPS
from harness.diagram.fast.side_ports import exact_ports
from harness.diagram.fast.univariate import isolated_zeros

Whole = tuple[int, int, int]
_STEPS: list[list[int]] = STEPS.tolist()


def whole(weights: Iterable[Fraction]) -> Whole:
    """Whole numbers in the same ratios."""
    exact = list(weights)
    unit = lcm(*(x.denominator for x in exact))
    a, b, c = (x.numerator * (unit // x.denominator) for x in exact)
    return a, b, c


def between(p: Whole, q: Whole, bits: int) -> Whole:
    """p + 2^−bits (q − p), both brought to the same sum."""
    s, t = sum(p), sum(q)
    a, b, c = (x * t * (2**bits - 1) + y * s for x, y in zip(p, q, strict=True))
    return a, b, c


def owners(chart: Chart) -> list[int]:
    """The segments that have a piece of a leaf's boundary, increasing."""
    arrays = chart.diagram.arrays
    base = int(arrays.start[chart.leaf])
    count = max(int(arrays.ports[chart.leaf]), 1)
    return sorted(set(arrays.owner[base : base + count].tolist()))


def points_of_piece(chart: Chart, slot: int) -> list[Whole]:
    """Points of the piece after a port, strictly between it and the next: corners, then others.

    None if both ports are at one corner.
    """
    arrays = chart.diagram.arrays
    base, count = int(arrays.start[chart.leaf]), int(arrays.ports[chart.leaf])
    following = base + (slot - base + 1) % count

    def position(port: int, after: bool) -> Fraction:
        """Corner k is at k, the side after it runs to k + 1."""
        k, on_side = divmod(int(arrays.place[port]), 2)
        if not on_side:
            return Fraction(k)
        zero = ports[port]
        return k + (zero.high if after else zero.low)

    ports = {
        port: zero
        for place in {int(arrays.place[slot]), int(arrays.place[following])}
        if place % 2
        for port, (zero, _) in exact_ports(chart, place).items()
    }
    low, high = position(slot, True), position(following, False)
    if following <= slot:
        high += 3
    if low == high:
        return []
    stops = [low, *(Fraction(k) for k in range(7) if low < k < high), high]
    result = []
    for at in [*stops[1:-1], *((x + y) / 2 for x, y in pairwise(stops))]:
        k, t = int(at) % 3, at - int(at)
        weights = [Fraction(0)] * 3
        weights[k], weights[(k + 1) % 3] = 1 - t, t
        result.append(whole(weights))
    return result


def polar(b: list[Any], p: Whole, q: Whole, r: Whole) -> Any:
    """The polar form of a cubic in Bernstein form at three points."""
    c = [sum((x * b[s] for x, s in zip(p, steps, strict=True)), 0) for steps in _STEPS]
    d = (
        q[0] * c[0] + q[1] * c[3] + q[2] * c[4],
        q[0] * c[3] + q[1] * c[1] + q[2] * c[5],
        q[0] * c[4] + q[1] * c[5] + q[2] * c[2],
    )
    return r[0] * d[0] + r[1] * d[1] + r[2] * d[2]


def is_clear(chart: Chart, winner: int, p: Whole, q: Whole) -> bool:
    """Whether no contest of a segment with another of the leaf is zero from p on until q.

    It may be zero at q.  Exactly: by the roots of a cubic in one variable.
    """
    return all(_is_free(_along(cubic, p, q)) for cubic in _contests(chart, winner))


def _contests(chart: Chart, winner: int) -> Iterator[list[Any]]:
    for other in owners(chart):
        if other != winner:
            for which in chart.signs(winner, other):
                yield chart.cubic(winner, other, which)


def _along(cubic: list[Any], p: Whole, q: Whole) -> list[Any]:
    return [polar(cubic, *([p] * (3 - k)), *([q] * k)) for k in range(4)]


def _is_free(b: list[Any]) -> bool:
    """Whether a polynomial in Bernstein form has no zero in [0, 1)."""
    if b[0] == 0:
        return False
    if all((x > 0) == (b[0] > 0) for x in b if x != 0):
        return True
    try:
        return not isolated_zeros(b)
    except ArithmeticError:  # a double zero
        return False
