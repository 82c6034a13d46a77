"""Ties that happen to lie at special corners, found exactly where doubles gave up."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from itertools import combinations

import numpy as np

from harness.diagram.fast.build import Leaves, open_rows
from harness.diagram.fast.hubs import Hubs
from harness.diagram.fast.plane import same_direction
from harness.diagram.fast.prepare import Ints
from harness.diagram.fast.roots import Roots
from harness.diagram.fast.rows import between_middles, contest_far, vector
from harness.diagram.planar_map import RationalPoint
from harness.geometry.instance import Instance

#: Rows (corner, i, j, which): the sum of 1 if F⁺ is zero there, 2 if F⁻ is, and 4 or 8 if its
#: gradient is, too.
Ties = set[tuple[int, int, int, int]]


def ties_at_corners(instance: Instance, roots: Roots, leaves: Leaves) -> Ties:
    """Pairs of candidates of hard leaves whose F is zero at a corner of a root in that leaf."""
    wanted: dict[int, set[int]] = {}
    for number, row in enumerate(open_rows(leaves).tolist()):
        ids = leaves.open_ids[leaves.open_first[number] : leaves.open_first[number + 1]].tolist()
        shape = leaves.shapes[row].reshape(3, 3)
        for k in range(3):
            if np.count_nonzero(shape[k]) != 1:
                continue
            corner = int(roots.triangles[leaves.shape_roots[row], int(shape[k].argmax())])
            if roots.corners.special[corner]:
                wanted.setdefault(corner, set()).update(ids)
    return {row for corner, ids in wanted.items() for row in _ties(instance, roots, corner, ids)}


def ties_at_hubs(instance: Instance, roots: Roots, hubs: Hubs) -> Ties:
    """Ties at hubs, between the segments of the leaves in which they were found, and known ones."""
    found: Ties = set()
    if not (hubs.points or hubs.directions or hubs.known):
        return found
    corners = roots.corners
    weights = np.array(corners.weights)
    rounded = corners.points()
    for point, ids in hubs.points.items():
        gap = np.abs(rounded - [float(c) for c in point]).max(axis=1)
        near = (gap <= 1e-9 * (1 + np.abs(rounded).max(axis=1))) & (weights != 0)
        for corner in np.flatnonzero(near).tolist():
            if corners.exact[corner] == point:
                found |= set(_ties(instance, roots, corner, ids))
    for direction in hubs.all_directions():
        x, y = (float(c) for c in direction)
        along, across = rounded @ (x, y), rounded @ (-y, x)
        near = (weights == 0) & (along > 0) & (np.abs(across) <= 1e-9 * along)
        for corner in np.flatnonzero(near).tolist():
            if same_direction(corners.exact[corner], direction):
                found |= set(_ties(instance, roots, corner, hubs.directions.get(direction, ())))
                found |= {(corner, *row) for row in hubs.known.get(direction, ())}
    return found


def _ties(
    instance: Instance, roots: Roots, corner: int, ids: Iterable[int]
) -> list[tuple[int, int, int, int]]:
    """All ties of some segments at a corner."""
    p = roots.corners.exact[corner]
    tie = _tie if roots.corners.weights[corner] else _tie_far
    rows = []
    for i, j in combinations(sorted(ids), 2):
        which = tie(instance, i, j, p)
        if which:
            rows.append((corner, i, j, which))
    return rows


def _tie(instance: Instance, i: int, j: int, p: RationalPoint) -> int:
    """Which of F⁺_ij and F⁻_ij are zero at p; see Ties."""
    (qi, li), (qj, lj) = _forms(instance, i, p), _forms(instance, j, p)
    which = (1 if qi * lj == qj * li else 0) + (2 if qi * lj == -qj * li else 0)
    if not which:
        return 0
    (ui, vi), (uj, vj) = _gradients(instance, i, p), _gradients(instance, j, p)
    if li == lj == 0 and vi[0] * vj[1] == vi[1] * vj[0]:
        return which  # on one line, whose factor is divided out
    for bit, sign in ((1, 1), (2, -1)):
        flat = all(ui[k] * lj + qi * vj[k] == sign * (uj[k] * li + qj * vi[k]) for k in range(2))
        which += 4 * bit if which & bit and flat else 0
    return which


def _tie_far(instance: Instance, i: int, j: int, d: RationalPoint) -> int:
    """The same at infinity, in the direction d.

    There Q is |d|² and L is −d × v.  If both have the vector v, and δ is the difference of their
    middles, F is w·(|d|² (v × δ) + 2 (δ·d)(d × v)) to first order in w.  That F vanishes itself is
    known without ties then.
    """
    v, w = vector(instance, i), vector(instance, j)
    li, lj = d[0] * v[1] - d[1] * v[0], d[0] * w[1] - d[1] * w[0]
    if v not in (w, (-w[0], -w[1])):
        return (1 if li == lj else 0) + (2 if li == -lj else 0)
    flat = li != 0 and contest_far(v, between_middles(instance, i, j), d) == 0
    return (4 if v == w else 8) if flat else 0


def _gradients(instance: Instance, k: int, p: RationalPoint) -> tuple[RationalPoint, RationalPoint]:
    """The gradients of Q and L of a segment at a point."""
    a, b = instance.rational_segment(k)
    return (2 * p[0] - a[0] - b[0], 2 * p[1] - a[1] - b[1]), (a[1] - b[1], b[0] - a[0])


def _forms(instance: Instance, k: int, p: RationalPoint) -> tuple[Fraction, Fraction]:
    """Q and L of a segment at a point."""
    a, b = instance.rational_segment(k)
    ax, ay, bx, by = a[0] - p[0], a[1] - p[1], b[0] - p[0], b[1] - p[1]
    return ax * bx + ay * by, ax * by - ay * bx


def tie_arrays(ties: Ties, corners: int) -> tuple[Ints, Ints]:
    """First row of each corner (corners + 1,), and rows (i, j, which), i < j, sorted."""
    merged: dict[tuple[int, int, int], int] = {}
    for corner, i, j, which in ties:
        merged[corner, i, j] = merged.get((corner, i, j), 0) | which
    rows = sorted((*key, which) for key, which in merged.items())
    first = np.searchsorted([row[0] for row in rows], np.arange(corners + 1))
    flat = np.array([row[1:] for row in rows], dtype=np.int64).reshape(-1, 3)
    return first.astype(np.int64), flat
