"""Where the nodes of a fast diagram are, as doubles."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from harness.diagram.fast.arrays import Arrays
from harness.diagram.fast.chart import Chart
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.leaves import CROSSING, TRIPLE
from harness.diagram.fast.nodes import vertex_points
from harness.diagram.fast.prepare import Floats
from harness.diagram.planar_map import Node, RationalPoint
from harness.geometry.exact import fraction, point

_ties: WeakKeyDictionary[FastDiagram, Floats] = WeakKeyDictionary()


def node_point(diagram: FastDiagram, node: int) -> tuple[float, float]:
    """The point of a node; at infinity, the direction as a unit vector.

    A tie of three is where the builder found it, in doubles; other nodes are exact up to rounding.
    O(1) after the first tie, which makes a table of all.
    """
    arrays, vertices = diagram.arrays, len(diagram.arrays.vertices)
    if node < vertices:
        return _vertex_point(diagram, node)
    if node < vertices + len(diagram.nodes.corners):
        x, y = diagram.roots.corners.exact[diagram.nodes.corners[node - vertices].corner]
        return float(x), float(y)
    port = single_port(diagram, node)
    local = local_node(diagram, port)
    if local is not None:
        return local.point
    half = int(arrays.inward[port])
    chart = Chart(diagram, int(arrays.leaf_of_arc[half >> 1]))
    return chart.plane(chart.end(half >> 1, half & 1))


def _vertex_point(diagram: FastDiagram, vertex: int) -> tuple[float, float]:
    arrays = diagram.arrays
    special = arrays.special.get(vertex)
    if special is not None:
        return special.point
    leaf = int(arrays.vertices[vertex, 0])
    kind = diagram.leaves.kinds[leaf]
    if kind == CROSSING:
        x, y = crossing(diagram, leaf)
        return float(x), float(y)
    if kind != TRIPLE:
        chart = Chart(diagram, leaf)
        return chart.plane(chart.vertex(vertex))
    if diagram not in _ties:
        _ties[diagram] = vertex_points(diagram.roots, diagram.leaves, arrays)
    x, y = _ties[diagram][vertex].tolist()
    return x, y


def crossing(diagram: FastDiagram, leaf: int) -> RationalPoint:
    """The common point of the two lines in a crossing leaf, exactly."""
    base = int(diagram.arrays.start[leaf])
    lines = []
    for segment in diagram.arrays.owner[base : base + 2].tolist():
        a, b = (point(end) for end in diagram.instance.rational_segment(segment))
        lines.append((a[1] - b[1], b[0] - a[0], a[0] * b[1] - a[1] * b[0]))
    (a, b, c), (d, e, f) = lines
    w = a * e - b * d
    return fraction((b * f - c * e) / w), fraction((c * d - a * f) / w)


def single_port(diagram: FastDiagram, node: int) -> int:
    """The port of a node on the boundary or at infinity that is no corner."""
    before = len(diagram.arrays.vertices) + len(diagram.nodes.corners)
    return int(diagram.nodes.ports[node - before])


def local_arc(arrays: Arrays, arc: int) -> int:
    """The number of an arc among those of its leaf, which are consecutive."""
    first = arc
    while first > 0 and arrays.leaf_of_arc[first - 1] == arrays.leaf_of_arc[arc]:
        first -= 1
    return arc - first


def local_node(diagram: FastDiagram, port: int) -> Node | None:
    """The node of a hard leaf's own diagram at one of its ports; None for other leaves."""
    half = int(diagram.arrays.inward[port])
    leaf = int(diagram.arrays.leaf_of_arc[half >> 1])
    local = diagram.solved.get(leaf)
    if local is None or local.diagram is None:
        return None
    edge = local.diagram.edges[local_arc(diagram.arrays, half >> 1)]
    node = edge.end if half & 1 else edge.start
    return None if node is None else local.diagram.nodes[node]
