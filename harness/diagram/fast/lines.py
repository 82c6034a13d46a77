"""The lines of all segments, in integers.

Every line is −dy·x + dx·y = c with integers and a primitive vector d = (dx, dy) whose angle lies in
[0, π), so that parallel lines have the same d and are ordered by c.  Coordinates are those of the
instance about a centre, times a number that makes them integers.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import gcd, lcm

import numpy as np

from harness.diagram.fast.prepare import Prepared
from harness.diagram.fast.roots import Floats, Ints
from harness.diagram.fast.squares import bits_of, over, squares_about
from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Contradiction

IntPoint = tuple[int, int]


@dataclass(frozen=True, eq=False)
class RoundedLines:
    """Lines in doubles, each rounded once: the integers divided by powers of two, since they may
    have thousands of bits.

    ``p`` (l, 2): points over 2^``reach``, where those of segments are at most 1.  ``d`` (l, 2):
    vectors over 2^``length`` (of each line), so that the greater part is in [1/2, 1].  ``c`` (l,):
    over both.  A place p + t·d of :class:`Lines` has t·2^(length − reach) here instead of t.
    """

    d: Floats
    c: Floats
    p: Floats
    length: list[int]
    reach: int


@dataclass(frozen=True, eq=False)
class Lines:
    """``segments``: those on each line, none on a free one.  ``d``, ``c``: see above.  ``p``: a
    point on each line.  A place on a line is written p + t·d.

    ``rank`` (l,): of the line's direction among all, by angle.  ``ends``: of every segment, in
    integers: a coordinate of the instance less ``centre``, times ``unit``.  ``orientation``: of a
    polygon, as it was given.
    """

    segments: list[list[int]]
    d: list[IntPoint]
    c: list[int]
    p: list[IntPoint]
    rank: Ints
    ends: list[tuple[IntPoint, IntPoint]]
    centre: RationalPoint
    unit: int
    orientation: int

    def crossing(self, i: int, j: int) -> tuple[int, int, int]:
        """(X, Y, W): the lines i and j meet in (X/W, Y/W); W = 0 if they are parallel."""
        (ux, uy), (vx, vy) = self.d[i], self.d[j]
        c, e = self.c[i], self.c[j]
        return c * vx - e * ux, c * vy - e * uy, ux * vy - uy * vx

    def parameter(self, i: int, j: int) -> Fraction:
        """Where on line i line j crosses it."""
        (ux, uy), (vx, vy), (px, py) = self.d[i], self.d[j], self.p[i]
        return Fraction(self.c[j] + vy * px - vx * py, vx * uy - vy * ux)

    def parameter_of_point(self, i: int, point: tuple[Fraction, Fraction]) -> Fraction:
        """Where on line i a point of it lies."""
        (ux, uy), (px, py) = self.d[i], self.p[i]
        return (point[0] - px) / ux if ux else (point[1] - py) / uy

    def in_integers(self, point: RationalPoint) -> tuple[Fraction, Fraction]:
        """A point of the instance in these coordinates (which are integers for endpoints)."""
        x, y = ((value - c) * self.unit for value, c in zip(point, self.centre, strict=True))
        return x, y

    def rounded(self) -> RoundedLines:
        """All lines in doubles."""
        reach = bits_of(self.ends)
        length = [max(map(int.bit_length, v)) for v in self.d]
        return RoundedLines(
            d=np.array([[over(x, k) for x in v] for v, k in zip(self.d, length, strict=True)]),
            c=np.array([over(c, reach + k) for c, k in zip(self.c, length, strict=True)]),
            p=np.array([[over(x, reach) for x in point] for point in self.p]),
            length=length,
            reach=reach,
        )

    def contains(self, i: int, point: tuple[Fraction, Fraction]) -> bool:
        """Whether a point (in these coordinates) lies on line i."""
        (ux, uy), (x, y) = self.d[i], point
        return ux * y - uy * x == self.c[i]


def lines_of(prepared: Prepared, seed: int = 0, squares: bool = True) -> Lines:
    """The lines of an instance, and with ``squares`` *free* lines about it, which hold no segment.

    The free lines form squares, each four times as large as the one before, until all crossings lie
    inside: so no face reaches from small distances to very large ones.  O(n²).

    Raises Contradiction if two lines are the same.
    """
    instance, centre = prepared.instance, prepared.centre
    exact = instance.rational_segments()
    unit = lcm(
        *(x.denominator for segment in exact for point in segment for x in point),
        *(x.denominator for x in centre),
    )
    ends = [(_integer_point(a, centre, unit), _integer_point(b, centre, unit)) for a, b in exact]
    groups: dict[int, list[int]] = {}
    for k, number in enumerate(prepared.lines.tolist()):
        groups.setdefault(number if number >= 0 else -1 - k, []).append(k)
    segments = list(groups.values())
    d, c, p = [], [], []
    for members in segments:
        (ax, ay), (bx, by) = ends[members[0]]
        x, y = bx - ax, by - ay
        g = gcd(x, y) if y > 0 or (y == 0 and x > 0) else -gcd(x, y)
        x, y = x // g, y // g
        d.append((x, y))
        c.append(x * ay - y * ax)
        p.append((ax, ay))
    for vector, offset, point in list(squares_about(d, c, ends, seed)) if squares else ():
        d.append(vector)
        c.append(offset)
        p.append(point)
        segments.append([])
    if len(set(zip(d, c, strict=True))) < len(d):
        raise Contradiction("two lines are the same")
    # −cot of an angle in [0, π) grows with it; 0 itself is the least.
    order = sorted(set(d), key=lambda v: (v[1] != 0, Fraction(-v[0], v[1]) if v[1] else 0))
    number_of = {v: k for k, v in enumerate(order)}
    return Lines(
        segments=segments,
        d=d,
        c=c,
        p=p,
        rank=np.array([number_of[v] for v in d], dtype=np.int64),
        ends=ends,
        centre=centre,
        unit=unit,
        orientation=instance.orientation,
    )


def _integer_point(point: RationalPoint, centre: RationalPoint, unit: int) -> IntPoint:
    x, y = ((value - c) * unit for value, c in zip(point, centre, strict=True))
    return x.numerator, y.numerator
