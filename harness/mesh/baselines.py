"""Methods to compare with: Laplacian, smart Laplacian, and smart Laplacian with ascent.

Kernels for :meth:`harness.mesh.state.State.sweep`.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled
from harness.mesh.angles import INVERTED, load_star, star_angles
from harness.mesh.soft import newton_step, softness, widest_of

PASSES = 12
FIRST, LAST = 10.0, 3000.0
"""Sharpness, per radian, along one vertex's ascent: its end is short of the top by ln(3k)/LAST."""


@compiled
def laplacian_sweep(order, first, last, offsets, degrees, ring, x, y):
    """Every vertex into the mean of its neighbours, whatever becomes of the triangles."""
    moved = 0
    for o in range(first, last):
        v = order[o]
        px = py = 0.0
        for i in range(offsets[v], offsets[v] + degrees[v]):
            px += x[ring[i]]
            py += y[ring[i]]
        px, py = px / degrees[v], py / degrees[v]
        if px != x[v] or py != y[v]:
            x[v], y[v] = px, py
            moved += 1
    return moved


@compiled
def smart_sweep(order, first, last, offsets, degrees, ring, x, y):
    """The same only where the least angle of the star rises."""
    widest = widest_of(order, first, last, degrees)
    rx, ry, angles = np.empty(widest), np.empty(widest), np.empty(3 * widest)
    moved = 0
    for o in range(first, last):
        v = order[o]
        k = load_star(v, offsets, degrees, ring, x, y, rx, ry)
        px, py = rx[:k].mean(), ry[:k].mean()
        least = star_angles(x[v], y[v], k, rx, ry, False, angles)
        if star_angles(px, py, k, rx, ry, True, angles) > least:
            x[v], y[v] = px, py
            moved += 1
    return moved


@compiled
def ascent_sweep(order, first, last, offsets, degrees, ring, x, y, threshold):
    """Towards the point of greatest least angle in every star whose least angle is too small.

    Each vertex alone, by Newton steps that grow sharper; it moves only if its star gets better.
    ``threshold``: in radians.
    """
    widest = widest_of(order, first, last, degrees)
    rx, ry, step = np.empty(widest), np.empty(widest), np.empty(2)
    angles, others = np.empty(3 * widest), np.empty(3 * widest)
    moved = 0
    for o in range(first, last):
        v = order[o]
        k = load_star(v, offsets, degrees, ring, x, y, rx, ry)
        px, py = x[v], y[v]
        begin = star_angles(px, py, k, rx, ry, False, angles)
        if not begin < threshold:
            continue
        least = begin
        for turn in range(PASSES):
            sharpness = FIRST * (LAST / FIRST) ** (turn / (PASSES - 1))
            total = softness(angles, 3 * k, sharpness, least)
            falls = newton_step(px, py, k, rx, ry, angles, sharpness, least, step)
            t = 1.0
            for _ in range(6):
                qx, qy = px + t * step[0], py + t * step[1]
                reached = star_angles(qx, qy, k, rx, ry, True, others)
                if reached != INVERTED:
                    less = softness(others, 3 * k, sharpness, least)
                    if less < total - 1e-4 * t * falls:
                        px, py, least = qx, qy, reached
                        angles, others = others, angles
                        break
                t *= 0.4
        if least > begin + 1e-9:
            x[v], y[v] = px, py
            moved += 1
    return moved
