"""A mesh cut open along its interfaces, and glued again.

Interfaces become boundary edges, which nothing changes.  So whatever changes edges or the number
of vertices needs to know nothing about them; the copies of their vertices are glued afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from harness.mesh.interfaces import are_among, shared_edges
from harness.mesh.mesh import Mesh
from harness.mesh.stars import Ints, stars_of


@dataclass(frozen=True, eq=False)
class Cut:
    """A mesh that is cut open.

    ``mesh``: the vertices of the whole one come first; copies follow.  ``owners``: (k,), the
    vertex of the whole mesh that each one is or copies.
    """

    mesh: Mesh
    owners: Ints


def uncut(mesh: Mesh) -> Cut:
    """The mesh as it is."""
    return Cut(mesh, np.arange(len(mesh.points)))


def cut(mesh: Mesh) -> Cut:
    """The mesh cut open along its interfaces; O(m log m).

    An edge that hangs free at both its ends cannot be cut open alone: another one at its second
    end, towards the neighbour of least index, is cut with it.
    """
    shared, pairs = shared_edges(mesh.triangles)
    closed = ~are_among(shared, mesh.kept)
    corners, owners = _split(mesh, shared[closed], pairs[closed])
    for e in np.flatnonzero(~closed).tolist():
        if all(_at(corners, mesh, v, pairs[e]) for v in shared[e]):
            here = np.flatnonzero(closed & (shared == shared[e, 1]).any(axis=1))
            closed[here[0]] = False
    if not closed.all():
        corners, owners = _split(mesh, shared[closed], pairs[closed])
    stars, _ = stars_of(len(owners), corners)
    fixed = ~stars.closed | mesh.fixed[owners]
    return Cut(Mesh(mesh.points[owners], corners, fixed, stars, mesh.kept[:0]), owners)


def _at(corners: Ints, mesh: Mesh, vertex: int, pair: Ints) -> bool:
    """Whether two triangles have the same copy of a vertex."""
    first, second = (corners[t][mesh.triangles[t] == vertex][0] for t in pair.tolist())
    return bool(first == second)


def _split(mesh: Mesh, edges: Ints, pairs: Ints) -> tuple[Ints, Ints]:
    """Triangles that share the vertices of these edges only, and whose copy each vertex is."""
    n, m = len(mesh.points), len(mesh.triangles)
    links = []
    for end in (0, 1):
        which = [mesh.triangles[pairs[:, k]] == edges[:, end, np.newaxis] for k in (0, 1)]
        links.append([3 * pairs[:, k] + np.argmax(which[k], axis=1) for k in (0, 1)])
    first, second = np.concatenate(links, axis=1)
    graph = coo_matrix((np.ones(len(first), np.int8), (first, second)), shape=(3 * m, 3 * m))
    count, part = connected_components(graph, directed=False)
    of_part = np.empty(count, dtype=np.int64)
    of_part[part] = mesh.triangles.ravel()
    _, original = np.unique(of_part, return_index=True)
    copy = np.ones(count, dtype=np.bool_)
    copy[original] = False
    names = of_part.copy()
    names[copy] = n + np.arange(int(copy.sum()))
    return names[part].reshape(m, 3), np.concatenate([np.arange(n), of_part[copy]])
