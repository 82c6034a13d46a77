"""Interfaces: interior edges that stay, such as those between two materials."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.mesh.stars import Flags, Ints


def shared_edges(corners: Ints) -> tuple[Ints, Ints]:
    """The edges (k, 2) of two triangles, ends increasing, and the two triangles (k, 2)."""
    edges = np.sort(np.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    owners = np.tile(np.arange(len(corners)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owners = edges[order], owners[order]
    at = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))
    return edges[at], np.column_stack([owners[at], owners[at + 1]])


def interfaces(
    corners: Ints, regions: npt.ArrayLike | None = None, edges: npt.ArrayLike | None = None
) -> Ints:
    """The interior edges (k, 2) between different regions, and those of ``edges`` themselves.

    ``corners``: the triangles (m, 3).  ``regions``: (m,) or (m, j), values that tell the regions
    apart.  ``edges``: (e, 2) edges of the mesh; those of the boundary stay anyway.

    Raises:
        UserError: there are not m regions, or an edge is none of the mesh.
    """
    if regions is None and edges is None:
        return np.empty((0, 2), dtype=np.int64)
    shared, pairs = shared_edges(corners)
    chosen = np.zeros(len(shared), dtype=np.bool_)
    if regions is not None:
        given = array_of("regions", regions)
        if given.shape[:1] != (len(corners),) or given.ndim > 2:
            raise UserError(f"regions need one entry (or row) for each of {len(corners)} triangles")
        given = given.reshape(len(corners), -1)
        chosen |= (given[pairs[:, 0]] != given[pairs[:, 1]]).any(axis=1)
    if edges is not None:
        wanted = _wanted(edges)
        known = are_edges(corners, wanted)
        if not known.all():
            a, b = wanted[int(np.argmin(known))]
            raise UserError(f"edges: the mesh has no edge between its vertices {a} and {b}")
        chosen |= are_among(shared, wanted)
    return shared[chosen]


def array_of(name: str, values: npt.ArrayLike) -> npt.NDArray[Any]:
    """An argument as an array.

    Raises:
        UserError: it is none, as its rows are not of one length.
    """
    try:
        return np.asarray(values)
    except ValueError as error:
        raise UserError(f"{name} must be an array: {error}") from None


def _wanted(edges: npt.ArrayLike) -> Ints:
    given = array_of("edges", edges)
    if given.size == 0:
        return np.empty((0, 2), dtype=np.int64)
    if given.ndim != 2 or given.shape[1] != 2 or not np.issubdtype(given.dtype, np.integer):
        raise UserError("edges must be pairs of vertices, as an array of the shape (k, 2)")
    return given.astype(np.int64)


def are_edges(corners: Ints, pairs: Ints) -> Flags:
    """Which pairs (k, 2) of vertices are joined by an edge of the triangles."""
    edges = np.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)])
    return are_among(pairs, edges)


def are_among(pairs: Ints, others: Ints) -> Flags:
    """Which of the unordered pairs are among the others."""
    base = 1 + max(int(pairs.max(initial=0)), int(others.max(initial=0)))
    low, high = np.sort(pairs, axis=1).T
    codes = np.sort(others, axis=1) @ np.array([base, 1])
    found: Flags = np.isin(low * base + high, codes)
    return found
