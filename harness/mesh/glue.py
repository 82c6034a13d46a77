"""From a state of a mesh that was cut open back to one mesh, with what its data come from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from harness.mesh.cuts import Cut
from harness.mesh.mesh import Mesh
from harness.mesh.stars import Ints
from harness.mesh.state import State
from harness.mesh.validation import Floats

APART = 8.0
"""Farther than any two points with coordinates of at most 1."""


@dataclass(frozen=True, eq=False)
class Glued:
    """The result with its copies of vertices glued; as in :class:`harness.mesh.door.Improved`."""

    points: Floats
    triangles: Ints
    vertices: Ints
    cells: Ints
    made: int


def glued(mesh: Mesh, whole: Cut, small: Mesh, state: State, exponent: int) -> Glued:
    """Glue copies, leave out vertices that were deleted, and number what is left.

    ``whole``: ``mesh`` cut open.  ``small``: the same, 2^−exponent times as large, as ``state``
    found it.
    """
    n, copies = len(mesh.points), len(whole.owners)
    cells = _origins(small, state)
    now = np.concatenate([state.points[:n], state.points[copies:]])
    places = np.ldexp(now, exponent)
    stayed = (now[:n] == small.points[:n]).all(axis=1)
    places[:n][stayed] = mesh.points[stayed]
    if state.triangles is small.triangles:
        return Glued(places[:n], mesh.triangles, np.arange(n), cells, 0)
    names = np.concatenate([whole.owners, n + np.arange(len(now) - n)])
    triangles = names[state.triangles]
    used = np.bincount(triangles.ravel(), minlength=len(now)) > 0
    used[:n] |= mesh.stars.degrees == 0
    origins = np.concatenate([np.arange(n), names[state.origins[copies:]]])[used]
    number = np.cumsum(used) - 1
    return Glued(places[used], number[triangles], origins, cells, int(used[n:].sum()))


def _origins(mesh: Mesh, state: State) -> Ints:
    """For each triangle the old one with the nearest centroid in the same piece of the mesh."""
    if state.triangles is mesh.triangles:
        return np.arange(len(mesh.triangles))
    a, b = mesh.triangles[:, :2].ravel(), mesh.triangles[:, 1:].ravel()
    size = len(state.origins)
    graph = coo_matrix((np.ones(len(a), np.int8), (a, b)), shape=(size, size))
    piece = connected_components(graph, directed=False)[1][state.origins]

    def places(points: Floats, triangles: Ints) -> Floats:
        apart = APART * piece[triangles[:, 0]]
        return np.column_stack([points[triangles].mean(axis=1), apart])

    tree = cKDTree(places(mesh.points, mesh.triangles))
    return np.asarray(tree.query(places(state.points, state.triangles))[1], dtype=np.int64)
