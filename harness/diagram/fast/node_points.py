"""Where the nodes of a fast diagram are, as doubles."""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from harness.diagram.fast.arrays import Arrays
from harness.diagram.fast.chart import Chart
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.enclosures import TiePlace
from harness.diagram.fast.leaves import CROSSING, QUAD, TRIPLE
from harness.diagram.fast.nodes import vertex_points
from harness.diagram.fast.prepare import Floats, Ints
from harness.diagram.planar_map import Node, Place, RationalPoint
from harness.geometry.exact import fraction, point
from harness.geometry.instance import Instance

Extended = NDArray[np.longdouble]
#: Polished points of ties, one row for every vertex; NaN where that failed.
_ties: WeakKeyDictionary[FastDiagram, Floats] = WeakKeyDictionary()
_STEPS = 6
#: Of the boxes around nodes of which doubles are not certain.
_BITS = 80
#: Relative to the size of the instance: the last step of an iteration that has converged.
_LAST_STEP = 1e-13


def node_point(diagram: FastDiagram, node: int) -> tuple[float, float]:
    """The point of a node; at infinity, the direction as a unit vector.

    O(1), after a table of all ties has been made when the first is asked for.
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
    if kind in (TRIPLE, QUAD):
        if diagram not in _ties:
            _ties[diagram] = _polished(diagram)
        x, y = _ties[diagram][vertex].tolist()
        if x == x:
            return x, y
    return middle(TiePlace(Chart(diagram, leaf), vertex))


def middle(place: Place) -> tuple[float, float]:
    """The middle of a small box around a place, as doubles."""
    (x, y), (z, w) = place.enclosure(_BITS)
    return float((x + z) / 2), float((y + w) / 2)


def _polished(diagram: FastDiagram) -> Floats:
    """The ties of three segments, (v, 2), by Newton's method in the plane from the builder's guess.

    NaN for other vertices, and where the iteration does not converge inside the leaf, or to a point
    that the rounding of the contests leaves uncertain by more than ``_LAST_STEP``.
    """
    arrays, leaves = diagram.arrays, diagram.leaves
    result = np.full((len(arrays.vertices), 2), np.nan)
    if diagram.instance.exact is not None:
        return result  # the endpoints are no doubles
    kind = leaves.kinds[arrays.vertices[:, 0]]
    ties = np.flatnonzero((kind == TRIPLE) | (kind == QUAD))
    leaf, second = arrays.vertices[ties].T
    # The first and second vertex of a quad lie between three consecutive pieces each.
    first = np.where(kind[ties] == QUAD, 2 * second - leaves.choices[leaf], 0)
    pieces = (first[:, None] + np.arange(3)) % np.where(kind[ties] == QUAD, 4, 3)[:, None]
    ends = diagram.instance.segments[arrays.owner[arrays.start[leaf][:, None] + pieces]]
    # Extended precision, where there is any, for the noise of contests that nearly agree.
    ends = ends.astype(np.longdouble)
    p = vertex_points(diagram.roots, leaves, arrays)[ties].astype(np.longdouble)
    step = blur = np.zeros_like(p)
    with np.errstate(all="ignore"):
        for _ in range(_STEPS):
            value, slope, noise = _contests(ends, p)
            (a, b), (c, e) = np.moveaxis(slope, 0, 2)
            u, v = value.T
            det = a * e - b * c
            step = np.stack([u * e - v * b, v * a - u * c], axis=1) / det[:, None]
            steep = np.abs(slope).sum(axis=2)
            blur = (noise * steep[:, ::-1]).sum(axis=1) / np.abs(det)
            p = p - step
    size = float(np.ptp(diagram.instance.segments.reshape(-1, 2), axis=0).max())
    small = np.abs(step).max(axis=1, initial=0.0) + blur < _LAST_STEP * size
    points = p.astype(np.float64)
    good = small & _is_inside(diagram, leaf, points)
    result[ties[good]] = points[good]
    return result


def _contests(ends: Extended, p: Extended) -> tuple[Extended, Extended, Extended]:
    """F_01 and F_02 of three segments (k, 3, 2, 2) at points (k, 2).

    Values (k, 2), gradients (k, 2, 2), and bounds of the values' rounding errors (k, 2).
    """
    to_a, to_b = ends[:, :, 0] - p[:, None], ends[:, :, 1] - p[:, None]
    d = to_b - to_a
    q, d_q = (to_a * to_b).sum(axis=2), -(to_a + to_b)
    line = to_a[:, :, 0] * d[:, :, 1] - to_a[:, :, 1] * d[:, :, 0]
    d_line = np.stack([-d[:, :, 1], d[:, :, 0]], axis=2)
    sign = np.sign(line)
    line, d_line = line * sign, d_line * sign[:, :, None]
    value = q[:, :1] * line[:, 1:] - q[:, 1:] * line[:, :1]
    reach = np.abs(to_a).sum(axis=2) * np.abs(to_b).sum(axis=2)
    wide = np.abs(to_a).sum(axis=2) * np.abs(d).sum(axis=2)
    noise = (
        16 * np.finfo(np.longdouble).eps * (reach[:, :1] * wide[:, 1:] + reach[:, 1:] * wide[:, :1])
    )
    slope = d_q[:, :1] * line[:, 1:, None] + q[:, :1, None] * d_line[:, 1:]
    slope -= d_q[:, 1:] * line[:, :1, None] + q[:, 1:, None] * d_line[:, :1]
    return value, slope, noise


def _is_inside(diagram: FastDiagram, leaf: Ints, p: Floats) -> NDArray[np.bool_]:
    """Whether points (k, 2) are inside leaves (k,), as far as doubles tell."""
    leaves, roots = diagram.leaves, diagram.roots
    rows = diagram.rows_of_leaves[leaf]
    corners = np.column_stack([diagram.corner_points, roots.corners.weights])[
        roots.triangles[leaves.shape_roots[rows]]
    ]
    shapes = leaves.shapes[rows].reshape(-1, 3, 3)
    point = np.column_stack([p, np.ones(len(p))])
    with np.errstate(all="ignore"):
        inside: NDArray[np.bool_] = np.ones(len(p), dtype=bool)
        triangle = shapes @ corners
        for k in range(3):
            u, v = triangle[:, (k + 1) % 3], triangle[:, (k + 2) % 3]
            normal = np.cross(u, v)
            here = (normal * point).sum(axis=1)
            there = (normal * triangle[:, k]).sum(axis=1)
            inside &= here > 1e-9 * there
    return inside


def crossing(diagram: FastDiagram, leaf: int) -> RationalPoint:
    """The common point of the two lines in a crossing leaf, exactly."""
    base = int(diagram.arrays.start[leaf])
    return common_point(diagram.instance, *diagram.arrays.owner[base : base + 2].tolist())


def common_point(instance: Instance, one: int, other: int) -> RationalPoint:
    """The common point of the lines of two segments, exactly."""
    lines = []
    for segment in (one, other):
        a, b = (point(end) for end in instance.rational_segment(segment))
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
