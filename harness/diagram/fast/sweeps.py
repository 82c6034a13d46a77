"""Stretches of a curve F = 0 in a triangle, one point at a time.

A stretch is swept by segments, one for every r in (0, 1), each of which meets it just once, so that
F changes sign there.  There are two kinds of triangles in which that is easy:

cone     F increases along a direction d: segments parallel to d, through points of the chord.
radial   F has a double zero at a corner C; on a ray it is s²(α + sβ) at distance s, so there is one
         more zero at most.  A stretch that does not end at C is swept by rays; one that does may be
         nearly straight, and is swept across: between the ray along which it leaves C and the ray
         through its other end.

Either way the curve is a graph over a coordinate, and its ends on the boundary, sorted by it,
belong together in pairs.  Other triangles are halved.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from harness.diagram.fast.chart import CORNERS, Weights
from harness.diagram.fast.forms import SIDES, STEPS
from harness.diagram.fast.leaves import has_cone
from harness.diagram.fast.univariate import single_zero, zeros_inside

Segment = tuple[Weights, Weights]
#: The coefficients of F that are of first order in the weight of a corner, in the order of the
#: directions from there to the next corner and to the one after that.
_NEAR = ((5, 9, 7), (8, 9, 3), (4, 9, 6))
#: The multiplicities of corners 0, 1, 2 in each coefficient's index.
_INDICES = (
    (0, 0, 0), (1, 1, 1), (2, 2, 2), (0, 0, 1), (0, 0, 2), (0, 1, 1), (1, 1, 2), (0, 2, 2),
    (1, 2, 2), (0, 1, 2),
)  # fmt: skip
#: Sides are cut here, lest a symmetric curve runs through the cut.
_CUT = 0.4877
_DEEPEST = 80


def combination(p: Weights, q: Weights, t: float) -> Weights:
    """(1 − t) p + t q."""
    s = 1.0 - t
    return s * p[0] + t * q[0], s * p[1] + t * q[1], s * p[2] + t * q[2]


@dataclass(frozen=True)
class Triangle:
    """A part of a leaf: its corners in the leaf's weights, and F in Bernstein form on it.

    ``centre``: the number of the corner at which F has a double zero, if that is what makes the
    triangle easy; else ``increase``, a direction (in the triangle's weights) in which F increases.
    """

    corners: tuple[Weights, Weights, Weights]
    cubic: list[float]
    centre: int | None = None
    increase: Weights = (0.0, 0.0, 0.0)

    def to_leaf(self, p: Weights) -> Weights:
        """A point of the triangle in the weights of the leaf."""
        a, b, c = self.corners
        return _sum3(p[0], a, p[1], b, p[2], c)

    def from_leaf(self, p: Weights) -> Weights:
        """The reverse."""
        if self.corners == CORNERS:
            return p
        z, x, y = np.linalg.solve(np.array(self.corners).T, np.array(p)).tolist()
        return z, x, y

    def coordinate(self, p: Weights) -> float:
        """That over which the curve is a graph: across the increase of F, or about the centre."""
        if self.centre is None:
            _, dx, dy = self.increase
            return dx * p[2] - dy * p[1]
        k = self.centre
        if p == CORNERS[k]:
            return self.heading()
        return p[(k + 2) % 3] / (p[(k + 1) % 3] + p[(k + 2) % 3])

    def heading(self) -> float:
        """The direction in which the curve leaves the centre, as the parameter of a point on the
        side opposite to it."""
        assert self.centre is not None
        near = [self.cubic[c] for c in _NEAR[self.centre]]
        zeros = zeros_inside(near)
        if zeros:
            return zeros[0]
        return 0.0 if abs(near[0]) < abs(near[2]) else 1.0

    def far_point(self, u: float) -> Weights:
        """The point with parameter u on the side opposite to the centre."""
        assert self.centre is not None
        return combination(CORNERS[(self.centre + 1) % 3], CORNERS[(self.centre + 2) % 3], u)


@dataclass(frozen=True)
class Stretch:
    """A part of the curve in an easy triangle, between two points in the triangle's weights."""

    triangle: Triangle
    ends: tuple[Weights, Weights]

    def at(self, r: float) -> Weights:
        """The point at r ∈ [0, 1], in the weights of the leaf."""
        if r <= 0.0 or r >= 1.0:
            return self.triangle.to_leaf(self.ends[r >= 1.0])
        p, q = self._across(r)
        b = _along(self.triangle.cubic, p, q)
        signs = [c > 0 for c in b if c != 0]
        if signs and signs[0] != signs[-1]:
            t = single_zero(b, signs[0])
        else:  # rounding leaves no change of sign: take the end where F is nearest to zero
            t = 0.0 if b[0] != 0 and abs(b[0]) < abs(b[3]) else 1.0
        return self.triangle.to_leaf(combination(p, q, t))

    def reversed(self) -> Stretch:
        """The same part, the other way round."""
        return replace(self, ends=self.ends[::-1])

    def _across(self, r: float) -> Segment:
        if self.triangle.centre is None:
            x, d = combination(*self.ends, r), self.triangle.increase
            back = [-a / b for a, b in zip(x, d, strict=True) if b > 0]
            on = [-a / b for a, b in zip(x, d, strict=True) if b < 0]
            return _moved(x, d, max(back)), _moved(x, d, min(on))
        k, centre = self.triangle.centre, CORNERS[self.triangle.centre]
        if centre not in self.ends:
            u = self.triangle.coordinate(combination(*self.ends, r))
            return centre, self.triangle.far_point(u)
        outwards = self.ends[0] == centre
        other = self.ends[1 if outwards else 0]
        t = (r if outwards else 1.0 - r) * (1.0 - other[k])
        rays = self.triangle.heading(), self.triangle.coordinate(other)
        p, q = (self.triangle.far_point(u) for u in rays)
        return combination(centre, p, t), combination(centre, q, t)


def easy_triangles(cubic: list[float]) -> Iterator[Triangle]:
    """Triangles, all of them easy, that cover the curve in the leaf.

    Raises ArithmeticError if the curve cannot be resolved in doubles.
    """
    waiting = [(Triangle((CORNERS[0], CORNERS[1], CORNERS[2]), cubic), 0)]
    while waiting:
        triangle, depth = waiting.pop()
        b = triangle.cubic
        if all(c >= 0 for c in b) or all(c <= 0 for c in b):
            continue
        easy = _as_easy(triangle)
        if easy is not None:
            yield easy
        elif depth == _DEEPEST:
            raise ArithmeticError("a curve that doubles cannot resolve")
        else:
            waiting += [(half, depth + 1) for half in _halves(triangle, depth)]


def _as_easy(triangle: Triangle) -> Triangle | None:
    controls = np.zeros((6, 2))
    if has_cone(np.array(triangle.cubic), 0.0, controls):
        gx, gy = controls.sum(axis=0).tolist()
        return replace(triangle, increase=(-gx - gy, gx, gy))
    for k in range(3):
        if _is_double(triangle, k):
            near = [triangle.cubic[c] for c in _NEAR[k]]
            far = [triangle.cubic[c] for c in SIDES[k]]
            return replace(triangle, centre=k) if max(map(_changes, (near, far))) <= 1 else None
    return None


def _is_double(triangle: Triangle, corner: int) -> bool:
    return all(triangle.cubic[c] == 0 for c in STEPS[corner])


def _changes(b: list[float]) -> int:
    signs = [c > 0 for c in b if c != 0]
    return sum(x != y for x, y in pairwise(signs))


def _halves(triangle: Triangle, depth: int) -> list[Triangle]:
    """Both parts of a triangle, cut across its longest side or, every other time, from a double
    zero."""
    corners = triangle.corners
    lengths = [
        sum((x - y) ** 2 for x, y in zip(corners[k - 2], corners[k - 1], strict=True))
        for k in range(3)
    ]
    k = lengths.index(max(lengths))
    double = [corner for corner in range(3) if _is_double(triangle, corner)]
    if double and depth % 2:
        k = double[0]
    middle = combination(CORNERS[(k + 1) % 3], CORNERS[(k + 2) % 3], _CUT)
    result = []
    for replaced in ((k + 1) % 3, (k + 2) % 3):
        part = [middle if c == replaced else CORNERS[c] for c in range(3)]
        result.append(
            Triangle(
                (triangle.to_leaf(part[0]), triangle.to_leaf(part[1]), triangle.to_leaf(part[2])),
                [_blossom(triangle.cubic, *(part[c] for c in index)) for index in _INDICES],
            )
        )
    return result


def stretches(triangle: Triangle) -> list[Stretch]:
    """The curve in an easy triangle: its ends on the boundary, sorted, in pairs."""
    ends: list[Weights] = []
    for k in range(3):
        side = [triangle.cubic[c] for c in SIDES[(k + 2) % 3]]
        start, end = CORNERS[k], CORNERS[(k + 1) % 3]
        ends += [combination(start, end, t) for t in zeros_inside(side)]
        before = [triangle.cubic[c] for c in SIDES[(k + 1) % 3]][::-1]
        if triangle.centre != k and side[0] == 0 and _germ(before) * _germ(side) < 0:
            ends.append(start)
    if len(ends) % 2 and triangle.centre is not None:
        ends.append(CORNERS[triangle.centre])
    ends.sort(key=triangle.coordinate)
    if len(ends) % 2:
        raise ArithmeticError("a curve that doubles cannot resolve")
    return [Stretch(triangle, (p, q)) for p, q in zip(ends[::2], ends[1::2], strict=True)]


def _germ(b: list[float]) -> float:
    return next((c for c in b if c != 0), 0.0)


def stretches_between(cubic: list[float], start: Weights, end: Weights) -> list[Stretch]:
    """The stretches that lead along the curve from one of its points in the leaf to another.

    Raises ArithmeticError if there is no way.
    """
    triangles = list(easy_triangles(cubic))
    if len(triangles) == 1 and triangles[0].corners == CORNERS:
        return [Stretch(triangles[0], (start, end))]
    every = [stretch for triangle in triangles for stretch in stretches(triangle)]
    if not every:
        raise ArithmeticError("there is no curve in the leaf")
    first, last = _nearest(every, start), _nearest(every, end)
    if first is last:
        return [_cut(_cut(first, 0, start), 1, end)]
    for away in (first, first.reversed()):
        way = [_cut(away, 0, start)]
        left = [stretch for stretch in every if stretch is not first]
        while left:
            following = _continuation(left, way[-1])
            if following is None:
                break
            k, onwards = following
            if left.pop(k) is last:
                return [*way, _cut(onwards, 1, end)]
            way.append(onwards)
    raise ArithmeticError("no way along the curve was found")


def _cut(stretch: Stretch, which: int, point: Weights) -> Stretch:
    """A stretch that begins (``which`` = 0) or ends (1) at a given point of it instead."""
    local = stretch.triangle.from_leaf(point)
    return replace(
        stretch, ends=(local, stretch.ends[1]) if which == 0 else (stretch.ends[0], local)
    )


def _nearest(every: list[Stretch], point: Weights) -> Stretch:
    """The stretch on which a point lies."""

    def distance(stretch: Stretch) -> float:
        local = stretch.triangle.from_leaf(point)
        beyond = max(0.0, -min(local))
        low, high = sorted(stretch.triangle.coordinate(p) for p in stretch.ends)
        at = stretch.triangle.coordinate(local)
        outside = max(0.0, low - at, at - high) / max(high - low, 1e-300)
        return beyond + min(outside, 1.0)

    return min(every, key=distance)


def _continuation(left: list[Stretch], before: Stretch) -> tuple[int, Stretch] | None:
    """Which stretch goes on where another ends, and it, directed away from there."""
    end = before.at(1.0)
    gaps = [
        (_gap(stretch.at(float(which)), end), k, which)
        for k, stretch in enumerate(left)
        for which in (0, 1)
    ]
    gap, k, which = min(gaps)
    if gap > 1e-7:
        return None
    return k, left[k].reversed() if which else left[k]


def _gap(p: Weights, q: Weights) -> float:
    return max(abs(x - y) for x, y in zip(p, q, strict=True))


def _moved(x: Weights, d: Weights, t: float) -> Weights:
    return x[0] + t * d[0], x[1] + t * d[1], x[2] + t * d[2]


def _sum3(s: float, p: Weights, t: float, q: Weights, u: float, r: Weights) -> Weights:
    return (
        s * p[0] + t * q[0] + u * r[0],
        s * p[1] + t * q[1] + u * r[1],
        s * p[2] + t * q[2] + u * r[2],
    )


# --- blossoming ----------------------------------------------------------------------------------


def _along(b: list[float], p: Weights, q: Weights) -> list[float]:
    """The Bernstein coefficients of a cubic on the segment pq."""
    one, two = _step(b, p), _step(b, q)
    pp, pq, qq = _step_two(one, p), _step_two(one, q), _step_two(two, q)
    return [_dot(pp, p), _dot(pp, q), _dot(pq, q), _dot(qq, q)]


def _blossom(b: list[float], p: Weights, q: Weights, r: Weights) -> float:
    return _dot(_step_two(_step(b, p), q), r)


def _step(b: list[float], p: Weights) -> list[float]:
    """One step of de Casteljau's scheme, to the order 200 020 002 110 101 011."""
    z, x, y = p
    return [
        z * b[0] + x * b[3] + y * b[4],
        z * b[5] + x * b[1] + y * b[6],
        z * b[7] + x * b[8] + y * b[2],
        z * b[3] + x * b[5] + y * b[9],
        z * b[4] + x * b[9] + y * b[7],
        z * b[9] + x * b[6] + y * b[8],
    ]


def _step_two(c: list[float], p: Weights) -> Weights:
    z, x, y = p
    return (
        z * c[0] + x * c[3] + y * c[4],
        z * c[3] + x * c[1] + y * c[5],
        z * c[4] + x * c[5] + y * c[2],
    )


def _dot(c: Weights, p: Weights) -> float:
    return c[0] * p[0] + c[1] * p[1] + c[2] * p[2]
