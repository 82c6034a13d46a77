"""Lemma 2: into how many cells a region of the plane falls."""

from __future__ import annotations

from collections import Counter
from itertools import combinations

from harness.audit import cases
from harness.audit.angles import forms
from harness.audit.claim import Claim, Finding, as_facts
from harness.audit.diagrams import diagram
from harness.geometry.coordinates import Point
from harness.geometry.instance import Instance

Segment = tuple[Point, Point]


def cells_by_segment(instance: Instance) -> Counter[int]:
    """How many cells of the plane every segment owns."""
    return Counter(cell.segment for cell in diagram(instance, "plane").cells)


def lines_meet_outside(s: Segment, t: Segment) -> bool:
    """Whether the lines of two segments meet in one point, in neither closed segment; exactly."""
    ends = [forms(s, p)[1] for p in t], [forms(t, p)[1] for p in s]
    parallel = ends[0][0] == ends[0][1]
    return not parallel and all(one * two > 0 for one, two in ends)


def check_every_region(instance: Instance) -> Finding:
    """Every region has at least two cells."""
    if instance.kind != "segments" or instance.n < 2 or not cases.generic(instance):
        return Finding("outside")
    cells = cells_by_segment(instance)
    whole = [k for k in range(instance.n) if cells[k] < 2]
    facts = as_facts(regions=instance.n, undivided=len(whole), cells=cells.total())
    if whole:
        return Finding("fails", f"segment {whole[0]} has {cells[whole[0]]} cell", facts)
    return Finding("holds", f"{cells.total()} cells, each region has at least two", facts)


def meeting_pairs(instance: Instance) -> list[tuple[int, int]]:
    """The pairs of segments whose lines meet outside both."""
    segments = instance.rational_segments()
    return [
        (i, j)
        for i, j in combinations(range(instance.n), 2)
        if lines_meet_outside(segments[i], segments[j])
    ]


def check_case_of_proof(instance: Instance) -> Finding:
    """Both regions of two segments whose lines meet outside both have at least two cells."""
    if instance.kind != "segments" or instance.n < 2 or not cases.generic(instance):
        return Finding("outside")
    partnered = sorted({k for pair in meeting_pairs(instance) for k in pair})
    if not partnered:
        return Finding("outside")
    cells = cells_by_segment(instance)
    whole = [k for k in partnered if cells[k] < 2]
    facts = as_facts(regions=len(partnered), undivided=len(whole), cells=cells.total())
    if whole:
        return Finding("fails", f"segment {whole[0]} has {cells[whole[0]]} cell", facts)
    return Finding("holds", f"{len(partnered)} such regions, each with at least two cells", facts)


def check_one_of_two(instance: Instance) -> Finding:
    """One of the regions of two segments whose lines meet outside both has at least two cells."""
    if instance.kind != "segments" or instance.n < 2 or not cases.generic(instance):
        return Finding("outside")
    pairs = meeting_pairs(instance)
    if not pairs:
        return Finding("outside")
    cells = cells_by_segment(instance)
    whole = [pair for pair in pairs if all(cells[k] < 2 for k in pair)]
    facts = as_facts(pairs=len(pairs), undivided=len(whole), cells=cells.total())
    if whole:
        return Finding("fails", f"neither region of the pair {whole[0]} is divided", facts)
    return Finding("holds", f"{len(pairs)} such pairs, one region of each divided", facts)


QUOTE = "Each Voronoi region is partitioned into at least two connected parts if n ≥ 2."
ARITHMETIC = "certified diagrams: every decision of the builder is exact"

SOME = cases.together(
    (cases.lattice_segments(2, 3, 4, admits=cases.generic), 0.6),
    (cases.families(*(("segments", n, {}) for n in (2, 3, 4, 6, 8))), 0.4),
)

CLAIMS = (
    Claim(
        name="lemma-2",
        title="Lemma 2",
        gloss="every region of the plane falls into two cells or more",
        quote=QUOTE,
        reading=(
            "For n ≥ 2 disjoint segments in the plane, no two of them parallel and no end point "
            "on the line of another segment, the region of every segment consists of at least "
            "two cells. A cell is a connected component of the interior of the closure of a "
            "region, so that single curves of ties split nothing. These hypotheses favour the "
            "lemma: parallel, collinear and touching segments are left out."
        ),
        failure="a segment that owns fewer than two cells; one instance refutes the lemma",
        arithmetic=ARITHMETIC,
        limits="A failure is final. The share of failures is that of these families, no more.",
        cases=SOME,
        check=check_every_region,
        domain="plane",
        count=250,
    ),
    Claim(
        name="lemma-2-proof",
        title="Lemma 2, in the case of its proof",
        gloss="so it does if two lines meet outside both segments",
        quote=(
            "the Voronoi region of s_i is partitioned into at least two parts by extensions of s_j"
        ),
        reading=(
            "Under the same hypotheses: if the lines of two segments meet outside of both, each "
            "of the two regions consists of at least two cells. (The proof asks only that they are "
            "not parallel, but its extensions do not cross unless the lines meet there.)"
        ),
        failure="such a segment that owns a single cell; one instance refutes the proof",
        arithmetic=ARITHMETIC + "; where lines meet, by rational arithmetic",
        limits=(
            "A failure is final. (The extensions of s_j do not cut the plane apart: V(s_i) may "
            "pass through s_j itself, where s_j is seen under π.)"
        ),
        cases=SOME,
        check=check_case_of_proof,
        domain="plane",
        count=250,
    ),
    Claim(
        name="lemma-2-repaired",
        title="Lemma 2, repaired",
        gloss="then one of the two regions does",
        quote=QUOTE,
        reading=(
            "Under the same hypotheses: if the lines of two segments meet outside of both, at "
            "least one of the two regions consists of two cells or more."
        ),
        failure="two such segments that own a single cell each",
        arithmetic=ARITHMETIC + "; where lines meet, by rational arithmetic",
        limits=(
            "No failure in a sample is no proof, but here is one: around the meeting point the two "
            "regions alternate. A path in one region that joins its two sectors closes to a curve "
            "through the meeting point, which separates the two sectors of the other."
        ),
        cases=SOME,
        check=check_one_of_two,
        domain="plane",
        count=250,
    ),
)
