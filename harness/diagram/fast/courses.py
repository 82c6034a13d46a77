"""The ways of the edges of a fast diagram: polylines and ranges of cot θ."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from harness.diagram.fast.chart import Chart, Weights, rounded
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.places import local_arc, node_point
from harness.diagram.fast.sweeps import LeafArc
from harness.diagram.planar_map import Edge, Window

Points = list[tuple[float, float]]

#: Halvings of an arc between two of its ends.
_DEEPEST = 40
#: Where the slope of cot θ is looked at along an arc: crowded towards the ends.
_SAMPLES = (1e-9, *((1 - math.cos(math.pi * k / 12)) / 2 for k in range(1, 12)), 1 - 1e-9)


class ArcCourse:
    """An edge of a fast diagram: a chain of arcs, each in one leaf.

    Nothing is kept between calls.
    """

    def __init__(self, diagram: FastDiagram, edge: int) -> None:
        """``edge``: a row of ``diagram.edges``."""
        self.diagram = diagram
        self.edge = edge

    def polyline(self, tolerance: float, window: Window | None = None) -> NDArray[np.float64]:
        """See :meth:`harness.diagram.planar_map.Edge.polyline`.

        All points lie on the edge up to rounding; its ends are the nodes' points.  A piece is
        halved until its middle is within ``tolerance`` of its chord; that the rest of the piece
        is, too, is not proved.  Raises ValueError if the tolerance is not positive.
        """
        if not tolerance > 0:
            raise ValueError("the tolerance must be positive")
        far = _Far(self.diagram, window)
        points: Points = []
        for half in self.halves():
            piece = self._piece(half >> 1, tolerance, window, far)
            points += piece[::-1] if half & 1 else piece
        return np.array(self._joined(points))

    def halves(self) -> Iterator[int]:
        """The half-arcs of the edge from its start to its end."""
        arrays = self.diagram.arrays
        half, last = self.diagram.edges[self.edge, 2:4].tolist()
        yield half
        while half != last:
            end = arrays.arcs[half >> 1, 1 - (half & 1)]
            half = int(arrays.inward[arrays.mate[end]])
            yield half

    def _joined(self, points: Points) -> Points:
        """The points from node to node, none repeated."""
        start, end = self.diagram.edges[self.edge, :2].tolist()
        if start < 0:
            points[-1] = points[0]
        else:
            if self._is_finite(start):
                points[0] = node_point(self.diagram, start)
            if self._is_finite(end):
                points[-1] = node_point(self.diagram, end)
        size = max(max(abs(x), abs(y)) for x, y in points)
        kept, last = [points[0]], points[-1]
        for p in points[1:-1]:
            # Neighbouring leaves find their common port each on their own.
            if min(math.dist(p, kept[-1]), math.dist(p, last)) > 1e-14 * size:
                kept.append(p)
        return [*kept, last]

    def _is_finite(self, node: int) -> bool:
        inner = len(self.diagram.arrays.vertices) + len(self.diagram.nodes.corners)
        return node < inner or self.diagram.domain != "plane"

    def _local(self, arc: int) -> Edge | None:
        """The edge of a hard leaf's own diagram that is this arc; None in other leaves."""
        local = self.diagram.solved.get(int(self.diagram.arrays.leaf_of_arc[arc]))
        if local is None or local.diagram is None:
            return None
        return local.diagram.edges[local_arc(self.diagram.arrays, arc)]

    def _leaf_arc(self, arc: int) -> LeafArc:
        return LeafArc(Chart(self.diagram, int(self.diagram.arrays.leaf_of_arc[arc])), arc)

    def _piece(self, arc: int, tolerance: float, window: Window | None, far: _Far) -> Points:
        """The points of an arc from its first end to its last."""
        local = self._local(arc)
        if local is not None:
            return [(x, y) for x, y in local.polyline(tolerance, window).tolist()]
        leaf_arc = self._leaf_arc(arc)
        low, high = (far.cut(leaf_arc, end) for end in (0, 1))
        return list(_refined(leaf_arc, low, high, tolerance))

    def cotangent_range(self) -> tuple[float, float]:
        """See :attr:`harness.diagram.planar_map.Edge.cotangent_range`.

        The limits at both ends, and in between the values where the slope of cot θ along the edge
        changes sign; it is looked at in a dozen points of each arc.  So both numbers belong to the
        closure of the edge (up to rounding), and they bound the whole edge unless cot θ turns twice
        between neighbouring points (it turns four times at most on a whole bisector).
        """
        values: list[float] = []
        first, last = self.diagram.edges[self.edge, 2:4].tolist()
        for half in self.halves():
            local = self._local(half >> 1)
            if local is not None:
                values += local.cotangent_range
                continue
            leaf_arc = self._leaf_arc(half >> 1)
            values += _turning_values(leaf_arc)
            if half == first:
                values.append(_limit(leaf_arc, half & 1))
            if half == last:
                values.append(_limit(leaf_arc, 1 - (half & 1)))
            values += [_cotangent(leaf_arc, leaf_arc.at(r)) for r in (1e-9, 1 - 1e-9)]
        return min(values), max(values)


class _Far:
    """Where unbounded ends are cut off: well outside the window and everything else."""

    def __init__(self, diagram: FastDiagram, window: Window | None) -> None:
        points = diagram.instance.segments.reshape(-1, 2)
        low, high = points.min(axis=0), points.max(axis=0)
        reach = float((high - low).max())
        low, high = low - reach, high + reach
        if window is not None:
            low, high = np.minimum(low, window[:2]), np.maximum(high, window[2:])
        self.centre = (low + high) / 2
        # Beyond the great triangle around all segments nothing but straight ends is left.
        self.radius = float(np.hypot(*(high - low))) + 8 * reach

    def cut(self, arc: LeafArc, end: int) -> float:
        """The parameter at which to leave off towards an end: the end itself unless it is at
        infinity."""
        chart = arc.chart
        w = sum(
            weight * corner[2]
            for weight, corner in zip(arc.ends[end], chart.rounded_corners.tolist(), strict=True)
        )
        if w != 0:
            return float(end)
        step = 0.25
        while step > 1e-300:
            r = 1.0 - step if end else step
            if math.dist(chart.plane(arc.at(r)), self.centre) > self.radius:
                return r
            step /= 2
        return r


def _refined(arc: LeafArc, low: float, high: float, tolerance: float) -> Iterator[tuple[float, float]]:
    """The points of an arc from parameter ``low`` to ``high``."""
    plane = arc.chart.plane
    ends = plane(arc.at(low)), plane(arc.at(high))
    yield ends[0]
    waiting = [(low, ends[0], high, ends[1], 0)]
    while waiting:
        a, p, b, q, depth = waiting.pop()
        middle = (a + b) / 2
        m = plane(arc.at(middle))
        if (depth >= 1 and _distance_to_chord(m, p, q) <= tolerance) or depth == _DEEPEST:
            yield m
            yield q
        else:
            waiting += [(middle, m, b, q, depth + 1), (a, p, middle, m, depth + 1)]


def _distance_to_chord(
    m: tuple[float, float], p: tuple[float, float], q: tuple[float, float]
) -> float:
    length = math.dist(p, q)
    if length == 0:
        return math.dist(m, p)
    along = ((m[0] - p[0]) * (q[0] - p[0]) + (m[1] - p[1]) * (q[1] - p[1])) / length**2
    along = min(1.0, max(0.0, along))
    return math.dist(m, (p[0] + along * (q[0] - p[0]), p[1] + along * (q[1] - p[1])))


# --- cot θ ---------------------------------------------------------------------------------------


def _jet(arc: LeafArc, weights: Weights, d: Weights) -> tuple[float, float]:
    """cot θ at a point and its derivative in a direction, times a positive factor.

    From the segment whose line is farther away, compared with its values at the corners.
    """
    best, result = -1.0, (math.inf, 0.0)
    ws = arc.chart.rounded_corners[:, 2].tolist()
    w, dw = _linear(ws, weights), _linear(ws, d)
    for k in arc.pair:
        form = [rounded(x) for x in arc.chart.forms(k)]
        line, d_line = _linear(form, weights), _linear(form, d)
        q, d_q = _polar(form, weights, weights), 2 * _polar(form, weights, d)
        weight = abs(line) / max(map(abs, form[:3]))
        if weight > best:
            best = weight
            if line * w == 0:
                result = math.copysign(math.inf, q), 0.0
            else:
                slope = (d_q * line * w - q * (d_line * w + line * dw)) / (line * w) / (line * w)
                result = q / (abs(line) * w), math.copysign(1.0, line) * slope
    return result


def _cotangent(arc: LeafArc, weights: Weights) -> float:
    return _jet(arc, weights, (0.0, 0.0, 0.0))[0]


def _linear(form: list[float], weights: Weights) -> float:
    return sum(f * w for f, w in zip(form[:3], weights, strict=True))


def _polar(form: list[float], p: Weights, q: Weights) -> float:
    """The polar form of Q at two points."""
    return (
        form[3] * p[0] * q[0] + form[4] * p[1] * q[1] + form[5] * p[2] * q[2]
        + form[6] * (p[0] * q[1] + p[1] * q[0])
        + form[7] * (p[0] * q[2] + p[2] * q[0])
        + form[8] * (p[1] * q[2] + p[2] * q[1])
    )  # fmt: skip


def _turning_values(arc: LeafArc) -> list[float]:
    """The values of cot θ where its slope along an arc changes sign between two samples."""

    def slope(r: float) -> float:
        weights = arc.at(r)
        return _jet(arc, weights, arc.tangent(weights))[1]

    slopes = [slope(r) for r in _SAMPLES]
    return [
        _cotangent(arc, arc.at(brentq(slope, a, b, xtol=1e-12)))
        for a, b, x, y in zip(_SAMPLES, _SAMPLES[1:], slopes, slopes[1:], strict=False)
        if x * y < 0
    ]


def _limit(arc: LeafArc, end: int) -> float:
    """The limit of cot θ towards an end of an arc at which its edge ends."""
    chart, weights = arc.chart, arc.ends[end]
    arrays = chart.diagram.arrays
    name = int(arrays.arcs[arc.arc, end])
    if name < 0:
        return math.inf if chart.is_crossing else _cotangent(arc, weights)
    place = int(arrays.place[name])
    if place % 2:
        return _cotangent(arc, weights)
    corner = place // 2
    if chart.corners[corner][2] == 0:
        return math.inf
    for k in arc.pair:
        line, q = chart.forms(k)[corner], chart.forms(k)[3 + corner]
        if line != 0:
            return rounded(q / (abs(line) * chart.corners[corner][2]))
        if q != 0:
            return math.copysign(math.inf, rounded(q))
    return _limit_at_endpoint(arc, corner)


def _limit_at_endpoint(arc: LeafArc, corner: int) -> float:
    """The limit at a common endpoint of both segments, where θ depends on the direction alone."""
    towards = arc.far_point(corner, arc.heading(corner))
    at = [0.0, 0.0, 0.0]
    at[corner] = 1.0
    values = []
    for k in arc.pair:
        form = [rounded(x) for x in arc.chart.forms(k)]
        line = _linear(form, towards)
        q = 2 * _polar(form, (at[0], at[1], at[2]), towards)
        w = float(arc.chart.rounded_corners[corner, 2])
        values.append((abs(line) / max(map(abs, form[:3])), q / (abs(line) * w) if line else math.copysign(math.inf, q)))
    return max(values)[1]
