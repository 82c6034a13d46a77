"""Is this a triangulation of a part of the plane?  Exactly decided, and the triangle is named."""

from __future__ import annotations

from typing import NoReturn

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.geometry.predicates import orientations
from harness.geometry.validation import first_conflict
from harness.mesh.pieces import stacked
from harness.mesh.stars import TWICE, Fault, Ints, Stars, stars_of, windings

Floats = npt.NDArray[np.float64]
NEAR = 1e-6
"""The sum of a fan's angles in doubles is far better than that."""
LARGE = 2.0**1022
"""Coordinates above it may differ by more than the greatest double."""


def checked(points: npt.ArrayLike, triangles: npt.ArrayLike) -> tuple[Floats, Ints, Stars]:
    """Coordinates (n, 2), counter-clockwise triangles (m, 3) and their stars.

    ``points``: (n, 2), or (n, 3) with one z for all vertices of triangles.  If every triangle is
    clockwise, all are turned round.  The triangles must have area, agree in orientation, share
    an edge two at most and a vertex as one fan, and not overlap.  Every decision is exact; the
    time is that of sorting, and of a sweep over the boundary's edges.

    Raises:
        UserError: names the first triangle (or vertex) that is wrong, counted from 0.
    """
    xy, corners = _arrays(points, triangles)
    signs = orientations(xy[corners[:, 0]], xy[corners[:, 1]], xy[corners[:, 2]])
    flat = np.flatnonzero(signs == 0)
    if len(flat):
        _refuse(int(flat[0]), "is flat: its vertices are collinear")
    if (signs < 0).all():
        corners = np.ascontiguousarray(corners[:, ::-1])
    elif (signs < 0).any():
        minority = -1 if (signs > 0).sum() * 2 >= len(signs) else 1
        _refuse(int(np.flatnonzero(signs == minority)[0]), "is inverted against most others")
    stars, fault = stars_of(len(xy), corners)
    if fault is not None:
        _refuse_fault(fault)
    _refuse_folds(xy, corners, stars)
    return xy, corners, stars


def _refuse(triangle: int, reason: str) -> NoReturn:
    raise UserError(f"triangle {triangle} (counting from 0) {reason}")


def _arrays(points: npt.ArrayLike, triangles: npt.ArrayLike) -> tuple[Floats, Ints]:
    """Finite coordinates, and triangles of three different vertices that exist."""
    try:
        given = np.array(points, dtype=np.float64)
        corners = np.array(triangles)
    except (TypeError, ValueError) as error:
        raise UserError(f"points and triangles must be arrays of numbers: {error}") from None
    if given.ndim != 2 or given.shape[1] not in (2, 3):
        raise UserError(f"points need the shape (n, 2) or (n, 3), not {given.shape}")
    if corners.ndim != 2 or corners.shape[1] != 3 or not len(corners):
        raise UserError(f"triangles need the shape (m, 3), m ≥ 1, not {corners.shape}")
    if not np.issubdtype(corners.dtype, np.integer):
        raise UserError("triangles must be whole numbers")
    corners = np.ascontiguousarray(corners, dtype=np.int64)
    outside = np.flatnonzero(((corners < 0) | (corners >= len(given))).any(axis=1))
    if len(outside):
        _refuse(int(outside[0]), f"has a vertex that is not among the {len(given)} points")
    twice = np.flatnonzero((corners == np.roll(corners, 1, axis=1)).any(axis=1))
    if len(twice):
        _refuse(int(twice[0]), "has a vertex twice")
    wild = ~np.isfinite(given).all(axis=1)
    if wild.any():
        raise UserError(f"point {np.flatnonzero(wild)[0]} (counting from 0) is not finite")
    if given.shape[1] == 3:
        z = given[corners, 2]
        off = np.flatnonzero((z != z[0, 0]).any(axis=1))
        if len(off):
            _refuse(int(off[0]), "is not in the plane of the first one: z differs")
    return np.ascontiguousarray(given[:, :2]), corners


def _refuse_fault(fault: Fault) -> NoReturn:
    if fault.kind == TWICE:
        reason = f"and triangle {fault.other} are on one side of a common edge"
        _refuse(fault.triangle, f"{reason} at vertex {fault.vertex}: the mesh is not a manifold")
    reason = f"hangs on the others by vertex {fault.vertex} alone"
    _refuse(fault.triangle, f"{reason}: the mesh is not a manifold")


def _refuse_folds(xy: Floats, corners: Ints, stars: Stars) -> None:
    """Positive triangles overlap unless all of this holds; then they do not.

    Around every vertex the triangles turn at most once, boundary edges do not cross, and no
    piece lies on another.  (A connected surface whose boundary curves are simple and disjoint
    and that lies in the plane without folds has one outer curve: the curves' turning numbers ±1
    add up to 2 − 2·genus − curves.  So it covers nothing twice.)
    """
    x, y = np.ascontiguousarray(xy[:, 0]), np.ascontiguousarray(xy[:, 1])
    wound = np.flatnonzero(windings(*stars, x, y) > 1)
    if len(wound):
        _refuse(_one_at(corners, int(wound[0])), f"is folded over others at vertex {wound[0]}")
    _refuse_wide_fans(xy, corners, stars)
    edges, owners = boundary(corners)
    _refuse_crossings(xy, edges, owners)
    _refuse_stacked(xy, corners)


def _one_at(corners: Ints, vertex: int) -> int:
    return int(np.flatnonzero((corners == vertex).any(axis=1))[0])


def boundary(corners: Ints) -> tuple[Ints, Ints]:
    """The directed edges (k, 2) that only one triangle has, and that triangle (k,)."""
    edges = np.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)])
    owners = np.tile(np.arange(len(corners)), 3)
    ends = np.sort(edges, axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    same = (ends[order[1:]] == ends[order[:-1]]).all(axis=1)
    alone = np.ones(len(edges), dtype=np.bool_)
    alone[order[1:][same]] = alone[order[:-1][same]] = False
    kept = np.flatnonzero(alone)
    return edges[kept], owners[kept]


def _refuse_wide_fans(xy: Floats, corners: Ints, stars: Stars) -> None:
    """An open star turns by at most 2π; near that, the sides of its first and last edge decide."""
    totals = np.zeros(len(xy))
    near = np.ldexp(xy, -1) if np.abs(xy).max() > LARGE else xy  # differences are doubles
    for k in range(3):
        here = near[corners[:, k]]
        u, w = near[corners[:, (k + 1) % 3]] - here, near[corners[:, (k + 2) % 3]] - here
        size = np.maximum(np.abs(u).max(axis=1), np.abs(w).max(axis=1))[:, np.newaxis]
        u, w = u / size, w / size
        turn = np.arctan2(u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0], (u * w).sum(axis=1))
        np.add.at(totals, corners[:, k], turn)
    wide = np.flatnonzero(~stars.closed & (totals > 2 * np.pi - NEAR))
    for v in wide.tolist():
        first = stars.ring[stars.offsets[v]]
        last = stars.ring[stars.offsets[v] + stars.degrees[v] - 1]
        beyond = orientations(xy[v], xy[last], xy[first]) < 0
        if totals[v] > 2 * np.pi + NEAR or beyond:
            _refuse(_one_at(corners, v), f"is folded over others at vertex {v}")


def _refuse_crossings(xy: Floats, edges: Ints, owners: Ints) -> None:
    """Boundary edges meet at their ends only, or lie on each other from both sides (a crack)."""
    ends = xy[edges].reshape(-1, 4)
    order = np.lexsort((ends[:, 3], ends[:, 2], ends[:, 1], ends[:, 0]))
    twin = np.flatnonzero((ends[order[1:]] == ends[order[:-1]]).all(axis=1))
    if len(twin):
        i, j = sorted(owners[[order[twin[0]], order[twin[0] + 1]]].tolist())
        _refuse(j, f"is folded over triangle {i}: their boundary edges are equal")
    backward = (ends[:, 0] > ends[:, 2]) | ((ends[:, 0] == ends[:, 2]) & (ends[:, 1] > ends[:, 3]))
    ends[backward] = ends[backward][:, [2, 3, 0, 1]]
    single, kept = np.unique(ends, axis=0, return_index=True)
    pair = first_conflict(Instance("segments", single.reshape(-1, 2, 2)))
    if pair is not None:
        i, j = sorted(owners[kept[list(pair)]].tolist())
        _refuse(j, f"is folded over triangle {i}: their boundary edges cross")


def _refuse_stacked(xy: Floats, corners: Ints) -> None:
    """No piece lies on another."""
    pair = stacked(xy, corners)
    if pair is not None:
        _refuse(pair[0], f"lies on triangle {pair[1]} of another piece of the mesh")
