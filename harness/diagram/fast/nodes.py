"""The nodes of a fast diagram: kinds, points, segments, degrees."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.diagram.counts import NodeKind
from harness.diagram.fast.arrays import Arrays
from harness.diagram.fast.build import Leaves
from harness.diagram.fast.corner_nodes import CornerNode, CornerNodes, corner_nodes
from harness.diagram.fast.glue import find
from harness.diagram.fast.leaves import CROSSING, EMPTY, SADDLE
from harness.diagram.fast.prepare import Floats, Ints, Prepared
from harness.diagram.fast.roots import INFINITY, Roots
from harness.geometry.instance import Instance
from harness.geometry.predicates import orientation

KINDS: tuple[NodeKind, ...] = ("triple", "crossing", "saddle", "endpoint", "boundary", "infinity")
TRIPLE, CROSS, SADDLE_NODE, ENDPOINT, BOUNDARY, AT_INFINITY = range(6)


@dataclass(eq=False)
class Nodes:
    """``kind`` (m,): numbers of KINDS.  ``degree`` (m,).  Vertices of leaves come first, then
    ``corners`` (special corners), then single ports on walls and at infinity.

    ``of_port`` (s,): the node of a port, or −1.  ``ports`` (p,): the single ports.  ``far``:
    special corners at infinity; each of their ports is a node of its own.
    """

    kind: Ints
    degree: Ints
    corners: CornerNodes
    ports: Ints
    of_port: Ints
    far: CornerNodes


def find_nodes(
    prepared: Prepared, roots: Roots, leaves: Leaves, arrays: Arrays, in_plane: bool
) -> Nodes:
    """All nodes of glued leaves."""
    n_vertices = len(arrays.vertices)
    kind = np.zeros(n_vertices, dtype=np.int64)
    leaf_kind = leaves.kinds[arrays.vertices[:, 0]] if n_vertices else np.zeros(0)
    kind[leaf_kind == CROSSING] = CROSS
    kind[leaf_kind == SADDLE] = SADDLE_NODE
    for v, node in arrays.special.items():
        kind[v] = KINDS.index(node.kind)
    degree = np.diff(arrays.out_first)
    met = corner_nodes(roots, leaves, arrays)
    finite = np.array(roots.corners.weights)[met.corners] != 0
    passing = finite & (met.degrees == 2)
    passing[passing] = _are_hubs(roots, met.corners[passing])
    for through in met.only(passing):
        one, two = through.ports  # an edge that passes through, without a node
        arrays.mate[one], arrays.mate[two] = two, one
    corners, far = met.only(finite & ~passing), met.only(~finite)
    of_port = np.full(len(arrays.place), -1, dtype=np.int64)
    of_port[corners.ports] = n_vertices + np.repeat(np.arange(len(corners)), corners.degrees)
    loose = np.flatnonzero((arrays.inward >= 0) & (arrays.mate < 0) & (of_port < 0))
    of_port[loose] = n_vertices + len(corners) + np.arange(len(loose))
    single = np.full(len(loose), AT_INFINITY if in_plane else BOUNDARY)
    corner_kinds = _corner_kinds(prepared, roots, arrays, corners)
    return Nodes(
        kind=np.concatenate([kind, corner_kinds, single]),
        degree=np.concatenate([degree, corners.degrees, np.ones(len(loose), dtype=np.int64)]),
        corners=corners,
        ports=loose,
        of_port=of_port,
        far=far,
    )


def _are_hubs(roots: Roots, corners: Ints) -> np.ndarray:
    """Whether special corners are neither on the boundary, nor endpoints."""
    hubs: np.ndarray = ~np.isin(corners, list(roots.on_walls)) & ~roots.corners.have_ends(corners)
    return hubs


def _corner_kinds(prepared: Prepared, roots: Roots, arrays: Arrays, corners: CornerNodes) -> Ints:
    """The kinds of nodes at finite corners."""
    kinds = np.where(_are_plain_crossings(prepared, roots, arrays, corners), CROSS, -1)
    for k in np.flatnonzero(kinds < 0).tolist():
        node = corners[k]
        kinds[k] = (
            BOUNDARY
            if node.corner in roots.on_walls
            else corner_kind(prepared.instance, roots, arrays, node)
        )
    return kinds


def _are_plain_crossings(
    prepared: Prepared, roots: Roots, arrays: Arrays, corners: CornerNodes
) -> np.ndarray:
    """Whether nodes at corners are certainly crossings of two lines outside their segments.

    Four edges between the cells of two segments, both with an acute view of them (Q > 0), and no
    others whose lines pass: so both lines pass.
    """
    plain: np.ndarray = corners.degrees == 4
    if not plain.any():
        return plain
    frame, _, first, flat = roots.corners.arrays(prepared.centre, prepared.scale)
    number = corners.corners
    plain &= first[number + 1] - first[number] == 2
    rows = np.flatnonzero(plain)
    lines = flat[first[number[rows]][:, None] + np.arange(2)]
    ports = corners.ports[corners.first[rows][:, None] + np.arange(4)]
    owners = arrays.owner[arrays.arcs[arrays.inward[ports] >> 1, 2:]].reshape(-1, 8)
    low, high = owners.min(axis=1), owners.max(axis=1)
    here = ((owners == low[:, None]) | (owners == high[:, None])).all(axis=1)
    here &= (lines[:, 0] == 2 * low) & (lines[:, 1] == 2 * high)
    p = frame[number[rows]][:, None, 0::2]
    ends = prepared.segments[lines >> 1][:, :, 0::2]
    to_a, to_b = ends[:, :, 0:2] - p, ends[:, :, 2:4] - p
    size = np.abs(to_a).sum(axis=2) * np.abs(to_b).sum(axis=2)
    here &= ((to_a * to_b).sum(axis=2) > 1e-9 * size).all(axis=1)
    plain[rows] = here
    return plain


def owners_around(arrays: Arrays, corner: CornerNode) -> list[int]:
    """The segments whose cells meet at a special corner."""
    around: set[int] = set()
    for port in corner.ports:
        half = int(arrays.inward[port])
        around |= {int(arrays.owner[s]) for s in arrays.arcs[half >> 1, 2:]}
    return sorted(around)


def corner_kind(instance: Instance, roots: Roots, arrays: Arrays, corner: CornerNode) -> int:
    """The kind of a node at a segment's endpoint or a hub.

    With up to two edges it is an ``endpoint``; with more a vertex: a crossing if the point lies on
    the extension of another segment whose cell is there (angle 0), else a triple point or saddle.
    """
    if len(corner.ports) < 3:
        return ENDPOINT
    around = owners_around(arrays, corner)
    p = roots.corners.exact[corner.corner]
    for k in around:
        a, b = instance.rational_segment(k)
        on_line = p not in (a, b) and orientation(a, b, p) == 0
        if on_line and (a[0] - p[0]) * (b[0] - p[0]) + (a[1] - p[1]) * (b[1] - p[1]) > 0:
            return CROSS
    return TRIPLE if len(around) >= 3 else SADDLE_NODE


def vertex_points(roots: Roots, leaves: Leaves, arrays: Arrays) -> Floats:
    """Coordinates of the vertices of all leaves, (v, 2), as doubles."""
    shape_of_leaf = np.cumsum(leaves.kinds != EMPTY) - 1
    rows = shape_of_leaf[arrays.vertices[:, 0]]
    x, y = leaves.points[rows, 0], leaves.points[rows, 1]
    shapes = leaves.shapes[rows].reshape(-1, 3, 3)
    weights = np.einsum("vk,vkc->vc", np.stack([1 - x - y, x, y], axis=1), shapes)
    return root_points(roots, leaves.shape_roots[rows], weights)


def root_points(roots: Roots, root: Ints, weights: Floats) -> Floats:
    """The points with given barycentric weights (k, 3) in given roots (k,), shape (k, 2).

    Where the point is at infinity, its direction.
    """
    exact = roots.corners.points()
    corner_weights = np.array(roots.corners.weights)
    corners = roots.triangles[root]
    summed = np.einsum("vc,vcd->vd", weights, exact[corners])
    w = (weights * corner_weights[corners]).sum(axis=1)
    points: Floats = summed / np.where(w == 0, 1, w)[:, None]
    return points


def unbounded_classes(arrays: Arrays, nodes: Nodes) -> set[int]:
    """Classes of slots that reach infinity, if only in one direction, between two edges."""
    result = set()
    for corner in nodes.far:
        for port in corner.ports:
            pieces = arrays.arcs[arrays.inward[port] >> 1, 2:].tolist()
            result |= {int(find(arrays.parent, piece)) for piece in pieces}
    for root, k in np.argwhere(arrays.opposite == INFINITY).tolist():
        port, _, first, _ = arrays.sides[root, k].tolist()
        result.add(int(find(arrays.parent, first)))
        while port >= 0:
            result.add(int(find(arrays.parent, port)))
            port = int(arrays.following[port])
    return result
