"""Lemma 1: the curves on which Voronoi edges lie."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from harness.audit import cases
from harness.audit.angles import as_doubles, forms, middle, winner
from harness.audit.claim import Claim, Finding, as_facts
from harness.audit.diagrams import diagram
from harness.diagram.planar_map import Edge, PlanarMap
from harness.geometry.bisector import Cubic, bisector_cubics
from harness.geometry.coordinates import Point
from harness.geometry.instance import Instance

Segment = tuple[Point, Point]

SHIFTS = (2.0**-3, 2.0**-6, 2.0**-10, 2.0**-15, 2.0**-22)
"""How far from the edge, in units of the distance to the next point of its polyline, the two
points are taken that see different segments smallest."""
MOST_EDGES = 12
"""Edges looked at in each diagram, evenly spread over its list."""
DEGREE = 3


def crossing(
    found: PlanarMap, edge: Edge, segments: list[Segment]
) -> tuple[Point, Point, int] | None:
    """Two rational points, one in either cell of an edge, close to each other; None if not found.

    That the left segment alone is seen smallest from the first and the right one from the second
    is checked exactly, so that the edge certainly passes between them; and that both points are
    on the same side of either segment's line.  The third item is the sign of L_i L_j there.
    """
    shape = found.instance.segments.reshape(-1, 2) if found.corners is None else found.corners
    line = edge.polyline(1e-3 * float(np.ptp(shape, axis=0).max()))
    k = len(line) // 2
    (x0, y0), (x1, y1) = line[k - 1].tolist(), line[k].tolist()
    x, y = (x0 + x1) / 2, (y0 + y1) / 2
    if not math.isfinite(x + y):
        return None
    for shift in SHIFTS:
        dx, dy = shift * (y0 - y1), shift * (x1 - x0)
        left = (Fraction(x + dx), Fraction(y + dy))
        right = (Fraction(x - dx), Fraction(y - dy))
        if (winner(segments, left), winner(segments, right)) != edge.segments:
            continue
        areas = [[forms(segments[k], p)[1] for k in edge.segments] for p in (left, right)]
        if all(one * two > 0 for one, two in zip(*areas, strict=True)):
            return left, right, 1 if areas[0][0] * areas[0][1] > 0 else -1
    return None


def _some(edges: Sequence[Edge]) -> Sequence[Edge]:
    return edges[:: max(1, -(-len(edges) // MOST_EDGES))]


def restricted(cubic: Cubic, p: Point, q: Point) -> list[Fraction]:
    """The coefficients (of t⁰ first) of a cubic along p + t (q − p), by interpolation at 5 points.

    Five, so that a degree above three would show as a coefficient of t⁴.
    """
    values = [cubic(*middle(p, q, Fraction(t))) for t in range(DEGREE + 2)]
    total = [Fraction(0)] * len(values)
    for i, value in enumerate(values):
        basis = [Fraction(1)]
        for j in range(len(values)):
            if j != i:
                shifted = [Fraction(0), *basis]
                basis = [
                    (a - j * b) / (i - j)
                    for a, b in zip(shifted, [*basis, Fraction(0)], strict=True)
                ]
        total = [a + value * b for a, b in zip(total, basis, strict=True)]
    return total


def check_cubic(instance: Instance) -> Finding:
    """Every edge lies on one of the two cubics of its pair, that of its side."""
    if not cases.is_valid(instance) or instance.n < 2:
        return Finding("outside")
    segments = instance.rational_segments()
    found = diagram(instance, "plane" if instance.kind == "segments" else "kernel")
    counts = {1: 0, -1: 0}
    unknown = 0
    for edge in _some(found.edges):
        gap = crossing(found, edge, segments)
        if gap is None:
            unknown += 1
            continue
        left, right, way = gap
        cubic = bisector_cubics(*(segments[k] for k in edge.segments))[0 if way > 0 else 1]
        along = restricted(cubic, left, right)
        changes = cubic(*left) * cubic(*right) < 0
        if any(along[DEGREE + 1 :]) or not any(cubic.coefficients) or not changes:
            return Finding(
                "fails",
                f"the edge of segments {edge.segments[0]} and {edge.segments[1]} is not on their "
                "cubic",
                as_facts(edges=len(found.edges)),
                (as_doubles(left),),
            )
        counts[way] += 1
    facts = as_facts(edges=len(found.edges), plus=counts[1], minus=counts[-1], unknown=unknown)
    if not counts[1] + counts[-1]:
        return Finding("undecided", "no edge could be crossed", facts)
    return Finding("holds", f"{counts[1]} edges on F₊, {counts[-1]} on F₋", facts)


def check_one_cubic(instance: Instance) -> Finding:
    """All edges of one pair lie on one and the same cubic."""
    if instance.n < 2 or instance.kind != "segments" or not cases.generic(instance):
        return Finding("outside")
    segments = instance.rational_segments()
    found = diagram(instance, "plane")
    seen: dict[frozenset[int], set[int]] = {}
    marks: dict[frozenset[int], list[tuple[float, float]]] = {}
    for edge in found.edges:
        gap = crossing(found, edge, segments)
        if gap is not None:
            pair = frozenset(edge.segments)
            seen.setdefault(pair, set()).add(gap[2])
            marks.setdefault(pair, []).append(as_doubles(gap[0]))
    both = sorted(sorted(pair) for pair, ways in seen.items() if len(ways) == 2)
    facts = as_facts(pairs=len(seen), on_both=len(both))
    if both:
        return Finding(
            "fails",
            f"segments {both[0][0]} and {both[0][1]} have edges on F₊ and edges on F₋",
            facts,
            tuple(marks[frozenset(both[0])]),
        )
    return Finding("holds", f"{len(seen)} pairs with edges, each on one cubic", facts)


QUOTE = (
    "Edges of an angular Voronoi diagram are described by polynomial curves of degree at most "
    "three."
)

CLAIMS = (
    Claim(
        name="lemma-1",
        title="Lemma 1",
        gloss="edges lie on curves of degree at most three",
        quote=QUOTE,
        reading=(
            "Every Voronoi edge lies on the zeros of one polynomial of degree at most three that "
            "does not vanish identically: F₊ = Q_i L_j − Q_j L_i if both segments are seen from "
            "the same side, F₋ = Q_i L_j + Q_j L_i otherwise."
        ),
        failure=(
            "an edge between whose cells (two points, one in either cell, checked exactly) that "
            "polynomial does not change its sign, vanishes identically, or has degree four along "
            "the line through them"
        ),
        arithmetic="rational arithmetic on both sides of each edge; certified diagrams",
        limits=(
            "One place on each edge is tried. The lemma is an identity: Q_i |L_j| = Q_j |L_i| on a "
            "bisector; the check says that the diagrams of this program obey it."
        ),
        cases=cases.together(
            (cases.lattice_segments(2, 3, 4), 0.5),
            (cases.families(("segments", 5, {}), ("star", 8, {}), ("zigzag", 8, {})), 0.3),
            (cases.lattice_stars(4, 6), 0.2),
        ),
        check=check_cubic,
        domain="plane",
        count=60,
    ),
    Claim(
        name="lemma-1-one-curve",
        title="Lemma 1, one curve for a pair",
        gloss="equation (5) describes all edges of a pair",
        quote=(
            "y{(x − a)² + (y − b)² − l²} − l{(x − a) sin φ − (y − b) cos φ}(x² + y² − 1) = 0 (5). "
            "This completes the proof of the lemma."
        ),
        reading=(
            "One such polynomial, equation (5), describes all edges of a pair of segments. (The "
            "proof takes one circle for each segment and level where there are two; which of the "
            "two cubics (5) is depends on which of its directions, φ or φ + π, the second segment "
            "is given.) Disjoint segments, no two parallel, no end point on another's line."
        ),
        failure="a pair with edges on both of its cubics; one instance refutes this reading",
        arithmetic="as for Lemma 1",
        limits="A failure is final. It concerns the proof's equation; the lemma itself stands.",
        cases=cases.together(
            (cases.lattice_segments(2, 3, admits=cases.generic), 0.7),
            (cases.families(("segments", 4, {})), 0.3),
        ),
        check=check_one_cubic,
        beyond=True,
        domain="plane",
        count=40,
    ),
)
