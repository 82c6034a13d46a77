"""Point location in a fast diagram, exactly."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property

import numpy as np

from harness.diagram.fast.chart import Chart
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.pieces import Whole, is_clear, owners, points_of_piece, whole
from harness.diagram.fast.points import determinant, homogeneous
from harness.diagram.fast.records import LEAF
from harness.diagram.fast.roots import WALL
from harness.diagram.planar_map import RationalPoint
from harness.geometry.predicates import compare_visual_angles

Weights = list[Fraction]
#: Points of a leaf by way of which a piece of its boundary is looked for, at most.
_MOST_STEPS = 400


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


@compiled
def starts_of_roots(tokens, order):
    """The first token and the first leaf of every root, (r, 2)."""
    starts = np.empty((len(order), 2), np.int64)
    position = leaf = 0
    for root in order:
        starts[root, 0], starts[root, 1] = position, leaf
        position, leaf = skip_tree(tokens, position, leaf)
    return starts


class FastLocator:
    """Finds the cell of an exact point: O(roots), and a walk down one of them."""

    def __init__(self, diagram: FastDiagram) -> None:
        """Nothing is done before the first question."""
        self.diagram = diagram

    def __call__(self, point: RationalPoint) -> int | None:
        """The cell's index, −1 outside the domain, None on an edge, a node or the boundary."""
        where = self._root(point)
        if where is None:
            return -1
        root, weights = where
        if self._on_boundary(root, weights) or self._at_node(root, weights):
            return None
        leaf, inside = self._descend(root, weights)
        diagram, arrays = self.diagram, self.diagram.arrays
        base, count = int(arrays.start[leaf]), int(arrays.ports[leaf])
        local = diagram.solved.get(leaf)
        if local is not None:
            assert local.diagram is not None
            cell = local.diagram.locator(point)
            return (
                None if cell is None else int(diagram.cell_of_slot[base + local.cell_slots[cell]])
            )
        if count == 0:
            return int(diagram.cell_of_slot[base])
        chart = Chart(diagram, leaf)
        winner = self._winner(point, owners(chart))
        if winner is None:
            return None
        slots = [s for s in range(base, base + count) if arrays.owner[s] == winner]
        cells = {int(diagram.cell_of_slot[s]) for s in slots}
        return cells.pop() if len(cells) == 1 else self._reached(chart, winner, slots, inside)

    def _winner(self, point: RationalPoint, segments: list[int]) -> int | None:
        """The only winner among some segments at an exact point, or None."""
        sense = 1 if self.diagram.objective == "smallest" else -1
        instance = self.diagram.instance
        best, tied = segments[0], False
        for k in segments[1:]:
            order = compare_visual_angles(
                point, instance.rational_segment(best), instance.rational_segment(k)
            )
            if order is None:
                return None
            if order == 0:
                order = self._order_beside(point, best, k)
            if order * sense > 0:
                best, tied = k, False
            elif order == 0:
                tied = True
        return None if tied else best

    def _order_beside(self, point: RationalPoint, i: int, j: int) -> int:
        """The sign of θ_i − θ_j beside a point where both are equal.

        It is not zero if the point is on the line of both, where both angles are 0: their ratio is
        (Q_j/|b_j − a_j|) / (Q_i/|b_i − a_i|) near the line.
        """
        lines = self.diagram.prepared.lines
        if lines[i] < 0 or lines[i] != lines[j]:
            return 0
        x, y = point
        values = []
        for k in (i, j):
            (ax, ay), (bx, by) = self.diagram.instance.rational_segment(k)
            product = (ax - x) * (bx - x) + (ay - y) * (by - y)
            values.append(product / (abs(bx - ax) or abs(by - ay)))
        return (values[1] > values[0]) - (values[1] < values[0])

    def _reached(self, chart: Chart, winner: int, slots: list[int], start: Weights) -> int:
        """The cell of a point of a leaf, of several cells there of the same segment.

        A way is looked for along which that segment wins, from the point to one of the pieces.
        """
        goals = [(p, s) for s in slots for p in points_of_piece(chart, s)]
        reached = [whole(start)]
        waiting = list(_spread())
        for step in range(_MOST_STEPS):
            if step >= len(reached):
                break
            here = reached[step]
            for goal, slot in goals:
                if is_clear(chart, winner, here, goal):
                    return int(self.diagram.cell_of_slot[slot])
            for point in list(waiting):
                if is_clear(chart, winner, here, point) and is_clear(chart, winner, point, here):
                    reached.append(point)
                    waiting.remove(point)
        raise ArithmeticError(f"no way was found to the boundary of leaf {chart.leaf}")

    @cached_property
    def _nodes(self) -> set[int]:
        """The corners of roots that are nodes."""
        return {node.corner for node in self.diagram.nodes.corners}

    def _at_node(self, root: int, weights: Weights) -> bool:
        """Whether a point of a root is a corner of it that is a node."""
        if max(weights) < sum(weights):
            return False
        return int(self.diagram.roots.triangles[root, weights.index(max(weights))]) in self._nodes

    def _on_boundary(self, root: int, weights: Weights) -> bool:
        """Whether a point of a root lies on a wall."""
        return any(
            weights[k] == 0 and self.diagram.arrays.opposite[root, k] == WALL for k in range(3)
        )

    # -- trees ----------------------------------------------------------------------------------

    @cached_property
    def _starts(self) -> list[tuple[int, int]]:
        leaves = self.diagram.leaves
        found: list[tuple[int, int]] = starts_of_roots(leaves.tokens, leaves.order).tolist()
        return found

    @cached_property
    def _corners(self) -> np.ndarray:
        """The corners (x, y, w) of the roots as doubles, (r, 3, 3)."""
        corners = self.diagram.roots.corners
        both = np.column_stack([corners.points(), corners.weights])
        rows: np.ndarray = both[self.diagram.roots.triangles]
        return rows

    def _root(self, point: RationalPoint) -> tuple[int, Weights] | None:
        """A root that contains the point and the point's barycentric coordinates in it.

        Doubles say where to look first.
        """
        p = np.array([float(point[0]), float(point[1]), 1.0])
        a, b, c = np.moveaxis(self._corners, 1, 0)
        with np.errstate(all="ignore"):
            areas = np.stack([np.cross(b, c) @ p, np.cross(c, a) @ p, np.cross(a, b) @ p], axis=1)
            share = areas.min(axis=1) / np.abs(areas).sum(axis=1)
        for root in np.argsort(-np.nan_to_num(share, nan=-1.0), kind="stable").tolist():
            weights = self._weights(root, point)
            if min(weights) >= 0:
                return root, weights
        return None

    def _weights(self, root: int, point: RationalPoint) -> Weights:
        """The barycentric coordinates of a point in a root (whose corners are homogeneous)."""
        roots = self.diagram.roots
        a, b, c = (homogeneous(roots.corners, k) for k in roots.triangles[root].tolist())
        p = (*point, Fraction(1))
        all_of_it = determinant(a, b, c)
        return [
            determinant(p, b, c) / all_of_it,
            determinant(a, p, c) / all_of_it,
            determinant(a, b, p) / all_of_it,
        ]

    def _descend(self, root: int, weights: Weights) -> tuple[int, Weights]:
        """The leaf that contains a point of a root, and the weights of its corners."""
        leaves = self.diagram.leaves
        position, leaf = self._starts[root]
        local = list(weights)
        while (token := int(leaves.tokens[position])) != LEAF:
            p, q, r = token, (token + 1) % 3, (token + 2) % 3
            position += 1
            if local[q] >= local[r]:
                local = [local[p], local[q] - local[r], 2 * local[r]]
            else:
                position, leaf = skip_tree(leaves.tokens, position, leaf)
                local = [local[p], 2 * local[q], local[r] - local[q]]
        return leaf, local


def _spread() -> Iterator[Whole]:
    """Points all over a triangle."""
    for size in (5, 7, 11, 17):
        for k in range(1, size - 1):
            for m in range(1, size - k):
                yield size - k - m, k, m
