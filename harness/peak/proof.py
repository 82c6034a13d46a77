"""From a search to a peak: three ways to prove an optimum, each taken if the one before fails.

1. In doubles, around a double point (:mod:`harness.peak.bounds`).  This is all that ordinary
   polygons need.
2. In doubles around an exact point, from which the coordinates are rounded anew: polygons far from
   the origin, kernels much smaller than the polygon, rational coordinates.
3. In rational arithmetic (:mod:`harness.peak.rational`): needles beyond the reach of doubles.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from flint import ctx

from harness.geometry.exact import ExactPoint, fraction, point
from harness.peak.ascent import cap_cotangent
from harness.peak.bounds import SEEN, angle_of, bound_of_start, cotangent_bound, least_angle
from harness.peak.cavity import certify, inside, place, unit_of
from harness.peak.polygon import Floats, Polygon
from harness.peak.powers import NONE
from harness.peak.rational import angle_ball, cap, least_edge, rational_ascent, rational_start
from harness.peak.result import WIDTH, Peak
from harness.peak.sampling import Ascent

#: The search: from a level and edges (4, n) near the origin to where the ascent ends.
Search = Callable[[float, Floats], Ascent]
BITS = 64
RECENTRED = 4


def prove(
    polygon: Polygon, search: Search, method: str, facts: Mapping[str, int] | None = None
) -> Peak:
    """The peak that ``search`` finds, with proven bounds at most 1e-12 apart.

    If ``search`` looks at the edges of a basis only and that is not the basis of the optimum, the
    proof fails on all other edges.  Raises :class:`harness.errors.UserError` if the kernel has no
    interior, ArithmeticError if no proof was found.
    """
    found = _by_doubles(polygon, search) if polygon.is_exact else None
    if found is None:
        found = _around_exact_points(polygon, search)
    return _peak(polygon, found, method, facts or {})


class _Found:
    """Bounds, the point they hold at, the constraints, and the vertex that the point is."""

    def __init__(
        self, lower: float, upper: float, p: ExactPoint, constraints: Any, vertex: int
    ) -> None:
        self.lower, self.upper, self.point = lower, upper, p
        self.constraints = [int(k) for k in constraints if k != NONE]
        self.vertex = vertex

    @property
    def is_certified(self) -> bool:
        return self.upper - self.lower <= WIDTH


def _by_doubles(polygon: Polygon, search: Search) -> _Found | None:
    """The first way; None if it does not prove enough."""
    n, x, y = polygon.n, polygon.x, polygon.y
    edges, out = np.empty((4, n)), np.empty(4)
    with np.errstate(over="ignore", invalid="ignore"):
        ox, oy, unit = float(np.mean(x)), float(np.mean(y)), unit_of(x, y, 0, n)
        place(ox, oy, unit, x, y, 0, n, 1, *edges)
        start, capped = polygon.start
        end = search(start, edges)
        px, py = inside(*end.point[:2], unit * (abs(ox) + abs(oy)), end.constraints, *edges)
        vertex = certify(
            *(end.level, start, capped, ox + px / unit, oy + py / unit, unit),
            *(end.constraints, end.multipliers),
            *(x, y, 0, n, 1, *edges, out),
        )
    if not out[3] - out[2] <= WIDTH:
        return None
    return _Found(
        float(out[2]), float(out[3]), point((out[0].item(), out[1].item())), end.constraints, vertex
    )


def _around_exact_points(polygon: Polygon, search: Search) -> _Found:
    """The second way and, if that does not prove enough, the third."""
    origin = polygon.inner_point()
    start, capped = polygon.start
    best: _Found | None = None
    named: list[int] = []
    for _ in range(RECENTRED):
        edges = polygon.edges_from(origin)
        end = search(start, edges)
        if not np.isfinite(end.point).all():
            break
        px, py = inside(*end.point[:2], 0.0, end.constraints, *edges)
        origin = polygon.moved(origin, float(px), float(py))
        named = [int(k) >> 1 for k in end.constraints if k != NONE]
        best = _best_of(polygon, origin, end, start, capped, best)
        if best is not None and best.is_certified:
            return best
    return _by_rationals(polygon, named)


def _best_of(
    polygon: Polygon,
    origin: ExactPoint,
    end: Ascent,
    start: float,
    capped: int,
    best: _Found | None,
) -> _Found | None:
    """The better of ``best`` and what is proven at a point, or an end of an edge of its basis."""
    ends = {(int(k) >> 1) + e for k in end.constraints if k != NONE for e in (0, 1)}
    corners = {i % polygon.n for i in ends} | ({capped} - {NONE})
    for corner in (NONE, *sorted(corners)):
        if best is not None and best.is_certified:
            break
        p = origin if corner == NONE else polygon.exact_vertex(corner)
        edges = polygon.edges_from(p)
        lower, edge = least_angle(corner, *edges, polygon.n)
        constraints: Sequence[int] = end.constraints.tolist()
        if corner != NONE:
            dx, dy = edges[2:]
            cap = cap_cotangent(dx[corner - 1], dy[corner - 1], dx[corner], dy[corner])
            own = angle_of(cap) - SEEN if cap > -np.inf else -1.0
            constraints = _at_vertex(polygon.n, corner, edge if lower < own else None)
            lower = min(lower, own)
        bound = cotangent_bound(end.level, end.constraints, end.multipliers, *edges, polygon.n)
        upper = min(bound_of_start(start), angle_of(bound), np.inf if best is None else best.upper)
        if best is not None:
            best.upper = min(best.upper, upper)
        if lower > 0 and (best is None or lower > best.lower):
            best = _Found(float(lower), float(upper), p, constraints, corner)
    return best


def _at_vertex(n: int, corner: int, least: int | None) -> list[int]:
    """The constraints of a peak in a vertex: its two edges, and one that is seen under less."""
    return [2 * ((corner - 1) % n), 2 * corner, *([] if least is None else [2 * int(least)])]


def _by_rationals(polygon: Polygon, named: list[int]) -> _Found:
    """The third way."""
    edges = polygon.exact_edges
    end = rational_ascent(edges, rational_start(edges, BITS), BITS, named)
    with ctx.workprec(2 * BITS):
        lower = float(angle_ball(end.reached).lower())
        upper = float(angle_ball(end.level).upper())
    lower, upper = float(np.nextafter(lower, 0.0)), float(np.nextafter(upper, 4.0))
    constraints: Sequence[int] = end.basis
    if end.vertex is not None:
        bound = end.reached > cap(edges, end.vertex, BITS)[1]
        least = least_edge(edges, end.point, end.vertex) if bound else None
        constraints = _at_vertex(polygon.n, end.vertex, least)
    vertex = NONE if end.vertex is None else end.vertex
    found = _Found(lower, upper, end.point, constraints, vertex)
    if not found.is_certified:
        raise ArithmeticError(f"{polygon.instance.label}: the peak is between {lower} and {upper}")
    return found


def _peak(polygon: Polygon, found: _Found, method: str, facts: Mapping[str, int]) -> Peak:
    """The result, in the numbers of the instance."""
    names = polygon.names
    x, y = (fraction(value) for value in found.point)
    return Peak(
        x=float(x),
        y=float(y),
        angle=min(
            found.upper,
            found.lower + SEEN
            if found.upper - found.lower > SEEN / 2
            else (found.lower + found.upper) / 2,
        ),
        basis=tuple(sorted({int(names[k >> 1]) for k in found.constraints})),
        lower=found.lower,
        upper=found.upper,
        point=(x, y),
        method=method,
        objective="max-min",
        walls=tuple(sorted(int(names[k >> 1]) for k in found.constraints if k & 1)),
        vertex=None if found.vertex == NONE else int(polygon.corners[found.vertex]),
        facts=dict(facts),
    )
