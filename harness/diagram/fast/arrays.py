"""The diagram as arrays: slots, arcs, vertices, edges, nodes, cells."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from harness.diagram.fast import chains, glue
from harness.diagram.fast.build import Leaves
from harness.diagram.fast.hard import LocalMap
from harness.diagram.fast.leaves import EMPTY, HARD
from harness.diagram.fast.prepare import Ints
from harness.diagram.fast.roots import Roots
from harness.diagram.planar_map import Node
from harness.diagram.work import Contradiction


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
    place: Ints
    owner: Ints
    arcs: Ints
    leaf_of_arc: Ints
    vertices: Ints
    out_first: Ints
    out: Ints
    inward: Ints
    parent: Ints
    mate: Ints
    following: Ints
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
    place, owner = [leaves.slots[:, 0].astype(np.int64)], [leaves.slots[:, 1].astype(np.int64)]
    used = len(leaves.slots)
    for leaf, local in solved.items():
        owner[0][leaves.first_slot[leaf] : leaves.first_slot[leaf + 1]] = -1
        kinds[leaf], choices[leaf] = HARD, 0
        start[leaf], ports[leaf] = used, local.ports
        place.append(np.array(local.places, dtype=np.int64))
        owner.append(np.array(local.owners, dtype=np.int64))
        used += len(local.places)
    n_arcs, n_vertices, n_ends = glue.count_parts(kinds, choices)
    more_arcs = sum(len(local.arcs) for local in solved.values())
    more_vertices = sum(len(local.vertices) for local in solved.values())
    more_ends = sum(len(out) for local in solved.values() for _, out in local.vertices)
    arrays = Arrays(
        start=start,
        ports=ports,
        place=np.concatenate(place),
        owner=np.concatenate(owner),
        arcs=np.zeros((n_arcs + more_arcs, 4), dtype=np.int64),
        leaf_of_arc=np.zeros(n_arcs + more_arcs, dtype=np.int64),
        vertices=np.zeros((n_vertices + more_vertices, 2), dtype=np.int64),
        out_first=np.zeros(n_vertices + more_vertices + 1, dtype=np.int64),
        out=np.zeros(n_ends + more_ends, dtype=np.int64),
        inward=np.full(used, -1, dtype=np.int64),
        parent=np.arange(used),
        mate=np.full(used, -1, dtype=np.int64),
        following=np.full(used, -1, dtype=np.int64),
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
        np.full(used, -1, dtype=np.int64),
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
