"""A peak decided exactly, on request (:mod:`harness.peak.algebra`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from harness.peak.algebra import ExactPeak, Root, decide, decide_at_vertex
from harness.peak.polygon import Polygon
from harness.peak.rational import Edge, rational_ascent, rational_start
from harness.peak.result import Peak

BITS = (64, 160, 400)
"""The accuracies at which the basis is looked for, one after the other."""


def decided(polygon: Polygon, peak: Peak) -> Peak:
    """The same max-min peak with its optimal cotangent as an algebraic number, and all ties.

    O(n) rational operations for each pivot; meant for up to some thousand edges.  Raises
    ArithmeticError if the basis cannot be told apart at 400 bits.
    """
    edges = polygon.exact_edges
    place = {int(name): k for k, name in enumerate(polygon.names)}
    decision = None
    if peak.vertex is not None:
        corner = {int(name): k for k, name in enumerate(polygon.corners)}[peak.vertex]
        decision = decide_at_vertex(edges, corner)
    first = [place[name] for name in peak.basis]
    for bits in BITS:
        if decision is not None:
            break
        decision = _searched(edges, first, bits)
    if decision is None:
        raise ArithmeticError(f"{polygon.instance.label}: the basis could not be decided")
    root, tied = decision
    low, high = root.isolated
    names = tuple(sorted(int(polygon.names[k]) for k in tied))
    coefficients = tuple(int(value) for value in root.polynomial.coeffs())
    return replace(peak, exact=ExactPeak(coefficients, low, high, names))


def _searched(
    edges: Sequence[Edge], first: Sequence[int], bits: int
) -> tuple[Root, list[int]] | None:
    """The decision for the basis that a rational ascent of this accuracy ends with."""
    end = rational_ascent(edges, rational_start(edges, bits), bits, first)
    if end.vertex is not None:
        found = decide_at_vertex(edges, end.vertex)
        if found is not None:
            return found
    discs = [k >> 1 for k in end.basis if not k & 1]
    walls = [k >> 1 for k in end.basis if k & 1]
    return decide(edges, discs, walls, end.level, end.reached) if len(walls) < 2 else None
