"""Section 3: superlevel sets of θ_min, convex in the kernel, and the single circle behind them."""

from __future__ import annotations

import random
from fractions import Fraction

from harness.audit import cases
from harness.audit.angles import (
    as_doubles,
    cotangents,
    forms,
    inner_points,
    middle,
    stays_inside,
)
from harness.audit.claim import Claim, Finding, as_facts
from harness.diagram.counts import Domain
from harness.geometry.instance import Instance
from harness.geometry.predicates import compare_visual_angles

PAIRS = 40
PARTS = (Fraction(1, 2), Fraction(1, 7), Fraction(9, 10))
POINTS = 24
#: The stream of test points depends on nothing: a check is a function of its instance.
SEED = 20060702


def check_convex(instance: Instance, domain: Domain) -> Finding:
    """θ_min at an inner point of a segment is at least the lesser of its values at the ends."""
    if not cases.star_shaped(instance):
        return Finding("outside")
    segments = instance.rational_segments()
    vertices = [instance.exact_vertex(k) for k in range(instance.n)]
    points = inner_points(instance, domain, random.Random(SEED), 2 * PAIRS)
    looked_at = 0
    for p, q in zip(points[::2], points[1::2], strict=False):
        if domain == "interior" and not stays_inside(p, q, vertices):
            continue
        at_ends = [cotangents(segments, end) for end in (p, q)]
        if at_ends[0] is None or at_ends[1] is None:
            continue
        level = max(*at_ends[0], *at_ends[1])
        for part in PARTS:
            m = middle(p, q, part)
            there = cotangents(segments, m)
            if there is None:
                continue
            looked_at += 1
            if max(there) > level:
                k = there.index(max(there))
                return Finding(
                    "fails",
                    f"from ({float(m[0]):.4g}, {float(m[1]):.4g}), between two points that see "
                    f"every edge under cot θ ≤ {float(level):.4g}, edge {k} has cot θ = "
                    f"{float(max(there)):.4g}: a smaller angle",
                    as_facts(triples=looked_at),
                    (as_doubles(p), as_doubles(m), as_doubles(q)),
                )
    if not looked_at:
        return Finding("outside")
    return Finding("holds", f"{looked_at} triples of points", as_facts(triples=looked_at))


def check_single_circle(instance: Instance, domain: Domain) -> Finding:
    """θ_p(s) ≥ α iff p is in one disc through the end points of s, the same for all p.

    The disc of level c = cot α is Q − c L ≤ 0, L positive on the inner side of s.  For every edge
    and test point, levels just under, at and just over the angle of the point are tried; θ ≥ α is
    decided by comparing with the visual angle of another segment whose cotangent is c.
    """
    if not cases.star_shaped(instance):
        return Finding("outside")
    segments = instance.rational_segments()
    looked_at = 0
    for p in inner_points(instance, domain, random.Random(SEED), POINTS):
        for k, s in enumerate(segments):
            q, area = forms(s, p)
            if area == 0:
                continue
            for step in (Fraction(-1, 100), Fraction(0), Fraction(1, 100)):
                c = q / abs(area) + step
                ruler = ((p[0] + 1, p[1]), (p[0] + c, p[1] + 1))  # seen from p under cot θ = c
                compared = compare_visual_angles(p, s, ruler)
                looked_at += 1
                if (compared is not None and compared >= 0) != (q - c * area <= 0):
                    return Finding(
                        "fails",
                        f"({float(p[0]):.4g}, {float(p[1]):.4g}) sees edge {k} under an angle with "
                        f"cot θ = {float(q / abs(area)):.4g}, yet with c = {float(c):.4g} it is on "
                        "the wrong side of the circle",
                        as_facts(comparisons=looked_at),
                        (as_doubles(p),),
                    )
    if not looked_at:
        return Finding("outside")
    return Finding("holds", f"{looked_at} comparisons", as_facts(comparisons=looked_at))


def convex_kernel(instance: Instance) -> Finding:
    """Convex level sets in the kernel."""
    return check_convex(instance, "kernel")


def convex_interior(instance: Instance) -> Finding:
    """Convex level sets in the interior."""
    return check_convex(instance, "interior")


def circle_kernel(instance: Instance) -> Finding:
    """A single circle in the kernel."""
    return check_single_circle(instance, "kernel")


def circle_interior(instance: Instance) -> Finding:
    """A single circle in the interior."""
    return check_single_circle(instance, "interior")


CONVEX = "the intersection of all of the regions R_α(s_i) is convex in the kernel"
CIRCLE = "the part of the region in the kernel … is characterized by a single circle"
INTERIOR = "if we are interested in the interior of a starshaped polygon … a disk instead"
EXACT = "rational arithmetic: visual angles are compared as cotangents, exactly"
POLYGONS = cases.together(
    (cases.lattice_stars(4, 5, 6, 8), 0.6),
    (
        cases.families(
            ("star", 8, {}), ("near-regular", 12, {}), ("cavity", 7, {}), ("zigzag", 10, {})
        ),
        0.4,
    ),
)

CLAIMS = (
    Claim(
        name="convex-levels",
        title="Convex level sets, kernel",
        gloss="{θ_min ≥ α} is convex in the kernel",
        quote=CONVEX,
        reading=(
            "For any two points of the kernel of a star-shaped polygon, every point between them "
            "sees the edges under a least angle that is not smaller than at both ends."
        ),
        failure="three collinear points of the kernel with the smallest least angle in the middle",
        arithmetic=EXACT,
        limits=(
            "A statement about all points, tried on random rational ones. It is a theorem: the "
            "level sets are intersections of discs with the kernel (see the single circle)."
        ),
        cases=POLYGONS,
        check=convex_kernel,
        count=200,
    ),
    Claim(
        name="convex-levels-interior",
        title="Convex level sets, interior",
        gloss="{θ_min ≥ α} is convex in the polygon",
        quote=INTERIOR,
        reading=(
            "The same in the whole interior of a star-shaped polygon, for points whose connecting "
            "segment stays inside. (The paper says interior in one half of the sentence and kernel "
            "in the other; the algorithm needs the kernel.)"
        ),
        failure="three such points with the smallest least angle in the middle",
        arithmetic=EXACT,
        limits="A failure is final: the kernel in the statement is needed.",
        cases=cases.lattice_stars(4, 5, 6),
        check=convex_interior,
        beyond=True,
        domain="interior",
        count=80,
    ),
    Claim(
        name="single-circle",
        title="Single circle, kernel",
        gloss="{θ ≥ α} is a disc in the kernel",
        quote=CIRCLE,
        reading=(
            "For every edge s of a star-shaped polygon and every angle α there is one disc, with "
            "both end points of s on its circle, that contains a point p of the kernel iff p sees "
            "s under at least α."
        ),
        failure="a point of the kernel that is on the wrong side of that circle",
        arithmetic=EXACT,
        limits=(
            "Tried on random points and levels. It is a theorem: the kernel lies on the inner side "
            "of every edge, where points of one angle form one arc."
        ),
        cases=POLYGONS,
        check=circle_kernel,
        count=120,
    ),
    Claim(
        name="single-circle-interior",
        title="Single circle, interior",
        gloss="{θ ≥ α} is a disc in the polygon",
        quote=INTERIOR,
        reading="The same for the points of the whole interior of the polygon.",
        failure="a point of the interior that is on the wrong side of the circle",
        arithmetic=EXACT,
        limits="A failure is final: outside the kernel, edges are seen from behind.",
        cases=cases.lattice_stars(4, 5, 6),
        check=circle_interior,
        beyond=True,
        domain="interior",
        count=80,
    ),
)
