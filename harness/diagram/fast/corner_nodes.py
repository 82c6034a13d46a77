"""Edges that end at special corners of root triangles, in their order about the corner.

No coordinate is compared: root triangles follow each other about a corner across their sides, and
the leaves of one root are ordered by the barycentric coordinates of their middles.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import overload

import numpy as np

from harness.diagram.fast.arrays import Arrays
from harness.diagram.fast.build import Leaves
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY
from harness.diagram.fast.prepare import Floats, Ints
from harness.diagram.fast.roots import Roots
from harness.diagram.work import Contradiction

#: Middles of leaves, as shares of the side opposite to the corner, that doubles tell apart: shares
#: lie between 0 and 1 and are off by a few roundings of sums and quotients of positive numbers.
APART = 1e-9


@dataclass(frozen=True)
class CornerNode:
    """Edge ends at a special corner: ``ports``, counter-clockwise about it."""

    corner: int
    ports: list[int]


class CornerNodes(Sequence[CornerNode]):
    """Many of them: ``corners`` (k,); the ports of each from ``first`` (k + 1,) on in ``ports``."""

    def __init__(self, corners: Ints, first: Ints, ports: Ints) -> None:
        """Takes the arrays as they are."""
        self.corners, self.first, self.ports = corners, first, ports

    @property
    def degrees(self) -> Ints:
        """The number of ports of each."""
        return np.diff(self.first)

    def only(self, wanted: np.ndarray) -> CornerNodes:
        """Those for which ``wanted`` (k,) holds."""
        ports = self.ports[np.repeat(wanted, self.degrees)]
        first = np.concatenate([[0], np.cumsum(self.degrees[wanted])]).astype(np.int64)
        return CornerNodes(self.corners[wanted], first, ports)

    def __len__(self) -> int:
        """How many there are."""
        return len(self.corners)

    @overload
    def __getitem__(self, index: int) -> CornerNode: ...
    @overload
    def __getitem__(self, index: slice) -> list[CornerNode]: ...
    def __getitem__(self, index: int | slice) -> CornerNode | list[CornerNode]:
        """One, made when asked for."""
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        ports = self.ports[self.first[index] : self.first[index + 1]].tolist()
        return CornerNode(int(self.corners[index]), ports)

    def __iter__(self) -> Iterator[CornerNode]:
        """In the order of corners."""
        return (self[k] for k in range(len(self)))


def corner_nodes(roots: Roots, leaves: Leaves, arrays: Arrays) -> CornerNodes:
    """All special corners at which edges end; O(roots + ports log ports).

    Raises Contradiction if an edge ends at a corner that is not special.
    """
    loose = np.flatnonzero((arrays.inward >= 0) & (arrays.mate < 0) & (arrays.place % 2 == 0))
    leaf = arrays.leaf_of_arc[arrays.inward[loose] >> 1]
    row = (np.cumsum(leaves.kinds != EMPTY) - 1)[leaf]
    shape = leaves.shapes[row].reshape(-1, 3, 3)
    mine = shape[np.arange(len(loose)), arrays.place[loose] // 2]
    if (np.count_nonzero(mine, axis=1) != 1).any():
        raise Contradiction("an edge ends at a corner that is not special")
    position = mine.argmax(axis=1)
    root = leaves.shape_roots[row].astype(np.int64)
    corner = roots.triangles[root, position]
    if not np.array(roots.corners.special)[corner].all():
        raise Contradiction("an edge passes through a free point")
    turn = _turns(arrays.opposite, 3 * root + position)
    share = _shares(shape.sum(axis=1), position)
    # Ports of one leaf come in the order of a walk inside, that is clockwise.
    order = np.lexsort((-loose, share, turn, corner))
    _resolve(leaves, row, position, share, turn, corner, order, loose)
    first = np.flatnonzero(np.diff(corner[order], prepend=-1))
    return CornerNodes(
        corner[order][first], np.append(first, len(order)).astype(np.int64), loose[order]
    )


@compiled
def _turns(opposite, wanted):
    """For (3·root + position of a corner) its place in the order of roots about that corner."""
    flat = opposite.ravel()
    turn = np.full(len(flat), -1, np.int64)
    result = np.empty(len(wanted), np.int64)
    for w in range(len(wanted)):
        if turn[wanted[w]] < 0:
            start = here = wanted[w]
            while True:  # clockwise to the beginning, or once around
                beyond = flat[_at(here, 2)]
                if beyond < 0:
                    break
                here = _at(beyond, 2)
                if here == start:
                    break
            start, place = here, 0
            while True:
                turn[here] = place
                place += 1
                beyond = flat[_at(here, 1)]
                if beyond < 0:
                    break
                here = _at(beyond, 1)
                if here == start:
                    break
        result[w] = turn[wanted[w]]
    return result


@compiled
def _at(corner, step):
    """The corner ``step`` positions on in the same root."""
    return corner - corner % 3 + (corner + step) % 3


def _shares(middle: Floats, position: Ints) -> Floats:
    """How far the middles of leaves are turned about a corner of their root, between 0 and 1."""
    k = np.arange(len(middle))
    near, far = middle[k, (position + 1) % 3], middle[k, (position + 2) % 3]
    share: Floats = far / (near + far)
    return share


def _resolve(
    leaves: Leaves,
    row: Ints,
    position: Ints,
    share: Floats,
    turn: Ints,
    corner: Ints,
    order: Ints,
    loose: Ints,
) -> None:
    """Sort anew, exactly, where shares of different leaves are too near to each other."""
    same = (corner[order][1:] == corner[order][:-1]) & (turn[order][1:] == turn[order][:-1])
    close = same & (row[order][1:] != row[order][:-1]) & ~(np.diff(share[order]) > APART)
    for corner_here, turn_here in {
        (int(corner[order[k]]), int(turn[order[k]])) for k in np.flatnonzero(close)
    }:
        places = np.flatnonzero((corner[order] == corner_here) & (turn[order] == turn_here))
        exact = {}
        for k in order[places].tolist():
            middle = [
                sum(column, Fraction(0))
                for column in zip(*leaves.weights(int(row[k])), strict=True)
            ]
            near, far = (middle[(int(position[k]) + step) % 3] for step in (1, 2))
            exact[k] = (far / (near + far), -int(loose[k]))
        order[places] = sorted(exact, key=exact.__getitem__)
