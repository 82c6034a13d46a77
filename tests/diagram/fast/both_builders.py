"""Small instances built twice, and which edge of the fast map is which of the reference's."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from generators.registry import generate
from harness.diagram import build
from harness.diagram.counts import Domain, Objective
from harness.diagram.planar_map import Edge, Node, PlanarMap
from harness.geometry.instance import Instance
from tests.diagram.support import SQUARE, polygon, segments

Points = NDArray[np.float64]
BUILDERS = ("fast", "reference")

FIVE = segments(
    ((901, 392), (1149, 234)),
    ((615, 61), (650, 182)),
    ((172, 893), (-123, 1022)),
    ((605, 893), (444, 1062)),
    ((687, 234), (824, 209)),
)
HEPTAGON = polygon((6, 1), (5, 4), (1, 5), (-4, 6), (-6, 0), (-3, -5), (3, -4))
DART = polygon((2, 0), (1, 1), (5, 7), (1, 3), (-6, 5), (-1, -2))
ACROSS = segments(((0, 0), (1, 0)), ((3, -1), (3, 1)))
#: An edge of its kernel turns one way and then the other, so that its middle is near its chord.
WAVY = polygon((2, 5), (0, 2), (0, 0), (2, 0), (3, 1))
COLLINEAR = segments(((0, 0), (2, 0)), ((3, 0), (4, 0)), ((0, 3), (1, 5)))


def _family(name: str, n: int, **params: Any) -> Instance:
    return Instance.from_generated(generate(name, n, 3, **params))


CASES: dict[str, tuple[Instance, Domain, Objective]] = {
    "five": (FIVE, "plane", "smallest"),
    "five-largest": (FIVE, "plane", "largest"),
    "heptagon": (HEPTAGON, "kernel", "smallest"),
    "heptagon-largest": (HEPTAGON, "interior", "largest"),
    "wavy": (WAVY, "kernel", "smallest"),
    "square": (polygon(*SQUARE), "kernel", "smallest"),
    "dart": (DART, "interior", "smallest"),
    "dart-largest": (DART, "kernel", "largest"),
    "across": (ACROSS, "plane", "smallest"),
    "across-largest": (ACROSS, "plane", "largest"),
    "collinear": (COLLINEAR, "plane", "smallest"),
    "zigzag": (_family("zigzag", 8, tilt=0.4), "kernel", "smallest"),
    "convex-weave": (_family("convex-weave", 8), "kernel", "smallest"),
    "star": (_family("star", 9), "kernel", "smallest"),
    "star-interior": (_family("star", 7), "interior", "smallest"),
    "segments": (_family("segments", 4), "plane", "smallest"),
}


@cache
def both(name: str) -> tuple[PlanarMap, PlanarMap]:
    """The fast and the reference map of a case."""
    instance, domain, objective = CASES[name]
    fast, reference = (build(instance, domain, objective, builder) for builder in BUILDERS)
    return fast, reference


def size_of(diagram: PlanarMap) -> float:
    return float(np.ptp(diagram.instance.segments.reshape(-1, 2), axis=0).max())


def same_node(one: Node | None, other: Node | None, size: float) -> bool:
    """Whether two nodes are at one place; those at infinity, in one direction."""
    if one is None or other is None:
        return one is other
    if (one.kind == "infinity") != (other.kind == "infinity"):
        return False
    unit = 1.0 if one.kind == "infinity" else size
    return math.dist(one.point, other.point) < 1e-7 * unit


def ends(diagram: PlanarMap, edge: Edge) -> tuple[Node | None, Node | None]:
    if edge.start is None or edge.end is None:
        return None, None
    return diagram.nodes[edge.start], diagram.nodes[edge.end]


def partner(fast: PlanarMap, edge: Edge, reference: PlanarMap) -> Edge:
    """The reference's edge that goes the same way between the same segments, or its reverse.

    Of several between the same nodes, the nearest.
    """
    size = size_of(fast)
    start, end = ends(fast, edge)
    found = []
    for other in reference.edges:
        first, last = ends(reference, other)
        pairs = [(other.segments, first, last), (other.segments[::-1], last, first)]
        if any(
            pair == edge.segments and same_node(start, a, size) and same_node(end, b, size)
            for pair, a, b in pairs
        ):
            found.append(other)
    assert found, edge.segments
    if len(found) == 1:
        return found[0]
    line = edge.polyline(size / 100)
    return min(found, key=lambda other: distance(other.polyline(size / 100), line, fast))


def distance(points: Points, line: Points, diagram: PlanarMap) -> float:
    """How far points near the segments are from a polyline, at most."""
    segments = diagram.instance.segments.reshape(-1, 2)
    size = size_of(diagram)
    low, high = segments.min(axis=0) - size, segments.max(axis=0) + size
    points = points[((points > low) & (points < high)).all(axis=1)]
    p, d = line[:-1], line[1:] - line[:-1]
    offset = points[:, None] - p
    weight = (offset * d).sum(axis=2) / np.maximum((d * d).sum(axis=1), 1e-300)
    foot = np.clip(weight, 0, 1)[:, :, None] * d
    gaps = np.hypot(*np.moveaxis(offset - foot, 2, 0)).min(axis=1)
    return float(gaps.max(initial=0.0))
