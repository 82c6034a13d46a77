"""Soft max–min: vertices go where the sum of exp(−s · angle) over their stars is less.

As the sharpness s grows, the minimum of that sum tends to the point of greatest least angle: its
least angle is short of the optimum by at most ln(3k)/s radians in a star of k triangles.  Sweeps
with a small s spread the angles evenly over the whole mesh and do not stop where one vertex alone
cannot raise the least angle, which is where plain max–min sweeps get stuck; s grows from sweep to
sweep.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled
from harness.mesh.angles import INVERTED, load_star, star_angles

HALVINGS = 8
SHORTER = 0.4
ENOUGH = 1e-4
"""The part of the predicted decrease that a step must reach (Armijo)."""
NOTHING = 1e-9
"""A predicted decrease, relative to the sum, that is not worth a move."""
DEFINITE = 1e-6


@compiled
def softness(angles, count, sharpness, shift):
    """The sum of exp(−s (angle − shift))."""
    total = 0.0
    for i in range(count):
        total += np.exp(-sharpness * (angles[i] - shift))
    return total


@compiled
def newton_step(px, py, k, rx, ry, angles, sharpness, shift, step):
    """Newton's step for the sum at (px, py); returns how fast the sum falls along it.

    Every angle at the centre is a difference of two arguments A_i = arg(p − r_i), every other one
    is such an argument but for a constant; so gradients and second derivatives are those of the
    A_i, which are harmonic.  Where the matrix is not safely positive, only the squares of the
    gradients stay in it.
    """
    gx = gy = hxx = hxy = hyy = cxx = cxy = 0.0
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        wx, wy, ux, uy = px - rx[i], py - ry[i], px - rx[j], py - ry[j]
        r, q = 1.0 / (wx * wx + wy * wy), 1.0 / (ux * ux + uy * uy)
        ax, ay, bx, by = -wy * r, wx * r, -uy * q, ux * q
        apex = np.exp(-sharpness * (angles[3 * i] - shift))
        base = np.exp(-sharpness * (angles[3 * i + 1] - shift))
        rest = np.exp(-sharpness * (angles[3 * i + 2] - shift))
        dx, dy = bx - ax, by - ay
        gx += apex * dx + base * ax - rest * bx
        gy += apex * dy + base * ay - rest * by
        hxx += apex * dx * dx + base * ax * ax + rest * bx * bx
        hxy += apex * dx * dy + base * ax * ay + rest * bx * by
        hyy += apex * dy * dy + base * ay * ay + rest * by * by
        fa, fb = (base - apex) * r * r, (apex - rest) * q * q
        cxx += 2.0 * (fa * wx * wy + fb * ux * uy)
        cxy += fa * (wy * wy - wx * wx) + fb * (uy * uy - ux * ux)
    a, b, d = sharpness * hxx - cxx, sharpness * hxy - cxy, sharpness * hyy + cxx
    trace, determinant = a + d, a * d - b * b
    if not (trace > 0.0 and determinant > DEFINITE * trace * trace):
        a, b, d = sharpness * hxx, sharpness * hxy, sharpness * hyy
        more = 1e-3 * (a + d)
        a, d = a + more, d + more
        determinant = a * d - b * b
    step[0], step[1] = (d * gx - b * gy) / determinant, (a * gy - b * gx) / determinant
    return sharpness * (gx * step[0] + gy * step[1])


@compiled
def widest_of(order, first, last, degrees):
    """The greatest degree among order[first:last]."""
    widest = 0
    for o in range(first, last):
        widest = max(widest, degrees[order[o]])
    return widest


@compiled
def soft_sweep(order, first, last, offsets, degrees, ring, x, y, sharpness):
    """One guarded Newton step for each of the vertices order[first:last]; how many moved.

    A vertex moves only to where all its triangles are proven to be positive and the sum is less.
    The stars must be closed.
    """
    widest = widest_of(order, first, last, degrees)
    rx, ry, step = np.empty(widest), np.empty(widest), np.empty(2)
    angles, others = np.empty(3 * widest), np.empty(3 * widest)
    moved = 0
    for o in range(first, last):
        v = order[o]
        k = load_star(v, offsets, degrees, ring, x, y, rx, ry)
        px, py = x[v], y[v]
        shift = star_angles(px, py, k, rx, ry, False, angles)
        total = softness(angles, 3 * k, sharpness, shift)
        falls = newton_step(px, py, k, rx, ry, angles, sharpness, shift, step)
        if not falls > NOTHING * total:
            continue
        t = 1.0
        for _ in range(HALVINGS):
            qx, qy = px + t * step[0], py + t * step[1]
            if star_angles(qx, qy, k, rx, ry, True, others) != INVERTED:
                less = softness(others, 3 * k, sharpness, shift)
                if less < total - ENOUGH * t * falls:
                    x[v], y[v] = qx, qy
                    moved += 1
                    break
            t *= SHORTER
    return moved
