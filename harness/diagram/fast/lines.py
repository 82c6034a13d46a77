"""The lines of all segments, and the points on each of them in their order; exactly.

Every line is −dy·x + dx·y = c with integers and a primitive vector d = (dx, dy) whose angle lies in
[0, π), so that parallel lines have the same d and are ordered by c.  Coordinates are those of the
instance about a centre, times a number that makes them integers.

Points on a line p + t·d are ordered by t.  Doubles with error bounds leave few neighbours open, and
these are compared as rationals; equal ones are one point.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import gcd, lcm

import numpy as np

from harness.diagram.fast.prepare import Prepared
from harness.diagram.fast.roots import Floats, Ints, free_number
from harness.diagram.planar_map import RationalPoint

U = 2.0**-53
IntPoint = tuple[int, int]


@dataclass(frozen=True, eq=False)
class Lines:
    """``segments``: those on each line.  ``d``, ``c``: see above.  ``p``: a point on each line.

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

    def contains(self, i: int, point: tuple[Fraction, Fraction]) -> bool:
        """Whether a point (in these coordinates) lies on line i."""
        (ux, uy), (x, y) = self.d[i], point
        return ux * y - uy * x == self.c[i]


def lines_of(prepared: Prepared, seed: int = 0, squares: bool = True) -> Lines:
    """The lines of an instance, and with ``squares`` *free* lines about it, which hold no segment.

    The free lines form squares, each four times as large as the one before, until all crossings lie
    inside: so no face reaches from small distances to very large ones.  O(n²).
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
    for vector, offset in _squares(d, c, ends, seed) if squares else ():
        d.append(vector)
        c.append(offset)
        p.append(_point_on(vector, offset))
        segments.append([])
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


#: The first square, against the size of everything, and how each grows from the one before.
FIRST_SQUARE, GROWTH = 2, 4


def _squares(
    d: list[IntPoint], c: list[int], ends: list[tuple[IntPoint, IntPoint]], seed: int
) -> Iterator[tuple[IntPoint, int]]:
    """The sides of all squares, as (d, c)."""
    xs, ys = ([point[axis] for segment in ends for point in segment] for axis in range(2))
    middle = ((min(xs) + max(xs)) // 2, (min(ys) + max(ys)) // 2)
    size = max(max(xs) - min(xs), max(ys) - min(ys))
    last = _reach(d, c, middle)
    slope = 0.2 + 0.5 * float(free_number(11, seed))
    radius = FIRST_SQUARE * size
    while True:
        for number in range(4):
            x, y = round(2**20 * slope), 2**20 + 1
            if number % 2:
                x, y = y, -x
            g = gcd(x, y) if y > 0 else -gcd(x, y)
            x, y = x // g, y // g
            away = int(radius * (1 + 0.1 * float(free_number(number, seed))) * np.hypot(x, y))
            yield (x, y), x * middle[1] - y * middle[0] + (away if number < 2 else -away)
        if radius > last:
            break
        radius *= GROWTH


def _reach(d: list[IntPoint], c: list[int], middle: IntPoint) -> float:
    """At least the distance of all crossings from a point, about."""
    x, y = (np.array([float(v[axis]) for v in d]) for axis in range(2))
    offset = np.array(
        [float(k - (v[0] * middle[1] - v[1] * middle[0])) for v, k in zip(d, c, strict=True)]
    )
    most = 0.0
    for i in range(len(d)):
        w = x[i] * y - y[i] * x
        error = 8 * U * (np.abs(x[i] * y) + np.abs(y[i] * x))
        known = np.abs(w) > 2 * error
        with np.errstate(all="ignore"):
            far = np.hypot(offset[i] * x - offset * x[i], offset[i] * y - offset * y[i]) / np.abs(w)
        most = max(most, float(far[known].max(initial=0.0)))
        for j in np.flatnonzero(~known).tolist():
            (ux, uy), (vx, vy) = d[i], d[j]
            exact = ux * vy - uy * vx
            if exact:
                size = np.hypot(
                    offset[i] * x[j] - offset[j] * x[i], offset[i] * y[j] - offset[j] * y[i]
                )
                most = max(most, float(size / abs(exact)))
    return 1.1 * most


def _point_on(d: IntPoint, c: int) -> IntPoint:
    """An integer point on a line whose d is primitive."""
    x, y = d
    if x == 0:
        return -c * y, 0  # y = 1
    # −y·px + x·py = c with py ≡ c/x modulo y.
    py = c * pow(x, -1, abs(y)) if y else c // x
    return (x * py - c) // y if y else 0, py


def _integer_point(point: RationalPoint, centre: RationalPoint, unit: int) -> IntPoint:
    x, y = ((value - c) * unit for value, c in zip(point, centre, strict=True))
    return x.numerator, y.numerator


@dataclass(frozen=True, eq=False)
class Points:
    """All points on the lines: crossings, endpoints, and points that were given.

    ``line``, ``vertex`` (k,): the lines one after the other, and the points along each.  ``first``
    (l + 1,): where each line begins.  ``pairs`` (v, 2): two lines that cross in each point, or −1
    and the number of a point in ``others``.  ``ends`` (n, 2): the endpoints of every segment.
    """

    line: Ints
    vertex: Ints
    first: Ints
    pairs: Ints
    others: list[tuple[Fraction, Fraction]]
    ends: Ints


class _Classes:
    """Union–find over few of very many numbers."""

    def __init__(self) -> None:
        self.parent: dict[int, int] = {}

    def find(self, x: int) -> int:
        """The least number of the class."""
        while (up := self.parent.get(x, x)) != x:
            x = up
        return x

    def unite(self, x: int, y: int) -> None:
        """Make one class of two."""
        x, y = self.find(x), self.find(y)
        if x != y:
            self.parent[max(x, y)] = min(x, y)


def points_on(
    lines: Lines, more: Iterable[RationalPoint] = (), within: Floats | None = None
) -> Points:
    """The points on all lines in their order, and those of ``more`` that lie on lines.

    ``within`` (l, 2): from which t on and up to which crossings are wanted on each line.
    O(l² log l) for l lines, if few points coincide nearly.
    """
    count = len(lines.d)
    others, other_lines = _other_points(lines, more)
    on_line: defaultdict[int, list[int]] = defaultdict(list)
    for number, row in enumerate(other_lines):
        for i in row:
            on_line[i].append(number)
    d, p = np.array(lines.d, dtype=object), np.array(lines.p, dtype=object)
    dx, dy = d[:, 0].astype(np.float64), d[:, 1].astype(np.float64)
    px, py = p[:, 0].astype(np.float64), p[:, 1].astype(np.float64)
    c = np.array(lines.c, dtype=object).astype(np.float64)
    classes = _Classes()
    rows = []
    for i in range(count):
        j = np.flatnonzero(lines.rank != lines.rank[i])
        above = c[j] + (dy[j] * px[i] - dx[j] * py[i])
        above_error = 8 * U * (np.abs(c[j]) + np.abs(dy[j] * px[i]) + np.abs(dx[j] * py[i]))
        below = dx[j] * dy[i] - dy[j] * dx[i]
        below_error = 8 * U * (np.abs(dx[j] * dy[i]) + np.abs(dy[j] * dx[i]))
        with np.errstate(all="ignore"):
            t = above / below
            error = 1.01 * (above_error + np.abs(t) * below_error) / (np.abs(below) - below_error)
            error = np.where(np.abs(below) > 2 * below_error, error + 4 * U * np.abs(t), np.inf)
        if within is not None:
            wanted = ~((t + error < within[i, 0]) | (t - error > within[i, 1]))
            j, t, error = j[wanted], t[wanted], error[wanted]
        exact = [lines.parameter_of_point(i, others[k]) for k in on_line[i]]
        near = np.array([float(x) for x in exact])
        t = np.concatenate([np.where(np.isfinite(t), t, 0.0), near])
        error = np.concatenate([error, 4 * U * np.abs(near)])
        ids = np.concatenate(
            [
                np.minimum(i, j) * count + np.maximum(i, j),
                count * count + np.array(on_line[i], dtype=np.int64),
            ]
        )
        rows.append(_in_order(lines, i, j, exact, t, error, ids, classes))
    return _joined(lines, rows, classes, others)


def _other_points(
    lines: Lines, more: Iterable[RationalPoint]
) -> tuple[list[tuple[Fraction, Fraction]], list[list[int]]]:
    """Endpoints, and those of more points that lie on lines, with the lines they are known to be
    on: of an endpoint, those of its segments."""
    found: dict[tuple[Fraction, Fraction], set[int]] = defaultdict(set)
    for i, members in enumerate(lines.segments):
        for k in members:
            for x, y in lines.ends[k]:
                found[Fraction(x), Fraction(y)].add(i)
    for point in more:
        here = lines.in_integers(point)
        row = {i for i in range(len(lines.d)) if lines.contains(i, here)}
        if row:
            found[here] |= row
    return list(found), [sorted(row) for row in found.values()]


def _in_order(
    lines: Lines,
    i: int,
    j: Ints,
    exact: list[Fraction],
    t: Floats,
    error: Floats,
    ids: Ints,
    classes: _Classes,
) -> Ints:
    """The numbers of the points on line i, in their order; equal points are noted."""
    low, high = t - error, t + error
    order = np.argsort(low, kind="stable")
    low, high = low[order], np.maximum.accumulate(high[order])
    joined = np.flatnonzero(~(low[1:] > high[:-1]))  # with the one before, not yet apart
    if len(joined):
        starts = joined[np.diff(joined, prepend=-2) > 1]
        stops = joined[np.diff(joined, append=len(order) + 2) > 1] + 2
        for start, stop in zip(starts.tolist(), stops.tolist(), strict=True):
            members = order[start:stop].tolist()
            values = {
                k: lines.parameter(i, int(j[k])) if k < len(j) else exact[k - len(j)]
                for k in members
            }
            members.sort(key=values.__getitem__)
            order[start:stop] = members
            for one, two in pairwise(members):
                if values[one] == values[two]:
                    classes.unite(int(ids[one]), int(ids[two]))
    found: Ints = ids[order]
    return found


def _joined(
    lines: Lines,
    rows: list[Ints],
    classes: _Classes,
    others: list[tuple[Fraction, Fraction]],
) -> Points:
    """Points with one number each."""
    count = len(rows)
    line = np.repeat(np.arange(count), [len(row) for row in rows])
    ids = np.concatenate(rows)
    if classes.parent:
        merged = np.array(sorted(classes.parent))
        roots = np.array([classes.find(x) for x in merged.tolist()])
        place = np.minimum(np.searchsorted(merged, ids), len(merged) - 1)
        ids = np.where(merged[place] == ids, roots[place], ids)
    kept = np.ones(len(ids), dtype=bool)
    kept[1:] = (ids[1:] != ids[:-1]) | (line[1:] != line[:-1])
    line, ids = line[kept], ids[kept]
    numbers, vertex = np.unique(ids, return_inverse=True)
    is_crossing = numbers < count * count
    pairs = np.column_stack(
        [
            np.where(is_crossing, numbers // count, -1),
            np.where(is_crossing, numbers % count, numbers - count * count),
        ]
    )
    number_of = {point: k for k, point in enumerate(others)}
    ends = [
        [classes.find(count * count + number_of[Fraction(x), Fraction(y)]) for x, y in segment]
        for segment in lines.ends
    ]
    return Points(
        line=line,
        vertex=vertex.astype(np.int64),
        first=np.searchsorted(line, np.arange(count + 1)),
        pairs=pairs,
        others=others,
        ends=np.searchsorted(numbers, np.array(ends)),
    )


def within_hull(lines: Lines) -> Floats:
    """Between which t every line is near the convex hull of all segments, (l, 2).

    A little is added, far more than roundings.
    """
    from scipy.spatial import ConvexHull

    ends = np.array([[float(x) for x in point] for segment in lines.ends for point in segment])
    middle, size = ends.mean(axis=0), np.ptp(ends, axis=0).max()
    normals = ConvexHull((ends - middle) / size).equations
    d = np.array([[float(x) for x in v] for v in lines.d]) / size
    p = (np.array([[float(x) for x in v] for v in lines.p]) - middle) / size
    within = np.tile([-np.inf, np.inf], (len(d), 1))
    for x, y, offset in normals:
        speed = d[:, 0] * x + d[:, 1] * y
        left = 1e-6 - (p[:, 0] * x + p[:, 1] * y + offset)  # what t·speed may be
        with np.errstate(all="ignore"):
            t = left / speed
        within[:, 1] = np.where(speed > 0, np.minimum(within[:, 1], t), within[:, 1])
        within[:, 0] = np.where(speed < 0, np.maximum(within[:, 0], t), within[:, 0])
    slack = 1e-6 / np.hypot(d[:, 0], d[:, 1])
    within += np.column_stack([-slack, slack])
    return within
