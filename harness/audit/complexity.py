"""Theorem 5, the grid and the linear claim: how many cells, edges and vertices there are."""

from __future__ import annotations

from collections.abc import Sequence

from harness.audit import cases
from harness.audit.claim import Claim, Finding, Row, Series, as_facts
from harness.audit.diagrams import diagram
from harness.audit.growing import Ratio, series_of
from harness.diagram.counts import Counts, Domain
from harness.geometry.instance import Instance

#: Theorem 5: at most MOST · n² cells, edges and vertices.
MOST = 4.0


def counts_of(instance: Instance, domain: Domain) -> Counts | None:
    """Certified counts; None for an instance that has no such diagram."""
    if domain == "kernel" and not cases.star_shaped(instance):
        return None
    if not cases.is_valid(instance) or (domain != "plane" and instance.kind != "polygon"):
        return None
    counts = diagram(instance, domain).counts
    return counts if counts.certified else None


def _facts(counts: Counts) -> dict[str, int | float]:
    return as_facts(cells=counts.cells, edges=counts.edges, vertices=counts.vertices)


def _words(counts: Counts) -> str:
    return f"{counts.cells} cells, {counts.edges} edges, {counts.vertices} vertices"


def check_quadratic(instance: Instance) -> Finding:
    """At most MOST · n² objects of each kind, in the default domain."""
    counts = counts_of(instance, "plane" if instance.kind == "segments" else "kernel")
    if counts is None:
        return Finding("outside")
    worst = max(counts.cells, counts.edges, counts.vertices)
    outcome = "fails" if worst > MOST * instance.n**2 else "holds"
    return Finding(outcome, _words(counts), _facts(counts))  # type: ignore[arg-type]  # literals


def check_grid(instance: Instance) -> Finding:
    """Between n²/4 and 4n² vertices, edges and cells, and at most 4n cells to a segment."""
    if instance.kind != "segments" or not cases.is_valid(instance):
        return Finding("outside")
    found = diagram(instance, "plane")
    counts, n = found.counts, instance.n
    owned = [0] * n
    for cell in found.cells:
        owned[cell.segment] += 1
    facts = {**_facts(counts), **as_facts(fewest=min(owned), most=max(owned))}
    numbers = (counts.cells, counts.edges, counts.vertices)
    fits = all(n * n <= 4 * k <= 16 * n * n for k in numbers)
    fits = fits and max(owned) <= 4 * n
    words = f"{_words(counts)}; {min(owned)} to {max(owned)} cells to a segment"
    return Finding("holds" if fits else "fails", words, facts)


def _check_connected(instance: Instance, domain: Domain) -> Finding:
    """At most 2(n − 1) vertices."""
    counts = counts_of(instance, domain)
    if counts is None:
        return Finding("outside")
    most = 2 * (instance.n - 1)
    if counts.vertices > most:
        return Finding("fails", f"{_words(counts)}, more than {most} vertices", _facts(counts))
    return Finding("holds", _words(counts), _facts(counts))


def check_linear_kernel(instance: Instance) -> Finding:
    """The kernel's diagram has at most as many vertices as n connected regions can have."""
    return _check_connected(instance, "kernel")


def check_linear_interior(instance: Instance) -> Finding:
    """The same in the interior of the polygon."""
    return _check_connected(instance, "interior")


RATIOS: dict[str, Ratio] = {
    "vertices/n": lambda n, f: f["vertices"] / n,
    "vertices/n²": lambda n, f: f["vertices"] / n**2,
    "edges/n²": lambda n, f: f["edges"] / n**2,
    "cells/n²": lambda n, f: f["cells"] / n**2,
}


def growth(rows: Sequence[Row]) -> list[Series]:
    """Vertices for each family and size, per segment and per n²."""
    return series_of(rows, "vertices", RATIOS)


def grid_growth(rows: Sequence[Row]) -> list[Series]:
    """The same, and the cells of the segments with the fewest and the most of them, per n."""
    regions: dict[str, Ratio] = {
        "fewest cells of a segment/n": lambda n, f: f["fewest"] / n,
        "most cells of a segment/n": lambda n, f: f["most"] / n,
    }
    return series_of(rows, "vertices", {**RATIOS, **regions})


CERTIFIED = "certified counts: every decision of the builder is exact"
DOUBLED = (8, 16, 32, 64, 128, 256, 512)
INNER = (12, 16, 24, 32, 48, 64, 96, 128, 192)
RANDOM = ("star", "near-regular", "cavity", "convex-circle", "convex-valtr")
LINEAR_QUOTE = (
    "if we restrict ourselves to a set of line segments forming a star-shaped polygon and also to "
    "its interior part, our experience tells us linear complexity. But there is no proof yet."
)
LINEAR_LIMITS = (
    "An instance above the threshold is proved to be there (certified counts), but by itself "
    "refutes only this threshold, no asymptotic statement. Against linear growth speaks every "
    "family below whose certified counts fit n²: the number of vertices per n² is steady, and the "
    "number per edge (vertices/n) grows in proportion to n. Other families may well be linear or "
    "less; the claim is about all polygons. No finite list of counts is a proof about all n; what "
    "proves that weaves (zigzag, convex-weave) have quadratically many vertices in their kernels, "
    "and so inside, is the derivation in the report of avd study weave."
)

CLAIMS = (
    Claim(
        name="theorem-5",
        title="Theorem 5",
        gloss="O(n^(2+ε)) cells, edges, vertices",
        quote=(
            "An angular Voronoi diagram for a set of n line segments in the plane consists of "
            "O(n^(2+ε)) cells, edges, and vertices"
        ),
        reading=(
            f"At most {MOST:g} n² cells, edges and vertices: segments in the plane, and "
            "star-shaped polygons in their kernels. The constant is ours."
        ),
        failure=f"more than {MOST:g} n² of one kind",
        arithmetic=CERTIFIED,
        limits=(
            "Neither a proof nor, if it failed, a refutation: the theorem is about all n. The "
            "tables show the counts per n² of each family."
        ),
        cases=cases.together(
            (cases.lattice_segments(1, 2, 3, 4), 0.5),
            (cases.lattice_stars(3, 4, 5, 6), 0.5),
            (
                cases.sizes(
                    {
                        "segments": (4, 8, 16, 32, 64, 128, 256),
                        "grid:generic": (4, 8, 16, 32, 64, 128, 256),
                        "zigzag": DOUBLED,
                        "near-regular": DOUBLED,
                        "convex-circle": DOUBLED,
                    },
                    {"grid:generic": {"variant": "generic"}},
                ),
                1.0,
            ),
        ),
        check=check_quadratic,
        kind="growth",
        series=growth,
        shrink=False,
        count=80,
    ),
    Claim(
        name="grid",
        title="The grid is quadratic",
        gloss="Θ(n²) cells, edges, vertices",
        quote=(
            "if we arrange n/2 horizontal line segments and n/2 vertical line segments as shown … "
            "each Voronoi region for a horizontal line segment is divided into O(n) pieces … thus "
            "yielding O(n²) Voronoi cells in total"
        ),
        reading=(
            "For such segments, in the exact grid and with positions and slopes jittered, there "
            "are between n²/4 and 4n² cells, edges and vertices, and every region consists of at "
            "most 4n cells: Θ(n²), and O(n) to a segment, with these constants, which are ours."
        ),
        failure="a count outside these bounds",
        arithmetic=CERTIFIED,
        limits=(
            "For all n it is a theorem: (n/2)² pairs of extensions meet outside both segments, and "
            "each meeting point is a vertex. The counts show the constants. That every single "
            "region has Θ(n) cells is not tested, and in the exact grid does not look so: the "
            "fewest cells of a segment, per n, fall as n grows (last columns of the table)."
        ),
        cases=cases.sizes(
            {
                "grid": (6, 8, 10, 12, 16, 20, 32, 48, 64, 96, 128),
                "grid:generic": (8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256),
            },
            {"grid:generic": {"variant": "generic"}},
        ),
        check=check_grid,
        kind="growth",
        domain="plane",
        series=grid_growth,
        shrink=False,
        count=16,
    ),
    Claim(
        name="linear-kernel",
        title="Linear complexity, kernel",
        gloss="linear number of vertices",
        quote="angular Voronoi diagrams seem to have linear complexity in the kernel",
        reading=(
            "In the kernel of a star-shaped polygon of n edges there are at most 2(n − 1) Voronoi "
            "vertices: as many as there can be if every region is connected (cells = edges − "
            "vertices + components and at least three edges at every vertex)."
        ),
        failure="more than 2(n − 1) vertices",
        arithmetic=CERTIFIED,
        limits=LINEAR_LIMITS,
        cases=cases.together(
            (cases.lattice_stars(4, 5, 6, 7, 8), 0.4),
            (
                cases.families(
                    ("near-regular", 8, {}),
                    ("cavity", 8, {}),
                    ("star", 12, {}),
                    ("zigzag", 6, {"tilt": 0.15}),
                    ("zigzag", 8, {"tilt": 0.15}),
                    ("convex-weave", 6, {}),
                    ("convex-weave", 8, {}),
                ),
                0.6,
            ),
            (
                cases.sizes({"zigzag": DOUBLED, "convex-weave": DOUBLED}),
                1.0,
            ),
            (cases.sizes(dict.fromkeys(RANDOM, DOUBLED), replicates=5), 1.0),
        ),
        check=check_linear_kernel,
        kind="growth",
        domain="kernel",
        series=growth,
        count=150,
    ),
    Claim(
        name="linear-interior",
        title="Linear complexity, interior",
        gloss="linear number of vertices",
        quote=LINEAR_QUOTE,
        reading=(
            "The same threshold of 2(n − 1) vertices in the whole interior of the polygon, whose "
            "edges are transparent."
        ),
        failure="more than 2(n − 1) vertices",
        arithmetic=CERTIFIED,
        limits=LINEAR_LIMITS,
        cases=cases.together(
            (cases.lattice_stars(4, 5, 6, 7), 1.0),
            (
                cases.sizes({"zigzag": INNER, "convex-weave": INNER}),
                1.0,
            ),
            (cases.sizes({"near-regular": INNER, "star": INNER}, replicates=3), 1.0),
        ),
        check=check_linear_interior,
        kind="growth",
        domain="interior",
        series=growth,
        count=60,
    ),
)
