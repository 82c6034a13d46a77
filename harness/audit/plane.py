"""Peaks in the whole plane: Lemma 3 for segments, and the remark on two of them."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from harness.audit import cases
from harness.audit.angles import as_doubles, cotangents
from harness.audit.claim import Claim, Finding, as_facts
from harness.audit.diagrams import diagram
from harness.geometry.coordinates import Point
from harness.geometry.instance import Instance
from harness.geometry.visual_angle import cot_visual_angle

Floats = npt.NDArray[np.float64]

MARGIN = 1e-9
"""Relative to 1 + |cot θ|: far above the rounding of doubles, far below any difference that
matters here."""
GRID, BEST, HALVINGS = 48, 6, 45


def check_plane_peak(instance: Instance) -> Finding:
    """No point of the plane that a search comes to sees more than the best point of the edges."""
    if instance.kind != "segments" or instance.n < 2 or not cases.disjoint(instance):
        return Finding("outside")
    found = diagram(instance, "plane")
    on_edges = min(edge.cotangent_range[0] for edge in found.edges)
    x, y = _search(instance.segments)
    there = cotangents(instance.rational_segments(), (Fraction(x), Fraction(y)))
    if there is None:
        return Finding("undecided", "the search ended at an end point of a segment")
    least = float(max(there))
    facts = as_facts(cotangent_edges=on_edges, cotangent_search=least)
    if least < on_edges - MARGIN * (1.0 + abs(on_edges)):
        return Finding(
            "fails",
            f"({x:.6g}, {y:.6g}) sees every segment under cot θ ≤ {least:.9g}, no point of an edge "
            f"under less than {on_edges:.9g}",
            facts,
            ((x, y),),
        )
    return Finding("holds", f"search: cot θ = {least:.9g}, edges: {on_edges:.9g}", facts)


def _search(segments: Floats) -> tuple[float, float]:
    """Where a grid and a pattern search from its best points find the least angle greatest."""

    def worst(points: Floats) -> Floats:
        values = cot_visual_angle(points[:, np.newaxis], segments)
        return np.asarray(np.where(np.isnan(values), np.inf, values).max(axis=1))

    ends = segments.reshape(-1, 2)
    low, high = ends.min(axis=0), ends.max(axis=0)
    size = float((high - low).max())
    axes = (np.linspace(low[k] - size / 3, high[k] + size / 3, GRID) for k in (0, 1))
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    at = points[np.argsort(worst(points), kind="stable")[:BEST]]
    turns = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    around = np.concatenate([[[0.0, 0.0]], np.column_stack([np.cos(turns), np.sin(turns)])])
    step = 2.0 * size / GRID
    for _ in range(HALVINGS):
        tried = at[:, np.newaxis] + step * around
        values = worst(tried.reshape(-1, 2)).reshape(len(at), -1)
        chosen = values.argmin(axis=1)
        at = tried[np.arange(len(at)), chosen]
        step *= 0.6
    x, y = at[worst(at).argmin()].tolist()
    return x, y


def check_two_segments(instance: Instance) -> Finding:
    """The point of greatest least angle of two segments does not see the least greatest one.

    If a point sees both segments under more than another far away sees either, so does the best
    point: its greatest angle is not the least.
    """
    if instance.n != 2 or instance.kind != "segments" or not cases.disjoint(instance):
        return Finding("outside")
    segments = instance.rational_segments()
    ends = [p for s in segments for p in s]
    near = [(max(seen), p) for p in _between(ends) if (seen := cotangents(segments, p))]
    if not near:
        return Finding("undecided", "all test points are end points")
    best, p = min(near)
    size = max(abs(x) for end in ends for x in end) + 1
    there = cotangents(segments, (1000 * size, 777 * size)) or [best]
    facts = as_facts(least_near=best, greatest_far=min(there))
    if min(there) > best:
        return Finding(
            "fails",
            f"({float(p[0]):.4g}, {float(p[1]):.4g}) sees both under cot θ ≤ {float(best):.4g}, a "
            f"point far away sees both under cot θ ≥ {float(min(there)):.4g}",
            facts,
            (as_doubles(p),),
        )
    return Finding("holds", "no such point was found", facts)


def _between(ends: list[Point]) -> Iterator[Point]:
    """Some points among others: averages, with one of them counted up to three times."""
    for extra in (0, 1, 2):
        for k in range(len(ends)):
            weights = [1 + extra * (j == k) for j in range(len(ends))]
            yield (
                sum((w * e[0] for w, e in zip(weights, ends, strict=True)), Fraction(0))
                / sum(weights),
                sum((w * e[1] for w, e in zip(weights, ends, strict=True)), Fraction(0))
                / sum(weights),
            )


CLAIMS = (
    Claim(
        name="lemma-3-plane",
        title="Lemma 3, plane",
        gloss="no point sees more than the best of the edges",
        quote="Given a set S of line segments in the plane, a peak lies on some Voronoi edge",
        reading=(
            "For n ≥ 2 disjoint segments no point of the plane sees them under a least angle that "
            "is greater than the supremum over all Voronoi edges. (With n = 1 there is no edge, "
            "and with equal maxima no peak in the paper's sense.)"
        ),
        failure="a point whose least angle exceeds that supremum by more than 10⁻⁹ in cot θ",
        arithmetic=(
            "the point is found in doubles and judged exactly; the range of cot θ over each edge "
            "is certified, rounded to doubles"
        ),
        limits="A search of the plane may miss a point; the lemma's proof does not.",
        cases=cases.together(
            (cases.lattice_segments(2, 3, 4), 0.6), (cases.families(("segments", 4, {})), 0.4)
        ),
        check=check_plane_peak,
        domain="plane",
        count=50,
    ),
    Claim(
        name="two-segments",
        title="Two segments: max–min and min–max",
        gloss="max–min is min–max for n = 2",
        quote=(
            "If we have only two line segments, a point maximizing the smallest visual angle also "
            "minimizes the largest visual angle."
        ),
        reading=(
            "For two disjoint segments in the plane, the point of greatest least angle has the "
            "least greatest angle of all points."
        ),
        failure=(
            "a point that sees both segments under less than another sees the smaller of the two"
        ),
        arithmetic="rational arithmetic at both points",
        limits="A failure is final for the whole plane: far away, both angles vanish.",
        cases=cases.lattice_segments(2),
        check=check_two_segments,
        domain="plane",
        count=40,
    ),
)
