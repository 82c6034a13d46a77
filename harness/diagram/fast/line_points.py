"""The points on lines in their order; exactly.

Points on a line p + t·d are ordered by t.  Doubles with error bounds leave few neighbours open, and
these are compared as rationals; equal ones are one point.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np

from harness.diagram.fast.forms import U
from harness.diagram.fast.lines import Lines, RoundedLines
from harness.diagram.fast.roots import Floats, Ints
from harness.diagram.fast.squares import over
from harness.diagram.planar_map import RationalPoint

#: So far outside the convex hull, against its size, crossings are looked at, too.
BEYOND = 1e-6
#: More than what underflow takes from a sum of products, whose factors are less than 2³⁰⁰.
TINY = 2.0**-700


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

    ``within`` (l, 2): from which t of :class:`RoundedLines` on and up to which crossings are wanted
    on each line.
    O(l² log l) for l lines, if few points coincide nearly.
    """
    count = len(lines.d)
    others, other_lines = _other_points(lines, more)
    on_line: defaultdict[int, list[int]] = defaultdict(list)
    for number, row in enumerate(other_lines):
        for i in row:
            on_line[i].append(number)
    rounded = lines.rounded()
    classes = _Classes()
    rows = []
    for i in range(count):
        j = np.flatnonzero(lines.rank != lines.rank[i])
        t, error = _crossings(rounded, i, j)
        if within is not None:
            wanted = ~((t + error < within[i, 0]) | (t - error > within[i, 1]))
            j, t, error = j[wanted], t[wanted], error[wanted]
        exact = [lines.parameter_of_point(i, others[k]) for k in on_line[i]]
        shift = Fraction(2) ** (rounded.length[i] - rounded.reach)
        near = np.array([float(x * shift) for x in exact])
        t = np.concatenate([t, near])
        error = np.concatenate([error, 4 * U * np.abs(near) + TINY])
        ids = np.concatenate(
            [
                np.minimum(i, j) * count + np.maximum(i, j),
                count * count + np.array(on_line[i], dtype=np.int64),
            ]
        )
        rows.append(_in_order(lines, i, j, exact, t, error, ids, classes))
    return _joined(lines, rows, classes, others)


def _crossings(rounded: RoundedLines, i: int, j: Ints) -> tuple[Floats, Floats]:
    """Where lines j cross line i, as t of :class:`RoundedLines`, with bounds on the errors.

    Let u = 2⁻⁵³.  t is A/B with A = c_j + v_y p_x − v_x p_y and B = v_x u_y − v_y u_x, for the
    vectors u and v of the lines i and j.  Every number is rounded once, so a product is off by 3u
    of it, and A by at most 2u|c_j| + 5u(|v_y p_x| + |v_x p_y|), B by 4u(|v_x u_y| + |v_y u_x|); for
    both 8u, and TINY for underflow, is enough even though the bounds are rounded.  If A and B are
    off by α and β, A/B is off by (α + |A/B|β)/(|B| − β), with the computed A and B.  4u|t| covers
    the division, and a sum of t and its error.
    """
    (ux, uy), (px, py) = rounded.d[i], rounded.p[i]
    vx, vy = rounded.d[j].T
    c = rounded.c[j]
    above = c + (vy * px - vx * py)
    above_error = 8 * U * (np.abs(c) + np.abs(vy * px) + np.abs(vx * py)) + TINY
    below = vx * uy - vy * ux
    below_error = 8 * U * (np.abs(vx * uy) + np.abs(vy * ux)) + TINY
    with np.errstate(all="ignore"):
        t = above / below
        error = 1.01 * (above_error + np.abs(t) * below_error) / (np.abs(below) - below_error)
        error += 4 * U * np.abs(t) + TINY
        known = (np.abs(below) > 2 * below_error) & np.isfinite(t) & np.isfinite(error)
    return np.where(known, t, 0.0), np.where(known, error, np.inf)


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
    """The numbers of the points on line i, in their order; equal points are noted.

    Every t is enclosed in an interval.  Sorted by the lower ends, the points fall into stretches
    where each interval begins before all earlier ones have ended; different stretches are apart,
    and within one the exact values are sorted.
    """
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
    """Between which t of :class:`RoundedLines` every line may be in the convex hull of all
    segments, (l, 2).

    The hull is cut out by half-planes, of which it does not matter how they are found: each is
    moved so that it contains all endpoints, and by ``BEYOND`` more.  Coordinates are at most 1 and
    have errors of a few u = 2⁻⁵³, as has the speed of a line towards the half-plane's side, and
    within the hull t·d is less than 3: so BEYOND is far more than all roundings.
    """
    from scipy.spatial import ConvexHull, QhullError

    rounded = lines.rounded()
    ends = np.array([[over(x, rounded.reach) for x in v] for row in lines.ends for v in row])
    size = np.ptp(ends, axis=0).max()
    try:
        normals = ConvexHull((ends - ends.mean(axis=0)) / size).equations[:, :2]
    except QhullError:  # too flat for doubles: nothing is left out
        normals = np.zeros((0, 2))
    d, p = rounded.d, rounded.p
    within = np.tile([-np.inf, np.inf], (len(d), 1))
    for x, y in normals:
        speed = d[:, 0] * x + d[:, 1] * y
        room = BEYOND * size + (ends @ (x, y)).max() - (p @ (x, y))  # what t·speed may be
        with np.errstate(all="ignore"):
            t = room / speed
        within[:, 1] = np.where(speed > 0, np.minimum(within[:, 1], t), within[:, 1])
        within[:, 0] = np.where(speed < 0, np.maximum(within[:, 0], t), within[:, 0])
    within += np.array([-2.0, 2.0]) * BEYOND * size
    return within
