"""The other objective: the least greatest visual angle in the kernel (the paper, end of section 2).

From the ``largest`` diagram.  No angle has a minimum of its own inside (it is harmonic) nor along a
line (cot θ is (s² + …)/(linear), without an inner maximum where the denominator is positive).  So
the least greatest angle is found

* at a node of the diagram, on its boundary included,
* on an edge where the circles of its two segments touch from inside,
* at a corner of the kernel; at one that is a vertex of the polygon, where two edges are seen under
  π − ψ and π − γ + ψ in direction ψ, it is approached along the direction that balances them best.

That these are all, is certified by the diagram; their angles are enclosed by balls, and the least
of the enclosures encloses the optimum.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb, ctx

from harness.diagram import domain_corners
from harness.diagram.planar_map import PlanarMap
from harness.geometry.coordinates import Point
from harness.geometry.exact import ExactPoint, fraction, point
from harness.peak.diagram import BITS, built
from harness.peak.polygon import Polygon
from harness.peak.rational import Edge, forms, rational_bounds
from harness.peak.result import Peak
from harness.peak.tangency import tangencies


@dataclass(frozen=True)
class _Candidate:
    """Enclosures of a point and of the greatest visual angle there, the edges that decide."""

    x: Any
    y: Any
    angle: Any
    edges: tuple[int, ...]
    vertex: int | None = None


def min_max_peak(polygon: Polygon, builder: str | None = None) -> Peak:
    """The point of the closed kernel with the least greatest visual angle.

    As dear as the diagram, and O(n) ball operations for each candidate.  ``facts``: ``candidates``.
    Raises :class:`harness.errors.UserError` as :func:`harness.diagram.build`.
    """
    found = built(polygon, "largest", builder)
    with ctx.workprec(BITS):
        candidates = [
            *_corners(polygon),
            *_nodes(polygon, found),
            *_touching(polygon, found),
        ]
        best = min(candidates, key=lambda one: float(one.angle.mid()))
        lower = min(float(one.angle.lower()) for one in candidates)
        upper = float(best.angle.upper())
        x, y = _middle(best.x), _middle(best.y)
    return Peak(
        x=float(x),
        y=float(y),
        angle=float(best.angle.mid()),
        basis=tuple(sorted(int(polygon.names[k]) for k in best.edges)),
        lower=float(np.nextafter(lower, 0.0)),
        upper=float(np.nextafter(upper, 4.0)),
        point=(x, y),
        method="diagram",
        objective="min-max",
        vertex=None if best.vertex is None else int(polygon.corners[best.vertex]),
        facts={"candidates": len(candidates)},
    )


def _middle(ball: Any) -> Fraction:
    """The middle of a ball, exactly."""
    return fraction(rational_bounds(ball.mid())[0])


def _angles(edges: list[Edge], x: Any, y: Any, left_out: tuple[int, ...] = ()) -> list[Any]:
    """The visual angles of the edges from the closed kernel in balls; −1 for those left out."""
    found = []
    for i, ((ax, ay), (bx, by)) in enumerate(edges):
        if i in left_out:
            found.append(arb(-1))
            continue
        ux, uy, vx, vy = ax - x, ay - y, bx - x, by - y
        area, q = ux * vy - uy * vx, ux * vx + uy * vy
        if isinstance(area, arb) and area.contains(0):  # never negative in the kernel
            area = arb(0).union(area.upper()) if area.upper() > 0 else arb(0)
        found.append(arb.atan2(arb(area), arb(q)))
    return found


def _decides(angles: list[Any], greatest: Any) -> tuple[int, ...]:
    """The edges whose angle may be the greatest."""
    return tuple(i for i, angle in enumerate(angles) if angle.overlaps(greatest))


def _greatest(angles: list[Any]) -> Any:
    """The maximum of balls."""
    greatest = angles[0]
    for angle in angles[1:]:
        greatest = greatest.max(angle)
    return greatest


def _corners(polygon: Polygon) -> Iterator[_Candidate]:
    """The corners of the kernel and the vertices of the polygon on its boundary, exactly."""
    edges = polygon.exact_edges
    corners = [point(p) for p in domain_corners(polygon.instance, "kernel")]
    around = {
        _key(p): (corners[(k + 1) % len(corners)], corners[k - 1]) for k, p in enumerate(corners)
    }
    vertices = {_key(edge[0]): k for k, edge in enumerate(edges)}
    for p in corners:
        if _key(p) not in vertices:
            angles = _angles(edges, *p)
            greatest = _greatest(angles)
            yield _Candidate(arb(p[0]), arb(p[1]), greatest, _decides(angles, greatest))
    for vertex, (p, _) in enumerate(edges):
        if all(forms(edge, p)[1] >= 0 for edge in edges):
            yield _vertex(polygon, vertex, around.get(_key(p)))


def _vertex(
    polygon: Polygon, vertex: int, around: tuple[ExactPoint, ExactPoint] | None
) -> _Candidate:
    """A vertex of the polygon; ``around``: the next corners, None on a straight side."""
    edges, own = polygon.exact_edges, ((vertex - 1) % polygon.n, vertex)
    p = edges[vertex][0]
    angles = _angles(edges, *p, left_out=own)
    pair = _balanced(edges, own, p, around or (edges[own[1]][1], edges[own[0]][0]))
    greatest = _greatest([*angles, pair])
    decides = _decides(angles, greatest) + (own if pair.overlaps(greatest) else ())
    return _Candidate(arb(p[0]), arb(p[1]), greatest, decides, vertex)


def _key(p: ExactPoint) -> Point:
    return fraction(p[0]), fraction(p[1])


def _balanced(
    edges: list[Edge], own: tuple[int, int], p: ExactPoint, around: tuple[ExactPoint, ExactPoint]
) -> Any:
    """The least of max(π − ψ, π − γ + ψ) over the directions that lead into the kernel.

    ψ is measured from edge ``own[1]``, which begins at p; the kernel lies between the directions
    to the corners ``around`` p, counter-clockwise.
    """
    first = _vector(p, edges[own[1]][1])
    last = _vector(p, edges[own[0]][0])
    gamma = _turned(first, last)
    low, high = (_turned(first, _vector(p, corner)) for corner in around)
    psi = (gamma / 2).max(low).min(high)
    return (arb.pi() - psi).max(arb.pi() - gamma + psi)


def _vector(p: ExactPoint, q: ExactPoint) -> ExactPoint:
    return q[0] - p[0], q[1] - p[1]


def _turned(u: ExactPoint, v: ExactPoint) -> Any:
    """The angle from u counter-clockwise to v, in [0, 2π); 0 for one direction."""
    sine, cosine = u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]
    angle = arb.atan2(arb(sine), arb(cosine))
    return angle if sine >= 0 else angle + 2 * arb.pi()


def _nodes(polygon: Polygon, found: PlanarMap) -> Iterator[_Candidate]:
    """The nodes off the polygon's vertices: their segments tie for the greatest angle."""
    position = {int(name): k for k, name in enumerate(polygon.names)}
    for node in found.nodes:
        if node.endpoint:
            continue  # a vertex of the polygon, looked at already
        if node.place is None:
            raise ArithmeticError(f"{polygon.instance.label}: a node without a place")
        low, high = node.place.enclosure(BITS)
        x, y = (_ball(low[k], high[k]) for k in (0, 1))
        tied = tuple(position[k] for k in node.segments)
        angles = _angles([polygon.exact_edges[k] for k in tied], x, y)
        yield _Candidate(x, y, min(angles, key=lambda ball: float(ball.rad())), tied)


def _ball(low: Fraction, high: Fraction) -> Any:
    """A ball around two rationals."""
    first, second = point((low, high))
    return arb(first).union(arb(second))


def _touching(polygon: Polygon, found: PlanarMap) -> Iterator[_Candidate]:
    """Tangencies from inside that are not certainly off the edges of the diagram."""
    position = {int(name): k for k, name in enumerate(polygon.names)}
    edges = polygon.exact_edges
    for i, j in sorted({tuple(sorted(position[k] for k in e.segments)) for e in found.edges}):
        for c, x, y in tangencies(edges[i], edges[j], -1):
            if not all(_may_be_left(edge, x, y) for edge in edges):
                continue
            angle = arb.atan2(arb(1), c)
            angles = _angles(edges, x, y)
            if not any(other > angle for other in angles):
                yield _Candidate(x, y, angle, (i, j))


def _may_be_left(edge: Edge, x: Any, y: Any) -> bool:
    """Whether a point in balls may be to the left of an edge, or on its line."""
    (ax, ay), (bx, by) = edge
    area = (ax - x) * (by - y) - (ay - y) * (bx - x)
    return not area < 0
