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
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb, ctx

from harness.diagram import domain_corners
from harness.geometry.coordinates import Point
from harness.geometry.exact import ExactPoint, fraction, point
from harness.peak.candidates import (
    BITS,
    Candidate,
    angles_at,
    built,
    node_candidates,
    touching_candidates,
)
from harness.peak.polygon import Polygon
from harness.peak.rational import Edge, forms, rational_bounds
from harness.peak.result import WIDTH, Peak


def min_max_peak(polygon: Polygon, builder: str | None = None) -> Peak:
    """The point of the closed kernel with the least greatest visual angle.

    As dear as the diagram, and O(n) ball operations for each candidate.  ``facts``: ``candidates``.
    Raises :class:`harness.errors.UserError` as :func:`harness.diagram.build`.
    """
    found = built(polygon, "largest", builder)
    with ctx.workprec(BITS[0]):
        corners = list(_corners(polygon))
    touching = touching_candidates(polygon, found, -1, "largest")
    candidates = [*corners, *node_candidates(polygon, found), *touching]
    best = min(candidates, key=lambda one: float(one.angle.mid()))
    lower = min(float(one.angle.lower()) for one in candidates)
    upper = float(best.angle.upper())
    if not upper - lower <= WIDTH / 2:
        raise ArithmeticError(f"{polygon.instance.label}: the angle is in [{lower!r}, {upper!r}]")
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


def _decides(angles: list[Any], greatest: Any) -> tuple[int, ...]:
    """The edges whose angle may be the greatest."""
    return tuple(i for i, angle in enumerate(angles) if angle.overlaps(greatest))


def _greatest(angles: list[Any]) -> Any:
    """The maximum of balls."""
    greatest = angles[0]
    for angle in angles[1:]:
        greatest = greatest.max(angle)
    return greatest


def _corners(polygon: Polygon) -> Iterator[Candidate]:
    """The corners of the kernel and the vertices of the polygon on its boundary, exactly."""
    edges = polygon.exact_edges
    corners = [point(p) for p in domain_corners(polygon.instance, "kernel")]
    around = {
        _key(p): (corners[(k + 1) % len(corners)], corners[k - 1]) for k, p in enumerate(corners)
    }
    vertices = {_key(edge[0]): k for k, edge in enumerate(edges)}
    for p in corners:
        if _key(p) not in vertices:
            angles = angles_at(edges, *p)
            greatest = _greatest(angles)
            yield Candidate(arb(p[0]), arb(p[1]), greatest, _decides(angles, greatest))
    for vertex, (p, _) in enumerate(edges):
        if all(forms(edge, p)[1] >= 0 for edge in edges):
            yield _vertex(polygon, vertex, around.get(_key(p)))


def _vertex(
    polygon: Polygon, vertex: int, around: tuple[ExactPoint, ExactPoint] | None
) -> Candidate:
    """A vertex of the polygon; ``around``: the next corners, None on a straight side."""
    edges, own = polygon.exact_edges, ((vertex - 1) % polygon.n, vertex)
    p = edges[vertex][0]
    angles = angles_at(edges, *p, left_out=own)
    pair = _balanced(edges, own, p, around or (edges[own[1]][1], edges[own[0]][0]))
    greatest = _greatest([*angles, pair])
    decides = _decides(angles, greatest) + (own if pair.overlaps(greatest) else ())
    return Candidate(arb(p[0]), arb(p[1]), greatest, decides, vertex)


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
