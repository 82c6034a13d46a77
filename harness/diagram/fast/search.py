"""From an instance to leaves: root triangles, subdivided until no hub or tie is new."""

from __future__ import annotations

from harness.diagram.counts import Domain, Objective
from harness.diagram.fast import domains
from harness.diagram.fast.build import Leaves, candidates_of, find_leaves
from harness.diagram.fast.faces import arranged_interior, arranged_roots
from harness.diagram.fast.hubs import Hubs, find_hubs
from harness.diagram.fast.plane import plane_roots
from harness.diagram.fast.prepare import Prepared
from harness.diagram.fast.roots import Roots
from harness.diagram.fast.rows import ties_at_infinity
from harness.diagram.fast.ties import Ties, tie_arrays, ties_at_corners, ties_at_hubs
from harness.diagram.work import Contradiction, Hopeless
from harness.geometry.kernel import Kernel

#: The interiors of larger polygons are not cut by all lines.
MOST_ARRANGED = 8192
#: Rounds of new hubs, at most.
ROUNDS = 12


def search(
    prepared: Prepared,
    domain: Domain,
    objective: Objective,
    found: Kernel | None,
    seed: int,
    workers: int,
) -> tuple[Roots, Leaves, Ties]:
    """The leaves of a diagram, and the ties known at special corners.

    Exact ties of many segments make leaves that no halving can resolve.  They are found there,
    become special corners, and everything is subdivided anew.  Raises Contradiction if that does
    not end, Hopeless if the halving does not: where three segments tie along a curve, for one.
    """
    hubs = Hubs(known=ties_at_infinity(prepared.instance) if domain == "plane" else {})
    sense = 1.0 if objective == "smallest" else -1.0
    for _ in range(ROUNDS):
        roots, spans = _roots(prepared, domain, found, sense, seed, hubs)
        leaves, ties = _settled(prepared, roots, spans, domain, sense, found, hubs, workers)
        if not find_hubs(prepared.instance, roots, leaves, sense, hubs):
            return roots, leaves, ties
    raise Contradiction("ever more ties of many segments")


def _roots(
    prepared: Prepared, domain: Domain, found: Kernel | None, sense: float, seed: int, hubs: Hubs
) -> tuple[Roots, list[tuple[int, int]]]:
    points = list(hubs.points)
    if domain == "plane":
        if sense > 0:
            return arranged_roots(prepared, seed, points, hubs.all_directions()), []
        return plane_roots(prepared.instance, seed, points, hubs.all_directions()), []
    assert found is not None
    if domain == "kernel":
        return domains.kernel_roots(prepared.instance, found, seed, points)
    if sense > 0 and prepared.instance.n <= MOST_ARRANGED:
        return arranged_interior(prepared, seed, points), []
    return domains.interior_roots(prepared.instance, found, seed, points), []


def _settled(
    prepared: Prepared,
    roots: Roots,
    spans: list[tuple[int, int]],
    domain: Domain,
    sense: float,
    found: Kernel | None,
    hubs: Hubs,
    workers: int,
) -> tuple[Leaves, Ties]:
    """Leaves in which all ties at special corners are known, and these."""
    ties: Ties = ties_at_hubs(prepared.instance, roots, hubs)
    definite = domain == "kernel"
    while True:
        first, rows = tie_arrays(ties, len(roots.corners.weights))
        world = (prepared.lines, prepared.lengths, prepared.classes, first, rows)
        candidates = candidates_of(prepared, roots, found, spans, sense, definite, world, workers)
        leaves = find_leaves(prepared, roots, candidates, definite, sense, workers, world)
        if leaves.statistics[5]:
            raise Hopeless("halving does not end")
        new = ties_at_corners(prepared.instance, roots, leaves)
        if new <= ties:
            return leaves, ties
        ties |= new
