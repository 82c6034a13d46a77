"""The diagram as arrays: slots, arcs, vertices, edges, nodes, cells."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from harness.diagram.fast import chains, glue
from harness.diagram.fast.build import Leaves
from harness.diagram.fast.hard import LocalMap
from harness.diagram.fast.leaves import EMPTY, HARD
from harness.diagram.fast.prepare import Ints
from harness.diagram.fast.roots import Roots
from harness.diagram.planar_map import Node
from harness.diagram.work import Contradiction

#: With fewer slots and half-arcs than this, they are numbered in 32 bits: half the memory.
LARGE = 2**31

Numbers = NDArray[np.signedinteger[Any]]


@dataclass(eq=False)
class Arrays:
    """Slots, arcs and vertices of all leaves, glued.

    ``start`` (leaves,): first slot of each; ``ports`` (leaves,): how many of its slots are ports.
    ``place``, ``owner`` (s,): of every slot (owner −1: not in use).  ``arcs``, ``leaf_of_arc``,
    ``vertices``, ``out_first``, ``out``, ``inward``: see :func:`harness.diagram.fast.glue.expand`;
    ``special`` names the nodes of vertices that came from a local map.  ``parent``: union–find over
    slots.  ``mate`` (s,): the port glued to a port, or −1.  ``sides`` (r, 3, 4): the sides of the
    roots.  ``following`` (s,): the next port on the same side.
    """

    start: Ints
    ports: Ints
    place: Numbers
    owner: Numbers
    arcs: Numbers
    leaf_of_arc: Numbers
    vertices: Numbers
    out_first: Numbers
    out: Numbers
    inward: Numbers
    parent: Numbers
    mate: Numbers
    following: Numbers
    sides: Ints
    opposite: Ints
    special: dict[int, Node] = field(default_factory=dict)


def glued(roots: Roots, leaves: Leaves, solved: dict[int, LocalMap]) -> Arrays:
    """Expand and glue all leaves.

    Raises Contradiction if two triangles see their common side differently.
    """
    kinds, choices = leaves.kinds.copy(), leaves.choices.copy()
    start = leaves.first_slot[:-1].copy()
    ports = np.where(kinds == EMPTY, 0, np.diff(leaves.first_slot))
    place, owner = (np.ascontiguousarray(leaves.slots[:, k]) for k in (0, 1))
    used = len(leaves.slots)
    more: list[LocalMap] = list(solved.values())
    if more:
        place = np.concatenate([place, *(np.array(m.places, dtype=place.dtype) for m in more)])
        owner = np.concatenate([owner, *(np.array(m.owners, dtype=owner.dtype) for m in more)])
    for leaf, local in solved.items():
        owner[leaves.first_slot[leaf] : leaves.first_slot[leaf + 1]] = -1
        kinds[leaf], choices[leaf] = HARD, 0
        start[leaf], ports[leaf] = used, local.ports
        used += len(local.places)
    n_arcs, n_vertices, n_ends = glue.count_parts(kinds, choices)
    more_arcs = sum(len(local.arcs) for local in more)
    more_vertices = sum(len(local.vertices) for local in more)
    more_ends = sum(len(out) for local in more for _, out in local.vertices)
    small: type[np.signedinteger[Any]] = (
        np.int32 if max(used, 2 * (n_arcs + more_arcs)) < LARGE else np.int64
    )
    arrays = Arrays(
        start=start,
        ports=ports,
        place=place,
        owner=owner,
        arcs=np.zeros((n_arcs + more_arcs, 4), dtype=small),
        leaf_of_arc=np.zeros(n_arcs + more_arcs, dtype=small),
        vertices=np.zeros((n_vertices + more_vertices, 2), dtype=small),
        out_first=np.zeros(n_vertices + more_vertices + 1, dtype=small),
        out=np.zeros(n_ends + more_ends, dtype=small),
        inward=np.full(used, -1, dtype=small),
        parent=np.arange(used, dtype=small),
        mate=np.full(used, -1, dtype=small),
        following=np.full(used, -1, dtype=small),
        sides=np.zeros((len(roots.triangles), 3, 4), dtype=np.int64),
        opposite=roots.opposite(),
    )
    glue.expand(
        kinds,
        choices,
        start,
        arrays.arcs,
        arrays.leaf_of_arc,
        arrays.vertices,
        arrays.out_first,
        arrays.out,
        arrays.inward,
        arrays.parent,
    )
    _add_local_maps(arrays, solved, n_arcs, n_vertices, n_ends)
    wrong = glue.glue_all(
        leaves.order,
        leaves.tokens,
        kinds,
        start,
        ports,
        arrays.place,
        arrays.owner,
        arrays.opposite,
        arrays.following,
        np.full(used, -1, dtype=small),
        arrays.parent,
        arrays.mate,
        arrays.sides,
    )
    if wrong != -1:
        raise Contradiction(f"triangles disagree about a common side near leaf {wrong}")
    return arrays


def _add_local_maps(arrays: Arrays, solved: dict[int, LocalMap], a: int, v: int, e: int) -> None:
    """Write arcs and vertices of local maps from arc a, vertex v, vertex end e on."""
    for leaf, local in solved.items():
        s, first_arc, first_vertex = int(arrays.start[leaf]), a, v
        for one, two, left, right in local.arcs:
            for half, end in enumerate((one, two)):
                arrays.arcs[a, half] = s + end if end >= 0 else end - first_vertex
                if end >= 0:
                    arrays.inward[s + end] = 2 * a + half
            arrays.arcs[a, 2:] = s + left, s + right
            arrays.leaf_of_arc[a] = leaf
            a += 1
        for node, out in local.vertices:
            arrays.vertices[v] = leaf, 0
            arrays.special[v] = node
            for half in out:
                arrays.out[e] = 2 * first_arc + half
                e += 1
            v += 1
            arrays.out_first[v] = e
        for x, y in local.united:
            glue.unite(arrays.parent, s + x, s + y)
        for x, y in local.mates:
            arrays.mate[s + x], arrays.mate[s + y] = s + y, s + x


def joined(arrays: Arrays, node_of_port: Ints) -> tuple[Ints, Ints]:
    """Edges and the edge of every arc; see :func:`harness.diagram.fast.chains.join_arcs`."""
    vertices = np.arange(len(arrays.vertices))
    edges, edge_of_arc = chains.join_arcs(
        arrays.arcs, arrays.mate, arrays.inward, vertices, node_of_port, arrays.parent
    )
    return edges, edge_of_arc
