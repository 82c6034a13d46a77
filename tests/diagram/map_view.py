"""A planar map as nodes, sides and cells, for comparing it with another."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

from harness.diagram.planar_map import PlanarMap, Side, Walk

#: A node is (0, k), a side (1, k) with k as in :attr:`View.sides`, a cell (2, k).
Thing = tuple[int, int]
NODE, SIDE, CELL = range(3)


class View:
    """A planar map as nodes, sides (every edge has two, a wall one) and cells."""

    def __init__(self, diagram: PlanarMap) -> None:
        """List the sides; a walk that does not cover them makes an error later."""
        self.diagram = diagram
        edges = [Side(k, forward) for k in range(len(diagram.edges)) for forward in (True, False)]
        walls = [Side(k, True, is_wall=True) for k in range(len(diagram.walls))]
        self.sides: list[Side] = [*edges, *walls]
        self.number = {side: k for k, side in enumerate(self.sides)}

    def ends(self, side: Side) -> tuple[int | None, int | None]:
        """The nodes at which a side starts and ends."""
        if side.is_wall:
            return self.diagram.walls[side.item].nodes
        edge = self.diagram.edges[side.item]
        return (edge.start, edge.end) if side.forward else (edge.end, edge.start)

    def cell(self, side: Side) -> int:
        """The cell to the left of a side."""
        if side.is_wall:
            return self.diagram.walls[side.item].cell
        edge = self.diagram.edges[side.item]
        return edge.left if side.forward else edge.right

    def twin(self, side: Side) -> int:
        """The number of the other side of an edge; of a wall, its own."""
        return self.number[side if side.is_wall else Side(side.item, not side.forward)]

    def walks(self, cell: int) -> list[tuple[bool, list[int]]]:
        """The walks around a cell as numbers of sides, each with whether it is the outer one."""
        outer, holes = self.diagram.cells[cell].outer, self.diagram.cells[cell].holes
        marked: list[tuple[bool, Walk]] = [] if outer is None else [(True, outer)]
        marked += [(False, hole) for hole in holes]
        return [(is_outer, [self.number[side] for side in walk]) for is_outer, walk in marked]

    @cached_property
    def place_on_walk(self) -> dict[int, tuple[bool, int, int]]:
        """For every side: whether its walk is an outer one, the side before and the side after."""
        places = {}
        for c in range(len(self.diagram.cells)):
            for is_outer, walk in self.walks(c):
                around = zip(walk[-1:] + walk[:-1], walk, walk[1:] + walk[:1], strict=True)
                for before, here, after in around:
                    places[here] = (is_outer, before, after)
        return places

    @cached_property
    def leaving(self) -> list[list[int]]:
        """The sides that leave each node."""
        result: list[list[int]] = [[] for _ in self.diagram.nodes]
        for k, side in enumerate(self.sides):
            start = self.ends(side)[0]
            if start is not None:
                result[start].append(k)
        return result

    def things(self) -> Iterator[Thing]:
        yield from ((NODE, k) for k in range(len(self.diagram.nodes)))
        yield from ((SIDE, k) for k in range(len(self.sides)))
        yield from ((CELL, k) for k in range(len(self.diagram.cells)))

    def describe(self, thing: Thing) -> str:
        kind, k = thing
        if kind == NODE:
            node = self.diagram.nodes[k]
            return f"node {k}: {node.kind} of {node.segments}, degree {node.degree}, {node.point}"
        if kind == SIDE:
            side = self.sides[k]
            name = "wall" if side.is_wall else "edge"
            return f"{name} {side.item} seen from cell {self.cell(side)}, ends {self.ends(side)}"
        cell = self.diagram.cells[k]
        lengths = [len(walk) for walk in cell.walks]
        return f"cell {k} of segment {cell.segment}, walks of {lengths} sides"
