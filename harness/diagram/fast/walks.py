"""Boundary walks around the cells of a fast diagram, and the walls of its domain."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.places import node_point
from harness.diagram.fast.roots import INFINITY, WALL
from harness.diagram.planar_map import Side, Walk, Wall
from harness.diagram.work import Contradiction


@dataclass(frozen=True)
class Boundary:
    """The domain's boundary (or infinity), counter-clockwise, as a cycle of steps.

    A step is a port, or a special corner with its ports in the order of the cycle.  ``pieces``: the
    slot of the piece after each step.
    """

    steps: list[tuple[int | None, list[int]]]
    pieces: list[int]


def boundary_cycles(diagram: FastDiagram) -> list[Boundary]:
    """The one cycle of a bounded domain's boundary, or of infinity.

    Ports at a corner are met clockwise about it; where their cycle begins shows in the cells.
    """
    arrays, roots = diagram.arrays, diagram.roots
    outside = {}
    for root, k in np.argwhere((arrays.opposite == WALL) | (arrays.opposite == INFINITY)).tolist():
        start = int(roots.triangles[root, (k + 1) % 3])
        outside[start] = (root, k, int(roots.triangles[root, (k + 2) % 3]))
    at_corner = {node.corner: node.ports for node in (*diagram.nodes.corners, *diagram.nodes.far)}
    first = min(outside)
    steps: list[tuple[int | None, list[int]]] = []
    pieces: list[int] = []
    corner = first
    while True:
        root, k, following = outside.pop(corner)
        port, _, piece, _ = arrays.sides[root, k].tolist()
        steps.append((corner, at_corner.get(corner, [])[::-1]))
        pieces.append(piece)
        while port >= 0:
            steps.append((None, [port]))
            pieces.append(port)
            port = int(arrays.following[port])
        corner = following
        if corner == first:
            break
    if outside:
        raise Contradiction("the boundary is not one cycle")
    for k, (corner_here, ports) in enumerate(steps):
        if len(ports) > 1:
            steps[k] = (corner_here, _turned(diagram, ports, pieces[k - 1], pieces[k]))
    return [Boundary(steps, pieces)]


def _step_point(diagram: FastDiagram, corner: int | None, ports: list[int]) -> tuple[float, float]:
    """A step of the boundary as a double point."""
    if corner is None:
        return node_point(diagram, int(diagram.nodes.of_port[ports[0]]))
    x, y = diagram.roots.corners.exact[corner]
    return float(x), float(y)


def _turned(diagram: FastDiagram, ports: list[int], before: int, after: int) -> list[int]:
    """The cycle of ports at a corner, begun where the piece before it fits."""
    cell, arrays = diagram.cell_of_slot, diagram.arrays
    for turn in range(len(ports)):
        order = ports[turn:] + ports[:turn]
        first, last = int(arrays.inward[order[0]]), int(arrays.inward[order[-1]])
        left = arrays.arcs[first >> 1, 2 + (first & 1)]
        right = arrays.arcs[last >> 1, 3 - (last & 1)]
        if cell[left] == cell[before] and cell[right] == cell[after]:
            return order
    raise Contradiction("the cells around a corner do not fit")


class Walks:
    """Walks of all cells, from the rotation of half-edges at every node.

    Half-edge 2e runs along edge e, 2e + 1 back; walls have numbers of their own.
    """

    def __init__(self, diagram: FastDiagram) -> None:
        """O(edges + nodes)."""
        self.diagram = diagram
        self.walls: list[Wall] = []
        #: The half-edge that leaves each node before (clockwise from) a given one.
        self.before: dict[int, Side] = {}
        self.after_wall: dict[int, Side] = {}
        self._rotate_inside()
        self._go_round()

    def leaving(self, half_arc: int) -> int:
        """The half-edge to which a half-arc belongs."""
        edge, backwards = self.diagram.edge_of_arc[half_arc >> 1].tolist()
        return 2 * int(edge) + ((half_arc & 1) ^ int(backwards))

    def _rotate(self, half_edges: list[int]) -> None:
        """Note the cyclic order of half-edges that leave an inner node, counter-clockwise."""
        for k, half in enumerate(half_edges):
            self.before[half] = _side(half_edges[k - 1])

    def _rotate_inside(self) -> None:
        arrays, nodes = self.diagram.arrays, self.diagram.nodes
        out, first = arrays.out.tolist(), arrays.out_first.tolist()
        for v in range(len(arrays.vertices)):
            self._rotate([self.leaving(h) for h in out[first[v] : first[v + 1]]])
        for node in nodes.corners:
            if node.corner not in self.diagram.roots.on_walls:
                self._rotate([self.leaving(int(arrays.inward[p])) for p in node.ports])
        for e, row in enumerate(self.diagram.edges.tolist()):
            if row[0] < 0:  # a loop goes on with itself
                self.before[2 * e + 1], self.before[2 * e] = Side(e, True), Side(e, False)

    def _go_round(self) -> None:
        for boundary in boundary_cycles(self.diagram):
            if self.diagram.domain == "plane":
                ports = [port for _, row in boundary.steps for port in row]
                inwards = [self.leaving(int(self.diagram.arrays.inward[p])) for p in ports]
                for k, half in enumerate(inwards):
                    # An edge that goes to infinity is followed by the next that comes from there.
                    self.before[half] = _side(inwards[(k + 1) % len(inwards)])
                continue
            self._add_walls(boundary)

    def _add_walls(self, boundary: Boundary) -> None:
        """Walls between steps of the cycle, joined across corners at which nothing happens."""
        diagram = self.diagram
        kept = [
            (corner, ports, piece)
            for (corner, ports), piece in zip(boundary.steps, boundary.pieces, strict=True)
            if ports or (corner is not None and self._bends(corner))
        ]
        points = [_step_point(diagram, corner, ports) for corner, ports, _ in kept]
        of_port = diagram.nodes.of_port
        names = [int(of_port[ports[0]]) if ports else None for _, ports, _ in kept]
        count = len(kept)
        for k, (_, ports, piece) in enumerate(kept):
            there = (k + 1) % count
            wall = Side(k, True, is_wall=True)
            self.walls.append(
                Wall(
                    (points[k], points[there]),
                    (names[k], names[there]),
                    int(diagram.cell_of_slot[piece]),
                )
            )
            inwards = [self.leaving(int(diagram.arrays.inward[p])) for p in ports]
            # Outwards along a port, then inwards along the next one, and last along the wall.
            for half, following in pairwise(inwards):
                self.before[half] = _side(following)
            if inwards:
                self.before[inwards[-1]] = wall
            previous = (k - 1) % count
            self.after_wall[previous] = _side(inwards[0]) if inwards else wall

    def _bends(self, corner: int) -> bool:
        """Whether a corner of roots is a corner of the domain."""
        return corner in self.diagram.domain_corners

    def following(self, side: Side) -> Side:
        """The next step of the walk around the cell to the left."""
        if side.is_wall:
            return self.after_wall[side.item]
        return self.before[2 * side.item + (1 if side.forward else 0)]

    def by_cell(self) -> dict[int, list[Walk]]:
        """All walks of every cell."""
        result: defaultdict[int, list[Walk]] = defaultdict(list)
        done: set[Side] = set()
        cells = self.diagram.cell_of_slot[self.diagram.edges[:, 4:6]]
        starts = [
            (Side(e, forward), int(cells[e, 0 if forward else 1]))
            for e in range(len(cells))
            for forward in (True, False)
        ]
        starts += [(Side(k, True, is_wall=True), wall.cell) for k, wall in enumerate(self.walls)]
        for first, cell in starts:
            if first in done:
                continue
            walk = [first]
            while (side := self.following(walk[-1])) != first:
                walk.append(side)
                if len(walk) > 4 * len(starts):
                    raise Contradiction("a boundary walk does not close")
            done.update(walk)
            result[cell].append(tuple(walk))
        return result


def _side(half_edge: int) -> Side:
    return Side(half_edge >> 1, half_edge & 1 == 0)
