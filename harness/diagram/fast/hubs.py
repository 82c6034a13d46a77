"""Points where many segments tie exactly: found in leaves that no halving can resolve.

Around such a *hub* every smaller triangle shows the same picture, so the subdivision hands the
triangle over.  If the hub is rational (and where lines meet it always is) it becomes a special
corner of the root triangles, at which all ties are known, and everything is subdivided again:

* three or more lines that meet in one point outside their segments (angle 0);
* four or more segments of which the best tie at a positive angle;
* at infinity, directions d with |d × v| = |d × w| for two segments' vectors v, w; and, for segments
  with the same vector v (up to sign) whose middles differ by δ, those that halve the angle between
  v and δ or are perpendicular to that: F then vanishes to second order at infinity.

Of rows of equal segments, where such directions are irrational as a rule, the latter are known
before (:mod:`harness.diagram.fast.rows`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import combinations
from typing import Any

from flint import arb, ctx

from harness.diagram.fast.arranged import ArrangedCorners
from harness.diagram.fast.build import Leaves, exact_corners, open_rows
from harness.diagram.fast.decisions import enclosed, exact_cubic, exact_forms, homogeneous_corners
from harness.diagram.fast.leaves import EMPTY, HARD
from harness.diagram.fast.plane import turns_left
from harness.diagram.fast.roots import Roots, between, free_number
from harness.diagram.fast.rows import (
    FarTies,
    between_middles,
    halving_directions,
    normalised,
    square_root,
    vector,
)
from harness.diagram.planar_map import RationalPoint
from harness.geometry.instance import Instance
from harness.geometry.predicates import orientation

#: Bits to which a hub is computed, and of the denominators it is looked for with.
BITS, DENOMINATORS = 1024, 256
#: Segments at least that tie at a positive angle in a hub.
FEWEST = 4


@dataclass
class Hubs:
    """Known hubs and the segments of the leaf each was found in: points, and directions.

    ``cuts``: the points among them at which a side was cut.  ``known``: ties in directions that are
    known from the beginning.
    """

    points: dict[RationalPoint, list[int]] = field(default_factory=dict)
    directions: dict[RationalPoint, list[int]] = field(default_factory=dict)
    cuts: set[RationalPoint] = field(default_factory=set)
    known: FarTies = field(default_factory=dict)

    def all_directions(self) -> list[RationalPoint]:
        """The directions, each once."""
        return list(dict.fromkeys([*self.known, *self.directions]))


def find_hubs(instance: Instance, roots: Roots, leaves: Leaves, sense: float, hubs: Hubs) -> bool:
    """Look for hubs in all hard leaves and add them; whether any is new."""
    before = len(hubs.points) + len(hubs.directions)
    shaped = (leaves.kinds != EMPTY).nonzero()[0]
    for number, row in enumerate(open_rows(leaves).tolist()):
        if leaves.kinds[shaped[row]] != HARD:
            continue
        ids = leaves.open_ids[leaves.open_first[number] : leaves.open_first[number + 1]].tolist()
        corners = homogeneous_corners(roots, leaves, row)
        far = [k for k in range(3) if corners[k][2] == 0]
        if len(far) == 2:
            low, high = (_direction(corners[k]) for k in _in_order(far))
            for d in _directions(instance, ids):
                if turns_left(low, d) and turns_left(d, high):
                    hubs.directions.setdefault(normalised(d), ids)
        elif not far:
            exact = exact_corners(roots, leaves, row)
            point = _crossing(instance, ids, exact)
            if point is None and len(ids) >= FEWEST:
                start = leaves.points[row].tolist()
                point = _tie(instance, ids, exact, corners, start, sense)
            if point is None:
                point = _cut(roots, leaves, row, hubs)
            if point is not None:
                hubs.points.setdefault(point, ids)
    return len(hubs.points) + len(hubs.directions) > before


def _cut(roots: Roots, leaves: Leaves, row: int, hubs: Hubs) -> RationalPoint | None:
    """A point on the side of a root in which a leaf lies, away from the middle.

    Between regularly spaced points an edge may pass through the middle of a side, which then is a
    corner of two triangles that no halving resolves.  Only sides on lines of an arrangement are
    cut, and those that have not been cut before.
    """
    if not isinstance(roots.corners, ArrangedCorners):
        return None
    weights = leaves.weights(row)
    triangle = roots.triangles[leaves.shape_roots[row]].tolist()
    for k in range(3):
        a, b = triangle[k - 2], triangle[k - 1]
        if sum(w[k] == 0 for w in weights) < 2 or not all(roots.corners.weights[[a, b]]):
            continue
        if not all(roots.corners.special[[a, b]]):
            continue
        p, q = roots.corners.exact[a], roots.corners.exact[b]
        if p not in hubs.cuts and q not in hubs.cuts:
            low, high = sorted((p, q))
            cut = between(low, high, free_number(3, 1))
            hubs.cuts.add(cut)
            return cut
    return None


def _in_order(far: list[int]) -> tuple[int, int]:
    """The two corners at infinity so that the second follows counter-clockwise."""
    return (2, 0) if far == [0, 2] else (far[0], far[1])


def _direction(corner: tuple[Any, Any, Any]) -> RationalPoint:
    x, y, _ = corner
    return Fraction(int(x.p), int(x.q)), Fraction(int(y.p), int(y.q))


def _directions(instance: Instance, ids: list[int]) -> Iterator[RationalPoint]:
    """Directions at infinity at which two of some segments tie without being parallel to them."""
    vectors = {k: vector(instance, k) for k in ids}
    for i, j in combinations(ids, 2):
        v, w = vectors[i], vectors[j]
        if v in (w, (-w[0], -w[1])):
            yield from halving_directions(v, between_middles(instance, i, j), square_root)
            continue
        for sign in (1, -1):
            d = (v[0] + sign * w[0], v[1] + sign * w[1])
            yield d
            yield -d[0], -d[1]


def _inside(p: RationalPoint, corners: list[RationalPoint]) -> bool:
    return all(orientation(corners[k - 1], corners[k], p) > 0 for k in range(3))


def _crossing(
    instance: Instance, ids: list[int], corners: list[RationalPoint]
) -> RationalPoint | None:
    """A point inside a triangle in which three lines meet."""
    lines = {k: instance.rational_segment(k) for k in ids}
    for i, j in combinations(ids, 2):
        (a, b), (c, d) = lines[i], lines[j]
        v, w = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
        det = v[0] * w[1] - v[1] * w[0]
        if det == 0:
            continue
        t = ((c[0] - a[0]) * w[1] - (c[1] - a[1]) * w[0]) / det
        p = (a[0] + t * v[0], a[1] + t * v[1])
        if _inside(p, corners):
            count = sum(orientation(*lines[k], p) == 0 for k in ids)
            return p if count >= 3 else None
    return None


def _tie(
    instance: Instance,
    ids: list[int],
    exact: list[RationalPoint],
    corners: list[tuple[Any, Any, Any]],
    start: list[float],
    sense: float,
) -> RationalPoint | None:
    """A rational point inside a triangle where the best of some segments tie, near a guess."""
    forms = {k: exact_forms(instance, k, corners, sense) for k in ids}
    a = ids[0]
    for b, c in combinations(ids[1:], 2):
        f, g = exact_cubic(forms[a], forms[b]), exact_cubic(forms[a], forms[c])
        with ctx.workprec(2 * BITS):
            box = enclosed(f, g, start[0], start[1], BITS)
            if box is None:
                continue
            x, y = box[0].mid(), box[1].mid()
            weights = (1 - x - y, x, y)
            px, py = (
                _simplest(
                    sum((w * _ball(z[k]) for w, z in zip(weights, exact, strict=True)), arb(0))
                )
                for k in range(2)
            )
        p = (px, py)
        return p if _inside(p, exact) and _best_tie(instance, ids, p, sense) else None
    return None


def _ball(value: Fraction) -> arb:
    return arb(value.numerator) / arb(value.denominator)


def _simplest(value: arb) -> Fraction:
    """A rational with a short denominator near a ball's middle."""
    man, exp = value.mid().man_exp()
    exact = Fraction(int(man)) * Fraction(2) ** int(exp)
    return exact.limit_denominator(2**DENOMINATORS)


def _best_tie(instance: Instance, ids: list[int], p: RationalPoint, sense: float) -> bool:
    """Whether several segments tie exactly at a point and win against the others there."""
    values = []
    for k in ids:
        a, b = instance.rational_segment(k)
        ax, ay, bx, by = a[0] - p[0], a[1] - p[1], b[0] - p[0], b[1] - p[1]
        line = abs(ax * by - ay * bx)
        if line == 0:
            return False
        values.append((ax * bx + ay * by) / line)
    best = max(values) if sense > 0 else min(values)
    return values.count(best) >= FEWEST
