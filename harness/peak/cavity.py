"""One polygon from coordinates to a certified peak, compiled: the direct branch, without set-up."""

from __future__ import annotations

import math

import numpy as np

from harness.geometry.jit import compiled
from harness.peak.ascent import ascend, cap_cotangent, greatest_cap
from harness.peak.bounds import SEEN, ULP, angle_of, bound_of_start, cotangent_bound, least_angle
from harness.peak.powers import FAINT, NONE

CERTIFIED, OPEN, IMPROPER = 0, 1, 2
"""The bounds are close enough; they are not (or the kernel has no interior); no polygon at all:
fewer than three vertices, two equal neighbours, no area, coordinates that are not finite, or
bounds that contradict each other, as only those of a polygon that winds around twice can."""
WIDTH = 1e-12
"""The greatest difference between the proven bounds of a certified angle, in radians."""
STEP_INSIDE = 2.0**-50
MOST_TRIES = 3


@compiled
def unit_of(x, y, first, n):
    """A power of two that brings the polygon to a size between 1/2 and 1, or as near as can be.

    So that no product of coordinates leaves the range of doubles on account of the size alone.
    """
    size = 0.0
    for k in range(first, first + n):
        size = max(size, abs(x[k] - x[first]), abs(y[k] - y[first]))
    exponent = math.frexp(size)[1] if size < np.inf else 1025
    return math.ldexp(1.0, min(max(-exponent, -1020), 1020))


@compiled
def place(ox, oy, unit, x, y, first, n, sense, ax, ay, dx, dy):
    """Starts and directions of the edges, counter-clockwise, seen from (ox, oy), times ``unit``.

    With ``sense`` −1 the vertices are listed clockwise and edge j is segment n − 1 − j.
    """
    for j in range(n):
        if sense > 0:
            a, b = first + j, first + (j + 1 if j + 1 < n else 0)
        else:
            a, b = first + (n - j if j > 0 else 0), first + n - 1 - j
        ax[j], ay[j] = unit * (x[a] - ox), unit * (y[a] - oy)
        dx[j], dy[j] = unit * (x[b] - x[a]), unit * (y[b] - y[a])


@compiled
def twice_area(unit, x, y, first, n):
    """(area, error): twice the signed area, times ``unit`` squared, and how far it may be off.

    The area is NaN if a coordinate is not finite or two neighbours are equal.
    """
    area = size = 0.0
    ox, oy = x[first], y[first]
    for k in range(n):
        a, b = first + k, first + (k + 1 if k + 1 < n else 0)
        if not (np.isfinite(x[a]) and np.isfinite(y[a])) or (x[a] == x[b] and y[a] == y[b]):
            return np.nan, 0.0
        ux, uy, vx, vy = x[a] - ox, y[a] - oy, x[b] - ox, y[b] - oy
        left, right = unit * ux * (unit * vy), unit * uy * (unit * vx)
        area += left - right
        size += abs(left) + abs(right) + FAINT
    return area, (n + 4.0) * 2.0 * ULP * size


@compiled
def inside(px, py, ulps_of, basis, ax, ay, dx, dy):
    """The point moved off the walls of the basis, by a few ulps of their edges' size.

    ``ulps_of``: a size whose ulps the steps must reach at least.
    """
    for k in range(3):
        if basis[k] != NONE and basis[k] & 1:
            i = basis[k] >> 1
            near = ulps_of + abs(ax[i]) + abs(ay[i]) + abs(dx[i]) + abs(dy[i])
            step = STEP_INSIDE * near / np.sqrt(dx[i] * dx[i] + dy[i] * dy[i])
            px -= step * dy[i]
            py += step * dx[i]
    return px, py


@compiled
def certify(c, start, capped, px, py, unit, basis, nu, x, y, first, n, sense, ax, ay, dx, dy, out):
    """Fill ``out`` = (x, y, lower, upper) near (px, py); the vertex that the point is, or −1.

    ``unit``: see :func:`place`.  ``start``: the level at which the ascent began, which bounds the
    angle from above; ``capped``: the vertex whose cap that is (−1: none).  A vertex counts as a
    point at which its two edges are seen under its cap (the limit along the best direction); the
    basis then becomes these two edges and, if it is seen under less, a third.
    """
    place(px, py, unit, x, y, first, n, sense, ax, ay, dx, dy)
    upper = bound_of_start(start)
    lower, _ = least_angle(NONE, ax, ay, dx, dy, n)
    out[0], out[1] = px, py
    upper = min(upper, angle_of(cotangent_bound(c, basis, nu, ax, ay, dx, dy, n)))
    at = least = NONE
    for slot in range(7):  # the capped vertex, and the ends of the edges of the basis
        if upper - lower <= WIDTH:
            break
        corner = capped if slot == 6 else basis[slot >> 1] >> 1
        if corner == NONE:
            continue
        if slot < 6 and slot & 1:
            corner = corner + 1 if corner + 1 < n else 0
        k = first + (corner if sense > 0 else (n - corner if corner > 0 else 0))
        place(x[k], y[k], unit, x, y, first, n, sense, ax, ay, dx, dy)
        before = n - 1 if corner == 0 else corner - 1
        cap = cap_cotangent(dx[before], dy[before], dx[corner], dy[corner])
        others, edge = least_angle(corner, ax, ay, dx, dy, n)
        own = angle_of(cap) - SEEN if cap > -np.inf else -1.0
        reached = min(others, own)
        upper = min(upper, angle_of(cotangent_bound(c, basis, nu, ax, ay, dx, dy, n)))
        if reached > lower:
            lower, at = reached, corner
            least = edge if others < own else NONE
            out[0], out[1] = x[k], y[k]
    if at != NONE:
        basis[0], basis[1] = 2 * (at - 1 if at > 0 else n - 1), 2 * at
        basis[2] = 2 * least if least != NONE else NONE
    out[2], out[3] = lower if lower >= 0.0 else np.nan, upper
    return at


@compiled
def peak_of(x, y, first, n, space, basis, nu, row, chosen, out):
    """The peak of one polygon; (status, vertex).

    ``x``, ``y``: coordinates, of which n from ``first`` on are the vertices, in either sense.
    ``space``: (4, at least n), to work in.  ``out`` = (x, y, lower, upper).  ``basis``: three
    constraints with multipliers ``nu``, in the numbers of the segments (segment i joins vertices
    i and i + 1).  ``vertex``: the vertex that the point is, −1 if it is none.
    """
    ax, ay, dx, dy = space[0], space[1], space[2], space[3]
    out[0] = out[1] = out[2] = out[3] = np.nan
    basis[:] = NONE
    if n < 3:
        return IMPROPER, NONE
    unit = unit_of(x, y, first, n)
    area, error = twice_area(unit, x, y, first, n)
    if area == 0.0 or np.isnan(area):
        return IMPROPER, NONE
    if not abs(area) > error:  # which side is inside?
        out[3] = np.pi
        return OPEN, NONE
    sense = 1 if area > 0.0 else -1
    ox = oy = 0.0
    for k in range(n):
        ox += x[first + k] / n
        oy += y[first + k] / n
    place(ox, oy, unit, x, y, first, n, sense, ax, ay, dx, dy)
    start, capped = greatest_cap(dx, dy, n)
    state = np.zeros(3)
    for _ in range(MOST_TRIES):
        state[:] = 0.0
        basis[:] = NONE
        c, _ = ascend(start, state, basis, nu, row, chosen, ax, ay, dx, dy, n)
        ulps_of = unit * (abs(ox) + abs(oy))
        px, py = inside(state[0], state[1], ulps_of, basis, ax, ay, dx, dy)
        ox, oy = ox + px / unit, oy + py / unit
        vertex = certify(
            c, start, capped, ox, oy, unit, basis, nu, x, y, first, n, sense, ax, ay, dx, dy, out
        )
        if not out[3] - out[2] > WIDTH:  # good enough, or no point inside
            break
        place(ox, oy, unit, x, y, first, n, sense, ax, ay, dx, dy)  # more accurate from near by
    if sense < 0:
        for k in range(3):
            if basis[k] != NONE:
                basis[k] = 2 * (n - 1 - (basis[k] >> 1)) + (basis[k] & 1)
        if vertex > 0:
            vertex = n - vertex
    if out[3] < out[2]:  # all edges are seen under more than 2π/n: once around is less
        out[:] = np.nan
        basis[:] = NONE
        return IMPROPER, NONE
    return (CERTIFIED if out[3] - out[2] <= WIDTH else OPEN), vertex
