"""Which of a cell's boundary walks is the outer one, from the topology alone.

Let the infinite ends be one point and the domain's boundary one curve.  Every component of edges
and nodes lies in one cell of the others; seen from there it is a hole, seen from all other cells
that touch it, their outer boundary.  So cells and components are a tree, whose root is the
component of infinity or of the domain's boundary (if neither has edges, the unbounded cell), and
the outer walk of a cell is the one through which the way from the root comes.
"""

from __future__ import annotations

from collections import defaultdict, deque

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.nodes import AT_INFINITY, BOUNDARY
from harness.diagram.fast.prepare import Ints
from harness.diagram.planar_map import Walk
from harness.diagram.work import Contradiction


def outer_walks(diagram: FastDiagram, walks: dict[int, list[Walk]]) -> list[int | None]:
    """The number of the outer walk among the walks of every cell; None if it has none.

    O(nodes + edges).  Raises Contradiction if cells and components are not a tree.
    """
    label, root = _components(diagram)
    found: list[int | None] = [None] * diagram.cells
    known = [False] * diagram.cells
    touching: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
    component_of: dict[tuple[int, int], int] = {}
    for cell, its in walks.items():
        for k, walk in enumerate(its):
            component = root if walk[0].is_wall else int(label[walk[0].item])
            touching[component].append((cell, k))
            component_of[cell, k] = component
    waiting = deque([root])
    if root not in touching:
        (around,) = diagram.unbounded or {0}
        known[around] = True
        waiting += [component_of[around, k] for k in range(len(walks.get(around, [])))]
    while waiting:
        component = waiting.popleft()
        for cell, k in touching.pop(component, []):
            if known[cell]:
                continue
            known[cell], found[cell] = True, k
            waiting += [component_of[cell, m] for m in range(len(walks[cell])) if m != k]
    if touching or not all(known):
        raise Contradiction("the cells are not nested")
    return found


def _components(diagram: FastDiagram) -> tuple[Ints, int]:
    """The component of every edge, and that of infinity (in the plane) or the boundary."""
    nodes, edges = len(diagram.nodes.kind), len(diagram.edges)
    common = nodes + edges
    start, end = diagram.edges[:, 0], diagram.edges[:, 1]
    loop = nodes + np.arange(edges)
    outside = np.flatnonzero(np.isin(diagram.nodes.kind, (AT_INFINITY, BOUNDARY)))
    one = np.concatenate([loop, loop, outside])
    two = np.concatenate(
        [np.where(start < 0, loop, start), np.where(start < 0, loop, end), outside * 0 + common]
    )
    links = coo_array((np.ones(len(one)), (one, two)), shape=(common + 1, common + 1))
    _, label = connected_components(links, directed=False)
    return label[nodes : nodes + edges].astype(np.int64), int(label[common])
