"""A polygon as the methods see it: its edges counter-clockwise, from any point, in doubles."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from flint import fmpq

from harness.errors import UserError
from harness.geometry.exact import ExactPoint, fraction, point
from harness.geometry.instance import Instance
from harness.geometry.kernel import kernel, why_not_star_shaped
from harness.peak.ascent import greatest_cap
from harness.peak.rational import Edge

Floats = npt.NDArray[np.float64]


class Polygon:
    """The edges of a polygon in counter-clockwise order, whatever the order of its vertices.

    Edge k here is segment ``names[k]`` of the instance; vertex k here, where edge k begins, is
    vertex ``corners[k]`` of the instance.
    """

    def __init__(self, instance: Instance) -> None:
        """Raises :class:`UserError` if the instance is no polygon or has no area."""
        if instance.kind != "polygon":
            raise UserError(f"{instance.label}: only a polygon has a peak, not segments")
        if instance.n < 3 or instance.orientation == 0:
            raise UserError(f"{instance.label}: the polygon has no area, hence no peak")
        self.instance = instance
        self.n = instance.n
        order = np.arange(self.n)
        self.corners = order if instance.orientation > 0 else order[::-1]
        self.names = order if instance.orientation > 0 else (self.n - 2 - order) % self.n
        self.x = np.ascontiguousarray(instance.floats[self.corners, 0])
        self.y = np.ascontiguousarray(instance.floats[self.corners, 1])

    @property
    def is_exact(self) -> bool:
        """Whether the doubles are the coordinates."""
        return self.instance.exact is None

    @cached_property
    def start(self) -> tuple[float, int]:
        """(c, vertex): a level below c*, up to a few roundings, and the vertex whose cap it is.

        See :func:`harness.peak.ascent.greatest_cap`; −1 for no vertex.
        """
        level, vertex = greatest_cap(*self.directions(), self.n)
        return float(level), int(vertex)

    def directions(self) -> Floats:
        """The directions of the edges, each as long as a power of two makes it about 1; (2, n).

        Relative errors are those of one rounding, unless an entry is 10³⁰⁰ times the smaller.
        """
        if self.is_exact:
            with np.errstate(over="ignore"):
                along = np.stack([np.roll(self.x, -1) - self.x, np.roll(self.y, -1) - self.y])
            if np.isfinite(along).all():
                return np.asarray(np.ldexp(along, -np.frexp(np.abs(along).max(axis=0))[1]))
        exact = [(b[0] - a[0], b[1] - a[1]) for a, b in self.exact_edges]
        units = [power_above(max(abs(x), abs(y))) for x, y in exact]
        pairs = [(x / unit, y / unit) for (x, y), unit in zip(exact, units, strict=True)]
        return np.array([[nearest(x) for x, _ in pairs], [nearest(y) for _, y in pairs]])

    def exact_vertex(self, k: int) -> ExactPoint:
        """Vertex k, exactly."""
        return point(self.instance.exact_vertex(int(self.corners[k])))

    @cached_property
    def exact_edges(self) -> list[Edge]:
        """All edges, exactly."""
        vertices = [self.exact_vertex(k) for k in range(self.n)]
        return list(zip(vertices, [*vertices[1:], vertices[0]], strict=True))

    @cached_property
    def scale(self) -> Any:
        """A power of two a little above the size of the polygon, as a rational."""
        (ox, oy), _ = self.exact_edges[0]
        return power_above(max(max(abs(x - ox), abs(y - oy)) for (x, y), _ in self.exact_edges))

    def edges_from(self, origin: ExactPoint) -> Floats:
        """Starts and directions of the edges from an exact origin, divided by ``scale``; (4, n).

        Every entry is the double nearest to the exact value.  O(n) rational operations.
        """
        ox, oy = origin
        vertices = [edge[0] for edge in self.exact_edges]
        starts = [((x - ox) / self.scale, (y - oy) / self.scale) for x, y in vertices]
        along = [
            ((b[0] - a[0]) / self.scale, (b[1] - a[1]) / self.scale) for a, b in self.exact_edges
        ]
        return np.array(
            [
                [nearest(start[0]) for start in starts],
                [nearest(start[1]) for start in starts],
                [nearest(step[0]) for step in along],
                [nearest(step[1]) for step in along],
            ]
        )

    def moved(self, origin: ExactPoint, x: float, y: float) -> ExactPoint:
        """An exact origin plus a vector in units of ``scale``."""
        step = point((x, y))
        return origin[0] + step[0] * self.scale, origin[1] + step[1] * self.scale

    def inner_point(self) -> ExactPoint:
        """A point in the interior of the kernel, exactly.  O(n log n).

        Raises :class:`UserError` naming edges without a common inner point if there is none.
        """
        found = kernel(self.instance)
        reason = why_not_star_shaped(self.instance, found)
        if reason is not None:
            raise UserError(reason)
        corners = [point(corner) for corner in found.corners]
        k = len(corners)
        three = [corners[0], corners[k // 3], corners[(2 * k) // 3]]
        return sum((p[0] for p in three), fmpq(0)) / 3, sum((p[1] for p in three), fmpq(0)) / 3


def power_above(size: Any) -> Any:
    """A power of two above a positive rational, but at most four times as large."""
    return fmpq(2) ** (int(size.p).bit_length() - int(size.q).bit_length() + 1)


def nearest(value: Any) -> float:
    """The double nearest to a rational."""
    return float(fraction(value))
