"""Objective ``apex``: the paper's greedy.

A free vertex v is worth α(v), the least angle at v; the mesh is worth the sorted vector of all α,
in lexicographic order.  The vertex of least α is moved to the peak of the polygon around it, and
only if the vector rises; if it does not, the greedy goes on with the second, the third, … vertex
of the vector.  Every vertex whose polygon has changed comes back into the queue.

The paper's remedies for a small angle at the rim of the polygon (its Figure 6) look at the rim:
with them α(v) is the least of all angles of the triangles at v.  If after the move an angle at
the rim vertex w is less than those at v, a better place is looked for on the bisector of the
polygon's angle at w, or the edge v–w is replaced by the chord that cuts w off.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled
from harness.mesh.angles import INVERTED, load_star, star_angles
from harness.mesh.edges import can_flip, flip
from harness.mesh.queue import filled, pop, put
from harness.peak.cavity import peak_of

GAIN = 1e-5
"""Radians by which the first component of the vector that changes must rise."""
PARTS = 4
"""Steps towards the peak that are tried: all of it, a half, a quarter, an eighth."""
GOLDEN = 0.6180339887498949


@compiled
def worth(angles, k, rim):
    """The least angle at the centre; with ``rim``, of all angles."""
    least = np.inf
    for i in range(k):
        least = min(least, angles[3 * i])
        if rim:
            least = min(least, angles[3 * i + 1], angles[3 * i + 2])
    return least


@compiled
def worth_of(v, rim, offsets, degrees, ring, x, y, space):
    """α(v) where v is."""
    k = load_star(v, offsets, degrees, ring, x, y, space[0], space[1])
    star_angles(x[v], y[v], k, space[0], space[1], False, space[2])
    return worth(space[2], k, rim)


@compiled
def least_rim(angles, k):
    """The neighbour with the least angle at the rim, and that angle."""
    least, at = np.inf, -1
    for i in range(k):
        if angles[3 * i + 1] < least:
            least, at = angles[3 * i + 1], i
        if angles[3 * i + 2] < least:
            least, at = angles[3 * i + 2], (i + 1 if i + 1 < k else 0)
    return at, least


@compiled
def on_bisector(at, k, rx, ry, angles):
    """The best point for the centre on the bisector at a neighbour; (α, x, y), −1 if none.

    The kernel is convex, so it meets the ray in an interval, and along it the least visual angle
    rises to one top and falls: golden section.
    """
    before, after = at - 1 if at > 0 else k - 1, at + 1 if at + 1 < k else 0
    ax, ay, bx, by = (
        rx[before] - rx[at],
        ry[before] - ry[at],
        rx[after] - rx[at],
        ry[after] - ry[at],
    )
    a, b = np.sqrt(ax * ax + ay * ay), np.sqrt(bx * bx + by * by)
    dx, dy = ax / a + bx / b, ay / a + by / b
    if ax * by - ay * bx > 0.0:  # counter-clockwise from the next to the previous: reflex
        dx, dy = -dx, -dy
    low, high = 0.0, np.inf
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        ex, ey = rx[j] - rx[i], ry[j] - ry[i]
        height = ex * (ry[at] - ry[i]) - ey * (rx[at] - rx[i])
        slope = ex * dy - ey * dx
        if i == at or j == at:
            height = 0.0
        if slope > 0.0:
            low = max(low, -height / slope)
        elif slope < 0.0:
            high = min(high, height / -slope)
        elif height < 0.0:
            return -1.0, 0.0, 0.0
    if not low < high < np.inf:
        return -1.0, 0.0, 0.0
    s, t = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    fs = along(s, at, dx, dy, k, rx, ry, angles)
    ft = along(t, at, dx, dy, k, rx, ry, angles)
    for _ in range(40):
        if fs < ft:
            low, s, fs = s, t, ft
            t = low + GOLDEN * (high - low)
            ft = along(t, at, dx, dy, k, rx, ry, angles)
        else:
            high, t, ft = t, s, fs
            s = high - GOLDEN * (high - low)
            fs = along(s, at, dx, dy, k, rx, ry, angles)
    middle = 0.5 * (low + high)
    best = along(middle, at, dx, dy, k, rx, ry, angles)
    return best, rx[at] + middle * dx, ry[at] + middle * dy


@compiled
def along(t, at, dx, dy, k, rx, ry, angles):
    """The least visual angle at a point of the bisector; INVERTED outside the kernel."""
    if star_angles(rx[at] + t * dx, ry[at] + t * dy, k, rx, ry, True, angles) == INVERTED:
        return INVERTED
    return worth(angles, k, False)


@compiled
def is_above(old, new, count):
    """Whether the sorted vector ``new`` is above ``old``; both are sorted here."""
    old[:count].sort()
    new[:count].sort()
    for i in range(count):
        if new[i] != old[i]:
            return new[i] > old[i] + GAIN
    return False


@compiled
def attempt(v, qx, qy, rim, mesh, keys, scratch):
    """Move v to (qx, qy) if the vector of α rises; whether it moved."""
    offsets, degrees, ring, _, free, x, y = mesh
    old, new, space = scratch
    k = load_star(v, offsets, degrees, ring, x, y, space[0], space[1])
    if star_angles(qx, qy, k, space[0], space[1], True, space[2]) == INVERTED:
        return False
    px, py = x[v], y[v]
    x[v], y[v] = qx, qy
    old[0], new[0], count = keys[v], worth(space[2], k, rim), 1
    for i in range(offsets[v], offsets[v] + k):
        w = ring[i]
        if free[w]:
            old[count] = keys[w]
            new[count] = worth_of(w, rim, offsets, degrees, ring, x, y, space)
            count += 1
    if is_above(old, new, count):
        return True
    x[v], y[v] = px, py
    return False


@compiled
def cut_ear(v, w, rim, mesh, keys, scratch):
    """Replace the edge v–w by the chord between w's neighbours if the vector of α rises.

    Returns the ends of the chord, or (−1, −1).
    """
    offsets, degrees, ring, closed, free, x, y = mesh
    old, new, space = scratch
    a, b = can_flip(v, w, offsets, degrees, ring, closed, x, y)
    if a < 0:
        return -1, -1
    count = 0
    for u in (v, w, a, b):
        if free[u]:
            old[count] = keys[u]
            count += 1
    flip(v, w, a, b, offsets, degrees, ring, closed)
    count = 0
    for u in (v, w, a, b):
        if free[u]:
            new[count] = worth_of(u, rim, offsets, degrees, ring, x, y, space)
            count += 1
    if is_above(old, new, count):
        return a, b
    flip(a, b, w, v, offsets, degrees, ring, closed)
    return -1, -1


@compiled
def renew(v, rim, mesh, keys, queue, size, scratch):
    """New keys for v and its neighbours, all of which come (back) into the queue; the new size."""
    offsets, degrees, ring, _, free, x, y = mesh
    heap, place = queue
    for i in range(offsets[v] - 1, offsets[v] + degrees[v]):
        w = ring[i] if i >= offsets[v] else v
        if free[w]:
            key = worth_of(w, rim, offsets, degrees, ring, x, y, scratch[2])
            size = put(heap, place, keys, size, w, key)
    return size


@compiled
def climb(v, peak, rim, mesh, keys, scratch):
    """Move v to the peak, or some of the way; whether it moved.

    ``peak``: its coordinates, and the angle that is proven there.
    """
    if not rim and not peak[2] > keys[v] + GAIN:
        return False  # it is there
    px, py, part = mesh[5][v], mesh[6][v], 1.0
    for _ in range(PARTS):
        qx, qy = px + part * (peak[0] - px), py + part * (peak[1] - py)
        if attempt(v, qx, qy, rim, mesh, keys, scratch):
            return True
        part *= 0.5
    return False


@compiled
def weak_rim(v, mesh, rx, ry, angles):
    """The place in v's star with the least angle at the rim, if that is less than α(v); or −1."""
    k = load_star(v, mesh[0], mesh[1], mesh[2], mesh[5], mesh[6], rx, ry)
    star_angles(mesh[5][v], mesh[6][v], k, rx, ry, False, angles)
    at, least = least_rim(angles, k)
    return (at if least < worth(angles, k, False) else -1), k


@compiled
def greedy(waiting, offsets, degrees, ring, closed, free, x, y, bisector, chord, visits, moves):
    """The greedy, for at most so many visits and moves; (visits, moves, flips, whether done).

    ``waiting``: (n,), the vertices in the queue: at first the free ones, after a call those that
    are left.  ``bisector``, ``chord``: the remedies to use.
    """
    order = np.flatnonzero(waiting)
    rim = bisector or chord
    n, widest = len(degrees), int(np.diff(offsets).max())
    rx, ry, angles = np.empty(widest), np.empty(widest), np.empty(3 * widest)
    work, row, peak = np.empty((4, widest)), np.zeros((4, 4)), np.zeros(4)
    basis, nu, chosen = np.full(4, -1), np.zeros(3), np.full(3, -1)
    scratch = (np.empty(widest + 4), np.empty(widest + 4), np.empty((3, 3 * widest)))
    mesh = (offsets, degrees, ring, closed, free, x, y)
    keys = np.full(n, np.inf)
    for v in np.flatnonzero(free):
        keys[v] = worth_of(v, rim, offsets, degrees, ring, x, y, scratch[2])
    heap, place, size = filled(keys, order)
    queue = (heap, place)
    visited = moved = flips = 0
    while size > 0 and visited < visits and moved + flips < moves:
        v, size = pop(heap, place, keys, size)
        visited += 1
        k = load_star(v, offsets, degrees, ring, x, y, rx, ry)
        peak_of(rx, ry, 0, k, work, basis, nu, row, chosen, peak)
        if np.isfinite(peak[0]) and climb(v, peak, rim, mesh, keys, scratch):
            moved += 1
            size = renew(v, rim, mesh, keys, queue, size, scratch)
        if bisector:
            at, k = weak_rim(v, mesh, rx, ry, angles)
            if at >= 0:
                best, qx, qy = on_bisector(at, k, rx, ry, angles)
                if best > 0.0 and attempt(v, qx, qy, rim, mesh, keys, scratch):
                    moved += 1
                    size = renew(v, rim, mesh, keys, queue, size, scratch)
        if chord:
            at, k = weak_rim(v, mesh, rx, ry, angles)
            if at >= 0:
                w = ring[offsets[v] + at]
                a, b = cut_ear(v, w, rim, mesh, keys, scratch)
                if a >= 0:
                    flips += 1
                    for u in (v, w, a, b):
                        size = renew(u, rim, mesh, keys, queue, size, scratch)
    waiting[:] = place >= 0
    return visited, moved, flips, size == 0
