"""Rows of equal segments: their ties at infinity are known before anything is subdivided.

Of segments with one vector v (up to sign) and the middles m, F_ij is w·δ·N(d) to first order in w
in the direction d at infinity (:func:`harness.diagram.fast.ties._tie_far`), where δ = m_i − m_j and
N does not depend on the middles.  So the winner there is extreme in the direction N(d) among the
middles, and where a side of their convex hull is orthogonal to N(d) all segments along it tie: a
hub if there are three, from which asymptotes leave side by side.  The hubs of a row are the
directions |δ|v ± |v|δ, or that orthogonal to v if δ is parallel to it.

Of segments with different vectors v and w those tie in the directions v ± w that are the best of
their classes in that order.

Most hubs of rows are irrational.  Their corners then stand for the irrational direction, and what
is stored of it is a rational one that is closer than 2^−``BITS``.  It has the same double-doubles
but for an error far below theirs, and its turns against all other corners are the same if they are
farther than ``APART``, which is checked.  That the row ties there is known by the above, not from
coordinates, and a triangle at infinity is never handed to algebra.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import combinations, permutations
from math import isqrt

from harness.diagram.planar_map import RationalPoint
from harness.geometry.instance import Instance
from harness.geometry.predicates import orientation

#: Longer rows are left to be found: all pairs of a row tie.
LONGEST = 128
#: Bits to which irrational directions are stored.
BITS = 512
#: Different directions are told apart if they are not closer.
APART = Fraction(1, 2**200)

#: Classes at most of segments with one vector whose differences are looked at.
MOST_CLASSES = 16

#: The ties (i, j, which) in each direction, i < j; see :data:`harness.diagram.fast.ties.Ties`.
FarTies = dict[RationalPoint, set[tuple[int, int, int]]]
#: A vector that three or more segments share, up to sign, and these by twice their middles.
Class = tuple[RationalPoint, Mapping[RationalPoint, list[int]]]


def ties_at_infinity(instance: Instance) -> FarTies:
    """What ties in directions at infinity where three equal segments do, or two such classes.

    O(n · directions) and all pairs of segments that tie, of which one is among the best.
    """
    classes = list(_classes(instance))
    found: defaultdict[RationalPoint, set[tuple[int, int, int]]] = defaultdict(set)
    for v, middles in classes:
        for row in _rows(list(middles)):
            members = sorted(k for point in row for k in middles[point])
            if len(members) <= LONGEST:
                ties = set(_ties_of_row(instance, members))
                delta = row[-1][0] - row[0][0], row[-1][1] - row[0][1]
                for d in halving_directions(normalised(v), normalised(delta), _near_root):
                    found[normalised(d)] |= ties
    if len(classes) <= MOST_CLASSES:
        for d in [*found, *_between_classes(classes)]:
            for one, two in permutations(classes, 2):
                found[d].update(_ties_of_classes(instance, one, two, d))
    return {d: ties for d, ties in found.items() if ties}


def _classes(instance: Instance) -> Iterator[Class]:
    found: defaultdict[RationalPoint, dict[RationalPoint, list[int]]] = defaultdict(dict)
    for k, (a, b) in enumerate(instance.rational_segments()):
        v = max((b[0] - a[0], b[1] - a[1]), (a[0] - b[0], a[1] - b[1]))
        found[v].setdefault((a[0] + b[0], a[1] + b[1]), []).append(k)
    return ((v, middles) for v, middles in found.items() if len(middles) >= 3)


def _ties_of_row(instance: Instance, row: Sequence[int]) -> Iterator[tuple[int, int, int]]:
    vectors = {k: vector(instance, k) for k in row}
    for i, j in combinations(row, 2):
        yield i, j, 4 if vectors[i] == vectors[j] else 8


def _between_classes(classes: Sequence[Class]) -> Iterator[RationalPoint]:
    """The directions v ± w."""
    for (v, _), (w, _) in combinations(classes, 2):
        for sign in (1, -1):
            x, y = normalised((v[0] + sign * w[0], v[1] + sign * w[1]))
            yield x, y
            yield -x, -y


def _ties_of_classes(
    instance: Instance, one: Class, two: Class, d: RationalPoint
) -> Iterator[tuple[int, int, int]]:
    """The ties between the best segments of a class and all of another."""
    (v, middles), (w, others) = one, two
    if abs(_cross(d, v)) != abs(_cross(d, w)):
        return
    far = {k: _cross(d, vector(instance, k)) for ids in others.values() for k in ids}
    for i in _best(v, middles, d):
        li = _cross(d, vector(instance, i))
        for j, lj in far.items():
            yield min(i, j), max(i, j), 1 if li == lj else 2


def _best(
    v: RationalPoint, middles: Mapping[RationalPoint, list[int]], d: RationalPoint
) -> list[int]:
    """The segments of a class that are extreme in the direction d at infinity."""
    values = {m: contest_far(v, m, d) for m in middles}
    extremes = min(values.values()), max(values.values())
    return [k for m, ids in middles.items() if values[m] in extremes for k in ids]


def contest_far(v: RationalPoint, delta: RationalPoint, d: RationalPoint) -> Fraction:
    """Twice F of two segments with the vector v in the direction d at infinity, over w.

    ``delta``: twice the difference of their middles.  Linear in it, so the contest of two segments
    is the difference of what comes out for twice their middles.
    """
    along = delta[0] * d[0] + delta[1] * d[1]
    return (d[0] ** 2 + d[1] ** 2) * _cross(v, delta) + 2 * along * _cross(d, v)


def between_middles(instance: Instance, i: int, j: int) -> RationalPoint:
    """Twice the difference of two segments' middles."""
    (a, b), (c, d) = instance.rational_segment(i), instance.rational_segment(j)
    return a[0] + b[0] - c[0] - d[0], a[1] + b[1] - c[1] - d[1]


def _cross(a: RationalPoint, b: RationalPoint) -> Fraction:
    return a[0] * b[1] - a[1] * b[0]


def normalised(d: RationalPoint) -> RationalPoint:
    """A vector of the same direction whose larger coordinate is 1 or −1."""
    size = max(abs(d[0]), abs(d[1]))
    return d[0] / size, d[1] / size


def are_apart(d: RationalPoint, e: RationalPoint) -> bool:
    """Whether two directions are told apart whatever they stand for."""
    (dx, dy), (ex, ey) = normalised(d), normalised(e)
    return dx * ex + dy * ey <= 0 or abs(dx * ey - dy * ex) > APART


def halving_directions(
    v: RationalPoint, delta: RationalPoint, root: Callable[[Fraction], Fraction | None]
) -> Iterator[RationalPoint]:
    """The directions that halve the angles between two vectors, with a square root that is
    computed by ``root``, or none; of parallel vectors, those orthogonal to v."""
    if v[0] * delta[1] == v[1] * delta[0]:
        yield -v[1], v[0]
        yield v[1], -v[0]
        return
    scale = v[0] ** 2 + v[1] ** 2
    size = root(scale * (delta[0] ** 2 + delta[1] ** 2))
    if size is None:
        return
    # |δ| v ± |v| δ, up to a factor |v|.
    for sign in (1, -1):
        x, y = (size * v[k] + sign * scale * delta[k] for k in range(2))
        if x or y:
            yield x, y
            yield -x, -y


def square_root(value: Fraction) -> Fraction | None:
    """The rational square root, if there is one."""
    p, q = isqrt(value.numerator), isqrt(value.denominator)
    return Fraction(p, q) if p * p == value.numerator and q * q == value.denominator else None


def _near_root(value: Fraction) -> Fraction:
    """The square root, exactly or with a relative error of 2^−BITS."""
    exact = square_root(value)
    if exact is not None:
        return exact
    product = value.numerator * value.denominator  # √(p/q) = √(pq)/q
    shift = BITS + 8
    return Fraction(isqrt(product << 2 * shift), value.denominator << shift)


def vector(instance: Instance, k: int) -> RationalPoint:
    """From a segment's first endpoint to its second."""
    a, b = instance.rational_segment(k)
    return b[0] - a[0], b[1] - a[1]


def _rows(points: Sequence[RationalPoint]) -> Iterator[list[RationalPoint]]:
    """The sides of the convex hull with three or more points (all points if they are on a line)."""
    ordered = sorted(points)
    for chain in (_half_hull(ordered), _half_hull(ordered[::-1])):
        row = chain[:2]
        for point in [*chain[2:], None]:
            if point is not None and orientation(row[0], row[-1], point) == 0:
                row.append(point)
                continue
            if len(row) > 2:
                yield row
            if point is not None:
                row = [row[-1], point]


def _half_hull(ordered: Sequence[RationalPoint]) -> list[RationalPoint]:
    """The lower half of the convex hull of sorted points (the upper half if they are reversed),
    with all points on it."""
    chain: list[RationalPoint] = []
    for point in ordered:
        while len(chain) > 1 and orientation(chain[-2], chain[-1], point) < 0:
            chain.pop()
        chain.append(point)
    return chain
