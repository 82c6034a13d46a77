"""From an instance to its fast diagram, and the record of its counts."""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from harness.diagram.counts import Counts, Domain, Objective
from harness.diagram.fast import chains
from harness.diagram.fast.arrays import Arrays, glued, joined
from harness.diagram.fast.build import SMALL, Leaves, open_rows, solve_open
from harness.diagram.fast.decisions import decide_open
from harness.diagram.fast.hard import LocalMap
from harness.diagram.fast.leaves import EMPTY
from harness.diagram.fast.nodes import (
    AT_INFINITY,
    BOUNDARY,
    KINDS,
    Nodes,
    find_nodes,
    unbounded_classes,
)
from harness.diagram.fast.prepare import Floats, Ints, Prepared, prepare
from harness.diagram.fast.roots import Roots
from harness.diagram.fast.search import search
from harness.diagram.fast.ties import Ties
from harness.diagram.work import Contradiction, Hopeless, Work
from harness.geometry.instance import Instance
from harness.geometry.kernel import Kernel, kernel

#: How often other free points are tried.
SEEDS = 4
#: So many open leaves are solved by algebra, one by one, in a small and in any other instance.
FEW_OPEN, MOST_OPEN = 60, 20_000


@dataclass(eq=False)
class FastDiagram:
    """Everything about a diagram, as arrays.

    ``edges`` (e, 6), ``edge_of_arc`` (a, 2): see :func:`harness.diagram.fast.chains.join_arcs`.
    ``cell_of_slot`` (s,), ``cells``: their number.  ``unbounded``: cells that reach infinity.
    ``solved``, ``candidates``: the local maps of leaves that went to the algebra, and the segments
    in them by their numbers there.  ``ties``: see :mod:`harness.diagram.fast.ties`.
    """

    prepared: Prepared
    domain: Domain
    objective: Objective
    roots: Roots
    leaves: Leaves
    arrays: Arrays
    nodes: Nodes
    edges: Ints
    edge_of_arc: Ints
    cell_of_slot: Ints
    cells: int
    unbounded: set[int]
    work: Work
    solved: dict[int, LocalMap]
    ties: Ties
    candidates: dict[int, list[int]]

    @cached_property
    def rows_of_leaves(self) -> Ints:
        """The row in ``leaves.shapes`` of every leaf that is not empty, (leaves,)."""
        rows: Ints = np.cumsum(self.leaves.kinds != EMPTY) - 1
        return rows

    @cached_property
    def corner_points(self) -> Floats:
        """The corners of roots as doubles, (c, 2)."""
        return self.roots.corners.points()

    @cached_property
    def domain_corners(self) -> set[int]:
        """The corners of roots at which the domain's boundary turns."""
        if self.domain == "plane":
            return set()
        walls = self.roots.walls
        before = {end: wall for (_, end), wall in walls.items()}
        return {start for (start, _), wall in walls.items() if before[start] != wall}

    @property
    def instance(self) -> Instance:
        """The instance."""
        return self.prepared.instance

    def cell_owners(self) -> Ints:
        """The segment of every cell, (cells,)."""
        owners = np.zeros(self.cells, dtype=np.int64)
        used = self.cell_of_slot >= 0
        owners[self.cell_of_slot[used]] = self.arrays.owner[used]
        return owners

    def counts(self) -> Counts:
        """The record of what is counted, from the arrays; O(nodes + edges + cells)."""
        kind, degree = self.nodes.kind, self.nodes.degree
        numbers = Counter({KINDS[k]: int(c) for k, c in enumerate(np.bincount(kind, minlength=6))})
        boundary = kind == BOUNDARY
        is_vertex = kind <= KINDS.index("saddle")
        degrees = np.bincount(degree[is_vertex])
        return Counts(
            domain=self.domain,
            objective=self.objective,
            builder="fast",
            n=self.instance.n,
            cells=self.cells,
            edges=len(self.edges),
            vertices=int(is_vertex.sum()),
            regions=len(np.unique(self.cell_owners())),
            loops=int((self.edges[:, 0] < 0).sum()),
            components=int(
                chains.count_components(
                    len(kind), self.edges, kind == AT_INFINITY, boundary, self.domain != "plane"
                )
            ),
            unbounded=len(self.unbounded),
            boundary_points=int(boundary.sum()),
            nodes={
                **{name: c for name, c in numbers.items() if c},
                "boundary": int(degree[boundary].sum()),
            },
            degrees={d: int(c) for d, c in enumerate(degrees) if c},
            certified=True,
        )


def fast_diagram(
    instance: Instance,
    domain: Domain,
    objective: Objective,
    workers: int | None = None,
    seed: int = 0,
) -> FastDiagram:
    """The diagram of a validated instance; ``workers`` threads (by default, one per processor).

    ``seed``: the first choice of free points.  The diagram does not depend on it.

    Raises Contradiction if no choice of free points worked.
    """
    found = kernel(instance) if domain != "plane" else None
    prepared = prepare(instance, parallels=domain == "plane")
    workers = workers or len(os.sched_getaffinity(0))
    problem: Contradiction | None = None
    for turn in range(SEEDS):
        try:
            return _attempt(prepared, domain, objective, found, seed + turn, workers)
        except Hopeless:
            raise
        except Contradiction as error:
            problem = error
    assert problem is not None
    raise problem


def _attempt(
    prepared: Prepared,
    domain: Domain,
    objective: Objective,
    found: Kernel | None,
    seed: int,
    workers: int,
) -> FastDiagram:
    roots, leaves, ties = search(prepared, domain, objective, found, seed, workers)
    sense = 1.0 if objective == "smallest" else -1.0
    rows_open = open_rows(leaves)
    by_balls = decide_open(prepared.instance, roots, leaves, sense)
    still_open = int(leaves.statistics[2] + leaves.statistics[3]) - by_balls
    if still_open > (FEW_OPEN if prepared.instance.n <= SMALL else MOST_OPEN):
        raise Hopeless(f"{still_open} triangles need algebra")
    solved = solve_open(prepared, roots, leaves, rows_open, domain, objective)
    arrays = glued(roots, leaves, solved)
    nodes = find_nodes(prepared, roots, leaves, arrays, domain == "plane")
    edges, edge_of_arc = joined(arrays, nodes.of_port)
    cell_of_slot, cells = chains.number_classes(arrays.parent, arrays.owner)
    far = (
        {int(cell_of_slot[s]) for s in unbounded_classes(arrays, nodes)}
        if domain == "plane"
        else set()
    )
    return FastDiagram(
        prepared=prepared,
        domain=domain,
        objective=objective,
        roots=roots,
        leaves=leaves,
        arrays=arrays,
        nodes=nodes,
        edges=edges,
        edge_of_arc=edge_of_arc,
        cell_of_slot=cell_of_slot,
        cells=int(cells),
        unbounded=far,
        work=Work(
            triangles=int(leaves.statistics[0]),
            tests=int(leaves.statistics[1]),
            leaves=len(leaves.kinds),
            by_floats=len(leaves.kinds) - len(solved) - by_balls,
            by_balls=by_balls,
            exactly=len(solved),
            workers=workers,
        ),
        solved=solved,
        ties=ties,
        candidates=_candidates(leaves, rows_open, solved),
    )


def _candidates(leaves: Leaves, rows: Ints, solved: dict[int, LocalMap]) -> dict[int, list[int]]:
    """The candidates of the leaves that were solved by algebra; ``rows``: of all open leaves."""
    shaped = np.flatnonzero(leaves.kinds != EMPTY)[rows].tolist()
    first, ids = leaves.open_first.tolist(), leaves.open_ids.tolist()
    return {leaf: ids[first[k] : first[k + 1]] for k, leaf in enumerate(shaped) if leaf in solved}
