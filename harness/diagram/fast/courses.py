"""The ways of the edges of a fast diagram: polylines and ranges of cot θ."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from harness.diagram.chords import (
    SAME,
    BisectorChords,
    Position,
    allowed_in,
    default_window,
    refined,
)
from harness.diagram.fast.chart import Chart
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.leaf_arcs import LeafArc
from harness.diagram.fast.node_points import local_arc, node_point
from harness.diagram.planar_map import Edge, Window


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

        All points lie on the edge up to rounding; its ends are the nodes' points.

        Raises ValueError if the tolerance is not positive.
        """
        if not tolerance > 0:
            raise ValueError("the tolerance must be positive")
        horizon = _Horizon(self.diagram, window)
        view = window or default_window(self.diagram.instance.segments.reshape(-1, 2))
        allowed = allowed_in(view, tolerance)
        points: list[Position] = []
        for half in self.halves():
            local = self._local(half >> 1)
            if local is not None:
                piece = [(x, y) for x, y in local.polyline(tolerance, window).tolist()]
            else:
                piece = self._leaf_polyline(self._leaf_arc(half >> 1), horizon, allowed)
            points += piece[::-1] if half & 1 else piece
        return np.array(self._joined(points))

    def cotangent_range(self) -> tuple[float, float]:
        """See :attr:`harness.diagram.planar_map.Edge.cotangent_range`.

        The limits at both ends, and in between the values where the slope of cot θ along the edge
        changes sign; it is looked at in a dozen points of each arc.  So both numbers belong to the
        closure of the edge (up to rounding), and they bound the whole edge unless cot θ turns twice
        between neighbouring points (it turns four times at most on a whole bisector).
        """
        first, last = self.diagram.edges[self.edge, 2:4].tolist()
        values: list[float] = []
        for half in self.halves():
            local = self._local(half >> 1)
            if local is not None:
                values += local.cotangent_range
                continue
            arc = self._leaf_arc(half >> 1)
            values += arc.cotangents()
            if self.diagram.edges[self.edge, 0] >= 0:
                values += [arc.limit(half & 1)] if half == first else []
                values += [arc.limit(1 - (half & 1))] if half == last else []
        return min(values), max(values)

    def halves(self) -> Iterator[int]:
        """The half-arcs of the edge from its start to its end."""
        arrays = self.diagram.arrays
        half, last = self.diagram.edges[self.edge, 2:4].tolist()
        yield half
        while half != last:
            end = arrays.arcs[half >> 1, 1 - (half & 1)]
            half = int(arrays.inward[arrays.mate[end]])
            yield half

    def _local(self, arc: int) -> Edge | None:
        """The edge of a hard leaf's own diagram that is this arc; None in other leaves."""
        local = self.diagram.solved.get(int(self.diagram.arrays.leaf_of_arc[arc]))
        if local is None or local.diagram is None:
            return None
        return local.diagram.edges[local_arc(self.diagram.arrays, arc)]

    def _leaf_arc(self, arc: int) -> LeafArc:
        return LeafArc(Chart(self.diagram, int(self.diagram.arrays.leaf_of_arc[arc])), arc)

    def _leaf_polyline(
        self, arc: LeafArc, horizon: _Horizon, allowed: Callable[[Position, Position], float]
    ) -> list[Position]:
        """The points of an arc from its first end to its last."""
        low, high = horizon.cut(arc, 0), horizon.cut(arc, 1)
        count = len(arc.stretches)
        cuts = [low, *(k / count for k in range(1, count) if low < k / count < high), high]
        chords = BisectorChords(self.diagram.instance.segments[list(arc.pair)])
        return list(refined(arc.point, cuts, chords, allowed))

    def _joined(self, points: list[Position]) -> list[Position]:
        """The points from node to node, none repeated."""
        start, end = self.diagram.edges[self.edge, :2].tolist()
        if start < 0:
            points[-1] = points[0]
        else:
            points[0] = self._node_or(start, points[0])
            points[-1] = self._node_or(end, points[-1])
        size = max(max(abs(x), abs(y)) for x, y in points)
        kept, last = [points[0]], points[-1]
        for p in points[1:-1]:
            if min(math.dist(p, kept[-1]), math.dist(p, last)) > SAME * size:
                kept.append(p)
        return [*kept, last]

    def _node_or(self, node: int, point: Position) -> Position:
        """The point of a node, unless it is at infinity."""
        inside = len(self.diagram.arrays.vertices) + len(self.diagram.nodes.corners)
        if node < inside or self.diagram.domain != "plane":
            return node_point(self.diagram, node)
        return point


class _Horizon:
    """A circle around the window and everything else, beyond which unbounded ends are cut off."""

    def __init__(self, diagram: FastDiagram, window: Window | None) -> None:
        points = diagram.instance.segments.reshape(-1, 2)
        low, high = points.min(axis=0), points.max(axis=0)
        reach = float((high - low).max())
        low, high = low - reach, high + reach
        if window is not None:
            low, high = np.minimum(low, window[:2]), np.maximum(high, window[2:])
        self._centre = (low + high) / 2
        self._radius = float(np.hypot(*(high - low))) + 8 * reach

    def cut(self, arc: LeafArc, end: int) -> float:
        """The parameter at which to leave off towards an end: the end, unless it is at infinity."""
        if not arc.is_far(end):
            return float(end)
        step = 0.25
        while step > 1e-300:
            r = 1.0 - step if end else step
            if math.dist(arc.point(r), self._centre) > self._radius:
                break
            step /= 2
        return r
