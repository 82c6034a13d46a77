"""Ties that happen to lie at special corners, found exactly where doubles gave up."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import numpy as np

from harness.diagram.fast.build import Leaves, open_rows
from harness.diagram.fast.prepare import Ints
from harness.diagram.fast.roots import Roots
from harness.diagram.planar_map import RationalPoint
from harness.geometry.instance import Instance

#: Rows (corner, i, j, 1 for F⁺ or 2 for F⁻ or 3).
Ties = set[tuple[int, int, int, int]]


def ties_at_corners(instance: Instance, roots: Roots, leaves: Leaves) -> Ties:
    """Pairs of candidates of hard leaves whose F is zero at a corner of a root in that leaf."""
    found: Ties = set()
    seen: set[tuple[int, int, int]] = set()
    for number, row in enumerate(open_rows(leaves).tolist()):
        ids = leaves.open_ids[leaves.open_first[number] : leaves.open_first[number + 1]].tolist()
        shape = leaves.shapes[row].reshape(3, 3)
        for k in range(3):
            if np.count_nonzero(shape[k]) != 1:
                continue
            corner = int(roots.triangles[leaves.shape_roots[row], int(shape[k].argmax())])
            if not roots.corners.weights[corner]:
                continue
            for i, j in combinations(sorted(ids), 2):
                if (corner, i, j) not in seen:
                    seen.add((corner, i, j))
                    which = _tie(instance, i, j, roots.corners.exact[corner])
                    if which:
                        found.add((corner, i, j, which))
    return found


def _tie(instance: Instance, i: int, j: int, p: RationalPoint) -> int:
    """1 if F⁺_ij is zero at p, 2 if F⁻_ij is, 3 if both are, 0 if none."""
    (qi, li), (qj, lj) = _forms(instance, i, p), _forms(instance, j, p)
    return (1 if qi * lj == qj * li else 0) + (2 if qi * lj == -qj * li else 0)


def _forms(instance: Instance, k: int, p: RationalPoint) -> tuple[Fraction, Fraction]:
    """Q and L of a segment at a point."""
    a, b = instance.rational_segment(k)
    ax, ay, bx, by = a[0] - p[0], a[1] - p[1], b[0] - p[0], b[1] - p[1]
    return ax * bx + ay * by, ax * by - ay * bx


def tie_arrays(ties: Ties, corners: int) -> tuple[Ints, Ints]:
    """First row of each corner (corners + 1,), and rows (i, j, which)."""
    rows = sorted(ties)
    first = np.searchsorted([row[0] for row in rows], np.arange(corners + 1))
    flat = np.array([row[1:] for row in rows], dtype=np.int64).reshape(-1, 3)
    return first.astype(np.int64), flat
