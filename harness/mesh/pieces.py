"""Does one piece of a mesh lie on another?  For pieces whose boundaries do not cross.

Then one point in the interior of each piece tells: the centroid of its first triangle.  It may lie
on an edge of another piece, so closed triangles are asked; and it need not be a double, so it is
taken as the rational that it is, after a look at boxes in doubles.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from harness.geometry.coordinates import Floats
from harness.geometry.predicates import orientation
from harness.mesh.stars import Ints

Point = tuple[Fraction, Fraction]

AT_ONCE = 1 << 20
"""Pairs of a triangle and a centroid whose boxes are compared together."""
RELATIVE, ABSOLUTE = 2.0**-50, 2.0**-1060
"""The mean of three doubles is computed with less error than these make together."""


def stacked(xy: Floats, corners: Ints) -> tuple[int, int] | None:
    """A triangle of a piece that lies on another one, and a triangle below it; None if none does.

    The triangles are positive.  Time: that of sorting, and of all pairs of a triangle and a piece
    that have an x in common.
    """
    pieces = _pieces(len(xy), corners)
    firsts = np.unique(pieces, return_index=True)[1]
    if len(firsts) == 1:
        return None
    above, below = _close(xy, corners, firsts)
    apart = pieces[above] != pieces[below]
    for i in np.lexsort((below[apart], above[apart])).tolist():
        t, other = int(above[apart][i]), int(below[apart][i])
        if _holds(_exact(xy[corners[other]]), _centroid(_exact(xy[corners[t]]))):
            return t, other
    return None


def _pieces(n: int, corners: Ints) -> Ints:
    """The piece (m,) that each triangle belongs to."""
    links = np.concatenate([corners[:, :2], corners[:, 1:]])
    ones = np.ones(len(links), dtype=np.int8)
    graph = coo_matrix((ones, (links[:, 0], links[:, 1])), shape=(n, n))
    of_vertex = connected_components(graph, directed=False)[1]
    return of_vertex[corners[:, 0]].astype(np.int64)


def _close(xy: Floats, corners: Ints, firsts: Ints) -> tuple[Ints, Ints]:
    """All pairs of one of ``firsts`` and a triangle whose box may hold the centroid of the first.

    In order of x, the centroids that a triangle's box may hold are in one range.
    """
    error = RELATIVE * float(np.abs(xy[corners]).max()) + ABSOLUTE
    with np.errstate(over="ignore"):
        low, high = xy[corners].min(axis=1) - error, xy[corners].max(axis=1) + error
    middles = (xy[corners[firsts]] / 3).sum(axis=1)
    order = np.argsort(middles[:, 0])
    firsts, middles = firsts[order], middles[order]
    begin = np.searchsorted(middles[:, 0], low[:, 0], "left")
    counts = np.searchsorted(middles[:, 0], high[:, 0], "right") - begin
    portion = np.cumsum(counts) // AT_ONCE
    found = []
    for few in np.split(np.arange(len(corners)), np.flatnonzero(np.diff(portion)) + 1):
        many = counts[few]
        which = np.repeat(few, many)
        within = np.arange(len(which)) - np.repeat(np.cumsum(many) - many, many)
        at = np.repeat(begin[few], many) + within
        y = middles[at, 1]
        near = (low[which, 1] <= y) & (y <= high[which, 1])
        found.append((firsts[at[near]], which[near]))
    above, below = zip(*found, strict=True)
    return np.concatenate(above), np.concatenate(below)


def _exact(places: Floats) -> list[Point]:
    return [(Fraction(x), Fraction(y)) for x, y in places.tolist()]


def _centroid(triangle: list[Point]) -> Point:
    (ax, ay), (bx, by), (cx, cy) = triangle
    return (ax + bx + cx) / 3, (ay + by + cy) / 3


def _holds(triangle: list[Point], p: Point) -> bool:
    """Whether a point lies in a closed positive triangle."""
    a, b, c = triangle
    return all(orientation(*side, p) >= 0 for side in ((a, b), (b, c), (c, a)))
