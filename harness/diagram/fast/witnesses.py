"""For every cell of a fast diagram an exact point in it."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from harness.diagram.fast.chart import Chart
from harness.diagram.fast.choice import half_of
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.forms import U
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaf_points import points_in_leaves
from harness.diagram.fast.leaves import EMPTY
from harness.diagram.fast.pieces import Whole, between, is_clear, points_of_piece
from harness.diagram.fast.points import exact_point
from harness.diagram.fast.prepare import Floats, Ints
from harness.diagram.fast.records import LEAF
from harness.diagram.fast.subdivide import DEEPEST
from harness.diagram.planar_map import RationalPoint
from harness.geometry.predicates import orientation

#: Ways into a leaf from its boundary are halved so often at most.
_MOST_BITS = 400


@compiled
def leaf_shapes(tokens, order, wanted, shapes, roots):
    """The corners λ (w, 18) and roots (w,) of the leaves numbered in ``wanted`` (increasing)."""
    stack = np.zeros((DEEPEST + 2, 18))
    exponents = np.zeros((DEEPEST + 2, 3), np.int64)
    lam, e = np.empty(18), np.empty(3, np.int64)
    position = leaf = found = 0
    for root in order:
        stack[0], exponents[0] = 0.0, 0
        stack[0, 0] = stack[0, 4] = stack[0, 8] = 1.0
        top = 1
        while top > 0:
            top -= 1
            lam[:], e[:] = stack[top], exponents[top]
            token = tokens[position]
            position += 1
            if token == LEAF:
                if found < len(wanted) and wanted[found] == leaf:
                    shapes[found] = lam
                    roots[found] = root
                    found += 1
                leaf += 1
                continue
            half_of(lam, e, token, True, stack[top], exponents[top])
            half_of(lam, e, token, False, stack[top + 1], exponents[top + 1])
            top += 2
    return found


def witnesses(diagram: FastDiagram) -> tuple[tuple[RationalPoint, int], ...]:
    """For every cell a point in it.

    The middle of an empty leaf, if there is one (as a double, if that stays in it); else a point
    inside a leaf of which the cell has a piece of the boundary, or a witness of a hard leaf's map.

    Raises ArithmeticError if none is found.
    """
    leaves, arrays = diagram.leaves, diagram.arrays
    chosen = np.full(diagram.cells, -1, dtype=np.int64)
    empty = np.flatnonzero(leaves.kinds == EMPTY)
    cells = diagram.cell_of_slot[arrays.start[empty]]
    chosen[cells[::-1]] = empty[::-1]
    known = np.flatnonzero(chosen >= 0)
    order = known[np.argsort(chosen[known], kind="stable")]
    shapes, roots = np.empty((len(order), 18)), np.empty(len(order), dtype=np.int64)
    leaf_shapes(leaves.tokens, leaves.order, chosen[order], shapes, roots)
    found: list[RationalPoint | None] = [None] * diagram.cells
    middles, certain = _middles(diagram, shapes[:, :9].reshape(-1, 3, 3), roots)
    sure = certain.tolist()
    for k, (cell, (x, y)) in enumerate(zip(order.tolist(), middles.tolist(), strict=True)):
        if sure[k]:
            found[cell] = Fraction(x), Fraction(y)
        else:
            found[cell] = _middle(diagram, shapes[k], int(roots[k]))
    found_too = points_in_leaves(diagram, np.flatnonzero(chosen < 0))
    for cell, x, y in zip(*found_too, strict=True):
        found[cell] = Fraction(x), Fraction(y)
    missing = np.array([cell for cell, point in enumerate(found) if point is None], dtype=np.int64)
    for cell, slots in zip(missing.tolist(), _slots_of(diagram, missing), strict=True):
        found[cell] = _beside_some_piece(diagram, cell, slots)
    return tuple((point, cell) for cell, point in enumerate(found) if point is not None)


def _middles(diagram: FastDiagram, shapes: Floats, roots: Ints) -> tuple[Floats, np.ndarray]:
    """The middles of triangles as doubles (t, 2), and where these are certainly in them, (t,).

    With coordinates up to R, a corner is computed within E = 8uR (1-norm of both coordinates).  An
    orientation d × e is then off by 4E(|d| + |e|) and a few roundings of products, at most.
    """
    corners, exact = diagram.roots.corners, diagram.corner_points
    of_root = diagram.roots.triangles[roots]
    finite = np.array(corners.weights)[of_root].all(axis=1)
    points = np.einsum("tkc,tcd->tkd", shapes, exact[of_root])
    middles = points.mean(axis=1)
    slack = 16 * U * np.abs(exact[of_root]).max(axis=(1, 2), initial=0.0)
    certain: np.ndarray = np.array(finite)
    for k in range(3):
        p = points[:, k]
        d, e = points[:, (k + 1) % 3] - p, middles - p
        area = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
        reach = np.abs(d).sum(axis=1) + np.abs(e).sum(axis=1)
        certain = certain & (area > 8 * slack * reach + 16 * U * reach**2)
    return middles, certain


def _middle(diagram: FastDiagram, shape: np.ndarray, root: int) -> RationalPoint:
    """The middle of a triangle, rounded to doubles if that is still inside."""
    exact = [Fraction(x) + Fraction(y) for x, y in zip(shape[:9], shape[9:], strict=True)]
    rows = [exact[3 * k : 3 * k + 3] for k in range(3)]
    point = exact_point(
        diagram.roots, root, [sum(column) / 3 for column in zip(*rows, strict=True)]
    )
    assert point is not None
    corners = [exact_point(diagram.roots, root, row) for row in rows]
    if any(corner is None for corner in corners):
        return point
    rounded = (Fraction(float(point[0])), Fraction(float(point[1])))
    a, b, c = (corner for corner in corners if corner is not None)
    inside = all(orientation(p, q, rounded) > 0 for p, q in ((a, b), (b, c), (c, a)))
    return rounded if inside else point


def _slots_of(diagram: FastDiagram, cells: Ints) -> list[Ints]:
    """The slots of each of some cells (increasing)."""
    order = np.argsort(diagram.cell_of_slot, kind="stable")
    ordered = diagram.cell_of_slot[order]
    low, high = (np.searchsorted(ordered, cells, side=side) for side in ("left", "right"))
    return [order[a:b] for a, b in zip(low, high, strict=True)]


def _beside_some_piece(diagram: FastDiagram, cell: int, slots: Ints) -> RationalPoint:
    """A point of a cell that contains no empty leaf."""
    arrays = diagram.arrays
    for slot in slots.tolist():
        leaf = _leaf_of(diagram, slot)
        local = diagram.solved.get(leaf)
        if local is None and slot < arrays.start[leaf] + arrays.ports[leaf]:
            point = point_beside(Chart(diagram, leaf), slot)
            if point is not None:
                return point
    for leaf, local in diagram.solved.items():
        base = int(arrays.start[leaf])
        mine = {s - base for s in slots.tolist() if base <= s < base + len(local.places)}
        if mine and local.diagram is not None:
            for point, k in local.diagram.witnesses:
                if k >= 0 and local.cell_slots.get(k) in mine:
                    return point
    raise ArithmeticError(f"no point of cell {cell} was found")


def _leaf_of(diagram: FastDiagram, slot: int) -> int:
    """The leaf of a slot; slots of hard leaves' maps come last, in the order of those leaves."""
    usual = int(diagram.leaves.first_slot[-1])
    if slot < usual:
        return int(np.searchsorted(diagram.leaves.first_slot, slot, side="right")) - 1
    starts = {leaf: int(diagram.arrays.start[leaf]) for leaf in diagram.solved}
    return max((leaf for leaf in starts if starts[leaf] <= slot), key=starts.__getitem__)


def point_beside(chart: Chart, slot: int) -> RationalPoint | None:
    """A point inside a leaf from which a clear way leads to the piece after a port.

    None if none is found close to the boundary.
    """
    winner = int(chart.diagram.arrays.owner[slot])
    points = points_of_piece(chart, slot)
    for bits in (2, 8, 24, 60, _MOST_BITS):
        for goal in points:
            inside = between(goal, (1, 1, 1), bits)
            if is_clear(chart, winner, inside, goal):
                return _in_plane(chart, inside)
    return None


def _in_plane(chart: Chart, p: Whole) -> RationalPoint:
    """A finite point of a leaf in coordinates of the instance."""
    x, y, w = (
        sum((f * corner[axis] for f, corner in zip(p, chart.corners, strict=True)), 0)
        for axis in range(3)
    )
    return Fraction(int(x), int(w)), Fraction(int(y), int(w))
