"""The method ``diagram``: the paper's naive algorithm, by the angular Voronoi diagram.

The greatest least visual angle is at a vertex of the diagram or on an edge where the circles of its
two segments touch (an edge may have several such points), or it is approached at an end of an
edge: a vertex of the polygon, a point on one of its edges.  All of these are looked at.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from flint import ctx

from harness.diagram import build
from harness.diagram.counts import Objective
from harness.diagram.planar_map import PlanarMap
from harness.geometry.visual_angle import visual_angle
from harness.peak.polygon import Floats, Polygon
from harness.peak.proof import prove
from harness.peak.result import Peak
from harness.peak.sampling import Ascent, ascent_over
from harness.peak.tangency import tangencies

FEW = 12
"""Up to so many edges the reference builder is quicker than compiling the other."""
BITS = 128
NEAR = 1e-7
"""How far, relative to the sizes there, a point in doubles may be from a line or vertex."""

#: A point with the edges (of the polygon, in its order) that decide there.
Candidate = tuple[tuple[float, float], tuple[int, ...]]


def built(polygon: Polygon, objective: Objective, builder: str | None) -> PlanarMap:
    """The diagram in the kernel, by a builder that suits the number of edges."""
    chosen = builder or ("reference" if polygon.n <= FEW else "fast")
    return build(polygon.instance, "kernel", objective, builder=chosen)


def diagram_peak(polygon: Polygon, builder: str | None = None) -> Peak:
    """The peak by the diagram: as dear as the diagram, and O(n) for every vertex and tangency.

    ``facts``: numbers of ``vertices`` and ``edges`` of the diagram and of ``tangencies`` of
    pairs with a common edge.  Raises :class:`harness.errors.UserError` as
    :func:`harness.diagram.build`, and ArithmeticError if the best candidate is not the peak: then
    the diagram is wrong.
    """
    found = built(polygon, "smallest", builder)
    ends = list(_ends(polygon, found))
    touching = [*tangent_points(polygon, found, 1), *tangent_points(polygon, found, -1)]
    segments = polygon.instance.segments
    best, angle = None, -1.0
    for candidate in (*ends, *touching):
        seen = _least(polygon, segments, candidate)
        if seen > angle:
            best, angle = candidate, seen
    if best is None:
        raise ArithmeticError(f"{polygon.instance.label}: a diagram without edges")
    among = np.array(sorted({*best[1], *_lines_through(polygon, best[0])}), dtype=np.int64)

    def search(start: float, edges: Floats) -> Ascent:
        return ascent_over(start, edges, among)

    facts = {"vertices": found.counts.vertices, "edges": found.counts.edges}
    peak = prove(polygon, search, "diagram", {**facts, "tangencies": len(touching)})
    if abs(peak.angle - angle) > NEAR:
        raise ArithmeticError(
            f"{polygon.instance.label}: the diagram's best angle is {angle}, not {peak.angle}"
        )
    return peak


def _positions(polygon: Polygon) -> dict[int, int]:
    """Segment of the instance → edge of the polygon."""
    return {int(name): k for k, name in enumerate(polygon.names)}


def _ends(polygon: Polygon, found: PlanarMap) -> Iterator[Candidate]:
    """The nodes, with the edges that tie there."""
    position = _positions(polygon)
    for node in found.nodes:
        yield node.point, tuple(position[k] for k in node.segments)


def tangent_points(polygon: Polygon, found: PlanarMap, sign: int) -> Iterator[Candidate]:
    """The tangencies, from outside (1) or inside (−1), of all pairs with a common edge."""
    position = _positions(polygon)
    pairs = {tuple(sorted(position[k] for k in edge.segments)) for edge in found.edges}
    exact = polygon.exact_edges
    for i, j in sorted(pairs):
        with ctx.workprec(BITS):
            for _, x, y in tangencies(exact[i], exact[j], sign):
                yield (float(x.mid()), float(y.mid())), (i, j)


def _lines_through(polygon: Polygon, p: tuple[float, float]) -> Sequence[int]:
    """The edges on whose lines p lies, as far as doubles tell."""
    a = np.stack([polygon.x, polygon.y], axis=1) - p
    b = np.roll(a, -1, axis=0)
    d = b - a
    area = a[:, 0] * d[:, 1] - a[:, 1] * d[:, 0]
    size = np.abs(a).sum(axis=1) * np.abs(d).sum(axis=1)
    return [int(k) for k in np.flatnonzero(np.abs(area) <= NEAR * size)]


def _least(polygon: Polygon, segments: Floats, candidate: Candidate) -> float:
    """The least visual angle at a candidate in doubles; −1 outside the kernel.

    Near a vertex of the polygon its two edges count with their cap, on an edge that edge with π.
    """
    (x, y), _ = candidate
    ax, ay = polygon.x - x, polygon.y - y
    bx, by = np.roll(ax, -1), np.roll(ay, -1)
    area = ax * by - ay * bx
    size = (np.abs(ax) + np.abs(ay)) * (np.abs(bx) + np.abs(by))
    if (area < -NEAR * size).any():
        return -1.0
    angles = np.nan_to_num(visual_angle((x, y), segments), nan=np.pi)[polygon.names]
    reach = np.abs(bx - ax) + np.abs(by - ay)
    (corners,) = np.nonzero(np.abs(ax) + np.abs(ay) <= NEAR * np.minimum(reach, np.roll(reach, 1)))
    for k in corners:
        ux, uy = ax[k] - ax[k - 1], ay[k] - ay[k - 1]
        vx, vy = bx[k] - ax[k], by[k] - ay[k]
        turn = np.arctan2(ux * vy - uy * vx, ux * vx + uy * vy)
        angles[k] = angles[k - 1] = (np.pi + turn) / 2
    return float(angles.min())
