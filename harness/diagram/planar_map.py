"""The planar map every builder returns: nodes, edges, cells, and how they touch.

The map is combinatorial.  Where its objects lie is known to *places* (of nodes) and *courses* (of
edges), which belong to the builder; this room needs no more of them than the two protocols below.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import DisjointSet

from harness.diagram.counts import Counts, Domain, NodeKind, Objective
from harness.diagram.work import Work
from harness.geometry import coordinates
from harness.geometry.instance import Instance

RationalPoint = coordinates.Point
Window = tuple[float, float, float, float]
VERTEX_KINDS = ("triple", "crossing", "saddle")


def _fraction(value: float | Fraction) -> Fraction:
    return value if isinstance(value, Fraction) else Fraction(float(value))


class Place(Protocol):
    """Exact isolating data of a point."""

    def enclosure(self, bits: int) -> tuple[RationalPoint, RationalPoint]:
        """Rational corners (low, high) of a box around the point, of about ``bits`` bits."""
        ...


class Course(Protocol):
    """The way of an edge between its ends."""

    def polyline(self, tolerance: float, window: Window | None) -> NDArray[np.float64]:
        """Points along the edge, shape (m, 2), at most ``tolerance`` away from it."""
        ...

    def cotangent_range(self) -> tuple[float, float]:
        """The infimum and supremum of cot θ over the open edge (±inf where unbounded)."""
        ...


@dataclass(frozen=True, eq=False)
class Node:
    """Where edges meet or end.

    ``point``: (x, y) as doubles; for kind ``infinity`` the unit vector of the direction in which
    the edge leaves.  ``segments``: those whose cells meet here and, unless a segment ends here, all
    others that win here, too; increasing.  ``degree``: edge ends at this node.  ``endpoint``:
    whether a segment ends here.
    """

    kind: NodeKind
    point: tuple[float, float]
    segments: tuple[int, ...]
    degree: int
    endpoint: bool = False
    place: Place | None = None


@dataclass(frozen=True, eq=False)
class Edge:
    """A Voronoi edge, directed from node ``start`` to node ``end`` (both None for a loop).

    ``segments`` = (winner to the left, winner to the right); ``left`` and ``right`` are the cells.
    Every unbounded end has its own node of kind ``infinity``.
    """

    segments: tuple[int, int]
    start: int | None
    end: int | None
    left: int
    right: int
    course: Course

    @property
    def is_loop(self) -> bool:
        """A closed edge without a node."""
        return self.start is None

    def polyline(self, tolerance: float, window: Window | None = None) -> NDArray[np.float64]:
        """Points from start to end, shape (m, 2), within ``tolerance`` of the true curve.

        That is proved of nearly every piece (:mod:`harness.diagram.chords`); where two branches of
        the bisector cross, and at the limits of doubles, it is checked in places close together.

        Unbounded ends are followed until they have left ``window`` (xmin, ymin, xmax, ymax), by
        default three times the box of the segments.  Outside the window the curve may be off by
        more, in proportion to the distance.
        """
        return self.course.polyline(tolerance, window)

    @cached_property
    def cotangent_range(self) -> tuple[float, float]:
        """(infimum, supremum) of cot θ of the two tied segments over the open edge."""
        return self.course.cotangent_range()


class Side(NamedTuple):
    """One step of a boundary walk: edge number ``item`` (with ``is_wall``: wall) and its sense.

    With ``forward`` the walk follows the edge's direction; the cell lies to its left either way.
    """

    item: int
    forward: bool
    is_wall: bool = False


Walk = tuple[Side, ...]


@dataclass(frozen=True)
class Wall:
    """A straight piece of the domain's boundary, with the domain to its left.

    ``ends``: the doubles of both ends; ``nodes``: the nodes there (None at a plain corner).
    """

    ends: tuple[tuple[float, float], tuple[float, float]]
    nodes: tuple[int | None, int | None]
    cell: int


@dataclass(frozen=True)
class Cell:
    """A Voronoi cell: a maximal connected piece of the region of ``segment``.

    ``outer`` runs counter-clockwise around the cell, through infinity where ``bounded`` is false
    (None only for an unbounded cell that no edge bounds at infinity); ``holes`` run clockwise.
    """

    segment: int
    bounded: bool
    outer: Walk | None
    holes: tuple[Walk, ...]

    @property
    def walks(self) -> tuple[Walk, ...]:
        """The outer walk, if any, and the holes."""
        return (*(() if self.outer is None else (self.outer,)), *self.holes)


@dataclass(frozen=True, eq=False)
class PlanarMap:
    """An angular Voronoi diagram.

    ``corners``: the counter-clockwise corners of the domain as doubles, (k, 2), or None for the
    plane.  ``witnesses``: exact points with the index of the cell they lie in (−1: outside), at
    least one for every cell.  ``locator`` finds the cell of an exact point: its index, −1 outside
    the domain, None on an edge or node.  ``tally``: the counts, from a builder that has them
    without looking at the objects.  ``work``: what the builder did, if it keeps account.
    """

    instance: Instance
    domain: Domain
    objective: Objective
    builder: str
    certified: bool
    nodes: Sequence[Node]
    edges: Sequence[Edge]
    cells: Sequence[Cell]
    walls: Sequence[Wall]
    corners: NDArray[np.float64] | None
    witnesses: Sequence[tuple[RationalPoint, int]] = field(repr=False)
    locator: Callable[[RationalPoint], int | None] = field(repr=False)
    tally: Counts | None = field(default=None, repr=False)
    work: Work | None = None

    @cached_property
    def counts(self) -> Counts:
        """The record of everything that is counted."""
        return self.recounted() if self.tally is None else self.tally

    def recounted(self) -> Counts:
        """The counts, from the objects themselves; O(nodes + edges + cells)."""
        kinds = Counter(node.kind for node in self.nodes)
        ends = sum(node.degree for node in self.nodes if node.kind == "boundary")
        vertices = [node for node in self.nodes if node.kind in VERTEX_KINDS]
        return Counts(
            domain=self.domain,
            objective=self.objective,
            builder=self.builder,
            n=self.instance.n,
            cells=len(self.cells),
            edges=len(self.edges),
            vertices=len(vertices),
            regions=len({cell.segment for cell in self.cells}),
            loops=sum(edge.is_loop for edge in self.edges),
            components=self._components(),
            unbounded=sum(not cell.bounded for cell in self.cells),
            boundary_points=kinds["boundary"],
            nodes={**kinds, "boundary": ends},
            degrees=dict(Counter(node.degree for node in vertices)),
            certified=self.certified,
        )

    def _components(self) -> int:
        """Components of edges ∪ nodes ∪ boundary; unbounded ends meet in one point, infinity."""
        names: list[object] = [k for k, node in enumerate(self.nodes) if node.kind != "infinity"]
        if any(node.kind == "infinity" for node in self.nodes):
            names.append("infinity")
        if self.corners is not None:
            names.append("boundary")
        parts: DisjointSet[object] = DisjointSet(names)
        for edge in self.edges:
            if edge.start is not None and edge.end is not None:
                parts.merge(self._anchor(edge.start), self._anchor(edge.end))
        for k, node in enumerate(self.nodes):
            if node.kind == "boundary":
                parts.merge(k, "boundary")
        return int(parts.n_subsets) + sum(edge.is_loop for edge in self.edges)

    def _anchor(self, node: int) -> object:
        return "infinity" if self.nodes[node].kind == "infinity" else node

    def locate(self, points: Sequence[Sequence[float | Fraction]]) -> list[int | None]:
        """The cell of each exact point: an index into ``cells``, −1 outside, None on an edge.

        ``points``: shape (m, 2).  Raises ValueError for coordinates that are not finite.
        """
        exact = []
        for x, y in points:
            if not (math.isfinite(x) and math.isfinite(y)):
                raise ValueError(f"({x}, {y}) is no point of the plane")
            exact.append((_fraction(x), _fraction(y)))
        return [self.locator(point) for point in exact]

    def sanity_check(self) -> None:
        """Check everything a diagram must satisfy.

        Raises:
            harness.diagram.checks.InsaneMap: names the first object that is wrong, and how.
        """
        from harness.diagram.checks import check

        check(self)
