"""Circles in the form |p|² + g x + h y + r = 0, their crossings and halves, in doubles.

Every function works on arrays of equal shape.  Roots of quadratics are taken from the sum that
does not cancel, so that what lies near the origin is accurate however large the circles are (at
small angles they are nearly lines); the origin should be near the intersection of the discs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class Circles(NamedTuple):
    """The coefficients, each of one shape."""

    g: Floats
    h: Floats
    r: Floats

    def take(self, index: Ints) -> Circles:
        """The circles with these numbers."""
        return Circles(self.g[index], self.h[index], self.r[index])


def of_discs(centres: npt.ArrayLike, radii: npt.ArrayLike) -> Circles:
    """The circles with these centres, (n, 2), and radii, (n,)."""
    z, radius = np.asarray(centres, dtype=np.float64), np.asarray(radii, dtype=np.float64)
    norm = np.hypot(z[:, 0], z[:, 1])
    return Circles(-2 * z[:, 0], -2 * z[:, 1], (norm - radius) * (norm + radius))


def of_edges(level: Floats | float, edges: Floats) -> Circles:
    """The circles of edges at a level: where their visual angle has this cotangent.

    ``edges``: (4, n), starts and directions; ``level``: broadcast against n.
    """
    ax, ay, dx, dy = edges
    bx, by = ax + dx, ay + dy
    area = ax * dy - ay * dx
    return Circles(
        level * dy - (ax + bx), -level * dx - (ay + by), ax * bx + ay * by - level * area
    )


def roots(b: Floats, q: Floats) -> tuple[Floats, Floats]:
    """The lower and the upper root of t² + b t + q; of the vertex, where there is none."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        root = np.sqrt(np.maximum(b * b - 4 * q, 0.0))
        far = -0.5 * (b + np.where(b >= 0, root, -root))
        near = np.where(far != 0, q / far, 0.0)
        near = np.where(root > 0, near, far)
    return np.where(b >= 0, far, near), np.where(b >= 0, near, far)


def crossing(one: Circles, other: Circles, side: Ints) -> tuple[Floats, Floats]:
    """The crossing of two circles on one ``side`` (±1) of the line through their centres.

    With side 0 the circles are one and the same: (x of its leftmost point, y of its centre);
    with side 2 likewise its rightmost point.
    """
    a, b, e = other.g - one.g, other.h - one.h, other.r - one.r
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        square = a * a + b * b
        size = np.sqrt(square)
        px, py = -e * a / square, -e * b / square
        tx, ty = -b / size, a / size
        low, high = roots(
            one.g * tx + one.h * ty + 2 * (px * tx + py * ty),
            px * px + py * py + one.g * px + one.h * py + one.r,
        )
        t = np.where(side > 0, high, low)
        x, y = px + t * tx, py + t * ty
    left, right = roots(one.g, one.r - one.h * one.h / 4)
    extreme = (side == 0) | (side == 2)
    x = np.where(extreme, np.where(side == 0, left, right), x)
    return x, np.where(extreme, -one.h / 2, y)


def crossing_margin(one: Circles, other: Circles) -> Floats:
    """Positive iff the circles cross in two points: the power of the foot on the radical axis.

    The foot of the centre of ``one`` on the radical axis is the middle of the crossings.
    """
    a, b, e = other.g - one.g, other.h - one.h, other.r - one.r
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        square = a * a + b * b
        radius = (one.g * one.g + one.h * one.h) / 4 - one.r
        distance = e - (one.g * a + one.h * b) / 2
        margin = radius - distance * distance / square
    return np.where(square > 0, margin, -1.0)


def ordinate(circle: Circles, x: Floats, upper: npt.NDArray[np.bool_]) -> Floats:
    """y of the upper or lower half at x; of the centre, beyond the circle."""
    low, high = roots(circle.h, x * x + circle.g * x + circle.r)
    return np.where(upper, high, low)
