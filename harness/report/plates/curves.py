"""Curves with no more points than print can show, so that vector files stay small."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from harness.diagram.planar_map import PlanarMap, Window
from harness.report.drawing_shapes import Points, Shapes, distance_to_chord

#: Of the window's extent: a fortieth of a typographic point on a plate of five inches.
FINE = 1 / 15_000


class PrintShapes(Shapes):
    """Curves and outlines thinned to what is seen; neighbours keep sharing their curves."""

    def __init__(self, diagram: PlanarMap, window: Window) -> None:
        """``window``: (xmin, ymin, xmax, ymax)."""
        super().__init__(diagram, window)

    @cached_property
    def curves(self) -> list[Points]:
        """The polyline of every edge, shape (m, 2), within ``FINE`` of the window's extent."""
        return [thinned(curve, FINE * self.extent) for curve in super().curves]


def thinned(curve: Points, tolerance: float) -> Points:
    """Some of a polyline's points (m, 2), its ends included, within ``tolerance`` of the rest.

    Douglas and Peucker, "Algorithms for the reduction of the number of points …", 1973; O(m²) at
    worst, O(m log m) for smooth curves.
    """
    kept = np.zeros(len(curve), dtype=bool)
    kept[[0, -1]] = True
    waiting = [(0, len(curve) - 1)]
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        away = distance_to_chord(curve[first + 1 : last], curve[first], curve[last])
        farthest = int(away.argmax())
        if away[farthest] > tolerance:
            middle = first + 1 + farthest
            kept[middle] = True
            waiting += [(first, middle), (middle, last)]
    result: Points = curve[kept]
    return result
