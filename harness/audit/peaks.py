"""Lemma 3, section 3 and Theorem 7: where the peak of a kernel is, and how it is found."""

from __future__ import annotations

import math
from collections.abc import Sequence

from harness.audit import cases
from harness.audit.claim import Claim, Finding, Row, Series, as_facts
from harness.audit.diagrams import diagram
from harness.audit.growing import series_of
from harness.diagram.planar_map import VERTEX_KINDS, PlanarMap
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.peak.candidates import node_candidates
from harness.peak.door import peak
from harness.peak.polygon import Polygon
from harness.peak.result import Peak

MARGIN = 1e-9
"""Relative to 1 + |cot θ|: far above the rounding of doubles, far below any difference that
matters here."""
#: Theorem 7: comparisons ≤ COMPARISONS · n log₂² n, decisions ≤ DECISIONS · log₂² n + SETTLING (to
#: begin and to end the search takes up to so many, whatever n is).
COMPARISONS, DECISIONS, SETTLING = 12.0, 4.0, 100.0


# --- Lemma 3 -------------------------------------------------------------------------------------


def check_kernel_peak(instance: Instance) -> Finding:
    """The peak of a kernel ties two edges or more, and the diagram has that edge or vertex."""
    if not cases.star_shaped(instance):
        return Finding("outside")
    best = peak(instance, exact=True)
    if best.vertex is not None or best.exact is None:
        return Finding("outside", "the optimum is approached at a vertex and not attained")
    tied = best.exact.tied
    facts = as_facts(tied=len(tied), walls=len(best.walls))
    mark = ((best.x, best.y),)
    if len(tied) < 2:
        return Finding("fails", f"only edge {tied[0]} has the optimal angle", facts, mark)
    if not _is_on_an_edge(diagram(instance, "kernel"), tied, best):
        return Finding("fails", f"no Voronoi edge or vertex of {tied} at the peak", facts, mark)
    return Finding("holds", f"edges {', '.join(map(str, tied))} tie at the peak", facts, mark)


def _is_on_an_edge(found: PlanarMap, tied: Sequence[int], best: Peak) -> bool:
    """Whether an edge of two tied segments holds the optimal cotangent, or a vertex all of them."""
    c = 1.0 / math.tan(best.angle)
    slack = MARGIN * (1.0 + abs(c))
    on_edge = any(
        set(edge.segments) <= set(tied)
        and edge.cotangent_range[0] - slack <= c <= edge.cotangent_range[1] + slack
        for edge in found.edges
    )
    return on_edge or any(set(tied) <= set(node.segments) for node in found.nodes)


# --- section 3 -----------------------------------------------------------------------------------


def check_not_a_vertex(instance: Instance) -> Finding:
    """Every Voronoi vertex sees less than the optimal angle (proven bounds)."""
    if not cases.star_shaped(instance):
        return Finding("outside")
    best = peak(instance)
    if best.vertex is not None:
        return Finding("outside", "the optimum is approached at a vertex and not attained")
    polygon = Polygon(instance)
    found = diagram(instance, "kernel")
    if not found.counts.vertices:
        return Finding("outside", "there is no Voronoi vertex")
    nodes = [node for node in found.nodes if not node.endpoint]
    candidates = node_candidates(polygon, found)
    greatest = 0.0
    for node, candidate in zip(nodes, candidates, strict=True):
        if node.kind in VERTEX_KINDS:
            greatest = max(greatest, float(candidate.angle.upper()))
    facts = as_facts(optimum=best.lower, at_vertices=greatest, vertices=found.counts.vertices)
    mark = ((best.x, best.y),)
    if greatest < best.lower:
        return Finding(
            "holds",
            f"the optimum is {math.degrees(best.lower):.4f}°, vertices have at most "
            f"{math.degrees(greatest):.4f}°",
            facts,
            mark,
        )
    return Finding("fails", "the optimum is at a Voronoi vertex", facts, mark)


def check_naive(instance: Instance) -> Finding:
    """The best of all vertices and touching points on edges is the peak."""
    if not cases.star_shaped(instance):
        return Finding("outside")
    best = peak(instance)
    try:
        other = peak(instance, "diagram", builder="fast")
    except ArithmeticError as error:
        return Finding("fails", str(error), {}, ((best.x, best.y),))
    return _compared(best, other, other.facts)


def _compared(best: Peak, other: Peak, facts: object) -> Finding:
    """Whether two proven enclosures have a number in common."""
    numbers = as_facts(**dict(facts))  # type: ignore[call-overload]  # a mapping of numbers
    if max(best.lower, other.lower) > min(best.upper, other.upper):
        return Finding(
            "fails", f"{best.method}: {best.angle!r}, {other.method}: {other.angle!r}", numbers
        )
    return Finding("holds", f"both find {math.degrees(best.angle):.6f}°", numbers)


def check_parametric(instance: Instance) -> Finding:
    """Parametric search finds the proven peak, within the bounds on its operations."""
    if not cases.star_shaped(instance):
        return Finding("outside")
    best = peak(instance)
    try:
        other = peak(instance, "parametric")
    except UserError:
        return Finding("undecided", "parametric search in doubles does not reach the peak")
    n, log = instance.n, math.log2(instance.n)
    comparisons = other.facts["comparisons"] / (n * log**2)
    decisions = (other.facts["decisions"] - SETTLING) / log**2
    found = _compared(best, other, other.facts)
    if found.outcome == "holds" and (comparisons > COMPARISONS or decisions > DECISIONS):
        return Finding(
            "fails",
            f"{comparisons:.2f} n log² n comparisons, {other.facts['decisions']} decisions",
            found.facts,
        )
    return found


def operations(rows: Sequence[Row]) -> list[Series]:
    """How comparisons and decisions of parametric search grow, family by family."""
    return series_of(
        rows,
        "comparisons",
        {
            "comparisons/(n log₂² n)": lambda n, f: f["comparisons"] / (n * math.log2(n) ** 2),
            "decisions": lambda _n, f: f["decisions"],
            "decisions/log₂² n": lambda n, f: f["decisions"] / math.log2(n) ** 2,
        },
    )


POLYGONS = cases.together(
    (cases.lattice_stars(3, 4, 5, 6, 8), 0.6),
    (
        cases.families(
            ("star", 8, {}),
            ("near-regular", 12, {}),
            ("cavity", 6, {}),
            ("convex-circle", 9, {}),
            ("zigzag", 12, {}),
        ),
        0.4,
    ),
)
PROVEN = "optimal angles enclosed to 10⁻¹² radians by balls and rational arithmetic"

CLAIMS = (
    Claim(
        name="lemma-3",
        title="Lemma 3, kernel",
        gloss="a peak is on a Voronoi edge",
        quote="a peak lies on some Voronoi edge",
        reading=(
            "The point of the closed kernel of a star-shaped polygon from which the smallest "
            "visual angle of the edges is greatest, if there is one, lies on a Voronoi edge or "
            "vertex. (If the supremum is approached at a vertex of the polygon, where no angle is "
            "defined, there is no peak; such polygons are counted apart.)"
        ),
        failure="a peak with a single edge of the optimal angle, or off all edges of the diagram",
        arithmetic="ties at the optimum by algebraic numbers; " + PROVEN + "; certified diagrams",
        limits=(
            "No failure in a sample is no proof. The lemma is one: a visual angle is a harmonic "
            "function, so no angle alone has a maximum inside a region."
        ),
        cases=POLYGONS,
        check=check_kernel_peak,
        domain="kernel",
        count=150,
    ),
    Claim(
        name="not-a-vertex",
        title="The optimum need not be a Voronoi vertex",
        gloss="a peak that no Voronoi vertex attains",
        quote=(
            "such an optimal point should be found at some Voronoi vertex. Unfortunately, it is "
            "not the case."
        ),
        reading=(
            "There is a star-shaped polygon in whose kernel there are Voronoi vertices, the peak "
            "exists, and every vertex sees a smaller least angle than the peak."
        ),
        failure="(an instance without the property refutes nothing)",
        arithmetic=PROVEN + "; the angles at all vertices enclosed likewise",
        limits="One witness proves it.",
        cases=POLYGONS,
        check=check_not_a_vertex,
        kind="there is",
        domain="kernel",
        count=100,
    ),
    Claim(
        name="naive-algorithm",
        title="Vertices and edges suffice",
        gloss="examining vertices and edges finds the peak",
        quote="it suffices to examine all Voronoi vertices and edges to find an optimal point",
        reading=(
            "The best of all Voronoi vertices, of all touching points of circles on Voronoi edges, "
            "and of the vertices of the polygon is the peak that quasiconvex programming proves. "
            "(All touching points: where Lemma 4 fails, an edge has several.)"
        ),
        failure="two proven enclosures of the optimum without a common number",
        arithmetic=PROVEN,
        limits="No failure in a sample is no proof. It follows from Lemma 3.",
        cases=POLYGONS,
        check=check_naive,
        count=100,
    ),
    Claim(
        name="theorem-7",
        title="Theorem 7",
        gloss="a peak in O(n log² n) operations",
        quote="a point (peak) in its kernel … can be found in O(n log² n) time",
        reading=(
            "Parametric search over the parallel intersection of discs finds the peak that "
            f"quasiconvex programming proves, with at most {COMPARISONS:g} n log₂² n comparisons "
            f"and at most {DECISIONS:g} log₂² n + {SETTLING:g} decisions, each linear in n."
        ),
        failure="another optimum, or more operations; the constants are ours",
        arithmetic=PROVEN + "; operations are counted, not timed",
        limits=(
            "Counts at finite n neither prove nor refute a bound for all n. A search in doubles "
            "may give up on very thin kernels: undecided. The proof is silent on decisions: "
            "O(log n) of them in each of O(log² n) batches would make O(n log³ n) if each is "
            "linear. The statement itself is true with room to spare: the problem is of LP type, "
            "expected O(n)."
        ),
        cases=cases.together(
            (cases.lattice_stars(4, 6, 8), 40 / 100),
            (
                cases.sizes(
                    {
                        "near-regular": (8, 16, 32, 64, 128, 256, 512, 1024),
                        "convex-circle": (8, 16, 32, 64, 128, 256, 512, 1024),
                        "zigzag": (8, 16, 32, 64, 128, 256, 512, 1024),
                    }
                ),
                1.0,
            ),
        ),
        check=check_parametric,
        kind="growth",
        series=operations,
        shrink=False,
        count=100,
    ),
)
