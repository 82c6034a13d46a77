"""From the faces of a sweep to the planar map: nodes, edges, cells and their boundary walks."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cmp_to_key

from harness.diagram.algebra import Point
from harness.diagram.arcs import Arc
from harness.diagram.counts import NodeKind
from harness.diagram.domain import Region
from harness.diagram.fibres import compare_points
from harness.diagram.planar_map import Cell, Edge, Node, Side, Walk, Wall
from harness.diagram.scene import Scene
from harness.diagram.sweep import Junction, Sweep, SweepError
from harness.diagram.trace import ExactCourse, ExactPlace, direction_at_infinity

HalfArc = tuple[Arc, bool]
"""An arc and whether it is run through from left to right."""


@dataclass(eq=False)
class Assembly:
    """The objects of a planar map in the making, with the tables that connect them."""

    scene: Scene
    region: Region
    swept: Sweep
    junction_at: dict[object, Junction] = field(default_factory=dict)
    label: dict[int, int] = field(default_factory=dict)
    cell_of: dict[int, int] = field(default_factory=dict)
    node_at: dict[object, int] = field(default_factory=dict)
    piece_of: dict[Arc, tuple[int, int, bool]] = field(default_factory=dict)
    chains: list[list[HalfArc]] = field(default_factory=list)
    wall_of: dict[Arc, int] = field(default_factory=dict)
    nodes: list[Node] = field(default_factory=list)
    edges: list[Edge] = field(default_factory=list)
    walls: list[Wall] = field(default_factory=list)
    cells: list[Cell] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Build everything, in the order in which it depends on itself."""
        self.junction_at = {j.point.number.key: j for j in self.swept.junctions}
        self._label_faces()
        self._make_nodes()
        self._make_edges()
        self._make_walls()
        self._make_cells()

    # -- faces ---------------------------------------------------------------------------------

    def _label_faces(self) -> None:
        """Give every face of the domain its winner; the arcs around it must agree."""
        for arc, faces in self.swept.faces.items():
            for face, winner in zip(faces, (arc.below, arc.above), strict=True):
                if winner is not None and self.label.setdefault(face, winner) != winner:
                    raise SweepError("the arcs around a face disagree about its winner")
        for u, v, face in self.swept.samples:
            if face in self.label:
                continue
            p = Point.rational(u, v)
            if self.region.side(p) > 0:
                self.label[face] = self.scene.side_winner(self.scene.winners(p), p, above=True)
        for _, _, face in self.swept.samples:
            if face in self.label and face not in self.cell_of:
                self.cell_of[face] = len(self.cell_of)

    # -- nodes ---------------------------------------------------------------------------------

    def _make_nodes(self) -> None:
        ends = {
            self.scene.sheared(point).number.key
            for segment in self.scene.segments
            for point in segment
        }
        for junction in self.swept.junctions:
            arcs = [*junction.left, *junction.right]
            degree = sum(not arc.is_wall for arc in arcs)
            on_boundary = degree < len(arcs)
            endpoint = junction.point.number.key in ends
            if degree == 0 or (degree == 2 and not on_boundary and not endpoint):
                continue
            meeting = self._segments_at(junction, endpoint)
            if on_boundary:
                kind: NodeKind = "boundary"
            else:
                kind = self._kind(junction, meeting, degree, endpoint)
            self.node_at[junction.point.number.key] = len(self.nodes)
            place = ExactPlace(self.scene, junction.point)
            self.nodes.append(Node(kind, place.floats, meeting, degree, endpoint, place))
        if self.region.is_plane:
            for arcs, outwards in ((self.swept.first, False), (self.swept.last, True)):
                for arc in arcs:
                    self.node_at[arc, outwards] = len(self.nodes)
                    direction = direction_at_infinity(self.scene, arc, outwards)
                    pair = tuple(sorted((_winner(arc.below), _winner(arc.above))))
                    self.nodes.append(Node("infinity", direction, pair, 1))

    def _segments_at(self, junction: Junction, endpoint: bool) -> tuple[int, ...]:
        arcs = [*junction.left, *junction.right]
        around = {w for arc in arcs for w in (arc.below, arc.above) if w is not None}
        if not endpoint:
            around |= set(self.scene.winners(junction.point))
        return tuple(sorted(around))

    def _kind(
        self, junction: Junction, meeting: tuple[int, ...], degree: int, endpoint: bool
    ) -> NodeKind:
        """The kind of a node inside the domain.

        A segment endpoint at which three or more edges meet is a vertex like any other; the kind
        ``endpoint`` is for those that only bend (or begin) an edge.
        """
        if endpoint and degree < 3:
            return "endpoint"
        levels = {self.scene.level(k, junction.point) for k in meeting}
        if levels == {1} or (endpoint and 1 in levels):
            return "crossing"
        return "triple" if len(meeting) >= 3 else "saddle"

    # -- edges ---------------------------------------------------------------------------------

    def _make_edges(self) -> None:
        """Join arcs through the points that are no nodes; what never meets a node is a loop."""
        arcs = [arc for arc in self.swept.faces if not arc.is_wall]
        for arc in arcs:
            for half in ((arc, True), (arc, False)):
                if self._node_before(half) is not None and arc not in self.piece_of:
                    self._add_edge(list(self._run(half)))
        for arc in arcs:
            if arc not in self.piece_of:
                self._add_edge(list(self._run((arc, True))))

    def _node_before(self, half: HalfArc) -> int | None:
        """The node at which a half-arc starts, if it starts at one."""
        arc, forward = half
        point = arc.start if forward else arc.end
        if point is None:
            return self.node_at[arc, not forward]
        return self.node_at.get(point.number.key)

    def _run(self, half: HalfArc) -> Iterator[HalfArc]:
        """The half-arcs from ``half`` on until the next node, or once around."""
        first = half
        while True:
            yield half
            arc, forward = half
            if self._node_before((arc, not forward)) is not None:
                return
            half = self._next(half)
            if half == first:
                return

    def _add_edge(self, chain: list[HalfArc]) -> None:
        index = len(self.edges)
        for position, (arc, forward) in enumerate(chain):
            self.piece_of[arc] = (index, position, forward)
        (first, forward), (last, last_forward) = chain[0], chain[-1]
        start = self._node_before((first, forward))
        end = self._node_before((last, not last_forward))
        below, above = self.swept.faces[first]
        left, right = (above, below) if forward else (below, above)
        self.chains.append(chain)
        self.edges.append(
            Edge(
                segments=(self.label[left], self.label[right]),
                start=start,
                end=end,
                left=self.cell_of[left],
                right=self.cell_of[right],
                course=ExactCourse(self.scene, chain, (self.label[left], self.label[right])),
            )
        )

    def _make_walls(self) -> None:
        for arc, (below, above) in self.swept.faces.items():
            if arc.is_wall:
                assert arc.start is not None
                assert arc.end is not None
                ends = (arc.start, arc.end) if above in self.cell_of else (arc.end, arc.start)
                inside = above if above in self.cell_of else below
                self.wall_of[arc] = len(self.walls)
                (a, b) = (self.scene.floats(p) for p in ends)
                nodes = tuple(self.node_at.get(p.number.key) for p in ends)
                self.walls.append(Wall((a, b), (nodes[0], nodes[1]), self.cell_of[inside]))

    # -- cells ---------------------------------------------------------------------------------

    def _next(self, half: HalfArc) -> HalfArc:
        """The half-arc that follows on the boundary of the face to the left."""
        arc, forward = half
        point = arc.end if forward else arc.start
        if point is None:
            around = [(a, False) for a in self.swept.last]
            around += [(a, True) for a in reversed(self.swept.first)]
            return around[(around.index((arc, not forward)) + 1) % len(around)]
        around = _rotation(self.junction_at[point.number.key])
        return around[around.index((arc, not forward)) - 1]

    def _make_cells(self) -> None:
        outer: dict[int, Walk] = {}
        holes: dict[int, list[Walk]] = {}
        done: set[HalfArc] = set()
        for half in itertools.product(self.swept.faces, (True, False)):
            if half in done or self._face_left_of(half) not in self.cell_of:
                continue
            walk = [half]
            while (following := self._next(walk[-1])) != half:
                walk.append(following)
            done.update(walk)
            face = self._face_left_of(half)
            if self._is_hole(walk):
                holes.setdefault(face, []).append(self._sides(walk))
            elif face in outer:
                raise SweepError("a face has two outer boundaries")
            else:
                outer[face] = self._sides(walk)
        for face in self.cell_of:
            bounded = face not in self.swept.unbounded
            self.cells.append(
                Cell(self.label[face], bounded, outer.get(face), tuple(holes.get(face, ())))
            )

    def _face_left_of(self, half: HalfArc) -> int:
        arc, forward = half
        return self.swept.faces[arc][1 if forward else 0]

    def _is_hole(self, walk: list[HalfArc]) -> bool:
        """Whether the walk turns around its leftmost point on the outside.

        Just left of the leftmost point of an outer boundary there is another face; left of the
        leftmost point of a hole there is the face itself, between the highest and the lowest arc.
        """
        ends = [arc.start if forward else arc.end for arc, forward in walk]
        starts = [point for point in ends if point is not None]
        if len(starts) < len(ends):
            return False
        leftmost = min(starts, key=cmp_to_key(compare_points))
        junction = self.junction_at[leftmost.number.key]
        return not junction.left and (junction.right[-1], True) in walk

    def _sides(self, walk: list[HalfArc]) -> Walk:
        """The walk over whole edges and wall pieces."""
        sides = []
        for arc, forward in walk:
            if arc.is_wall:
                above_inside = self.swept.faces[arc][1] in self.cell_of
                sides.append(Side(self.wall_of[arc], forward == above_inside, is_wall=True))
                continue
            edge, position, along = self.piece_of[arc]
            entered = 0 if forward == along else len(self.chains[edge]) - 1
            if position == entered:
                sides.append(Side(edge, forward == along))
        return tuple(sides)


def _rotation(junction: Junction) -> list[HalfArc]:
    """The half-arcs that leave a junction, counter-clockwise from straight down."""
    return [(arc, True) for arc in junction.right] + [
        (arc, False) for arc in reversed(junction.left)
    ]


def _winner(segment: int | None) -> int:
    assert segment is not None
    return segment
