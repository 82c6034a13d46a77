"""Arcs of leaves that are not hard, and cot θ along them."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from harness.diagram.fast.chart import CORNERS, Chart, Weights
from harness.diagram.fast.forms import value_and_gradient
from harness.diagram.fast.prepare import Floats
from harness.diagram.fast.sweeps import stretches_between
from harness.diagram.fast.univariate import rounded

#: Where the slope of cot θ is looked at along a stretch: crowded towards its ends.
_SAMPLES = (1e-9, *((1 - math.cos(math.pi * k / 12)) / 2 for k in range(1, 12)), 1 - 1e-9)


class LeafArc:
    """An arc of a leaf, run through from its first end (r = 0) to its last (r = 1).

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
        cubic = rounded(chart.cubic(*self.pair, self.which))
        self._coefficients: Floats = np.array(cubic)
        self.stretches = stretches_between(cubic, *self.ends)
        self._forms = [chart.rounded_forms(k) for k in self.pair]
        self._w: list[float] = chart.rounded_corners[:, 2].tolist()

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
        return max(signs, key=self._gain_on_the_left)

    def _gain_on_the_left(self, which: int) -> float:
        """How fast the segment to the left gains on the other to the left of a curve, at r = ½."""
        try:
            other = LeafArc(self.chart, self.arc, which)
        except ArithmeticError:
            return -math.inf
        p, q, middle = other.at(0.4), other.at(0.6), other.at(0.5)
        normal = other.tangent(middle)  # F > 0 to its left
        along = normal[1] * (q[1] - p[1]) + normal[2] * (q[2] - p[2])
        sense = 1 if self.chart.diagram.objective == "smallest" else -1
        return math.copysign(1.0, _linear(other._forms[1], middle)) * sense * along

    def at(self, r: float) -> Weights:
        """The point of the arc at r ∈ [0, 1]; every stretch takes an equal part of that."""
        count = len(self.stretches)
        if r <= 0.0 or r >= 1.0:
            return self.ends[r >= 1.0]
        k = min(int(r * count), count - 1)
        return self.stretches[k].at(r * count - k)

    def tangent(self, weights: Weights) -> Weights:
        """A direction along the curve, with F > 0 to its left."""
        out = np.zeros(3)
        value_and_gradient(self._coefficients, weights[1], weights[2], out)
        _, fx, fy = out.tolist()
        return fx - fy, fy, -fx

    def point(self, r: float) -> tuple[float, float]:
        """The point of the plane at r; a direction at infinity."""
        return self.chart.plane(self.at(r))

    def is_far(self, end: int) -> bool:
        """Whether an end is at infinity."""
        return _linear(self._w, self.ends[end]) == 0

    # -- cot θ ----------------------------------------------------------------------------------

    def cotangents(self) -> list[float]:
        """Values of cot θ between the ends: close to them, and where it turns."""
        values = [self._jet(self.at(r))[0] for r in (1e-9, 1 - 1e-9)]
        count = len(self.stretches)
        samples = [(k + r) / count for k in range(count) for r in _SAMPLES]
        slopes = [self._slope(r) for r in samples]
        if self.which == 0:
            # cot θ is infinite where the arc crosses the line that both segments are on.
            points = [self.at(r) for r in samples]
            line = [_linear(self._forms[0], p) for p in points]
            values += [
                math.copysign(math.inf, _polar(self._forms[0], p, p))
                for p, one, two in zip(points, line, line[1:], strict=False)
                if one * two < 0
            ]
            values += [self._at_line(end) for end in range(2) if self._ends_on_line(end)]
        for k in range(len(samples) - 1):
            if slopes[k] * slopes[k + 1] < 0:
                turn = brentq(self._slope, samples[k], samples[k + 1], xtol=1e-12)
                values.append(self._jet(self.at(turn))[0])
        return values

    def _ends_on_line(self, end: int) -> bool:
        """Whether an end lies on a side or in a corner of the leaf that is on a segment's line, and
        is not the segment's endpoint."""
        arrays = self.chart.diagram.arrays
        name = int(arrays.arcs[self.arc, end])
        if name < 0:
            return False
        place = int(arrays.place[name])
        corners = {place // 2, (place // 2 + place % 2) % 3}
        form = self._forms[0]
        return all(form[k] == 0 for k in corners) and (place % 2 == 1 or form[3 + place // 2] != 0)

    def _at_line(self, end: int) -> float:
        """cot θ at an end that lies on the line of both segments."""
        return math.copysign(math.inf, _polar(self._forms[0], self.ends[end], self.ends[end]))

    def _slope(self, r: float) -> float:
        weights = self.at(r)
        return self._jet(weights, self.tangent(weights))[1]

    def _jet(self, p: Weights, d: Weights = (0.0, 0.0, 0.0)) -> tuple[float, float]:
        """cot θ at a point and its derivative in a direction.

        From the segment whose line is farther away, compared with its distance from the corners.
        """
        form = max(self._forms, key=lambda f: abs(_linear(f, p)) / max(map(abs, f[:3])))
        line, d_line = _linear(form, p), _linear(form, d)
        w, d_w = _linear(self._w, p), _linear(self._w, d)
        q, d_q = _polar(form, p, p), 2 * _polar(form, p, d)
        if line * w == 0:
            return math.copysign(math.inf, q), 0.0
        slope = (d_q - q * d_line / line - q * d_w / w) / (abs(line) * w)
        return q / (abs(line) * w), slope

    def limit(self, end: int) -> float:
        """The limit of cot θ towards an end of the arc at which its edge ends."""
        arrays = self.chart.diagram.arrays
        name = int(arrays.arcs[self.arc, end])
        place = int(arrays.place[name]) if name >= 0 else 1
        if self.is_far(end) or (name < 0 and self.chart.is_crossing):
            return math.inf
        if place % 2:
            on_line = self.which == 0 and self._ends_on_line(end)
            return self._at_line(end) if on_line else self._jet(self.ends[end])[0]
        corner = place // 2
        for form in self._forms:
            line, q = form[corner], form[3 + corner]
            if line != 0:
                return q / (abs(line) * self._w[corner])
            if q != 0:
                return math.copysign(math.inf, q)
        return self._limit_at_endpoint(corner, end)

    def _limit_at_endpoint(self, corner: int, end: int) -> float:
        """The limit at a common endpoint of both segments, where θ depends on the direction alone.

        At C + εX, up to terms in ε², Q is 2ε q(C, X) and L is ε L(X).
        """
        triangle = self.stretches[-1 if end else 0].triangle
        towards = triangle.to_leaf(triangle.far_point(triangle.heading()))
        form = max(self._forms, key=lambda f: abs(_linear(f, towards)) / max(map(abs, f[:3])))
        line, q = _linear(form, towards), 2 * _polar(form, CORNERS[corner], towards)
        return q / (abs(line) * self._w[corner]) if line else math.copysign(math.inf, q)


def _linear(form: list[float], p: Weights) -> float:
    return form[0] * p[0] + form[1] * p[1] + form[2] * p[2]


def _polar(form: list[float], p: Weights, q: Weights) -> float:
    """The polar form of Q at two points."""
    return (
        form[3] * p[0] * q[0] + form[4] * p[1] * q[1] + form[5] * p[2] * q[2]
        + form[6] * (p[0] * q[1] + p[1] * q[0])
        + form[7] * (p[0] * q[2] + p[2] * q[0])
        + form[8] * (p[1] * q[2] + p[2] * q[1])
    )  # fmt: skip
