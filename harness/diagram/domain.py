"""The domain of a diagram: a simple polygon (kernel or interior) or the whole plane."""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb, fmpq, fmpz_mpoly

from harness.diagram.algebra import Point, Polynomial, U, V
from harness.diagram.fibres import Strip
from harness.diagram.planar_map import RationalPoint
from harness.diagram.scene import Scene


class Region:
    """A simple polygon in sheared coordinates; without corners it is the whole plane.

    ``corners``: counter-clockwise, as exact points.  ``walls[k]`` is the line from corner k to
    corner k+1, positive inside near the wall.
    """

    def __init__(self, scene: Scene, corners: Sequence[RationalPoint]) -> None:
        """``corners``: counter-clockwise rational points, or none for the plane."""
        following = [*corners[1:], *corners[:1]]
        self.is_plane = not corners
        self.corners = [scene.sheared(corner) for corner in corners]
        self.walls = [scene.line_through(a, b) for a, b in zip(corners, following, strict=True)]
        self._right = [_offset(corner.coordinates[0], U) for corner in self.corners]
        self._up = [_offset(corner.coordinates[1], V) for corner in self.corners]

        by_u = sorted(self.corners, key=lambda corner: corner.coordinates[0])
        self.strip: Strip = (by_u[0], by_u[-1]) if by_u else (None, None)
        self.is_convex = all(
            corner.sign(wall) >= 0 for corner in self.corners for wall in self.walls
        )

    def surely_outside(self, u: arb, v: arb) -> bool:
        """True only if the box u × v is certainly disjoint from the closed (convex) domain."""
        return self.is_convex and any(wall.at_balls(u, v) < 0 for wall in self.walls)

    def side(self, p: Point) -> int:
        """+1 inside, 0 on the boundary, −1 outside: walls below p on its vertical line, counted."""
        if self.is_plane:
            return 1
        offsets = [p.sign(right) for right in self._right]
        inside = False
        for k, wall in enumerate(self.walls):
            here, there = offsets[k], offsets[(k + 1) % len(offsets)]
            if here == 0 and p.sign(self._up[k]) == 0:
                return 0
            if (here > 0) == (there > 0):
                continue
            # u grows along the wall from a corner left of p to a corner right of p.
            side = p.sign(wall) * (1 if there > 0 else -1)
            if side == 0:
                return 0
            inside ^= side > 0
        return 1 if inside else -1

    def wall_contains(self, k: int, p: Point) -> bool:
        """Whether p, known to be on the line of wall k, is on the closed wall."""
        here, there = p.sign(self._right[k]), p.sign(self._right[(k + 1) % len(self.walls)])
        return here * there <= 0


def _offset(value: fmpq, coordinate: fmpz_mpoly) -> Polynomial:
    """A polynomial with the sign of value − coordinate."""
    return Polynomial(int(value.p) - int(value.q) * coordinate)
