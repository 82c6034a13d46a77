"""Lemma 4: how the visual angle runs along a Voronoi edge.

On a bisector the common angle of two segments has its extrema where their circles touch
(:mod:`harness.peak.tangency`).  With the circles' centres m + c h (c = cot θ) and the polynomial

    g(c) = |m_j − m_i + c (h_j − h_i)|² − ((l_i ± l_j)/2)² (1 + c²)

the circles of level c near a touching level cross iff g < 0 (+, touching from outside) or g > 0
(−, from inside).  If they cross on the side of greater angles only, the bisector has a strict
local minimum of θ there, if on the side of smaller angles only, a strict local maximum: the sign
of g' decides.  The point is on a Voronoi edge iff every other segment is seen under more.
All of that is decided in balls, so nothing depends on a diagram that was built.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from typing import Any

from flint import arb, ctx

from harness.audit import cases
from harness.audit.claim import Claim, Finding, as_facts
from harness.diagram.counts import Domain
from harness.geometry.exact import ExactPoint, point
from harness.geometry.instance import Instance
from harness.peak.rational import Edge
from harness.peak.rational import forms as exact_forms
from harness.peak.tangency import tangencies

Ball = Any

BITS = (128, 512)


@dataclass(frozen=True)
class Extremum:
    """A touching point of the circles of segments ``pair`` that lies on a Voronoi edge of both.

    ``is_minimum``: of θ along the edge; ``from_outside``: how the circles touch.
    """

    pair: tuple[int, int]
    at: tuple[float, float]
    cotangent: float
    is_minimum: bool
    from_outside: bool


@dataclass(frozen=True)
class Extrema:
    """All that were found, and how many points the last precision left open."""

    found: tuple[Extremum, ...]
    undecided: int


def extrema(instance: Instance, domain: Domain) -> Extrema:
    """All strict extrema of θ inside the Voronoi edges of the smallest angle; O(n³) balls.

    ``domain``: the plane, or the kernel of a star-shaped polygon.  Complete but for the points
    counted as undecided.
    """
    edges = [(point(a), point(b)) for a, b in instance.rational_segments()]
    found: list[Extremum] = []
    undecided = 0
    for i, j in combinations(range(len(edges)), 2):
        for one, other in _directions(edges[i], edges[j], domain):
            for sign in (1, -1):
                new, unknown = _of_pair(edges, (i, j), one, other, sign, domain)
                found += new
                undecided += unknown
    return Extrema(tuple(found), undecided)


def _directions(one: Edge, other: Edge, domain: Domain) -> Iterator[tuple[Edge, Edge]]:
    """Both segments with the side on which the point lies to their left."""
    ways = (False,) if domain == "kernel" else (False, True)
    for back, turned in product(ways, ways):
        yield one[::-1] if back else one, other[::-1] if turned else other


def _of_pair(
    edges: Sequence[Edge],
    pair: tuple[int, int],
    one: Edge,
    other: Edge,
    sign: int,
    domain: Domain,
) -> tuple[list[Extremum], int]:
    """The extrema of one pair, one choice of sides and one way of touching."""
    for bits in BITS:
        with ctx.workprec(bits):
            touches = tangencies(one, other, sign)
            verdicts = None
            if touches is not None:
                verdicts = [_kind(edges, pair, one, other, sign, t, domain) for t in touches]
        if touches is None or verdicts is None or None in verdicts:
            continue
        return [
            Extremum(pair, (float(x.mid()), float(y.mid())), float(c.mid()), verdict > 0, sign > 0)
            for (c, x, y), verdict in zip(touches, verdicts, strict=True)
            if verdict
        ], 0
    return [], 1


def _kind(
    edges: Sequence[Edge],
    pair: tuple[int, int],
    one: Edge,
    other: Edge,
    sign: int,
    touch: tuple[Ball, Ball, Ball],
    domain: Domain,
) -> int | None:
    """1 for a minimum on a Voronoi edge, −1 for a maximum, 0 for neither; None: not decided."""
    c, x, y = touch
    if _is_endpoint(one, other, x, y) or _is_endpoint(other, one, x, y):
        return 0  # a node, at which edges end
    on_left = [_forms(s, x, y)[1] for s in (one, other)]
    if any(area < 0 for area in on_left):
        return 0
    is_sure = all(area > 0 for area in on_left)
    for k, edge in enumerate(edges):
        if k in pair:
            continue
        q, area = _forms(edge, x, y)
        if domain == "kernel":
            if area < 0:
                return 0
            is_sure = is_sure and bool(area > 0)
        difference = q - c * abs(area)  # negative iff seen under more than the pair
        if difference > 0:
            return 0
        is_sure = is_sure and bool(difference < 0)
    slope = sign * _slope(one, other, sign, c)
    if not is_sure or not (slope > 0 or slope < 0):
        return None
    return 1 if slope > 0 else -1


def _is_endpoint(one: Edge, other: Edge, x: Ball, y: Ball) -> bool:
    """Whether the circles touch in an end point of ``one``; if balls allow it, exactly."""
    for e in one:
        if not (arb(x - e[0]).contains(0) and arb(y - e[1]).contains(0)):
            continue
        q, area = exact_forms(other, e)
        if area > 0:
            (px, py), (qx, qy) = (_centre(s, q / area) for s in (one, other))
            if (px - e[0]) * (qy - e[1]) == (py - e[1]) * (qx - e[0]):
                return True
    return False


def _centre(edge: Edge, c: Any) -> ExactPoint:
    """The centre of an edge's circle of level c."""
    mx, my, hx, hy, _ = _circle(edge)
    return mx + c * hx, my + c * hy


def _slope(one: Edge, other: Edge, sign: int, c: Ball) -> Ball:
    """g'(c)/2, see the module's text."""
    (mx, my, hx, hy, first), (nx, ny, kx, ky, second) = _circle(one), _circle(other)
    s = (arb(first).sqrt() + sign * arb(second).sqrt()) / 2
    dx, dy, ex, ey = nx - mx, ny - my, kx - hx, ky - hy
    return (arb(ex * ex + ey * ey) - s * s) * c + arb(dx * ex + dy * ey)


def _circle(edge: Edge) -> tuple[Any, Any, Any, Any, Any]:
    """Midpoint, half the normal to the left, the square of the length."""
    (ax, ay), (bx, by) = edge
    dx, dy = bx - ax, by - ay
    return (ax + bx) / 2, (ay + by) / 2, -dy / 2, dx / 2, dx * dx + dy * dy


def _forms(edge: Edge, x: Ball, y: Ball) -> tuple[Ball, Ball]:
    """Q and L at a point."""
    (ax, ay), (bx, by) = edge
    ux, uy, vx, vy = ax - x, ay - y, bx - x, by - y
    return arb(ux * vx + uy * vy), arb(ux * vy - uy * vx)


# --- the claims ----------------------------------------------------------------------------------


def _finding(seen: Extrema, bad: list[Extremum], what: str) -> Finding:
    facts = as_facts(
        minima=sum(e.is_minimum for e in seen.found),
        maxima=sum(not e.is_minimum for e in seen.found),
        open=seen.undecided,
    )
    marks = tuple(e.at for e in bad)
    if bad:
        e = bad[0]
        return Finding(
            "fails",
            f"the edge of segments {e.pair[0]} and {e.pair[1]} has a strict local {what} of the "
            f"visual angle at ({e.at[0]:.6g}, {e.at[1]:.6g}), where cot θ = {e.cotangent:.6g}",
            facts,
            marks,
        )
    if seen.undecided:
        return Finding("undecided", "a touching point could not be placed", facts)
    return Finding("holds", f"{len(seen.found)} extrema inside edges, none a {what}", facts)


def check_unimodal(instance: Instance, domain: Domain) -> Finding:
    """No Voronoi edge has a strict local minimum of θ inside."""
    seen = extrema(instance, domain)
    return _finding(seen, [e for e in seen.found if e.is_minimum], "minimum")


def check_plane(instance: Instance) -> Finding:
    """Lemma 4 for disjoint segments in the plane."""
    if instance.kind != "segments" or instance.n < 2 or not cases.generic(instance):
        return Finding("outside")
    return check_unimodal(instance, "plane")


def check_kernel(instance: Instance) -> Finding:
    """Lemma 4 in the kernel of a star-shaped polygon."""
    if not cases.star_shaped(instance):
        return Finding("outside")
    return check_unimodal(instance, "kernel")


def check_convex(instance: Instance) -> Finding:
    """Lemma 4, literally: a convex function has no strict local maximum."""
    if not cases.star_shaped(instance):
        return Finding("outside")
    seen = extrema(instance, "kernel")
    return _finding(seen, [e for e in seen.found if not e.is_minimum], "maximum")


QUOTE = "The function θ_min(p) is convex in each Voronoi edge."
ARITHMETIC = (
    "touching points of circles as roots of quadratics, their type and every comparison of angles "
    "in ball arithmetic (128, then 512 bits): certain, or undecided"
)
UNIMODAL = (
    "Along a Voronoi edge the visual angle of its two segments rises to at most one maximum and "
    "falls: it has no strict local minimum inside the edge. (So the introduction reads the lemma: "
    "“our objective function is unimodal on each Voronoi edge”.)"
)
FAILURE = (
    "a Voronoi edge with a strict local minimum of θ at an inner point; one instance refutes the "
    "lemma"
)

CLAIMS = (
    Claim(
        name="lemma-4-plane",
        title="Lemma 4, unimodal, plane",
        gloss="θ has no minimum inside an edge",
        quote=QUOTE,
        reading=UNIMODAL + " For disjoint segments in the plane, no two of them "
        "parallel, no end point on the line of another.",
        failure=FAILURE,
        arithmetic=ARITHMETIC,
        limits="A failure is final. The share of failures is that of these families, no more.",
        cases=cases.together(
            (cases.lattice_segments(2, 3, 4, admits=cases.generic), 0.75),
            (cases.families(("segments", 4, {}), ("segments", 8, {})), 0.25),
        ),
        check=check_plane,
        domain="plane",
        count=240,
    ),
    Claim(
        name="lemma-4-kernel",
        title="Lemma 4, unimodal, kernel",
        gloss="θ has no minimum inside an edge",
        quote=QUOTE,
        reading=UNIMODAL + " For the edges of a star-shaped polygon, inside its kernel.",
        failure=FAILURE,
        arithmetic=ARITHMETIC,
        limits="A failure is final. Without one, nothing is proved for other polygons.",
        cases=cases.together(
            (cases.lattice_stars(4, 5, 6, 7), 0.6),
            (
                cases.families(
                    ("cavity", 6, {}),
                    ("near-regular", 12, {}),
                    ("star", 8, {}),
                    ("convex-circle", 10, {}),
                    ("zigzag", 12, {}),
                    ("convex-weave", 12, {}),
                ),
                0.4,
            ),
        ),
        check=check_kernel,
        domain="kernel",
        count=1200,
    ),
    Claim(
        name="lemma-4-convex",
        title="Lemma 4, convex to the letter",
        gloss="θ is a convex function on each edge",
        quote=QUOTE,
        reading=(
            "Along a Voronoi edge θ_min is a convex function of the position, in some "
            "parametrisation: in particular it has no strict local maximum inside the edge. (The "
            "proof shows the contrary, that θ is greatest where the circles touch: what is meant "
            "is unimodality.)"
        ),
        failure="a Voronoi edge in a kernel with a strict local maximum of θ at an inner point",
        arithmetic=ARITHMETIC,
        limits="A failure is final; it concerns the word, not the intention of the lemma.",
        cases=cases.lattice_stars(4, 5, 6),
        check=check_convex,
        beyond=True,
        domain="kernel",
        count=120,
    ),
)
