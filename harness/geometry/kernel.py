"""The kernel of a simple polygon: the points that see all of it, exactly.

The kernel is the intersection of the half-planes to the left of the (counter-clockwise) edges;
see Preparata and Shamos, "Computational Geometry", 1985, section 7.2.6.  Edges that run to the
right bound it from below by a convex function f, those that run to the left bound it from above
by a concave function g, vertical edges bound x.  The two envelopes are computed by filtered
loops in O(n log n); what remains is a handful of binary searches in rational arithmetic for the
greatest gap g − f and for its zeros.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.geometry import exact
from harness.geometry.coordinates import COUNTING, Floats, Point
from harness.geometry.halfplanes import HalfPlanes
from harness.geometry.instance import Instance


@dataclass(frozen=True, eq=False)
class Kernel:
    """The kernel of ``instance``, a closed convex set.

    ``dimension`` is 2 if it has interior points, 1 if it is a line segment, 0 if it is a point,
    −1 if it is empty.  ``sides`` lists, counter-clockwise, the polygon edges whose lines bound it
    along some length (of edges on one line the least); it is empty unless the dimension is 2.
    ``witness`` names two or three edges without a common point strictly to the left of all of
    them, if there is no interior (Helly's theorem), and is empty otherwise.
    """

    instance: Instance
    dimension: int
    sides: list[int]
    witness: tuple[int, ...] = ()
    flat_corners: tuple[Point, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Whether no point sees the whole polygon."""
        return self.dimension < 0

    @property
    def has_interior(self) -> bool:
        """Whether the kernel has an interior; only then is there a diagram in it."""
        return self.dimension == 2

    @cached_property
    def corners(self) -> list[Point]:
        """The corners, exactly, counter-clockwise; side k joins corner k to corner k + 1.

        One or two points if the kernel is a point or a segment.  Computed when first asked for.
        """
        if self.dimension < 2:
            return list(self.flat_corners)
        halfplanes = HalfPlanes(self.instance)
        return [self._corner(k, halfplanes) for k in range(len(self.sides))]

    def _corner(self, k: int, halfplanes: HalfPlanes) -> Point:
        """Where sides k − 1 and k meet: a polygon vertex if their edges are consecutive."""
        i, j, n = self.sides[k - 1], self.sides[k], self.instance.n
        if (i + 1) % n == j:
            return self.instance.exact_vertex(j)
        if (j + 1) % n == i:
            return self.instance.exact_vertex(i)
        return _as_fractions(halfplanes.meeting(i, j))

    @cached_property
    def floats(self) -> Floats:
        """The corners as nearest doubles, shape (k, 2)."""
        return np.array([[float(x), float(y)] for x, y in self.corners]).reshape(-1, 2)


def kernel(instance: Instance) -> Kernel:
    """The kernel of a simple polygon, in O(n log n).

    Emptiness, the presence of an interior and the sides are decided exactly.  The polygon must be
    simple (see :func:`harness.geometry.validation.validate`): of any other closed polygon this is
    merely the intersection of half-planes.  Raises :class:`UserError` if the instance is not a
    polygon or has no area.
    """
    if instance.kind != "polygon":
        raise UserError(f"{instance.label}: only a polygon has a kernel")
    if instance.n < 3 or instance.orientation == 0:
        raise UserError(f"{instance.label}: the polygon has no area, hence no kernel")
    return _Gap(HalfPlanes(instance)).kernel()


def why_not_star_shaped(instance: Instance, found: Kernel | None = None) -> str | None:
    """Why a simple polygon's kernel has no interior, naming edges; None if it has one.

    ``found`` is the polygon's kernel if it is already known.
    """
    found = found or kernel(instance)
    if found.has_interior:
        return None
    flat = {-1: "empty", 0: "a point, without interior", 1: "a segment, without interior"}
    edges = ", ".join(map(str, found.witness[:-1])) + f" and {found.witness[-1]} {COUNTING}"
    return (
        f"{instance.label}: the polygon is not star-shaped: its kernel is {flat[found.dimension]} "
        f"(no point lies strictly on the inner side of edges {edges})"
    )


def _as_fractions(point: exact.ExactPoint) -> Point:
    return exact.fraction(point[0]), exact.fraction(point[1])


def _first(count: int, true_from: Callable[[int], bool]) -> int:
    """The least i < count for which a monotone condition holds, else count."""
    return bisect_left(range(count), True, key=true_from)


class _Chain:
    """A piecewise linear function: the envelope of lines, given from left to right."""

    def __init__(self, halfplanes: HalfPlanes, edges: list[int]) -> None:
        self.edges = edges
        self._halfplanes = halfplanes
        self._lines: dict[int, tuple[Any, Any]] = {}

    def line(self, piece: int) -> tuple[Any, Any]:
        """Slope and intercept of a piece."""
        found = self._lines.get(piece)
        if found is None:
            found = self._lines[piece] = self._halfplanes.line(self.edges[piece])
        return found

    @property
    def bends(self) -> int:
        """The number of points where pieces meet."""
        return len(self.edges) - 1

    def bend(self, i: int) -> Any:
        """The abscissa where pieces i and i + 1 meet."""
        (slope, intercept), (next_slope, next_intercept) = self.line(i), self.line(i + 1)
        return (next_intercept - intercept) / (slope - next_slope)

    def before(self, x: Any) -> int:
        """The piece just left of x."""
        return _first(self.bends, lambda i: self.bend(i) >= x)

    def after(self, x: Any) -> int:
        """The piece just right of x."""
        return _first(self.bends, lambda i: self.bend(i) > x)

    def value(self, x: Any) -> Any:
        """The function at x."""
        slope, intercept = self.line(self.after(x))
        return slope * x + intercept


class _Gap:
    """The concave function h = g − f over [left, right]; the kernel is where it is ≥ 0."""

    def __init__(self, halfplanes: HalfPlanes) -> None:
        self.halfplanes = halfplanes
        headings = halfplanes.headings()
        self.floor = _Chain(halfplanes, halfplanes.envelope(1))
        self.roof = _Chain(halfplanes, halfplanes.envelope(-1)[::-1])
        upright = np.where(headings == 0, halfplanes.headings(axis=1), 0)
        self.left_edge, self.left = self._vertical_bound(upright < 0, -1)
        self.right_edge, self.right = self._vertical_bound(upright > 0, 1)

    def _vertical_bound(self, chosen: npt.NDArray[np.bool_], way: int) -> tuple[int | None, Any]:
        """The vertical edge that bounds x most (``way`` 1: from the right), and its abscissa.

        Rounding is monotone: only edges whose rounded abscissa is extreme need be looked at.
        """
        edges = np.flatnonzero(chosen)
        if not edges.size:
            return None, None
        x = way * self.halfplanes.instance.segments[edges, 0, 0]
        extreme = edges[x == x.min()].tolist()
        if self.halfplanes.instance.exact is None:
            extreme = extreme[:1]
        best = min(extreme, key=lambda edge: way * self.halfplanes.ends(edge)[0][0])
        return best, self.halfplanes.ends(best)[0][0]

    def height(self, x: Any) -> Any:
        """h(x)."""
        return self.roof.value(x) - self.floor.value(x)

    def rises(self, roof_piece: int, floor_piece: int) -> bool:
        """Whether h increases where these pieces are in force."""
        return bool(self.roof.line(roof_piece)[0] > self.floor.line(floor_piece)[0])

    def top(self) -> Any:
        """The least x at which h is greatest.

        As the directions of a closed polygon positively span the plane, h falls towards ±∞
        unless a vertical edge bounds x on that side, so the maximum exists.
        """
        if self.rises(0, 0):
            candidates = []
            for chain, other in ((self.floor, self.roof), (self.roof, self.floor)):

                def past(i: int, chain: _Chain = chain, other: _Chain = other) -> bool:
                    pieces = (i + 1, other.after(chain.bend(i)))
                    return not self.rises(*(pieces if chain is self.roof else pieces[::-1]))

                i = _first(chain.bends, past)
                if i < chain.bends:
                    candidates.append(chain.bend(i))
            top = min(candidates) if candidates else self.right
        else:
            top = self.left
        if self.right is not None and top > self.right:
            top = self.right
        return self.left if self.left is not None and top < self.left else top

    def kernel(self) -> Kernel:
        """Decide the dimension at the top, and collect the sides on both ways down."""
        instance = self.halfplanes.instance
        verticals = [edge for edge in (self.left_edge, self.right_edge) if edge is not None]
        if len(verticals) == 2 and self.left >= self.right:
            witness = tuple(sorted(verticals))
            ends: tuple[exact.ExactPoint, ...] = ()
            if self.left == self.right and self.height(self.left) >= 0:
                ends = tuple((self.left, c.value(self.left)) for c in (self.floor, self.roof))
            return self._flat(witness, ends)
        top = self.top()
        height = self.height(top)
        if height > 0:
            return Kernel(instance, 2, self._sides(top))
        active = [c.edges[p(top)] for c in (self.floor, self.roof) for p in (c.before, c.after)]
        witness = self.halfplanes.without_common_interior(active + verticals) or ()
        if height < 0:
            return self._flat(witness, ())
        end = top  # h = 0 from here to `end`, as far as the two pieces agree
        floor_piece, roof_piece = self.floor.after(top), self.roof.after(top)
        if self.floor.line(floor_piece) == self.roof.line(roof_piece) and top != self.right:
            stops = [c.bend(p) for c, p in self._both(floor_piece, roof_piece) if p < c.bends]
            end = min([*stops, *([] if self.right is None else [self.right])])
        return self._flat(witness, tuple((x, self.floor.value(x)) for x in (top, end)))

    def _both(self, floor_piece: int, roof_piece: int) -> tuple[tuple[_Chain, int], ...]:
        return (self.floor, floor_piece), (self.roof, roof_piece)

    def _flat(self, witness: tuple[int, ...], ends: tuple[exact.ExactPoint, ...]) -> Kernel:
        """A kernel without interior, from the ends of the segment that it is (if not empty)."""
        corners = tuple(dict.fromkeys(_as_fractions(point) for point in ends))
        return Kernel(self.halfplanes.instance, len(corners) - 1, [], witness, corners)

    def _sides(self, top: Any) -> list[int]:
        """The edges around a kernel with interior, whose greatest height is at ``top``."""

        def from_left(chain: _Chain) -> int:
            """The piece of ``chain`` at the kernel's left end."""
            if self.left is not None and self.height(self.left) >= 0:
                return chain.after(self.left)
            return _first(chain.bends, lambda i: chain.bend(i) >= top or self._open(chain, i))

        def to_right(chain: _Chain) -> int:
            """The piece of ``chain`` at the kernel's right end."""
            if self.right is not None and self.height(self.right) >= 0:
                return chain.before(self.right)
            return _first(chain.bends, lambda i: chain.bend(i) > top and not self._open(chain, i))

        floor = self.floor.edges[from_left(self.floor) : to_right(self.floor) + 1]
        roof = self.roof.edges[from_left(self.roof) : to_right(self.roof) + 1]
        right = self._vertical(self.right, self.right_edge)
        left = self._vertical(self.left, self.left_edge)
        return [*floor, *right, *roof[::-1], *left]

    def _open(self, chain: _Chain, i: int) -> bool:
        """Whether h > 0 at bend i of a chain."""
        return bool(self.height(chain.bend(i)) > 0)

    def _vertical(self, x: Any, edge: int | None) -> list[int]:
        """The vertical edge at x, if it bounds the kernel along some length."""
        return [edge] if edge is not None and self.height(x) > 0 else []
