"""Exact points of root triangles."""

from __future__ import annotations

from fractions import Fraction

from harness.diagram.fast.roots import Roots
from harness.diagram.planar_map import RationalPoint


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
