"""Point location in a fast diagram, and points that witness its cells; exactly."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np

from harness.diagram.fast.chart import Chart
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.hard import solve
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY
from harness.diagram.fast.points import exact_point
from harness.diagram.fast.roots import WALL
from harness.diagram.fast.subdivide import LEAF
from harness.diagram.planar_map import RationalPoint
from harness.geometry.predicates import compare_visual_angles, orientation


@compiled
def leaf_shapes(tokens, order, wanted, shapes, roots):
    """The corners λ (w, 9) and roots (w,) of the leaves numbered in ``wanted`` (increasing)."""
    stack = np.zeros((256, 9))
    position = leaf = found = 0
    for root in order:
        stack[0] = 0.0
        stack[0, 0] = stack[0, 4] = stack[0, 8] = 1.0
        top = 1
        while top > 0:
            top -= 1
            lam = stack[top].copy()
            token = tokens[position]
            position += 1
            if token == LEAF:
                if found < len(wanted) and wanted[found] == leaf:
                    shapes[found] = lam
                    roots[found] = root
                    found += 1
                leaf += 1
                continue
            p, q, r = token, (token + 1) % 3, (token + 2) % 3
            for c in range(3):
                middle = 0.5 * (lam[3 * q + c] + lam[3 * r + c])
                stack[top, c], stack[top, 3 + c] = lam[3 * p + c], middle
                stack[top, 6 + c] = lam[3 * r + c]
                stack[top + 1, c], stack[top + 1, 3 + c] = lam[3 * p + c], lam[3 * q + c]
                stack[top + 1, 6 + c] = middle
            top += 2
    return found


def witnesses(diagram: FastDiagram) -> tuple[tuple[RationalPoint, int], ...]:
    """For every cell a point in it.

    The middle of an empty leaf, if there is one (as a double, if that stays in it); else a point of
    the boundary of a leaf, strictly between two ports.
    """
    leaves, arrays = diagram.leaves, diagram.arrays
    chosen = np.full(diagram.cells, -1, dtype=np.int64)
    empty = np.flatnonzero(leaves.kinds == EMPTY)
    cells = diagram.cell_of_slot[arrays.start[empty]]
    chosen[cells[::-1]] = empty[::-1]
    known = np.flatnonzero(chosen >= 0)
    order = known[np.argsort(chosen[known], kind="stable")]
    shapes, roots = np.empty((len(order), 9)), np.empty(len(order), dtype=np.int64)
    leaf_shapes(leaves.tokens, leaves.order, chosen[order], shapes, roots)
    found: dict[int, RationalPoint] = {}
    for cell, shape, root in zip(order.tolist(), shapes, roots.tolist(), strict=True):
        found[cell] = _middle(diagram, shape, root)
    for cell in np.flatnonzero(chosen < 0).tolist():
        found[cell] = _on_some_side(diagram, cell)
    return tuple((found[cell], cell) for cell in range(diagram.cells))


def _middle(diagram: FastDiagram, shape: np.ndarray, root: int) -> RationalPoint:
    """The middle of a triangle, rounded to doubles if that is still inside."""
    rows = [[Fraction(x) for x in row] for row in shape.reshape(3, 3)]
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


def _on_some_side(diagram: FastDiagram, cell: int) -> RationalPoint:
    """A point of a cell that contains no triangle: on the boundary of a leaf, or in a hard leaf."""
    arrays = diagram.arrays
    slots = np.flatnonzero(diagram.cell_of_slot == cell)
    for slot in slots.tolist():
        leaf = int(np.searchsorted(arrays.start, slot, side="right")) - 1
        if (
            arrays.ports[leaf]
            and arrays.start[leaf] <= slot < arrays.start[leaf] + arrays.ports[leaf]
        ):
            point = point_of_piece(diagram, leaf, slot)
            if point is not None:
                return point
    for leaf, local in diagram.solved.items():
        base = int(arrays.start[leaf])
        for slot in slots.tolist():
            if base <= slot < base + len(local.places) and local.diagram is not None:
                owner = local.diagram
                for point, k in owner.witnesses:
                    if k >= 0 and local.cell_slots.get(k) == slot - base:
                        return point
    raise ArithmeticError(f"no point of cell {cell} was found")


def point_of_piece(diagram: FastDiagram, leaf: int, slot: int) -> RationalPoint | None:
    """An exact point of a leaf's piece between a port and the next one.

    A corner of the leaf, if one lies between them, or a point halfway along a part of a side; off
    the boundary of the domain if possible; a little inside if all of the piece is at infinity.
    """
    arrays, roots = diagram.arrays, diagram.roots
    chart = Chart(diagram, leaf)
    root = int(diagram.leaves.shape_roots[chart.row])
    shape = diagram.leaves.weights(chart.row)
    base, count = int(arrays.start[leaf]), int(arrays.ports[leaf])

    def position(port: int) -> Fraction:
        """Corner k is at k; the side after it runs to k + 1."""
        k, on_side = divmod(int(arrays.place[port]), 2)
        return k + (Fraction(chart.port_on_side(port).along) if on_side else Fraction(0))

    following = base + (slot - base + 1) % count
    low, high = position(slot), position(following)
    if following <= slot:
        high += 3
    stops = [low, *(Fraction(k) for k in range(7) if low < k < high), high]
    best: tuple[bool, int, RationalPoint] | None = None
    for number, at in enumerate([*stops[1:-1], *((x + y) / 2 for x, y in pairwise(stops))]):
        k, t = int(at) % 3, at - int(at)
        weights = [x + t * (y - x) for x, y in zip(shape[k], shape[(k + 1) % 3], strict=True)]
        point = exact_point(roots, root, weights) or _inwards(diagram, root, weights, shape, slot)
        if point is not None and max(weights) < 1:
            on_wall = any(weights[c] == 0 and arrays.opposite[root, c] < 0 for c in range(3))
            if best is None or (on_wall, number) < best[:2]:
                best = (on_wall, number, point)
    return best[2] if best else None


def _inwards(
    diagram: FastDiagram, root: int, weights: list[Fraction], shape: list[list[Fraction]], slot: int
) -> RationalPoint | None:
    """A point near one at infinity, towards the middle of a leaf, where the slot's owner wins."""
    owner = int(diagram.arrays.owner[slot])
    middle = [sum(column, Fraction(0)) / 3 for column in zip(*shape, strict=True)]
    for bits in range(4, 64, 4):
        t = Fraction(1, 2**bits)
        inside = [x + t * (y - x) for x, y in zip(weights, middle, strict=True)]
        point = exact_point(diagram.roots, root, inside)
        if point is not None and winner_at(diagram, point) == owner:
            return point
    return None


def winner_at(diagram: FastDiagram, point: RationalPoint) -> int | None:
    """The only winner at an exact point, or None; O(n)."""
    sense = 1 if diagram.objective == "smallest" else -1
    segments = diagram.instance.rational_segments()
    best, tied = 0, False
    for k in range(1, len(segments)):
        order = compare_visual_angles(point, segments[best], segments[k])
        if order is None:
            return None
        if order * sense > 0:
            best, tied = k, False
        elif order == 0:
            tied = True
    return None if tied else best


@compiled
def skip_tree(tokens, position, leaf):
    """The position after the tokens of one triangle, and the number of the next leaf."""
    wanted = 1
    while wanted > 0:
        if tokens[position] == LEAF:
            wanted -= 1
            leaf += 1
        else:
            wanted += 1
        position += 1
    return position, leaf


class FastLocator:
    """Finds the cell of an exact point; O(n) comparisons, and a walk down one root."""

    def __init__(self, diagram: FastDiagram) -> None:
        """Nothing is done before the first question."""
        self.diagram = diagram

    def __call__(self, point: RationalPoint) -> int | None:
        """The cell's index, −1 outside the domain, None on an edge, a node or the boundary."""
        where = self._root(point)
        if where is None:
            return -1
        root, weights = where
        if self._on_boundary(root, weights):
            return None
        winner = winner_at(self.diagram, point)
        if winner is None:
            return None
        leaf, shape = self._descend(root, weights)
        arrays, diagram = self.diagram.arrays, self.diagram
        base, count = int(arrays.start[leaf]), max(int(arrays.ports[leaf]), 1)
        local = diagram.solved.get(leaf)
        if local is None:
            cells = {
                int(diagram.cell_of_slot[s])
                for s in range(base, base + count)
                if arrays.owner[s] == winner
            }
            if len(cells) == 1:
                return cells.pop()
            owners = sorted({int(arrays.owner[s]) for s in range(base, base + count)})
            corners = [exact_point(diagram.roots, root, row) for row in shape]
            finite = [corner for corner in corners if corner is not None]
            if len(finite) < 3:
                raise ArithmeticError("a triangle at infinity holds several pieces of one region")
            local = solve(diagram.instance, owners, finite, diagram.domain, diagram.objective)
        assert local.diagram is not None
        cell = local.diagram.locator(point)
        return None if cell is None else int(diagram.cell_of_slot[base + local.cell_slots[cell]])

    def _root(self, point: RationalPoint) -> tuple[int, list[Fraction]] | None:
        """A root that contains the point and the point's barycentric coordinates in it."""
        roots = self.diagram.roots
        for root, corners in enumerate(roots.triangles.tolist()):
            rows = [(*roots.corners.exact[c], Fraction(roots.corners.weights[c])) for c in corners]
            p = (*point, Fraction(1))
            whole = _determinant(rows[0], rows[1], rows[2])
            weights = [
                _determinant(p, rows[1], rows[2]) / whole,
                _determinant(rows[0], p, rows[2]) / whole,
                _determinant(rows[0], rows[1], p) / whole,
            ]
            if all(w >= 0 for w in weights):
                return root, weights
        return None

    def _on_boundary(self, root: int, weights: list[Fraction]) -> bool:
        """Whether a point of a root lies on a wall."""
        return any(
            weights[k] == 0 and self.diagram.arrays.opposite[root, k] == WALL for k in range(3)
        )

    def _descend(self, root: int, weights: list[Fraction]) -> tuple[int, list[list[Fraction]]]:
        """The leaf that contains a point of a root, and the barycentric corners of the leaf."""
        leaves = self.diagram.leaves
        position = leaf = 0
        for other in leaves.order.tolist():
            if other == root:
                break
            position, leaf = skip_tree(leaves.tokens, position, leaf)
        shape = [[Fraction(int(r == c)) for c in range(3)] for r in range(3)]
        local = list(weights)
        while (token := int(leaves.tokens[position])) != LEAF:
            p, q, r = token, (token + 1) % 3, (token + 2) % 3
            middle = [(x + y) / 2 for x, y in zip(shape[q], shape[r], strict=True)]
            position += 1
            if local[q] >= local[r]:
                local = [local[p], local[q] - local[r], 2 * local[r]]
                shape = [shape[p], shape[q], middle]
            else:
                position, leaf = skip_tree(leaves.tokens, position, leaf)
                local = [local[p], 2 * local[q], local[r] - local[q]]
                shape = [shape[p], middle, shape[r]]
        return leaf, shape


def _determinant(
    a: tuple[Fraction, ...], b: tuple[Fraction, ...], c: tuple[Fraction, ...]
) -> Fraction:
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
