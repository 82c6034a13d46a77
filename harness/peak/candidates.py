"""Where the diagram says that an optimum may be, in balls: for either objective.

An optimum is at a vertex of the polygon, at another node of the diagram, or on a Voronoi edge
where the circles of its two segments touch (or, for min–max, at a corner of the kernel).  Angles
are enclosed with as many bits as it takes to tell points in the kernel from points outside.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import arb, ctx

from harness.diagram import build
from harness.diagram.counts import Objective
from harness.diagram.planar_map import Node, PlanarMap
from harness.geometry.exact import point
from harness.peak.polygon import Polygon
from harness.peak.rational import Edge
from harness.peak.tangency import tangencies

Ball = Any

FEW = 12
"""Up to so many edges the reference builder is quicker than compiling the other."""
BITS = (128, 512, 2048)
SHARP = 2.0**-60
"""The greatest radius of an angle of a node."""


@dataclass(frozen=True)
class Candidate:
    """Enclosures of a point and of the angle that counts there, the edges that decide.

    ``vertex``: the vertex (in the polygon's order) that the point is, or None.
    """

    x: Ball
    y: Ball
    angle: Ball
    edges: tuple[int, ...]
    vertex: int | None = None


def built(polygon: Polygon, objective: Objective, builder: str | None) -> PlanarMap:
    """The diagram in the kernel, by a builder that suits the number of edges."""
    chosen = builder or ("reference" if polygon.n <= FEW else "fast")
    return build(polygon.instance, "kernel", objective, builder=chosen)


def angles_at(edges: Sequence[Edge], x: Ball, y: Ball, left_out: Sequence[int] = ()) -> list[Ball]:
    """The visual angles of the edges from a point of the closed kernel; those left out are 0."""
    found = []
    for i, edge in enumerate(edges):
        if i in left_out:
            found.append(arb(0))
            continue
        area, q = _forms(edge, x, y)
        if isinstance(area, arb) and area.contains(0):  # never negative in the kernel
            area = arb(0).union(area.upper()) if area.upper() > 0 else arb(0)
        found.append(arb.atan2(arb(area), arb(q)))
    return found


def lines_through(edges: Sequence[Edge], x: Ball, y: Ball) -> list[int]:
    """The edges on whose lines a point may lie."""
    return [i for i, edge in enumerate(edges) if arb(_forms(edge, x, y)[0]).contains(0)]


def node_candidates(polygon: Polygon, found: PlanarMap) -> Iterator[Candidate]:
    """The nodes off the polygon's vertices: their segments tie for the angle that counts."""
    position = positions(polygon)
    for node in found.nodes:
        if not node.endpoint:
            yield _of_node(polygon, node, tuple(position[k] for k in node.segments))


def touching_candidates(
    polygon: Polygon, found: PlanarMap, sign: int, objective: Objective
) -> Iterator[Candidate]:
    """Where circles of pairs with a common Voronoi edge touch, from outside (1) or inside (−1).

    Only points of the closed kernel in which no other edge is seen under less (``smallest``) or
    more (``largest``).  What the last precision cannot tell from the kernel's boundary counts as
    on it, unless it cannot be told from a vertex either: vertices are candidates of their own.
    """
    position = positions(polygon)
    pairs = {tuple(sorted(position[k] for k in edge.segments)) for edge in found.edges}
    for i, j in sorted(pairs):
        yield from _touching(polygon, (i, j), sign, objective)


def positions(polygon: Polygon) -> dict[int, int]:
    """Segment of the instance → edge of the polygon."""
    return {int(name): k for k, name in enumerate(polygon.names)}


def _forms(edge: Edge, x: Ball, y: Ball) -> tuple[Ball, Ball]:
    """L and Q of an edge at a point, in balls or exactly."""
    (ax, ay), (bx, by) = edge
    ux, uy, vx, vy = ax - x, ay - y, bx - x, by - y
    return ux * vy - uy * vx, ux * vx + uy * vy


def _of_node(polygon: Polygon, node: Node, tied: tuple[int, ...]) -> Candidate:
    """A node and the narrowest enclosure of the common angle of its segments."""
    label = polygon.instance.label
    if node.place is None:
        raise ArithmeticError(f"{label}: a node without a place")
    for bits in BITS:
        low, high = node.place.enclosure(bits)
        with ctx.workprec(bits):
            x, y = (_ball(low[k], high[k]) for k in (0, 1))
            angles = angles_at([polygon.exact_edges[k] for k in tied], x, y)
            narrowest = min(angles, key=lambda ball: float(ball.rad()))
            if narrowest.rad() < SHARP:
                return Candidate(x, y, narrowest, tied)
    raise ArithmeticError(f"{label}: a node too close to a vertex for {BITS[-1]} bits")


def _ball(low: Fraction, high: Fraction) -> Ball:
    """A ball around two rationals."""
    first, second = point((low, high))
    return arb(first).union(arb(second))


def _touching(
    polygon: Polygon, pair: tuple[int, int], sign: int, objective: Objective
) -> list[Candidate]:
    """The candidates of one pair of edges."""
    edges = polygon.exact_edges
    for bits in BITS:
        with ctx.workprec(bits):
            touches = tangencies(edges[pair[0]], edges[pair[1]], sign)
            if touches is None:
                continue
            verdicts = [_counts(edges, touch, objective) for touch in touches]
            if None in verdicts and bits < BITS[-1]:
                continue
            return [
                Candidate(x, y, arb.atan2(arb(1), c), pair)
                for verdict, (c, x, y) in zip(verdicts, touches, strict=True)
                if verdict or (verdict is None and not _is_vertex(edges, x, y))
            ]
    raise ArithmeticError(f"{polygon.instance.label}: circles of edges {pair} cannot be resolved")


def _counts(
    edges: Sequence[Edge], touch: tuple[Ball, Ball, Ball], objective: Objective
) -> bool | None:
    """Whether a touching point is in the open kernel and no edge beats the pair; None: unknown."""
    c, x, y = touch
    areas = [_forms(edge, x, y)[0] for edge in edges]
    if any(area < 0 for area in areas):
        return False
    angle = arb.atan2(arb(1), c)
    for other in angles_at(edges, x, y):
        if other < angle if objective == "smallest" else other > angle:
            return False
    return True if all(area > 0 for area in areas) else None


def _is_vertex(edges: Sequence[Edge], x: Ball, y: Ball) -> bool:
    """Whether the enclosure of a point holds a vertex."""
    return any((x - px).contains(0) and (y - py).contains(0) for (px, py), _ in edges)
