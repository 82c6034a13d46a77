"""Leaves of two candidates: one arc, or two, or a saddle."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.forms import SIDES, value_and_gradient
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import ARC, EMPTY, FAILED, OPEN, SADDLE, TWO_ARCS, side_value
from harness.diagram.fast.loops import has_no_loop, hessian_controls, saddle_bounds
from harness.diagram.fast.sides import SIDE_AFTER


@compiled
def classify_pair(ports, w):
    """The kind of leaf that two candidates make; see :mod:`harness.diagram.fast.leaves`."""
    values, signs, bound, controls = w[0][0, 1], w[1][0, 1], w[2][0, 1], w[3][0, 1]
    if ports not in (0, 2, 4) or not has_no_loop(signs, values, bound, controls):
        return FAILED, 0, 0
    if ports == 0:
        return EMPTY, 0, 0
    if ports == 2:
        return ARC, 2, 0
    for piece in range(4):
        if pieces_are_joined(piece, w):
            return TWO_ARCS, 4, 1 if piece & 1 == 0 else 0
    return classify_saddle(w)


@compiled
def piece_point(piece, values, slots, positive, point):
    """A point (x, y) on the boundary in the piece after a port, of four; False if none is found."""
    here, there = slots[piece, 0], slots[(piece + 1) & 3, 0]
    if here == there and here & 1 and piece < 3:
        k = SIDE_AFTER[here >> 1]
        best, extreme = 0.0, 0.0
        for r in range(1, 16):
            value = side_value(values, k, r / 16.0)
            if (value > 0.0) == positive and abs(value) > extreme:
                best, extreme = r / 16.0, abs(value)
        if extreme == 0.0:
            return False
        start, t = here >> 1, best
    else:
        # The corner that follows the port, unless the next port is at it.
        start, t = ((here >> 1) + 1) % 3, 0.0
        if here & 1 == 0 or there == 2 * start:
            return False
    end = (start + 1) % 3
    x = (1.0 - t if start == 1 else 0.0) + (t if end == 1 else 0.0)
    y = (1.0 - t if start == 2 else 0.0) + (t if end == 2 else 0.0)
    point[0], point[1] = x, y
    return True


@compiled
def polar(b, p, q, r):
    """The polar form of a cubic at three points (x, y)."""
    x, y = p[0], p[1]
    z = 1.0 - x - y
    c0 = z * b[0] + x * b[3] + y * b[4]
    c1 = z * b[5] + x * b[1] + y * b[6]
    c2 = z * b[7] + x * b[8] + y * b[2]
    c3 = z * b[3] + x * b[5] + y * b[9]
    c4 = z * b[4] + x * b[9] + y * b[7]
    c5 = z * b[9] + x * b[6] + y * b[8]
    x, y = q[0], q[1]
    z = 1.0 - x - y
    d0 = z * c0 + x * c3 + y * c4
    d1 = z * c3 + x * c1 + y * c5
    d2 = z * c4 + x * c5 + y * c2
    return (1.0 - r[0] - r[1]) * d0 + r[0] * d1 + r[1] * d2


@compiled
def pieces_are_joined(piece, w):
    """Whether a piece and the one after next are certainly one cell: F keeps its sign on a chord
    between them, in Bernstein form on each half of it."""
    values, bound, slots = w[0][0, 1], w[2][0, 1], w[4]
    if piece > 1:
        # The same two pieces, from another point of each is not tried.
        return False
    positive = slots[piece, 1] == 0
    p, q, m = np.empty(2), np.empty(2), np.empty(2)
    if not piece_point(piece, values, slots, positive, p):
        return False
    if not piece_point(piece + 2, values, slots, positive, q):
        return False
    m[0], m[1] = 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])
    sign = 1.0 if positive else -1.0
    for value in (
        polar(values, p, p, p),
        polar(values, p, p, m),
        polar(values, p, m, m),
        polar(values, m, m, m),
        polar(values, m, m, q),
        polar(values, m, q, q),
        polar(values, q, q, q),
    ):
        if not sign * value > 2.0 * bound:
            return False
    return True


@compiled
def classify_saddle(w):
    """Saddle: at most one critical point in T, no extremum; the sign of F there decides.

    If F at the critical point p* is positive, the two pieces where F > 0 are joined: ascending
    lines leave p* on both sides.  That they reach different pieces follows if F − F(p*), too,
    changes sign just four times on the boundary; its coefficients are those of F, shifted, so we
    ask that no sign we used is within 2|F(p*)| of zero.
    """
    values, signs, bound = w[0][0, 1], w[1][0, 1], w[2][0, 1]
    slots, out = w[4], w[5]
    hx, hy = np.zeros((3, 2)), np.zeros((3, 2))
    hessian_controls(values, hx, hy)
    least, steep = saddle_bounds(hx, hy, bound)
    if least == 0.0:
        return FAILED, 0, 0
    for c in range(10):
        if signs[c] == 0:
            return FAILED, 0, 0
    # Newton for the critical point.
    x = y = 1.0 / 3.0
    for _ in range(12):
        gx, gy, jxx, jxy, jyx, jyy = _gradient_and_hessian(values, hx, hy, x, y, out)
        det = jxx * jyy - jxy * jyx
        dx, dy = (gx * jyy - jxy * gy) / det, (jxx * gy - jyx * gx) / det
        x, y = x - dx, y - dy
        if not (abs(x) < 4.0 and abs(y) < 4.0):
            return FAILED, 0, 0
        if abs(dx) + abs(dy) < 1e-15:
            break
    inside = min(x, y, (1.0 - x - y) * 0.7)
    if not inside > 0.0:
        return FAILED, 0, 0
    sigma = 0.99 * least / np.sqrt(steep)
    value_and_gradient(values, x, y, out)
    residue = abs(out[1]) + abs(out[2]) + 24.0 * bound
    radius = residue / sigma
    if not radius < inside:
        return FAILED, 0, 0
    # Within the ball |∇F| ≤ residue + radius·‖Hessian‖.
    reach = 2.0 * bound + 1.01 * radius * (residue + radius * np.sqrt(steep))
    level = abs(out[0]) + reach
    for k in range(3):
        for r in range(4):
            if not abs(values[SIDES[k, r]]) > 2.0 * level + bound:
                return FAILED, 0, 0
    w[6][0], w[6][1] = x, y
    if abs(out[0]) <= reach:
        return SADDLE, 4, OPEN
    # The candidate 0 is joined if F > 0.  Joining slots 1 and 3 is choice 0.
    joined = 0 if out[0] > 0.0 else 1
    return TWO_ARCS, 4, (0 if slots[1, 1] == joined else 1)


@compiled
def _gradient_and_hessian(values, hx, hy, x, y, out):
    value_and_gradient(values, x, y, out)
    z = 1.0 - x - y
    jxx = z * hx[0, 0] + x * hx[1, 0] + y * hx[2, 0]
    jxy = z * hx[0, 1] + x * hx[1, 1] + y * hx[2, 1]
    jyx = z * hy[0, 0] + x * hy[1, 0] + y * hy[2, 0]
    jyy = z * hy[0, 1] + x * hy[1, 1] + y * hy[2, 1]
    return out[1], out[2], jxx, jxy, jyx, jyy
