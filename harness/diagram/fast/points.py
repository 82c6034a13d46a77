"""Where ports and leaves are, in doubles; points of leaves, exactly."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from harness.diagram.fast.arrays import Arrays
from harness.diagram.fast.build import Leaves
from harness.diagram.fast.leaves import EMPTY
from harness.diagram.fast.prepare import Floats
from harness.diagram.fast.roots import Roots
from harness.diagram.planar_map import RationalPoint
from harness.geometry.instance import Instance


def homogeneous_corners(roots: Roots, root: int, shape: Floats) -> Floats:
    """The corners of a triangle in a root as rows (x, y, w), shape (3, 3)."""
    corners = roots.triangles[root].tolist()
    base = np.array(
        [
            [float(roots.corners.exact[c][0]), float(roots.corners.exact[c][1]),
             roots.corners.weights[c]]
            for c in corners
        ]
    )
    return shape.reshape(3, 3) @ base


def row_of_leaf(leaves: Leaves, leaf: int) -> int:
    """The row of a leaf that is not empty in ``shapes``."""
    return int(np.count_nonzero(leaves.kinds[: leaf + 1] != EMPTY)) - 1


def contest(instance: Instance, i: int, j: int, points: Floats) -> Floats:
    """Q_i|L_j| − Q_j|L_i| at homogeneous points (m, 3), shape (m,)."""
    values = []
    for k in (i, j):
        a, b = instance.segments[k]
        p, w = points[:, :2], points[:, 2:]
        to_a, to_b = a * w - p, b * w - p
        d = b - a
        values.append(
            ((to_a * to_b).sum(axis=1), np.abs(to_a[:, 0] * d[1] - to_a[:, 1] * d[0]))
        )
    return values[0][0] * values[1][1] - values[1][0] * values[0][1]


def port_on_side(
    instance: Instance, roots: Roots, leaves: Leaves, arrays: Arrays, port: int
) -> Floats:
    """The homogeneous point (3,) of a port on a side or corner of its leaf, in doubles.

    Found by sampling the side for changes of the contest between its two segments; the rank among
    the ports of the same pair tells which.
    """
    leaf = int(arrays.leaf_of_arc[arrays.inward[port] >> 1])
    row = row_of_leaf(leaves, leaf)
    corners = homogeneous_corners(roots, int(leaves.shape_roots[row]), leaves.shapes[row])
    place = int(arrays.place[port])
    start, end = corners[place // 2], corners[(place // 2 + 1) % 3]
    if place % 2 == 0:
        return np.asarray(start)
    base, count = int(arrays.start[leaf]), int(arrays.ports[leaf])

    def pair(p: int) -> frozenset[int]:
        before = base + (p - base - 1) % count
        return frozenset((int(arrays.owner[before]), int(arrays.owner[p])))

    rank = sum(
        arrays.place[p] == place and pair(p) == pair(port) for p in range(base, port)
    )
    i, j = sorted(pair(port))
    t = np.linspace(0.0, 1.0, 257)
    low, high = 0.0, 1.0
    for _ in range(6):
        values = contest(instance, i, j, start + t[:, None] * (end - start))
        changes = np.flatnonzero((values[:-1] > 0) != (values[1:] > 0))
        if not len(changes):
            break
        at = changes[min(rank, len(changes) - 1)]
        low, high, rank = t[at], t[at + 1], 0
        t = np.linspace(low, high, 257)
    middle = (low + high) / 2
    return np.asarray(start + middle * (end - start))


def exact_point(roots: Roots, root: int, weights: list[Fraction]) -> RationalPoint | None:
    """The exact point with given barycentric weights in a root; None at infinity."""
    corners = roots.triangles[root].tolist()
    w = sum(
        (f * Fraction(roots.corners.weights[c]) for f, c in zip(weights, corners, strict=True)),
        Fraction(0),
    )
    if w == 0:
        return None
    x, y = (
        sum(
            (f * roots.corners.exact[c][axis] for f, c in zip(weights, corners, strict=True)),
            Fraction(0),
        )
        / w
        for axis in range(2)
    )
    return x, y


def point_of_piece(
    roots: Roots, leaves: Leaves, arrays: Arrays, instance: Instance, leaf: int, slot: int
) -> RationalPoint | None:
    """An exact point on a leaf's boundary between a port and the next one.

    Halfway between them if they are on one side, else the corner that follows the port; None if
    that is on the boundary of the root, at infinity, or a port itself.
    """
    row = row_of_leaf(leaves, leaf)
    root = int(leaves.shape_roots[row])
    shape = [[Fraction(x) for x in line] for line in leaves.shapes[row].reshape(3, 3)]
    base, count = int(arrays.start[leaf]), int(arrays.ports[leaf])
    following = base + (slot - base + 1) % count
    here, there = int(arrays.place[slot]), int(arrays.place[following])
    k = here // 2
    if here == there and here % 2 and following > slot:
        points = [
            port_on_side(instance, roots, leaves, arrays, port) for port in (slot, following)
        ]
        corners = homogeneous_corners(roots, root, leaves.shapes[row])
        start, end = corners[k], corners[(k + 1) % 3]
        along = end - start
        t = [Fraction(float((p - start) @ along / (along @ along))) for p in points]
        middle = (t[0] + t[1]) / 2
        weights = [x + middle * (y - x) for x, y in zip(shape[k], shape[(k + 1) % 3], strict=True)]
    elif here % 2 == 0 or there == 2 * ((k + 1) % 3):
        return None
    else:
        weights = shape[(k + 1) % 3]
    return exact_point(roots, root, weights) if all(weights) else None
