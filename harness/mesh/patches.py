"""Worst first: the patch around the worst vertex is smoothed as a whole, and kept if better.

One vertex alone often cannot raise the least angle of its star, because its neighbours' angles
are as small; the vertices within some steps of it together can.  A patch is kept only if the
least angle of all triangles that it changed has risen, so the sorted vector of the triangles'
least angles rises in lexicographic order with every patch that is kept.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled
from harness.mesh.angles import star_least
from harness.mesh.queue import filled, pop, put
from harness.mesh.soft import soft_sweep

RADIUS, WIDER, TRIES = 4, 2, 3
"""Steps from the worst vertex to the rim; how much wider after a failure; when to give it up."""
ROUNDS = 12
SHARP = 80.0, 400.0
"""Sharpness of the first and of the last round, per radian."""
GAIN = 1e-5
"""Radians by which a patch must be better."""


@compiled
def gather(v, radius, offsets, degrees, ring, free, mark, tick, patch):
    """The free vertices within ``radius`` steps of v, v first, through free ones; their number."""
    count, low = 1, 0
    patch[0], mark[v] = v, tick
    for _ in range(radius):
        high = count
        for a in range(low, high):
            u = patch[a]
            for i in range(offsets[u], offsets[u] + degrees[u]):
                w = ring[i]
                if free[w] and mark[w] != tick:
                    mark[w] = tick
                    patch[count] = w
                    count += 1
        low = high
    return count


@compiled
def smooth_patch(patch, count, rounds, low, high, offsets, degrees, ring, x, y):
    """Soft sweeps over a patch while the sharpness grows from ``low`` to ``high``; the moves."""
    moved = 0
    for r in range(rounds):
        sharpness = low * (high / low) ** (r / max(rounds - 1, 1))
        moved += soft_sweep(patch, 0, count, offsets, degrees, ring, x, y, sharpness)
    return moved


@compiled
def least_of(patch, count, offsets, degrees, ring, closed, x, y):
    """The least angle of all triangles at vertices of a patch."""
    least = np.inf
    for a in range(count):
        least = min(least, star_least(patch[a], offsets, degrees, ring, closed, x, y))
    return least


@compiled
def mend(order, offsets, degrees, ring, closed, free, x, y, failures, budget):
    """Smooth the patches of the worst vertices, until ``budget`` visits of vertices are used.

    ``order``: the free vertices.  ``failures``: (n,), how often each vertex's patch was no better;
    kept from call to call.  Returns (visits, moves, whether nothing is left to be done).
    """
    n = len(degrees)
    keys = np.full(n, np.inf)
    for v in order:
        keys[v] = star_least(v, offsets, degrees, ring, closed, x, y)
    heap, place, size = filled(keys, order[failures[order] < TRIES])
    mark, patch = np.full(n, -1), np.empty(n, np.int64)
    old_x, old_y = np.empty(n), np.empty(n)
    visits, moves, tick = 0, 0, 0
    while size > 0 and visits < budget:
        v, size = pop(heap, place, keys, size)
        tick += 1
        radius = RADIUS + WIDER * failures[v]
        count = gather(v, radius, offsets, degrees, ring, free, mark, tick, patch)
        for a in range(count):
            old_x[a], old_y[a] = x[patch[a]], y[patch[a]]
        least = least_of(patch, count, offsets, degrees, ring, closed, x, y)
        moved = smooth_patch(patch, count, ROUNDS, *SHARP, offsets, degrees, ring, x, y)
        visits += count * ROUNDS
        if least_of(patch, count, offsets, degrees, ring, closed, x, y) > least + GAIN:
            moves += moved
            for a in range(count):
                u = patch[a]
                failures[u] = 0
                for i in range(offsets[u], offsets[u] + degrees[u]):
                    w = ring[i]
                    if free[w] and mark[w] != tick and place[w] >= 0:
                        key = star_least(w, offsets, degrees, ring, closed, x, y)
                        size = put(heap, place, keys, size, w, key)
                key = star_least(u, offsets, degrees, ring, closed, x, y)
                size = put(heap, place, keys, size, u, key)
            continue
        for a in range(count):
            x[patch[a]], y[patch[a]] = old_x[a], old_y[a]
        failures[v] += 1
        if failures[v] < TRIES:
            size = put(heap, place, keys, size, v, keys[v])
    return visits, moves, size == 0
