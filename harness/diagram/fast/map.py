"""A fast diagram as a planar map, whose objects are made when first asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any, TypeVar, overload

import numpy as np

from harness.diagram.counts import Domain, Objective
from harness.diagram.fast.counting import FastDiagram, fast_diagram
from harness.diagram.fast.courses import ArcCourse
from harness.diagram.fast.locate import FastLocator
from harness.diagram.fast.meeting import Meeting
from harness.diagram.fast.nesting import outer_walks
from harness.diagram.fast.nodes import KINDS
from harness.diagram.fast.places import node_point, place_of
from harness.diagram.fast.walks import Walks
from harness.diagram.fast.witnesses import witnesses
from harness.diagram.planar_map import Cell, Edge, Node, PlanarMap, RationalPoint, Wall
from harness.diagram.work import Contradiction
from harness.geometry.instance import Instance

T = TypeVar("T")


class Lazy(Sequence[T]):
    """A tuple of known length that is made when its members are first needed."""

    def __init__(self, length: int, make: Callable[[], tuple[T, ...]]) -> None:
        """``make`` is called once at most."""
        self._length = length
        self._make = make
        self._made: tuple[T, ...] | None = None

    def _all(self) -> tuple[T, ...]:
        if self._made is None:
            self._made = self._make()
            if len(self._made) != self._length:
                raise Contradiction(f"{len(self._made)} objects, {self._length} expected")
        return self._made

    def __len__(self) -> int:
        """Known without making anything."""
        return self._length

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[T, ...]: ...
    def __getitem__(self, index: Any) -> Any:
        """As of a tuple."""
        return self._all()[index]

    def __iter__(self) -> Iterator[T]:
        """As of a tuple."""
        return iter(self._all())


def build_fast(
    instance: Instance,
    domain: Domain,
    objective: Objective,
    corners: Sequence[RationalPoint],
    workers: int | None = None,
    subdivision: int = 0,
) -> PlanarMap:
    """The exact diagram of ``instance`` inside the polygon ``corners`` (none: the plane).

    ``corners``: those of :func:`harness.diagram.domain_corners`.  ``workers``: threads, by default
    one per processor; the map does not depend on their number.  ``subdivision``: which free points
    the root triangles are made with; the diagram does not depend on it, only the way there.

    Raises Contradiction if every choice of free points failed.
    """
    diagram = fast_diagram(instance, domain, objective, workers, subdivision)
    tally = diagram.counts()
    parts = _Parts(diagram)
    return PlanarMap(
        instance=instance,
        domain=domain,
        objective=objective,
        builder="fast",
        certified=True,
        nodes=Lazy(len(diagram.nodes.kind), parts.nodes),
        edges=Lazy(len(diagram.edges), parts.edges),
        cells=Lazy(diagram.cells, parts.cells),
        walls=parts.walls() if len(diagram.edges) < 1000 else Lazy(len(parts.walls()), parts.walls),
        corners=np.array([[float(c) for c in corner] for corner in corners]) if corners else None,
        witnesses=Lazy(diagram.cells, lambda: witnesses(diagram)),
        locator=FastLocator(diagram),
        tally=tally,
        work=diagram.work,
    )


class _Parts:
    """Makes the objects of the map."""

    def __init__(self, diagram: FastDiagram) -> None:
        self.diagram = diagram
        self._walks: Walks | None = None

    @property
    def walked(self) -> Walks:
        """The walks, made once."""
        if self._walks is None:
            self._walks = Walks(self.diagram)
        return self._walks

    def nodes(self) -> tuple[Node, ...]:
        """All nodes."""
        diagram, arrays, nodes = self.diagram, self.diagram.arrays, self.diagram.nodes
        meeting = Meeting(diagram)
        kinds = [KINDS[k] for k in nodes.kind.tolist()]
        degrees = nodes.degree.tolist()
        result: list[Node] = []
        for v, segments in enumerate(meeting.inside()):
            special = arrays.special.get(v)
            if special is not None:
                result.append(
                    replace(special, segments=tuple(sorted({*special.segments, *segments})))
                )
                continue
            point = node_point(diagram, v)
            result.append(Node(kinds[v], point, segments, degrees[v], False, _Later(diagram, v)))
        for corner in nodes.corners:
            k = len(result)
            segments, endpoint = meeting.at_corner(corner), meeting.is_endpoint(corner)
            point = node_point(diagram, k)
            later = _Later(diagram, k)
            result.append(Node(kinds[k], point, segments, degrees[k], endpoint, later))
        for port in nodes.ports.tolist():
            k = len(result)
            place = None if kinds[k] == "infinity" else _Later(diagram, k)
            segments = meeting.at_port(port)
            result.append(Node(kinds[k], node_point(diagram, k), segments, 1, False, place))
        return tuple(result)

    def edges(self) -> tuple[Edge, ...]:
        """All edges."""
        diagram = self.diagram
        rows = diagram.edges
        owners = diagram.arrays.owner[rows[:, 4:6]].tolist()
        cells = diagram.cell_of_slot[rows[:, 4:6]].tolist()
        return tuple(
            Edge(
                segments=(owner[0], owner[1]),
                start=None if row[0] < 0 else row[0],
                end=None if row[0] < 0 else row[1],
                left=cell[0],
                right=cell[1],
                course=ArcCourse(diagram, e),
            )
            for e, (row, owner, cell) in enumerate(zip(rows.tolist(), owners, cells, strict=True))
        )

    def walls(self) -> tuple[Wall, ...]:
        """All walls."""
        return tuple(self.walked.walls)

    def cells(self) -> tuple[Cell, ...]:
        """All cells."""
        diagram = self.diagram
        by_cell = self.walked.by_cell()
        outer = outer_walks(diagram, by_cell)
        result = []
        for c, segment in enumerate(diagram.cell_owners().tolist()):
            walks, first = by_cell.get(c, []), outer[c]
            holes = tuple(walk for k, walk in enumerate(walks) if k != first)
            around = None if first is None else walks[first]
            result.append(Cell(segment, c not in diagram.unbounded, around, holes))
        return tuple(result)


class _Later:
    """The place of a node, found when first asked for."""

    def __init__(self, diagram: FastDiagram, node: int) -> None:
        self._diagram = diagram
        self._node = node

    def enclosure(self, bits: int) -> tuple[RationalPoint, RationalPoint]:
        """See :class:`harness.diagram.planar_map.Place`."""
        place = place_of(self._diagram, self._node)
        assert place is not None
        return place.enclosure(bits)
