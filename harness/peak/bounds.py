"""What doubles prove about an optimum: an angle that is reached, and one that is not exceeded.

Both bounds hold for the polygon as given, however the point and the multipliers were found; if
those are poor the bounds are far apart, never wrong.  u = 2⁻⁵³.  Here the point is the origin, and
``ax``, ``ay``, ``dx``, ``dy`` are the starts and the directions of the edges, counter-clockwise,
each coordinate with a relative error of at most u (one rounded difference of given numbers).

Products may be as small as doubles can be, and then have absolute errors instead of relative
ones: u times FAINT is more than any of them, so that FAINT counts as a part of every size.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled
from harness.peak.powers import FAINT, NONE

ULP = 2.0**-53
SEEN = 32.0 * ULP
"""An absolute error bound for a visual angle: relative errors u of four coordinates and rounded
products make 8u for Q and L each relative to |a||b|, the arc tangent and its quotient 4u, choosing
the least angle by its rounded cotangent 2u; the rest is a reserve."""


@compiled
def least_angle(corner, ax, ay, dx, dy, n):
    """The least visual angle of the n edges from the origin, less its error, and its edge.

    ``corner`` names the vertex the origin lies in (−1: none), whose two edges are left out.
    The angle is −1 unless the origin is certainly strictly to the left of all (other) edges.
    """
    worst, chosen, seen_l, seen_q = -np.inf, NONE, 0.0, 1.0
    before = n - 1 if corner == 0 else corner - 1
    ux, uy = ax[0], ay[0]
    for i in range(n):
        k = i + 1 if i + 1 < n else 0
        vx, vy = ax[k], ay[k]
        if corner == NONE or (i != corner and i != before):
            wx, wy = dx[i], dy[i]
            if abs(vx) + abs(vy) < abs(wx) + abs(wy):  # the better conditioned of equal forms
                wx, wy = vx, vy
            left, right = ux * wy, uy * wx
            level = left - right
            if not level > 4.0 * ULP * (abs(left) + abs(right) + FAINT):
                return -1.0, i
            q = ux * vx + uy * vy
            if not max(level, abs(q)) > FAINT:  # errors would be no small part of |a||b|
                return -1.0, i
            f = q / level
            if f > worst:
                worst, chosen, seen_l, seen_q = f, i, level, q
        ux, uy = vx, vy
    return np.arctan2(seen_l, seen_q) - SEEN, chosen


@compiled
def cotangent_bound(c, basis, nu, ax, ay, dx, dy, n):
    """A level c' ≤ c* near c, by weak duality; −∞ if the multipliers ``nu`` prove nothing.

    For any ν ≥ 0,  min_q Σ ν_i E_i(q, c − η) − Σ ν_e L_e(q) = T + η s − |G + η H|²/(4S)  with T, G
    the value and gradient of the sum at the origin, s = Σ ν_i L_i, H = Σ ν_i ∇L_i and S = Σ ν_i
    (over discs).  If that is positive, no point of the kernel is in all discs of level c − η.
    Every product is off by less than 8u of its size, FAINT included.
    """
    value = gx = gy = s = hx = hy = total = 0.0
    value_size = g_size = s_size = h_size = 0.0
    for k in range(3):
        if basis[k] == NONE:
            continue
        i = basis[k] >> 1
        j = i + 1 if i + 1 < n else 0
        weight = max(nu[k], 0.0)
        ux, uy, vx, vy, wx, wy = ax[i], ay[i], ax[j], ay[j], dx[i], dy[i]
        area, area_size = ux * wy - uy * wx, abs(ux * wy) + abs(uy * wx) + FAINT
        if basis[k] & 1:
            value -= weight * area
            value_size += weight * area_size + FAINT
            gx += weight * wy
            gy -= weight * wx
            g_size += weight * (abs(wx) + abs(wy)) + FAINT
            continue
        value += weight * (ux * vx + uy * vy - c * area)
        q_size = abs(ux * vx) + abs(uy * vy) + FAINT
        value_size += weight * (q_size + abs(c) * area_size) + FAINT
        gx += weight * (c * wy - (ux + vx))
        gy -= weight * (c * wx + (uy + vy))
        g_size += weight * (abs(ux) + abs(uy) + abs(vx) + abs(vy) + abs(c) * (abs(wx) + abs(wy)))
        g_size += FAINT
        s += weight * area
        s_size += weight * area_size + FAINT
        hx -= weight * wy
        hy += weight * wx
        h_size += weight * (abs(wx) + abs(wy)) + FAINT
        total += weight
    value -= 16.0 * ULP * value_size
    s -= 16.0 * ULP * s_size
    slope = np.hypot(gx, gy) * (1.0 + 8.0 * ULP) + 16.0 * ULP * g_size
    if not (s > 0.0 and total > 0.0):
        return -np.inf
    turn = np.hypot(hx, hy) * (1.0 + 8.0 * ULP) + 16.0 * ULP * h_size
    eta = 1.01 * max(0.0, slope * slope / (4.0 * total) - value) / s
    moved = slope + eta * turn
    if np.inf > value + eta * s >= 1.001 * moved * moved / (4.0 * total) + FAINT:
        return (c - eta) - 2.0 * ULP * (abs(c) + eta)
    return -np.inf


@compiled
def angle_of(c):
    """acot c in (0, π), rounded up; π for c = −∞."""
    return np.arctan2(1.0, c) + 8.0 * ULP


@compiled
def bound_of_start(c):
    """The angle of the level an ascent starts from, rounded up.

    That level is a quotient of sine and cosine of 2π/n, or of half the turn at a vertex, which
    rounding moves by a few u of radians.
    """
    return angle_of(c) + 16.0 * ULP
