"""The figures by which meshes are compared: the least angle of each triangle."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt

from harness.geometry.jit import compiled
from harness.mesh.angles import triangle_least
from harness.mesh.stars import Ints
from harness.mesh.validation import Floats

SMALL, LARGER = 2.0**-300, 2.0**600
"""Products of sides below the first have no digits, unless they are multiplied by the second."""


@dataclass(frozen=True)
class Quality:
    """Of the least angles of all triangles, in degrees: least, percentiles and mean."""

    smallest: float
    percentile_1: float
    percentile_5: float
    mean: float

    def as_dict(self) -> dict[str, float]:
        """The figures by name."""
        return asdict(self)


def least_angles(points: npt.ArrayLike, triangles: npt.ArrayLike) -> Floats:
    """The least angle of each counter-clockwise triangle, in degrees; 0 if it is not positive.

    It is the same double whichever vertex of a triangle comes first.
    ``points``: (n, 2); ``triangles``: (m, 3).
    """
    xy = np.ascontiguousarray(points, dtype=np.float64)
    corners = np.asarray(triangles, dtype=np.int64)
    exponent = int(np.frexp(_greatest(xy, corners))[1])
    with np.errstate(over="ignore"):  # of vertices that no triangle uses
        least: Floats = _least(np.ldexp(xy, -exponent), corners)
    return least


@compiled
def _greatest(xy, triangles):
    greatest = 0.0
    for t in range(len(triangles)):
        for k in range(3):
            v = triangles[t, k]
            greatest = max(greatest, abs(xy[v, 0]), abs(xy[v, 1]))
    return greatest


@compiled
def is_shorter(xy, a, b, c, d):
    """Whether the side a–b is shorter than c–d; of equal ones, whether a is left of c or below."""
    first = max(abs(xy[b, 0] - xy[a, 0]), abs(xy[b, 1] - xy[a, 1]))
    second = max(abs(xy[d, 0] - xy[c, 0]), abs(xy[d, 1] - xy[c, 1]))
    if first != second:
        return first < second
    return xy[a, 0] < xy[c, 0] or (xy[a, 0] == xy[c, 0] and xy[a, 1] < xy[c, 1])


@compiled
def shortest_first(xy, a, b, c):
    """The corners of a triangle, in their order, such that a–b is the shortest side.

    Seen from there, differences of coordinates keep most digits; and what is computed does not
    depend on the order that was given.
    """
    while is_shorter(xy, b, c, a, b) or is_shorter(xy, c, a, a, b):
        a, b, c = b, c, a
    return a, b, c


@compiled
def _least(xy, triangles):
    least = np.empty(len(triangles))
    for t in range(len(triangles)):
        a, b, c = shortest_first(xy, triangles[t, 0], triangles[t, 1], triangles[t, 2])
        ux, uy = xy[b, 0] - xy[a, 0], xy[b, 1] - xy[a, 1]
        wx, wy = xy[c, 0] - xy[a, 0], xy[c, 1] - xy[a, 1]
        if max(abs(ux), abs(uy)) < SMALL and max(abs(wx), abs(wy)) < SMALL:
            ux, uy, wx, wy = ux * LARGER, uy * LARGER, wx * LARGER, wy * LARGER
        least[t] = np.degrees(triangle_least(0.0, 0.0, ux, uy, wx, wy))
    return least


def corner_angles(points: npt.ArrayLike, triangles: npt.ArrayLike) -> Floats:
    """The three angles (m, 3) of each triangle, in degrees, at its vertices in their order."""
    xy = np.asarray(points, dtype=np.float64)
    corners: Ints = np.asarray(triangles)
    places = xy[corners]
    places = places - places[:, :1]
    size = np.abs(places).max(axis=(1, 2), keepdims=True)
    with np.errstate(invalid="ignore"):
        places = places / size
    angles = np.empty((len(corners), 3))
    for k in range(3):
        u = places[:, (k + 1) % 3] - places[:, k]
        w = places[:, (k + 2) % 3] - places[:, k]
        cross = u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]
        angles[:, k] = np.degrees(np.arctan2(cross, (u * w).sum(axis=1)))
    return angles


def quality_of(points: npt.ArrayLike, triangles: npt.ArrayLike) -> Quality:
    """The figures of a mesh: ``points`` (n, 2), counter-clockwise ``triangles`` (m, 3); O(m)."""
    least = least_angles(points, triangles)
    low, five = np.percentile(least, [1, 5]).tolist()
    return Quality(float(least.min()), low, five, float(least.mean()))
