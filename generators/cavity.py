"""``cavity``: the star polygons of real meshes, rings around a vertex of a Delaunay triangulation.

Inversion in a point O (p ↦ p/|p|², O at the origin) maps the circles through O to lines.  So the
neighbours of O in the Delaunay triangulation of O and a set of points are the vertices of the
convex hull of the inverted points: the ring needs no triangulation, only one convex hull, and the
same few lines of arithmetic give the same ring on every machine.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from generators.family import Family
from generators.portable import Array, Stream, polar, surely_left_of_origin

_Point = tuple[float, float]


def cavity(n: int, seed: int = 0) -> Array:
    """The ring of a Delaunay vertex O of valence n among random points; shape (n, 2).

    The points are uniform, one per unit area, outside a disc of radius R about O, given that O
    has valence n:

    * n ≤ 6: R = 0.  This is the typical interior vertex of the Delaunay triangulation
      of random points (adding the origin to a Poisson process gives the typical point:
      Slivnyak–Mecke), whose valence is 6 on average;
    * n > 6: random meshes hardly ever have such vertices, graded ones do, where a coarse part
      meets a fine one: O stands alone in a hole, whose radius makes the mean valence about n.

    Point sets are drawn until the valence is n, which has probability 0.013 (n = 3), 0.10 (4),
    0.26 (5), 0.28 (6), then about 0.8/√n.  Only the 8n + 56 points nearest to O are drawn;
    a set is accepted only if no circle of the ring reaches beyond them.  O is the origin, the
    farthest vertex is at distance 1.  Expected O(n^1.5 log n).

    Source: Okabe, Boots, Sugihara & Chiu, "Spatial Tessellations", 2000, chapter 5 (typical
    valence); Rényi & Sulanke, Z. Wahrscheinlichkeitstheorie 2 (1963) 75–84.
    """
    CAVITY.check(n)
    stream = Stream("cavity", n, seed)
    hole = _hole(n)
    count = 8 * n + 56
    reach = math.sqrt(hole * hole + count / math.pi)
    while True:
        turns = np.sort(stream.uniform(count))
        spread = np.multiply(reach * reach - hole * hole, stream.uniform(count))
        radii = np.sqrt(np.add(hole * hole, spread))
        ring = delaunay_ring(polar(radii, turns), reach)
        if len(ring) == n:
            vertices = polar(np.divide(radii[ring], radii[ring].max()), turns[ring])
            if surely_left_of_origin(vertices):
                return vertices


def _hole(n: int) -> float:
    """The radius R of the hole at which a vertex has about n neighbours.

    Near a large hole the hull of the inverted points is that of random points in a disc, whose
    vertices Rényi & Sulanke count: 4.95 R^(2/3).  Without a hole the mean is 6, and
    √(36 + (4.95 R^(2/3))²) fits the mean between the two within 5 %.
    """
    base = math.sqrt(max(0, n * n - 36)) / 4.95
    return base * math.sqrt(base)


def delaunay_ring(points: Array, reach: float) -> list[int]:
    """Indices of the Delaunay neighbours of the origin among ``points``, counter-clockwise.

    ``points`` are sorted by angle and are all the points there are within ``reach`` of the
    origin.  Empty if that does not settle the ring: the origin is not an interior vertex, a circle
    of the ring is larger than ``reach``, or four points are cocircular up to rounding.

    Graham's scan of the inverted points, from the nearest point on.  O(number of points).
    """
    squared = np.add(np.square(points[:, 0]), np.square(points[:, 1]))
    inverted = np.divide(points, squared[:, np.newaxis])
    first = int(np.argmin(squared))
    order = [*range(first, len(points)), *range(first + 1)]
    q: list[_Point] = list(map(tuple, inverted.tolist()))
    hull: list[int] = []
    for index in order:
        while len(hull) > 1:
            turn = _turn(q[hull[-2]], q[hull[-1]], q[index])
            if turn == 0:
                return []
            if turn > 0:
                break
            hull.pop()
        hull.append(index)
    hull.pop()  # the first point again
    closed = [*hull, hull[0]]
    if len(hull) < 3 or not all(_within(q[a], q[b], reach) for a, b in pairwise(closed)):
        return []
    return hull


def _turn(a: _Point, b: _Point, c: _Point) -> int:
    """+1 if a, b, c turn left, −1 if right, 0 if rounding leaves it open."""
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], c[0] - b[0], c[1] - b[1]
    value = ux * vy - uy * vx
    size = abs(a[0]) + abs(a[1]) + abs(b[0]) + abs(b[1]) + abs(c[0]) + abs(c[1])
    if abs(value) <= 2.0**-49 * size * (abs(ux) + abs(uy) + abs(vx) + abs(vy)):
        return 0
    return 1 if value > 0.0 else -1


def _within(a: _Point, b: _Point, reach: float) -> bool:
    """Whether the circle through the origin that inverts to the line ab has diameter ≤ reach."""
    area = a[0] * b[1] - a[1] * b[0]
    length = math.sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]))
    return area * reach >= length


CAVITY = Family(
    name="cavity",
    kind="polygon",
    summary="ring around an interior vertex of a Delaunay triangulation of random points",
    source="typical Poisson–Delaunay vertex; Okabe et al. 2000, Rényi & Sulanke 1963",
    growth="unknown",
    build=cavity,
    largest=5_000,
)
