"""Leaves that doubles cannot read: the reference builder's algebra, on one small triangle.

The triangle and its few candidates are an instance of their own, whose exact diagram gives ports,
arcs and vertices.  The sides of the triangle are in general position, so that every port is the
end of a single edge; at special corners several edges may end.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise

from harness.diagram.counts import Domain, Objective
from harness.diagram.planar_map import Node, PlanarMap, RationalPoint, Side
from harness.diagram.work import Contradiction
from harness.geometry.instance import Instance

#: Bits of the boxes by which ports are sorted along a side.
BITS = 1024
#: Barycentric coordinates from these boxes are off by less than this; what is closer is not told
#: apart.
TINY = Fraction(1, 2**200)


@dataclass
class LocalMap:
    """A hard leaf's part of the diagram in terms of slots (numbers relative to its first).

    ``places``, ``owners``: of the ports (of the only piece, if there is none), then of cells
    without a port and of pseudo ports.  ``arcs``: (end, end, left, right); ends are ports or
    −1 − vertex.  ``vertices``: the nodes, with the half-arcs that leave them, counter-clockwise.
    ``united``: pairs of slots of one cell.  ``diagram``: the local diagram; ``cell_slots``: a
    slot of each of its cells.  ``mates``: pairs of pseudo ports (they close loops).
    """

    ports: int
    places: list[int] = field(default_factory=list)
    owners: list[int] = field(default_factory=list)
    arcs: list[tuple[int, int, int, int]] = field(default_factory=list)
    vertices: list[tuple[Node, list[int]]] = field(default_factory=list)
    united: list[tuple[int, int]] = field(default_factory=list)
    mates: list[tuple[int, int]] = field(default_factory=list)
    diagram: PlanarMap | None = None
    cell_slots: dict[int, int] = field(default_factory=dict)


def solve(
    instance: Instance,
    candidates: list[int],
    corners: list[RationalPoint],
    domain: Domain,
    objective: Objective,
) -> LocalMap:
    """The diagram of some segments in a triangle.

    Raises Contradiction if several edges meet a side in one point that is no corner.
    """
    from harness.diagram.reference import build_reference

    rational = [instance.rational_segment(k) for k in candidates]
    small = Instance.from_arrays("segments", rational)
    inside: Domain = "kernel" if domain == "kernel" else "interior"
    diagram = build_reference(small, inside, objective, corners)
    return _Reading(diagram, candidates, corners).local


class _Reading:
    """Reads a local map off a planar map."""

    def __init__(
        self, diagram: PlanarMap, candidates: list[int], corners: list[RationalPoint]
    ) -> None:
        self.diagram = diagram
        self.candidates = candidates
        self.corners = corners
        self.slot_of_cell: dict[int, int] = {}
        self.port_of_end: dict[tuple[int, bool], int] = {}
        ports = self._ports()
        self.local = LocalMap(len(ports), diagram=diagram)
        self._write_slots(ports)
        self._write_arcs()
        self.local.cell_slots = self.slot_of_cell

    def _owner(self, cell: int) -> int:
        return self.candidates[self.diagram.cells[cell].segment]

    def _ports(self) -> list[tuple[int, tuple[int, bool], int]]:
        """(place, edge end, cell after it), counter-clockwise from corner 0."""
        before, after = {}, {}
        for wall in self.diagram.walls:
            if wall.nodes[0] is not None:
                after[wall.nodes[0]] = wall.cell
            if wall.nodes[1] is not None:
                before[wall.nodes[1]] = wall.cell
        ends: defaultdict[int, list[tuple[int, bool]]] = defaultdict(list)
        for k, edge in enumerate(self.diagram.edges):
            for node, at_end in ((edge.start, False), (edge.end, True)):
                if node is not None and self.diagram.nodes[node].kind == "boundary":
                    ends[node].append((k, at_end))
        located = sorted((self._place(node), node) for node in ends)
        for ((place, t), _), ((other, s), _) in pairwise(located):
            if place == other and abs(t - s) < TINY:
                raise Contradiction("two ports in one point")
        # A corner is the end of walls, as a node or without one: were a node only close to it,
        # there would be one too many.
        at_corners = sum(place % 2 == 0 for (place, _), _ in located)
        if at_corners + sum(wall.nodes[0] is None for wall in self.diagram.walls) != 3:
            raise Contradiction("a port too close to a corner")
        ports = []
        for (place, _), node in located:
            if place % 2 and len(ends[node]) > 1:
                raise Contradiction("several edges meet a side in one point")
            cell = before[node]
            for end in self._in_order(ends[node], cell):
                edge = self.diagram.edges[end[0]]
                cell = edge.left if end[1] else edge.right
                ports.append((place, end, cell))
            if cell != after[node]:
                raise Contradiction("cells around a port do not fit")
        return ports

    def _in_order(self, ends: list[tuple[int, bool]], cell: int) -> list[tuple[int, bool]]:
        """The edge ends at a corner in the order in which a walk inside meets them."""
        left, result = list(ends), []
        while left:
            for end in left:
                edge = self.diagram.edges[end[0]]
                # Seen from the node inwards, the cell met first lies to the left.
                first, second = (edge.right, edge.left) if end[1] else (edge.left, edge.right)
                if first == cell:
                    result.append(end)
                    left.remove(end)
                    cell = second
                    break
            else:
                raise Contradiction("cells around a corner do not fit")
        return result

    def _place(self, node: int) -> tuple[int, Fraction]:
        """Place and parameter of a boundary node."""
        place = self.diagram.nodes[node].place
        assert place is not None
        low, high = place.enclosure(BITS)
        x, y = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
        a, b, c = self.corners
        area = _cross(a, b, c)
        width = max(high[0] - low[0], high[1] - low[1])
        reach = max(abs(p[k] - q[k]) for p, q in ((a, b), (b, c), (c, a)) for k in range(2))
        if 2 * width * reach >= TINY * area:
            raise Contradiction("a triangle too small for boxes")
        weights = [
            _cross((x, y), b, c) / area,
            _cross(a, (x, y), c) / area,
            _cross(a, b, (x, y)) / area,
        ]
        zero = [abs(w) < TINY for w in weights]
        if sum(zero) == 2:
            return 2 * zero.index(False), Fraction(0)
        if sum(zero) != 1:
            raise Contradiction("a boundary node is not on the boundary")
        k = zero.index(True)
        start = (k + 1) % 3
        return 2 * start + 1, weights[(k + 2) % 3]

    def _write_slots(self, ports: list[tuple[int, tuple[int, bool], int]]) -> None:
        local = self.local
        for slot, (place, end, cell) in enumerate(ports):
            self.port_of_end[end] = slot
            local.places.append(place)
            local.owners.append(self._owner(cell))
            if cell in self.slot_of_cell:
                local.united.append((self.slot_of_cell[cell], slot))
            else:
                self.slot_of_cell[cell] = slot
        if not ports:
            cell = self.diagram.walls[0].cell
            self.slot_of_cell[cell] = self._extra(self._owner(cell))
        for cell in range(len(self.diagram.cells)):
            if cell not in self.slot_of_cell:
                self.slot_of_cell[cell] = self._extra(self._owner(cell))

    def _extra(self, owner: int) -> int:
        self.local.places.append(1)
        self.local.owners.append(owner)
        return len(self.local.places) - 1

    def _write_arcs(self) -> None:
        local, diagram = self.local, self.diagram
        vertex_of: dict[int, int] = {}
        for v, node in enumerate(diagram.nodes):
            if node.kind != "boundary":
                vertex_of[v] = len(local.vertices)
                segments = tuple(sorted(self.candidates[k] for k in node.segments))
                local.vertices.append(
                    (
                        Node(
                            node.kind, node.point, segments, node.degree, node.endpoint, node.place
                        ),
                        self._leaving(v),
                    )
                )
        for k, edge in enumerate(diagram.edges):
            left, right = self.slot_of_cell[edge.left], self.slot_of_cell[edge.right]
            if edge.start is None or edge.end is None:
                one, two = self._extra(local.owners[left]), self._extra(local.owners[left])
                local.mates.append((one, two))
                local.united += [(left, one), (left, two)]
                local.arcs.append((one, two, left, right))
                continue
            ends = []
            for end, at_end in ((edge.start, False), (edge.end, True)):
                inner = vertex_of.get(end)
                ends.append(self.port_of_end[k, at_end] if inner is None else -1 - inner)
            local.arcs.append((ends[0], ends[1], left, right))

    def _leaving(self, node: int) -> list[int]:
        """The half-arcs that leave a node, counter-clockwise (2·edge, + 1 if backwards)."""
        diagram = self.diagram
        after: dict[int, int] = {}
        for cell in diagram.cells:
            for walk in cell.walks:
                for side, following in zip(walk, (*walk[1:], walk[0]), strict=True):
                    if not following.is_wall and _start(diagram, following) == node:
                        if side.is_wall:
                            raise Contradiction("a node inside lies on the boundary")
                        # ``side`` arrives; reversed, it leaves next after ``following``.
                        after[_half(following)] = _half(side) ^ 1
        first = min(after)
        order = [first]
        while after[order[-1]] != first:
            order.append(after[order[-1]])
        if len(order) != diagram.nodes[node].degree:
            raise Contradiction("the edges around a node are not one cycle")
        return order


def _half(side: Side) -> int:
    return 2 * side.item + (0 if side.forward else 1)


def _start(diagram: PlanarMap, side: Side) -> int | None:
    edge = diagram.edges[side.item]
    return edge.start if side.forward else edge.end


def _cross(a: RationalPoint, b: RationalPoint, c: RationalPoint) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
