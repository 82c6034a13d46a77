"""Arcs of a leaf, one point at a time.

An arc is swept by segments, one for every r in (0, 1), each of which meets its curve F = 0 just
once, so that F changes sign there.  Which segments do that follows from why the leaf was accepted
(:mod:`harness.diagram.fast.leaves`):

cone     F increases along a direction d: parallels to d through the points of the arc's chord.
radial   F has a double zero at a corner C and one zero on every ray from there.  An arc that does
         not end at C is swept by rays; one that does may be nearly straight, and is swept across:
         between the ray along which it leaves C and the ray through its other end.
saddle   rays from the only critical point of F, through the points of the arc's chord.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from harness.diagram.fast.chart import (
    CORNERS,
    Chart,
    Weights,
    rounded,
    single_zero,
    value_at,
    zeros_inside,
)
from harness.diagram.fast.forms import STEPS, gradient_controls, value_and_gradient
from harness.diagram.fast.leaves import has_cone
from harness.diagram.fast.prepare import Floats

Segment = tuple[Weights, Weights]
#: The coefficients of F that are of first order in the weight of a corner, in the order of the
#: directions from there to the next corner and to the one after that.
_NEAR = ((5, 9, 7), (8, 9, 3), (4, 9, 6))


def combination(p: Weights, q: Weights, t: float) -> Weights:
    """(1 − t) p + t q."""
    s = 1.0 - t
    return s * p[0] + t * q[0], s * p[1] + t * q[1], s * p[2] + t * q[2]


class LeafArc:
    """An arc of a leaf that is not hard, run through from its first end (r = 0) to its last (r = 1).

    ``pair``: the segments to the left and right.
    """

    def __init__(self, chart: Chart, arc: int, which: int | None = None) -> None:
        """``which``: the curve (see :meth:`Chart.signs`), found out if not given."""
        self.chart = chart
        self.arc = arc
        arrays = chart.diagram.arrays
        self.pair = int(arrays.owner[arrays.arcs[arc, 2]]), int(arrays.owner[arrays.arcs[arc, 3]])
        self.ends = chart.end(arc, 0), chart.end(arc, 1)
        self.which = self._which() if which is None else which
        self.cubic = [rounded(c) for c in chart.cubic(*self.pair, self.which)]
        self._coefficients: Floats = np.array(self.cubic)
        self._across = self._sweep()

    def _which(self) -> int:
        """The curve that the arc is part of.

        Where that is open, a port inside a side tells; else the segment that must win to the left.
        """
        signs = self.chart.signs(*self.pair)
        if len(signs) == 1:
            return signs[0]
        arrays = self.chart.diagram.arrays
        for end in arrays.arcs[self.arc, :2].tolist():
            if end >= 0 and arrays.place[end] % 2:
                return self.chart.port_on_side(end).sign
        one, two = (LeafArc(self.chart, self.arc, which) for which in signs)
        return one.which if one.gain_to_the_left() > two.gain_to_the_left() else two.which

    def gain_to_the_left(self) -> float:
        """How fast the segment to the left gains on the other to the left of r = ½, relative to all
        slopes of F: positive if this is the right curve."""
        sense = 1 if self.chart.diagram.objective == "smallest" else -1
        weights = self.at(0.5)
        slope = self.tangent(weights)
        (one, two), (_, x, y) = (self.at(0.4), self.at(0.6)), weights
        along = slope[1] * (two[1] - one[1]) + slope[2] * (two[2] - one[2])
        line = self.chart.forms(self.pair[1])[:3]
        side = sum(w * rounded(value) for w, value in zip(weights, line, strict=True))
        return math.copysign(1.0, side) * sense * along if x + y else 0.0

    def tangent(self, weights: Weights) -> Weights:
        """A direction along the curve, with F > 0 to its left; F′ turned by a right angle."""
        out = np.zeros(3)
        value_and_gradient(self._coefficients, weights[1], weights[2], out)
        _, fx, fy = out.tolist()
        return fx - fy, fy, -fx

    def at(self, r: float) -> Weights:
        """The point of the arc at r ∈ [0, 1]."""
        if r <= 0.0:
            return self.ends[0]
        if r >= 1.0:
            return self.ends[1]
        p, q = self._across(r)
        return combination(p, q, self._zero_between(p, q))

    def _zero_between(self, p: Weights, q: Weights) -> float:
        """Where F is zero between two points; at the end where it is nearest to zero, if rounding
        leaves no change of sign."""
        b = _along(self.cubic, p, q)
        signs = [c > 0 for c in b if c != 0]
        if signs and signs[0] != signs[-1]:
            return single_zero(b, signs[0])
        return 0.0 if b[0] != 0 and abs(b[0]) < abs(b[3]) else 1.0

    # -- sweeps ---------------------------------------------------------------------------------

    def _sweep(self) -> Callable[[float], Segment]:
        controls = np.zeros((6, 2))
        if has_cone(self._coefficients, 0.0, controls):
            gx, gy = controls.sum(axis=0).tolist()
            return self._parallels((-gx - gy, gx, gy))
        for corner in range(3):
            if all(self.cubic[c] == 0 for c in STEPS[corner]):
                return self._from_corner(corner)
        return self._rays(self._critical_point())

    def _parallels(self, d: Weights) -> Callable[[float], Segment]:
        def across(r: float) -> Segment:
            x = combination(*self.ends, r)
            reach = [-a / b for a, b in zip(x, d, strict=True) if b > 0]
            back = [-a / b for a, b in zip(x, d, strict=True) if b < 0]
            low, high = max(reach), min(back)
            return _moved(x, d, low), _moved(x, d, high)

        return across

    def _rays(self, centre: Weights) -> Callable[[float], Segment]:
        def across(r: float) -> Segment:
            x = combination(*self.ends, r)
            d = x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]
            out = [-a / b for a, b in zip(centre, d, strict=True) if b < 0]
            return centre, _moved(centre, d, min(out))

        return across

    def _from_corner(self, corner: int) -> Callable[[float], Segment]:
        at = CORNERS[corner]
        if at not in self.ends:
            return self._rays(at)
        other = self.ends[1] if self.ends[0] == at else self.ends[0]
        u = other[(corner + 2) % 3] / (1.0 - other[corner])
        far_ends = self.far_point(corner, self.heading(corner)), self.far_point(corner, u)
        reach = 1.0 - other[corner]

        def across(r: float) -> Segment:
            t = reach * (r if self.ends[0] == at else 1.0 - r)
            return combination(at, far_ends[0], t), combination(at, far_ends[1], t)

        return across

    def heading(self, corner: int) -> float:
        """The direction in which the curve leaves a corner where F has a double zero, as the
        parameter of a point on the side opposite to it."""
        near = [self.cubic[c] for c in _NEAR[corner]]
        zeros = zeros_inside(near)
        if len(zeros) == 1:
            return zeros[0]
        return 0.0 if abs(near[0]) < abs(near[2]) else 1.0

    @staticmethod
    def far_point(corner: int, u: float) -> Weights:
        """The point with parameter u on the side opposite to a corner."""
        return combination(CORNERS[(corner + 1) % 3], CORNERS[(corner + 2) % 3], u)

    def _critical_point(self) -> Weights:
        """The critical point of F in the triangle, by Newton's method from where it was found."""
        controls, out = np.zeros((6, 2)), np.zeros(3)
        gradient_controls(self._coefficients, controls)
        rows = controls[[0, 3, 4, 1, 5, 2]]  # 200 110 101 020 011 002
        x, y = self.chart.diagram.leaves.points[self.chart.row].tolist()
        for _ in range(20):
            weights = 1.0 - x - y, x, y
            value_and_gradient(self._coefficients, x, y, out)
            to_x = 2 * sum(w * (rows[b] - rows[a]) for w, (a, b) in
                           zip(weights, ((0, 1), (1, 3), (2, 4)), strict=True))
            to_y = 2 * sum(w * (rows[b] - rows[a]) for w, (a, b) in
                           zip(weights, ((0, 2), (1, 4), (2, 5)), strict=True))
            det = to_x[0] * to_y[1] - to_x[1] * to_y[0]
            dx = (out[1] * to_y[1] - out[2] * to_y[0]) / det
            dy = (out[2] * to_x[0] - out[1] * to_x[1]) / det
            x, y = x - dx, y - dy
            if abs(dx) + abs(dy) < 1e-15:
                break
        if not min(x, y, 1.0 - x - y) > 0.0:
            raise ArithmeticError(f"leaf {self.chart.leaf} has no reason to be simple")
        return 1.0 - x - y, x, y


def _moved(x: Weights, d: Weights, t: float) -> Weights:
    return x[0] + t * d[0], x[1] + t * d[1], x[2] + t * d[2]


def _along(b: list[float], p: Weights, q: Weights) -> list[float]:
    """The Bernstein coefficients of a cubic on the segment pq, by blossoming."""
    one, two = _step(b, p), _step(b, q)
    pp, pq, qq = _step_two(one, p), _step_two(one, q), _step_two(two, q)
    return [_dot(pp, p), _dot(pp, q), _dot(pq, q), _dot(qq, q)]


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


__all__ = ["LeafArc", "combination", "value_at"]
