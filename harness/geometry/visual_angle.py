"""The visual angle of a segment from a point, and the two forms it is made of, in floating point.

For a segment s with endpoints a, b and a point p (the paper, section 2):

    Q(p) = (a − p)·(b − p)     quadratic, with leading part |p|² for every segment
    L(p) = (a − p)×(b − p)     affine, zero on the line through s, positive on its left
    cot θ_p(s) = Q / |L|,      θ ∈ [0, π]

All functions broadcast: ``points`` of shape (…, 2) against ``segments`` of shape (…, 2, 2) gives
arrays of shape (…).  To compare angles for certain, use :mod:`harness.geometry.predicates`.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from harness.geometry.coordinates import Floats


def Q(points: npt.ArrayLike, segments: npt.ArrayLike) -> Floats:
    """The inner product (a − p)·(b − p).

    Absolute error at most 5u(|a−p|ₓ|b−p|ₓ + |a−p|ᵧ|b−p|ᵧ), u = 2⁻⁵³, unless something over- or
    underflows; an overflow gives an infinity or NaN without a warning.
    """
    to_a, to_b = _to_ends(points, segments)
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        return np.asarray(to_a[..., 0] * to_b[..., 0] + to_a[..., 1] * to_b[..., 1])


def L(points: npt.ArrayLike, segments: npt.ArrayLike) -> Floats:
    """The cross product (a − p)×(b − p): twice the signed area of the triangle p, a, b.

    Absolute error at most 5u(|a−p|ₓ|b−p|ᵧ + |a−p|ᵧ|b−p|ₓ); for overflow see :func:`Q`.
    """
    to_a, to_b = _to_ends(points, segments)
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        return np.asarray(to_a[..., 0] * to_b[..., 1] - to_a[..., 1] * to_b[..., 0])


def visual_angle(points: npt.ArrayLike, segments: npt.ArrayLike) -> Floats:
    """The visual angle θ in radians, in [0, π]; NaN at the endpoints of a segment.

    It is 0 on the line of s outside of s and π inside s.  The two directions are scaled before
    they are multiplied, so that any finite coordinates will do; the absolute error is below
    16u ≈ 2·10⁻¹⁵ (2u for the rounding of each direction, 8u for the two products, the rest for
    the arc tangent).  Only coordinates beyond 2¹⁰²¹ beside others below 2⁻¹⁰²⁰ lose more.
    """
    q, area = _bounded_forms(points, segments)
    angle = np.arctan2(np.abs(area), q)
    return np.where((q == 0) & (area == 0), np.nan, angle)


def cot_visual_angle(points: npt.ArrayLike, segments: npt.ArrayLike) -> Floats:
    """cot θ = Q / |L|, decreasing in θ.

    +∞ on the line of s outside of s, −∞ inside s, NaN at the endpoints of s.
    """
    q, area = _bounded_forms(points, segments)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
        return np.asarray(q / np.abs(area))


def _to_ends(points: npt.ArrayLike, segments: npt.ArrayLike) -> tuple[Floats, Floats]:
    """The vectors from the points to both ends of the segments."""
    p = np.asarray(points, dtype=np.float64)
    s = np.asarray(segments, dtype=np.float64)
    with np.errstate(over="ignore", under="ignore"):
        return s[..., 0, :] - p, s[..., 1, :] - p


def _bounded_forms(points: npt.ArrayLike, segments: npt.ArrayLike) -> tuple[Floats, Floats]:
    """Q and L divided by a common positive factor |a − p||b − p|, up to powers of two."""
    p = np.asarray(points, dtype=np.float64)
    s = np.asarray(segments, dtype=np.float64)
    if max(np.abs(p).max(initial=0.0), np.abs(s).max(initial=0.0)) > 2.0**1021:
        p, s = p / 4, s / 4  # so that no difference overflows
    with np.errstate(under="ignore"):
        a, b = _unit(s[..., 0, :] - p), _unit(s[..., 1, :] - p)
        q = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
        return np.asarray(q), np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _unit(vectors: Floats) -> Floats:
    """Vectors times powers of two that bring their largest coordinates into [1/2, 1)."""
    _, exponent = np.frexp(np.abs(vectors).max(axis=-1, keepdims=True))
    return np.asarray(np.ldexp(vectors, -exponent))
