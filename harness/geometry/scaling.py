"""Coordinates brought into [−1, 1], so that no filter can overflow."""

from __future__ import annotations

import numpy as np

from harness.geometry.coordinates import Floats


def scaled(floats: Floats, rounded: bool) -> tuple[Floats, float]:
    """``floats`` times the power of two that brings them into [−1, 1], and the slack of filters.

    ``rounded`` says that the floats are only the nearest doubles of the true coordinates.

    Scaling changes no sign of a homogeneous predicate.  The slack is 0 if every scaled double is
    exactly the (scaled) coordinate; otherwise it is 32 ε + 2⁻¹⁰⁵⁰, where ε bounds the distance
    from a scaled double to its coordinate:

    * if the coordinates are doubles, multiplying by a power of two is exact unless it
      underflows, and then off by at most ε = 2⁻¹⁰⁷⁵;
    * if they are rationals, a double is off by at most 2⁻⁵³ times its size or by 2⁻¹⁰⁷⁵ before
      scaling; if the largest is at least 2⁻¹⁰⁰⁰, both are at most ε = 2⁻⁵³ afterwards.  If it is
      less, the slack is so large that no filter decides anything.
    """
    largest = float(np.abs(floats).max(initial=0.0))
    if largest == 0.0 or (rounded and largest < 2.0**-1000):
        return np.zeros_like(floats), 32.0 if rounded else 0.0
    exponent = -int(np.frexp(largest)[1])
    with np.errstate(under="ignore"):
        result: Floats = np.ldexp(floats, exponent)
        if rounded:
            return result, 32 * 2.0**-53
        exact = bool((np.ldexp(result, -exponent) == floats).all())
    return result, 0.0 if exact else 32 * 2.0**-1075 + 2.0**-1050
