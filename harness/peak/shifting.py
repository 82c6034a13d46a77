"""Polygons far from the origin, moved to it exactly and back."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np

from harness.geometry.coordinates import Point
from harness.geometry.instance import Instance
from harness.peak.polygon import Polygon
from harness.peak.result import Peak

FAR = 16.0
"""How many times its own size a polygon may be away from the origin."""
NOWHERE: Point = (Fraction(0), Fraction(0))


def near_origin(polygon: Polygon) -> tuple[Polygon, Point]:
    """The polygon, moved by an exact vector if it is far from the origin, and minus that vector."""
    instance = polygon.instance
    low, high = instance.floats.min(axis=0), instance.floats.max(axis=0)
    with np.errstate(over="ignore"):
        if np.abs([low, high]).max() <= FAR * (high / 2 - low / 2).max():
            return polygon, NOWHERE
    x, y = instance.exact_vertex(0)
    vertices = [instance.exact_vertex(k) for k in range(instance.n)]
    moved = Instance.from_arrays(
        "polygon",
        [(vx - x, vy - y) for vx, vy in vertices],
        name=instance.name,
        source=instance.source,
    )
    return Polygon(moved), (x, y)


def shifted(peak: Peak, shift: Point) -> Peak:
    """The peak, moved by a vector."""
    if shift == NOWHERE:
        return peak
    x, y = peak.point[0] + shift[0], peak.point[1] + shift[1]
    return replace(peak, x=float(x), y=float(y), point=(x, y))
