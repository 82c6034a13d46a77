"""The method ``diagram``: the paper's naive algorithm, by the angular Voronoi diagram.

The greatest least visual angle is at a vertex of the diagram or on an edge where the circles of its
two segments touch (an edge may have several such points), or it is approached at an end of an
edge: a vertex of the polygon, a point on one of its edges.  All of these are looked at.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from flint import arb, ctx

from harness.peak.candidates import (
    BITS,
    Candidate,
    angles_at,
    built,
    lines_through,
    node_candidates,
    touching_candidates,
)
from harness.peak.polygon import Floats, Polygon
from harness.peak.proof import prove
from harness.peak.rational import cap, forms
from harness.peak.result import Peak
from harness.peak.sampling import Ascent, ascent_over


def diagram_peak(polygon: Polygon, builder: str | None = None) -> Peak:
    """The peak by the diagram: as dear as the diagram, and O(n) for every vertex and tangency.

    ``facts``: numbers of ``vertices`` and ``edges`` of the diagram and of ``tangencies`` on them.
    Raises :class:`harness.errors.UserError` as :func:`harness.diagram.build`, and ArithmeticError
    if the best candidate is not the peak: then the diagram is wrong.
    """
    found = built(polygon, "smallest", builder)
    touching = [
        one for sign in (1, -1) for one in touching_candidates(polygon, found, sign, "smallest")
    ]
    candidates = [*vertex_candidates(polygon), *node_candidates(polygon, found), *touching]
    if not candidates:
        raise ArithmeticError(f"{polygon.instance.label}: a diagram without candidates")
    best = max(candidates, key=lambda one: float(one.angle.mid()))
    with ctx.workprec(BITS[0]):
        walls = lines_through(polygon.exact_edges, best.x, best.y)
    among = np.array(sorted({*best.edges, *walls}), dtype=np.int64)

    def search(start: float, edges: Floats) -> Ascent:
        return ascent_over(start, edges, among)

    facts = {"vertices": found.counts.vertices, "edges": found.counts.edges}
    peak = prove(polygon, search, "diagram", {**facts, "tangencies": len(touching)})
    if best.angle < peak.lower or best.angle > peak.upper:
        raise ArithmeticError(
            f"{polygon.instance.label}: the diagram's best angle is {float(best.angle.mid())!r}, "
            f"not {peak.angle!r}"
        )
    return peak


def vertex_candidates(polygon: Polygon) -> Iterator[Candidate]:
    """The vertices in the closed kernel; their own edges count with the cap π − γ/2 of the vertex.

    See :mod:`harness.peak.ascent`.
    """
    edges = polygon.exact_edges
    for vertex, (p, _) in enumerate(edges):
        own = ((vertex - 1) % polygon.n, vertex)
        if any(forms(edge, p)[1] < 0 for edge in edges):
            continue
        with ctx.workprec(BITS[0]):
            low, high = cap(edges, vertex, BITS[0])
            least = arb.atan2(arb(1), arb(low).union(arb(high)))
            angles = angles_at(edges, *p)
            for k in own:
                angles[k] = least
            for angle in angles:
                least = least.min(angle)
            decide = tuple(k for k, angle in enumerate(angles) if angle.overlaps(least))
            yield Candidate(arb(p[0]), arb(p[1]), least, (*own, *decide), vertex)
