"""Root triangles: a triangulation of the domain whose inner sides are in general position.

The subdivision is exact as long as no vertex of the diagram lies on a side of a triangle and no
edge runs along one.  Input is often symmetric, so the sides must not be: every inner side has at
least one corner at an arbitrarily chosen, *free* point, and at most one *special* corner, where
something is known to happen: a segment's endpoint, a corner of the domain, a crossing of lines.  At
special corners the forms that vanish are known by construction (``incident``).  (A free point that
is not free enough shows as a contradiction and is replaced, with all others, by the next choice.)

kernel    its corners c_k are special; on every side a free point g_k.  Triangles
          (g_{k−1}, c_k, g_k), and halving chords of the polygon of the g_k.
plane,    for the smallest angle: the faces of the arrangement of all segments' lines, each a fan
interior  about a free point (:mod:`harness.diagram.fast.faces`).  A line's segment owns the line
          outside the segment, so there sides may have two special corners.
interior  for the largest angle, or very large: of a star-shaped polygon, a fan about a free point
          of the kernel; of others, a triangulation, refined as in the plane.
plane     for the largest angle: a Delaunay triangulation of all endpoints and a large free triangle
          about them; in every triangle a free point, on every side between two endpoints a free
          point beside it.  Outside the large triangle, triangles with corners at infinity.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Contradiction

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]
#: What lies beyond a side of a root triangle that has no neighbour.
WALL, INFINITY = -1, -2


def double_double(value: Fraction) -> tuple[float, float]:
    """The two doubles whose sum is nearest to a rational, up to 2⁻¹⁰⁶ of it."""
    high = float(value)
    return high, float(value - Fraction(high))


class CornerTable(Protocol):
    """What both kinds of corners have; see :class:`Corners` for the meaning."""

    @property
    def exact(self) -> Sequence[RationalPoint]:
        """Coordinates; directions of corners at infinity."""

    @property
    def weights(self) -> Any:
        """1, or 0 at infinity, (c,)."""

    @property
    def incident(self) -> Sequence[list[int]]:
        """The forms that vanish at each corner."""

    @property
    def special(self) -> Any:
        """Whether something is known to happen at each, (c,)."""

    def add(
        self,
        point: RationalPoint,
        incident: Sequence[int] = (),
        weight: float = 1.0,
        special: bool = False,
    ) -> int:
        """Add a corner; its number."""

    def arrays(self, centre: RationalPoint, scale: Fraction) -> tuple[Floats, Floats, Ints, Ints]:
        """Coordinates, weights, incident segments (CSR)."""

    def have_ends(self, corners: Ints) -> NDArray[np.bool_]:
        """Whether each of some corners (k,) is an endpoint."""

    def points(self) -> Floats:
        """Coordinates as doubles."""


@dataclass
class Corners:
    """Corners of triangles: exact, as double-doubles, and the forms that vanish there."""

    exact: list[RationalPoint] = field(default_factory=list)
    weights: list[float] = field(default_factory=list)
    incident: list[list[int]] = field(default_factory=list)
    special: list[bool] = field(default_factory=list)

    def add(
        self,
        point: RationalPoint,
        incident: Sequence[int] = (),
        weight: float = 1.0,
        special: bool = False,
    ) -> int:
        """Add a corner; its number.  ``incident``: 2·segment, + 1 if it is an endpoint."""
        self.exact.append(point)
        self.weights.append(weight)
        self.incident.append(list(incident))
        self.special.append(special)
        return len(self.exact) - 1

    def arrays(self, centre: RationalPoint, scale: Fraction) -> tuple[Floats, Floats, Ints, Ints]:
        """Coordinates (c, 4) about ``centre`` times ``scale``, as double-doubles, weights (c,),
        and the incident segments in CSR form."""
        coordinates = np.empty((len(self.exact), 4))
        for k, (point, weight) in enumerate(zip(self.exact, self.weights, strict=True)):
            for axis in range(2):
                value = point[axis] - centre[axis] if weight else point[axis]
                coordinates[k, 2 * axis : 2 * axis + 2] = double_double(value * scale)
        first = np.cumsum([0, *map(len, self.incident)])
        flat = [z for row in self.incident for z in row]
        return coordinates, np.array(self.weights), first, np.array(flat, dtype=np.int64)

    def have_ends(self, corners: Ints) -> NDArray[np.bool_]:
        """Whether each of some corners (k,) is the endpoint of a segment."""
        rows = (self.incident[k] for k in corners.tolist())
        return np.array([any(z & 1 for z in row) for row in rows], dtype=bool)

    def points(self) -> Floats:
        """Coordinates (c, 2) as doubles; directions of corners at infinity."""
        return np.array([[float(x), float(y)] for x, y in self.exact]).reshape(-1, 2)


@dataclass(frozen=True, eq=False)
class Roots:
    """Root triangles with their candidates.

    ``triangles`` (r, 3): corners, counter-clockwise.  ``walls`` maps (corner, corner) of a side on
    the boundary to the number of the domain's side.  ``regions`` (k, 3): larger triangles on which
    candidates are sifted first; ``region_of`` (r,): that of each root, or −1.
    """

    corners: CornerTable
    triangles: Ints
    walls: dict[tuple[int, int], int]
    regions: Ints
    region_of: Ints

    @cached_property
    def on_walls(self) -> frozenset[int]:
        """The corners on the boundary of the domain."""
        return frozenset(corner for side in self.walls for corner in side)

    def opposite(self) -> Ints:
        """(r, 3): 3·root + side beyond the side opposite to each corner, or WALL or INFINITY.

        Raises Contradiction if a side belongs to two triangles in the same sense, or to one only
        without being a wall or at infinity.
        """
        r = len(self.triangles)
        start = self.triangles[:, [1, 2, 0]].ravel().astype(np.int64)
        end = self.triangles[:, [2, 0, 1]].ravel().astype(np.int64)
        keys = np.minimum(start, end) * len(self.corners.weights) + np.maximum(start, end)
        order = np.argsort(keys)
        same = np.diff(keys[order]) == 0
        one, other = order[:-1][same], order[1:][same]
        if (same[1:] & same[:-1]).any() or (start[one] == start[other]).any():
            raise Contradiction("two root triangles overlap")
        result = np.full(3 * r, WALL, dtype=np.int64)
        result[one], result[other] = other, one
        weights = np.array(self.corners.weights)
        alone = result == WALL
        far = alone & (weights[start] == 0) & (weights[end] == 0)
        result[far] = INFINITY
        for k in np.flatnonzero(alone & ~far):
            if (int(start[k]), int(end[k])) not in self.walls:
                raise Contradiction("a side of a root triangle has no neighbour")
        return result.reshape(r, 3)


def free_number(k: int, seed: int) -> Fraction:
    """A number in (1/4, 3/4) with 20 bits, well spread over k, different for every seed."""
    golden = 0.6180339887498949 + 0.0137 * seed
    return Fraction(int(((k * golden + 0.371 + 0.219 * seed) % 1 / 2 + 0.25) * 2**20), 2**20)


def between(a: RationalPoint, b: RationalPoint, t: Fraction) -> RationalPoint:
    """The point a + t(b − a)."""
    return a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])


def rounded_about(point: RationalPoint, origin: RationalPoint) -> RationalPoint:
    """A point with fewer digits: its difference from an origin is rounded to doubles."""
    return (
        origin[0] + Fraction(float(point[0] - origin[0])),
        origin[1] + Fraction(float(point[1] - origin[1])),
    )


def free_wall_point(corners: Corners, a: int, b: int, number: int, seed: int) -> int:
    """A free point between two corners on the boundary, on the lines that both are on."""
    lines = {z >> 1 for z in corners.incident[a]} & {z >> 1 for z in corners.incident[b]}
    point = between(corners.exact[a], corners.exact[b], free_number(number, seed))
    return corners.add(point, [2 * k for k in sorted(lines)])
