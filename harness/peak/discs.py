"""The intersection of discs by parallel divide and conquer (the paper, Lemma 6).

A region is a list of slabs from left to right: between two neighbouring vertices it is bounded by
one arc from above and one from below.  All pairs of regions of one level are merged together, and
each step of the merging is one batch of independent comparisons, what n processors do at a time:

1. merge the vertices of both lists by binary search;
2. in each slab, the crossings of the at most four arcs whose x lies inside;
3. order them; between two neighbours the arcs do not cross, so one comparison at the middle says
   which arc is the innermost, above and below, and whether anything is left between;
4. forget vertices at which no arc changes.

A *judge* answers the comparisons.  Here it looks at one given set of discs; in
:mod:`harness.peak.parametric` at discs that grow with an unknown parameter.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.peak.circles import (
    Circles,
    Floats,
    Ints,
    crossing,
    crossing_margin,
    of_discs,
    ordinate,
)

LEFTMOST, RIGHTMOST = 0, 2
"""Sides of a vertex that is an extreme point of a single circle: see
:func:`harness.peak.circles.crossing`."""

Booleans = npt.NDArray[np.bool_]


class Vertices(NamedTuple):
    """Crossings of circles ``one`` and ``other`` on a ``side``; arrays of one length."""

    one: Ints
    other: Ints
    side: Ints

    def take(self, index: Ints | Booleans) -> Vertices:
        """Those with these numbers."""
        return Vertices(self.one[index], self.other[index], self.side[index])


class Judge(Protocol):
    """Who answers a batch of independent comparisons."""

    def cross(self, one: Ints, other: Ints) -> Booleans:
        """Whether the circles cross in two points."""
        ...

    def is_left(self, v: Vertices, w: Vertices) -> Booleans:
        """Whether x(v) < x(w)."""
        ...

    def is_below(
        self, v: Vertices, w: Vertices, one: Ints, other: Ints, halves: tuple[bool, bool]
    ) -> Booleans:
        """Whether at the middle of x(v) and x(w) one arc is below another.

        ``halves``: whether each is an upper half.
        """
        ...


class Slabs(NamedTuple):
    """The slabs of many regions, by region and then from left to right."""

    region: Ints
    left: Vertices
    right: Vertices
    upper: Ints
    lower: Ints

    def take(self, index: Ints | Booleans) -> Slabs:
        """Those with these numbers."""
        return Slabs(
            self.region[index],
            self.left.take(index),
            self.right.take(index),
            self.upper[index],
            self.lower[index],
        )


@dataclass(frozen=True, eq=False)
class Meet:
    """The intersection of discs: vertices and arcs, from left to right.

    ``vertices``: (m + 1, 2), by increasing x; ``upper``, ``lower``: (m,), the discs whose arcs
    bound it between vertex k and vertex k + 1, from above and from below.  No vertices if it is
    empty.
    """

    vertices: Floats
    upper: Ints
    lower: Ints

    @property
    def is_empty(self) -> bool:
        """Whether no point is in all discs (or a single one, up to rounding)."""
        return len(self.vertices) == 0

    def arcs(self) -> list[int]:
        """The discs with an arc on the boundary, increasing."""
        return sorted({*self.upper.tolist(), *self.lower.tolist()})


def meet(centres: npt.ArrayLike, radii: npt.ArrayLike) -> Meet:
    """The intersection of discs, in doubles; O(n log n), in O(log² n) batches.

    ``centres``: (n, 2); ``radii``: (n,), positive.  Coordinates near the intersection should be
    small, for they are accurate relative to the origin.  Equal discs count once.  Crossings closer
    together than rounding may come out in any order or not at all.

    Raises:
        UserError: no discs; shapes that do not fit; a radius that is not positive or not finite.
    """
    z, radius = np.asarray(centres, dtype=np.float64), np.asarray(radii, dtype=np.float64)
    if z.ndim != 2 or z.shape[1] != 2 or radius.shape != z.shape[:1] or not len(z):
        raise UserError(f"discs need centres (n, 2) and radii (n,), not {z.shape}, {radius.shape}")
    wrong = np.flatnonzero(~(np.isfinite(z).all(axis=1) & np.isfinite(radius) & (radius > 0)))
    if len(wrong):
        raise UserError(f"disc {wrong[0]} (counting from 0) has no finite positive radius")
    _, distinct = np.unique(np.column_stack([z, radius]), axis=0, return_index=True)
    circles = of_discs(z[distinct], radius[distinct])
    slabs = intersect(len(distinct), Present(circles))
    if not len(slabs.region):
        return Meet(np.empty((0, 2)), slabs.upper, slabs.lower)
    corners = joined(slabs.left, slabs.right.take(np.array([-1])))
    x, y = crossing(circles.take(corners.one), circles.take(corners.other), corners.side)
    return Meet(np.stack([x, y], axis=1), distinct[slabs.upper], distinct[slabs.lower])


class Present:
    """The judge of given circles."""

    def __init__(self, circles: Circles) -> None:
        """``circles``: all of them, by number."""
        self.circles = circles

    def _x(self, v: Vertices) -> Floats:
        return crossing(self.circles.take(v.one), self.circles.take(v.other), v.side)[0]

    def cross(self, one: Ints, other: Ints) -> Booleans:
        """See :class:`Judge`."""
        return crossing_margin(self.circles.take(one), self.circles.take(other)) > 0

    def is_left(self, v: Vertices, w: Vertices) -> Booleans:
        """See :class:`Judge`."""
        return self._x(v) < self._x(w)

    def is_below(
        self, v: Vertices, w: Vertices, one: Ints, other: Ints, halves: tuple[bool, bool]
    ) -> Booleans:
        """See :class:`Judge`."""
        x = (self._x(v) + self._x(w)) / 2
        first, second = (
            ordinate(self.circles.take(k), x, np.full(len(x), half))
            for k, half in zip((one, other), halves, strict=True)
        )
        return first < second


def joined(*parts: Vertices) -> Vertices:
    """Lists of vertices, one after the other."""
    return Vertices(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def single(n: int) -> Slabs:
    """Every disc as a region of its own."""
    k = np.arange(n)
    return Slabs(
        k,
        Vertices(k, k, np.full(n, LEFTMOST)),
        Vertices(k, k, np.full(n, RIGHTMOST)),
        k,
        k,
    )


def intersect(n: int, judge: Judge) -> Slabs:
    """The intersection of discs 0 … n − 1, by merging all pairs of a level at a time."""
    from harness.peak.merging import merged

    slabs = single(n)
    while n > 1:
        slabs = merged(slabs, n, judge)
        n = (n + 1) // 2
    return slabs
