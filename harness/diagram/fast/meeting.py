"""Which segments meet at the nodes of a fast diagram.

At a point that is no segment's endpoint: all that win there, whether they own a cell beside it or
not.  A segment that is certainly beaten inside a triangle can only tie with the winner on the
triangle's boundary, where that is known by construction: at a special corner (it is on the
segment's line, or among the known ties) or along a wall (the segment is on the wall's line), or
where both have the angle 0, being on one line.  So inside leaves the owners of the cells around a
node are all, but at crossings, where others on their lines win, too.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cached_property
from itertools import pairwise

from harness.diagram.fast.corner_nodes import CornerNode
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.node_points import common_point, local_node
from harness.diagram.fast.nodes import CROSS, owners_around
from harness.diagram.planar_map import RationalPoint
from harness.geometry.predicates import compare_visual_angles

Segments = tuple[int, ...]


class Meeting:
    """The segments of every node of a diagram."""

    def __init__(self, diagram: FastDiagram) -> None:
        """Nothing is done before the first question."""
        self.diagram = diagram

    def inside(self) -> list[Segments]:
        """The segments of the vertices in leaves."""
        arrays = self.diagram.arrays
        around = arrays.owner[arrays.arcs[arrays.out >> 1, 2:]].tolist()
        first = arrays.out_first.tolist()
        crossing = (self.diagram.nodes.kind[: len(first) - 1] == CROSS).tolist()
        result = []
        for v, (low, high) in enumerate(pairwise(first)):
            owners = {k for pair in around[low:high] for k in pair}
            if crossing[v]:
                owners |= self._on_lines(owners)
            result.append(tuple(sorted(owners)))
        return result

    def _on_lines(self, owners: set[int]) -> set[int]:
        """The segments on the lines of those that meet at a crossing, unless it is inside them."""
        lines = self.diagram.prepared.lines
        numbers = {int(lines[k]) for k in owners} - {-1}
        if not numbers:
            return set()
        members = [k for number in numbers for k in self._members[number]]
        one = min(owners, key=lambda k: -int(lines[k]))  # on one of the lines in question
        other = next(k for k in owners if lines[k] != lines[one])
        p = common_point(self.diagram.instance, one, other)
        return {k for k in members if not _covers(self.diagram.instance.rational_segment(k), p)}

    @cached_property
    def _members(self) -> dict[int, list[int]]:
        """The segments on every line that holds several."""
        found: defaultdict[int, list[int]] = defaultdict(list)
        for k, line in enumerate(self.diagram.prepared.lines.tolist()):
            found[line].append(k)
        return found

    def is_endpoint(self, corner: CornerNode) -> bool:
        """Whether a segment ends at a special corner."""
        roots = self.diagram.roots
        if any(z & 1 for z in roots.corners.incident[corner.corner]):
            return True
        return self.diagram.domain == "kernel" and roots.corners.exact[corner.corner] in self._ends

    @cached_property
    def _ends(self) -> set[RationalPoint]:
        """All endpoints.  At a corner of the kernel several edges on one line may end."""
        return {point for segment in self.diagram.instance.rational_segments() for point in segment}

    def at_corner(self, node: CornerNode) -> Segments:
        """The segments that meet at a special corner.

        At an endpoint, where the visual angle of a segment is not defined, the owners around it.
        """
        diagram = self.diagram
        around = owners_around(diagram.arrays, node)
        if self.is_endpoint(node):
            return tuple(around)
        corner = node.corner
        others = {z >> 1 for z in diagram.roots.corners.incident[corner]}
        lines = diagram.prepared.lines
        on_lines = {int(lines[k]) for k in others} - {-1}
        others |= {k for number in on_lines for k in self._members[number]}
        others |= {k for c, i, j, _ in diagram.ties if c == corner for k in (i, j)}
        best = self._winners(diagram.roots.corners.exact[corner], sorted(others | set(around)))
        return tuple(sorted(set(around) | best))

    def _winners(self, point: RationalPoint, candidates: list[int]) -> set[int]:
        """The segments with the best visual angle at a point that is no endpoint, exactly."""
        instance = self.diagram.instance
        sense = 1 if self.diagram.objective == "smallest" else -1
        best: list[int] = []
        for k in candidates:
            order = 0
            if best:
                found = compare_visual_angles(
                    point, instance.rational_segment(k), instance.rational_segment(best[0])
                )
                assert found is not None
                order = found * sense
            best = [k] if order < 0 else ([*best, k] if order == 0 else best)
        return set(best)

    def at_port(self, port: int) -> Segments:
        """The segments that meet where an edge ends on a wall or at infinity."""
        diagram, arrays = self.diagram, self.diagram.arrays
        half = int(arrays.inward[port])
        around = {int(k) for k in arrays.owner[arrays.arcs[half >> 1, 2:]]}
        node = local_node(diagram, port)
        leaf = int(arrays.leaf_of_arc[half >> 1])
        if node is not None and node.kind == "boundary":
            around |= {diagram.candidates[leaf][k] for k in node.segments}
        if diagram.domain != "plane" and diagram.objective == "smallest":
            around |= self._on_wall(port, leaf, around)
        return tuple(sorted(around))

    def _on_wall(self, port: int, leaf: int, around: set[int]) -> set[int]:
        """The segments on a wall's line that see nothing of it, if one of them wins at a port.

        All of them have the angle 0 there.
        """
        diagram = self.diagram
        lines = diagram.prepared.lines
        on_line = {int(lines[k]) for k in around} - {-1}
        if not on_line:
            return set()
        row = int(diagram.rows_of_leaves[leaf])
        root = int(diagram.leaves.shape_roots[row])
        shape = diagram.leaves.shapes[row].reshape(3, 3)
        place = int(diagram.arrays.place[port]) // 2
        weights = shape[place] + shape[(place + 1) % 3]
        corners = diagram.roots.triangles[root][weights > 0].tolist()
        common = set.intersection(
            *({z >> 1 for z in diagram.roots.corners.incident[c]} for c in corners)
        )
        here = {int(lines[k]) for k in common} & on_line
        members = [k for number in here for k in self._members[number]]
        (ax, ay), (bx, by) = (diagram.roots.corners.exact[c] for c in corners)
        middle = ((ax + bx) / 2, (ay + by) / 2)
        apart = [k for k in members if not _covers(diagram.instance.rational_segment(k), middle)]
        return set(apart) if around & set(apart) else set()


def _covers(segment: tuple[RationalPoint, RationalPoint], p: RationalPoint) -> bool:
    """Whether a point of a segment's line is inside the segment."""
    (ax, ay), (bx, by) = segment
    return (ax - p[0]) * (bx - p[0]) + (ay - p[1]) * (by - p[1]) < 0
