"""Exact points of root triangles."""

from __future__ import annotations

from fractions import Fraction

from harness.diagram.fast.roots import CornerTable, Roots
from harness.diagram.planar_map import RationalPoint

Homogeneous = tuple[Fraction, Fraction, Fraction]


def homogeneous(corners: CornerTable, corner: int) -> Homogeneous:
    """The exact coordinates x, y, w of a corner."""
    x, y = corners.exact[corner]
    return x, y, Fraction(corners.weights[corner])


def determinant(a: Homogeneous, b: Homogeneous, c: Homogeneous) -> Fraction:
    """Positive if a, b, c turn left (and no weight is negative)."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def exact_point(roots: Roots, root: int, weights: list[Fraction]) -> RationalPoint | None:
    """The exact point with given barycentric weights in a root; None at infinity."""
    corners = roots.triangles[root].tolist()
    w = sum(
        (f * Fraction(roots.corners.weights[c]) for f, c in zip(weights, corners, strict=True)),
        Fraction(0),
    )
    if w == 0:
        return None
    x, y = (
        sum(
            (f * roots.corners.exact[c][axis] for f, c in zip(weights, corners, strict=True)),
            Fraction(0),
        )
        / w
        for axis in range(2)
    )
    return x, y
